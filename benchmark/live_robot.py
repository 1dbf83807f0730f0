"""The robot of the live benchmark: ten nodes that publish, a model of them, and who hears them."""
from __future__ import annotations

import abc
import contextlib
import os
import signal
import subprocess
import threading
import time
from pathlib import Path
from tempfile import mkdtemp
from typing import IO, Callable, List, NamedTuple, Sequence, Tuple

import numpy as np
import rosbag
import rospy
from diagnostic_msgs.msg import DiagnosticArray

from page import built
from self_awareness import (Calibration, EncodingRules, EventType, EvidenceModel, Learner,
                            TrainedModel)
from self_awareness.msg import SelfAwareness
from self_awareness.recordings import RecordingEvents
from self_awareness.stamps import SECOND_NS
from self_awareness_evaluation.live.processes import Processes, await_condition

NODES = 10
IMAGE_TOPIC = '/camera/image'
FULL_HD_BYTES = 1920 * 1080 * 3
LOAD_CORE = 1  # core of the publishers, the master and this program
SUBJECT_CORE = 0  # core of the program that is measured; nothing else runs on it

_PROGRAM = 'live_load'
_TRAINING_WITHIN_S = 900.0
_NEVER_REACHED = 1e6
_SYNTHETIC_EVENTS = 300
_SYNTHETIC_START_S = 1_600_000_000
_TINY_IMAGE_BYTES = 3  # training needs no payload


class Configuration(NamedTuple):
    """How much is published."""

    rate: int  # messages a second, without the images
    topics: int
    image: bool  # whether 30 full HD images a second are published, too


def pin(core: int, *command: str) -> List[str]:
    """Return the command as it runs on one core."""
    return ['taskset', '-c', str(core), *command]


class Robot:
    """The publishers of one configuration. As a context manager, it ends them."""

    def __init__(self, configuration: Configuration) -> None:
        self.configuration = configuration
        counts = [len(range(node, configuration.topics, NODES)) for node in range(NODES)]
        self._counts = [count for count in counts if count > 0]
        self._nodes = [self._start(node) for node in range(len(self._counts))]

    def _start(self, node: int) -> subprocess.Popen:
        rate = self.configuration.rate / self.configuration.topics
        command = pin(LOAD_CORE, 'rosrun', 'self_awareness', _PROGRAM, _prefix(node),
                      str(self._counts[node]), repr(rate), str(node + 1))
        if node == 0 and self.configuration.image:
            command.append(IMAGE_TOPIC)
        return subprocess.Popen([*command, f'__name:={self.node_name(node)}'],
                                stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
                                bufsize=1, start_new_session=True)

    def __enter__(self) -> Robot:
        return self

    def __exit__(self, *_: object) -> None:
        for node in self._nodes:
            _kill(node)

    @property
    def topics(self) -> List[str]:
        """All topics, the image's last, if there is one."""
        numbers = [f'{_prefix(node)}{i}' for node, count in enumerate(self._counts)
                   for i in range(count)]
        return numbers + ([IMAGE_TOPIC] if self.configuration.image else [])

    @staticmethod
    def node_name(node: int) -> str:
        """Return the name of a node, without its slash."""
        return f'component_{node}'

    def await_subscribers(self, count: int) -> None:
        """Wait until every topic has so many subscribers."""
        self._tell(f'await {count}')
        self._answers()

    def start(self, seconds: float, image_bytes: int = FULL_HD_BYTES) -> None:
        """Let all nodes publish for so long, images, if there are any, of that size; `published`
        waits for the end."""
        self._tell(f'publish {seconds} {image_bytes if self.configuration.image else 0}')

    def published(self) -> int:
        """Wait until all have published; return the number of messages."""
        return sum(int(answer) for answer in self._answers())

    def crash(self, node: int) -> float:
        """Kill one node; return when [s since 1970]."""
        stamp = time.time()
        _kill(self._nodes[node])
        return stamp

    def restart(self, node: int, subscribers: int, seconds: float) -> None:
        """Start a crashed node again, and let it publish."""
        started = self._nodes[node] = self._start(node)
        print(f'await {subscribers}', file=started.stdin, flush=True)
        _read(started.stdout)
        print(f'publish {seconds} 0', file=started.stdin, flush=True)

    def _tell(self, command: str) -> None:
        for node in self._nodes:
            print(command, file=node.stdin, flush=True)

    def _answers(self) -> List[str]:
        return [_read(node.stdout) for node in self._nodes]


