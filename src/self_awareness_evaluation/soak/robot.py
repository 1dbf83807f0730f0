"""The fast robot of a soak as processes: started, recorded, broken and mended."""
from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import time
from pathlib import Path
from typing import Iterator, Optional, Sequence

from self_awareness_evaluation.live.listeners import STARTED_WITHIN_S, RobotListener
from self_awareness_evaluation.live.passing import wait
from self_awareness_evaluation.live.processes import LiveError, Processes, await_condition
from self_awareness_evaluation.soak.schedule import CRASH, HANG, Fault, regular
from self_awareness_follow_me import induction
from self_awareness_follow_me.effects import Crash
from self_awareness_follow_me.scenario import Scenario

_WARM_UP_S = 10.0  # after the robot's start, which is no normal operation


class Robot:
    """The follow-me robot at some speed; `rospy.init_node` has been called."""

    def __init__(self, scenario: Scenario, speed: float, folder: Path, processes: Processes,
                 respawn: bool = False) -> None:
        """Start nothing yet.

        Args:
            scenario: the robot at its usual speed.
            speed: times as fast.
            folder: exists; for recordings.
            processes: to be started among.
            respawn: roslaunch starts nodes again that end.
        """
        self._respawn = respawn
        self._regular = regular(scenario)
        self._speed = speed
        self._folder = folder
        self._processes = processes
        self._running: Optional[subprocess.Popen] = None

    def start(self, seed: int) -> None:
        """Start all components, and wait until they do what they do all the time."""
        with self._heard(list(self._regular)):
            self._running = self._processes.start(
                'robot', 'roslaunch', '--wait', 'self_awareness', 'follow_me.launch',
                f'seed:={seed}', f'speed:={self._speed:g}',
                f'respawn:={str(self._respawn).lower()}')
        wait(_WARM_UP_S, 'warming up')

    def end(self) -> None:
        """End all components."""
        if self._running is not None:
            self._processes.end(self._running)
            self._running = None

    def recorded(self, name: str, seed: int, length_s: float) -> Path:
        """Return an event log of a start of its own; one that is there is used again.

        Raises:
            LiveError: the robot does not start, or nothing is recorded.
        """
        found = self._log(name)
        if found is None:
            self.start(seed)
            recorder = self._processes.start(
                f'record_{name}', 'rosrun', 'self_awareness', 'record_events', '__name:=recorder',
                f'_output:={self._folder / name}')
            wait(length_s, f'recording {name}')
            self._processes.end(recorder)
            self.end()
            found = self._log(name)
        if found is None:
            raise LiveError(f'{name}: nothing is recorded, see {self._folder}/record_{name}.log')
        return found

    @contextlib.contextmanager
    def broken(self, fault: Fault, seed: int) -> Iterator[float]:
        """Induce a fault, hand out its onset [s since 1970], and undo it; the component is heard
        again when the with statement is over.

        Raises:
            LiveError: it is not heard again.
            InduceError: the fault cannot be induced.
        """
        if fault.kind == CRASH:
            induction.crash(Crash(fault.component))
            yield time.time()
            with self._heard([fault.component]):
                if not self._respawn:
                    self._processes.start(
                        fault.component, 'rosrun', 'self_awareness', 'component',
                        fault.component, '--seed', str(seed), '--speed', f'{self._speed:g}',
                        f'__name:={fault.component}')
        elif fault.kind == HANG:
            pid = induction.process_id(f'/{fault.component}')
            os.kill(pid, signal.SIGSTOP)
            try:
                yield time.time()
            finally:
                with contextlib.suppress(ProcessLookupError):  # it was killed, as it hung
                    os.kill(pid, signal.SIGCONT)
        else:
            with induction.disturbed(fault.name):
                yield time.time()

    @contextlib.contextmanager
    def _heard(self, components: Sequence[str]) -> Iterator[None]:
        """Wait at the end until all these components have been heard since the beginning."""
        topics = [self._regular[name] for name in components]
        listener = RobotListener(topics)
        begin = time.time()
        try:
            yield
            for name, topic in zip(components, topics):
                await_condition(f'/{name} publishes /{topic}',
                                lambda: listener.last(f'/{name}', topic) > begin,
                                STARTED_WITHIN_S)
        finally:
            listener.close()

    def _log(self, name: str) -> Optional[Path]:
        return next(iter(sorted(self._folder.glob(f'{name}_*.bag'))), None)
