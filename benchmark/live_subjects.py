"""The programs that the live benchmark measures; they hear all that the robot publishes."""
from __future__ import annotations

import abc
import subprocess
import threading
import time
from pathlib import Path
from tempfile import mkdtemp
from typing import Callable, List, NamedTuple, Sequence, Tuple

import rosbag
import rospy
from diagnostic_msgs.msg import DiagnosticArray

from live_robot import SUBJECT_CORE, pin, record_command
from programs import built
from self_awareness.msg import SelfAwareness
from self_awareness_evaluation.live.processes import Processes, await_condition


class Usage(NamedTuple):
    """What a process has used so far."""

    cpu_s: float
    """User and system."""
    peak_bytes: int
    """Peak of the resident memory."""


def usage(pid: int) -> Usage:
    """Return what a process and all its threads have used."""
    # To the nanosecond, while /proc/PID/stat counts ticks of 10 ms.
    cpu_ns = sum(int((task / 'schedstat').read_text().split()[0])
                 for task in Path(f'/proc/{pid}/task').iterdir())
    status = Path(f'/proc/{pid}/status').read_text()
    peak_kib = next(int(line.split()[1]) for line in status.splitlines()
                    if line.startswith('VmHWM:'))
    return Usage(cpu_ns * 1e-9, peak_kib * 1024)


class Subject(abc.ABC):
    """A program that listens.

    Args:
        processes: to start it among.
        log: name of its log.
        command: that starts it.
    """

    def __init__(self, processes: Processes, log: str, *command: str) -> None:
        self._processes = processes
        self._log = log
        self._command = command

    def start(self, *more: str) -> subprocess.Popen:
        """Start the program with further arguments."""
        self._process = self._processes.start(self._log,
                                              *pin(SUBJECT_CORE, *self._command, *more))
        return self._process

    def stop(self) -> int:
        """End the program; return how many messages it got."""
        self._processes.end(self._process)
        return self._count()

    @abc.abstractmethod
    def _count(self) -> int:
        """Return how many messages it got."""


class Bare(Subject):
    """Counts by ShapeShifter subscriptions."""

    def __init__(self, processes: Processes, folder: Path, topics: Sequence[str]) -> None:
        super().__init__(processes, 'bare', built('live_bare_subscriber'), *topics)
        self._counted = folder / 'bare.log'

    def _count(self) -> int:
        return int(self._counted.read_text().split()[-1])


class Record(Subject):
    """`rosbag record` into a file in memory."""

    def __init__(self, processes: Processes, folder: Path, topics: Sequence[str]) -> None:
        self._bag = folder / 'measured.bag'
        super().__init__(processes, 'measured', *record_command(self._bag, topics))

    def _count(self) -> int:
        with rosbag.Bag(str(self._bag)) as bag:
            count = bag.get_message_count()
        self._bag.unlink()
        return count


class Monitor(Subject):
    """The live monitor; hears its verdicts and diagnostics. Needs rospy.init_node()."""

    NAME = '/watch'

    def __init__(self, processes: Processes, model: Path) -> None:
        super().__init__(processes, 'monitor', built('self_awareness_node'),
                         f'__name:={self.NAME[1:]}', f'_model:={model}', '_subscribe:=model')
        self._folder = model.parent
        self._lock = threading.Lock()
        self._events = 0
        self.verdicts: List[Tuple[float, float]] = []
        """End of every window since it had settled, and when its verdict was heard [s since
        1970]."""
        self.level = -1
        """Level of communication on /diagnostics; -1 before the first."""
        self._changed_at = 0.0
        self._subscribers = [
            rospy.Subscriber(f'{self.NAME}/status', SelfAwareness, self._on_status),
            rospy.Subscriber('/diagnostics', DiagnosticArray, self._on_diagnostics)]

    def start(self, *more: str) -> subprocess.Popen:
        """Start the program with further arguments."""
        with self._lock:
            self._events = 0
            self.verdicts = []
            self.level = -1
        # An alarm of the one before is none of this one's.
        return super().start('_recorder/directory:=' + mkdtemp(dir=self._folder), *more)

    def _count(self) -> int:
        with self._lock:
            return self._events

    def close(self) -> None:
        """Listen no longer."""
        for subscriber in self._subscribers:
            subscriber.unregister()

    def await_level(self, what: str, holds: Callable[[int], bool], within_s: float) -> float:
        """Wait for a level on /diagnostics; return when it came [s since 1970]."""
        await_condition(what, lambda: self.level >= 0 and holds(self.level), within_s)
        with self._lock:
            return self._changed_at

    def _on_status(self, status: SelfAwareness) -> None:
        now = time.time()
        with self._lock:
            self._events += status.events
            if not status.settling:
                self.verdicts.append((status.header.stamp.to_sec(), now))

    def _on_diagnostics(self, array: DiagnosticArray) -> None:
        now = time.time()
        for status in array.status:
            if status.name == f'{self.NAME[1:]}: communication' and status.level != self.level:
                with self._lock:
                    self.level, self._changed_at = status.level, now