def train(processes: Processes, robot: Robot, seconds: float, model: Path) -> None:
    """Record the robot for so long and learn a model from it.

    Where the recording is too short to find limits, there are some that are never reached: to
    judge by them takes the same work.
    """
    bag = model.with_suffix('.bag')
    recorder = processes.start('record', *record_command(bag, robot.topics))
    robot.await_subscribers(1)
    robot.start(seconds, _TINY_IMAGE_BYTES)
    robot.published()
    processes.end(recorder)
    processes.run('train', _TRAINING_WITHIN_S, 'rosrun', 'self_awareness', 'train', str(bag),
                  '--start', '1', '-o', str(model))
    bag.unlink()
    trained = TrainedModel.load(str(model))
    if trained.calibration is None:
        judge_without_alarms(trained)
        trained.save(str(model))


def judge_without_alarms(model: TrainedModel) -> None:
    """Give a model limits that are never reached."""
    calibration = Calibration()
    calibration.limits = [_NEVER_REACHED] * len(EvidenceModel(model).tracks)
    model.calibration = calibration


def write_synthetic_model(model: Path, types: int) -> None:
    """Write a model of so many event types, each 16 times a second."""
    rng = np.random.default_rng(1)
    period = SECOND_NS // 16
    ticks = np.arange(_SYNTHETIC_EVENTS)[:, None] * period
    stamps = ticks + rng.integers(0, period, types) + rng.integers(0, period // 50, (
        _SYNTHETIC_EVENTS, types))
    order = np.argsort(stamps, axis=None, kind='stable')
    learner = Learner(encoding=EncodingRules.defaults(), paper=True)
    learner.count(RecordingEvents(
        [EventType(f'/{Robot.node_name(i % NODES)}', f'/topic_{i}', 'std_msgs/String')
         for i in range(types)],
        stamps.ravel()[order] + _SYNTHETIC_START_S * SECOND_NS, order % types))
    learner.model().save(str(model))


def record_command(bag: Path, topics: Sequence[str]) -> List[str]:
    """Return the command that records topics in a bag."""
    # The command `rosbag record` would add a Python process that only waits.
    return ['rosrun', 'rosbag', 'record', '-b', '0', '--tcpnodelay', '-O', str(bag), *topics]


def _prefix(node: int) -> str:
    return f'/component_{node}/data_'


def _read(stream: IO[str]) -> str:
    line = stream.readline()
    if not line:
        raise RuntimeError('a node of the load ended')
    return line


def _kill(process: subprocess.Popen) -> None:
    with contextlib.suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()


class Usage(NamedTuple):
    """What a process has used so far."""

    cpu_s: float  # user and system
    peak_bytes: int  # peak of the resident memory


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
    """A program that listens; its log has a name of its own."""

    def __init__(self, processes: Processes, log: str, *command: str) -> None:
        self._processes = processes
        self._started_by = log, *pin(SUBJECT_CORE, *command)

    def start(self, *more: str) -> subprocess.Popen:
        """Start the program with further arguments."""
        self._process = self._processes.start(*self._started_by, *more)
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
        # End of every window since it had settled, and when its verdict was heard [s since 1970].
        self.verdicts: List[Tuple[float, float]] = []
        self.level = -1  # of communication on /diagnostics; -1 before the first
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
