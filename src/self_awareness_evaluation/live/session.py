"""One session of the live evaluation: robot, recordings, model, monitor, and fault after fault."""
from __future__ import annotations

import contextlib
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Callable, Dict, Iterator, List, Optional, Sequence

from self_awareness_evaluation.live.learning import Apart, learn
from self_awareness_evaluation.live.listeners import (STARTED_WITHIN_S, MonitorListener,
                                                      RobotListener, reset_until_quiet)
from self_awareness_evaluation.live.master import own_master
from self_awareness_evaluation.live.passing import say, stretch, wait
from self_awareness_evaluation.live.processes import LiveError, Processes, await_condition
from self_awareness_evaluation.live.samples import Status, Stretch
from self_awareness_evaluation.records import NORMAL
from self_awareness_follow_me import induction
from self_awareness_follow_me.effects import Crash, Effect, Intruder, Silence, Starvation
from self_awareness_follow_me.faults import effect_of
from self_awareness_follow_me.scenario import load_scenario

FAULTS_S: Dict[str, float] = {
    'lat': 8.0, 'half:player': 8.0, 'double:gaze_control': 8.0, 'order': 8.0, 'unknown': 5.0,
    'extra': 8.0, 'rs': 20.0, 'ac': 35.0, 'cc1': 6.0, 'cc2': 6.0, 'silence': 6.0}
"""How long each fault lasts in a round [s], in their order; the last one ends the robot."""

# One regular topic of each component that has one.
_REGULAR = ('odom', 'scan', 'pose', 'obstacles', 'legs', 'tracks', 'task/state', 'battery',
            'camera/image', 'faces', 'joint_states')
_SHARED = 'cmd_vel'  # where the intruder publishes
_EXCLUDED = '/rosout_agg|/self_awareness/.*|/diagnostics.*'
_RECORDED_SEED = 100  # of the robot that is recorded; beyond the numbers of the rounds
_WARM_UP_S = 10.0  # after the robot's start, which is no normal operation


@dataclass(frozen=True)
class SessionPlan:
    """What a session does.

    Args:
        rounds: how often each fault is induced.
        training: lengths of the recordings to learn from, each of another start [s].
        calibration_s: of the one that the limits are found by, of one more start [s].
        normal_s: of the normal operation in each round, for false alarms [s].
    """

    rounds: int
    training: Sequence[float]
    calibration_s: float
    normal_s: float


@dataclass(frozen=True)
class Session:
    """What a session has: recordings, what was wrong when, and what the monitor said."""

    training: List[Path]
    calibration: Path
    model: Path
    recording: Path
    stretches: List[Stretch]
    statuses: List[Status]


def run(plan: SessionPlan, folder: Path,
        told: Callable[[Stretch, Sequence[Status]], None]) -> Session:
    """Run a session under a master of its own; nothing of it runs on afterwards.

    Args:
        plan: what to do.
        folder: exists; for recordings, the model and logs.
        told: called after every stretch, with all statuses so far.

    Raises:
        LiveError: a program failed, or something does not happen in time.
        InduceError: a fault cannot be induced.
    """
    with own_master(folder) as processes:
        return _Session(plan, folder, processes, told).run()


class _Session:
    def __init__(self, plan: SessionPlan, folder: Path, processes: Processes,
                 told: Callable[[Stretch, Sequence[Status]], None]) -> None:
        self._plan = plan
        self._folder = folder
        self._processes = processes
        self._told = told
        self._scenario = load_scenario()
        self._robot = RobotListener([*_REGULAR, _SHARED])
        self._monitor = MonitorListener()
        self._robot_process: Optional[subprocess.Popen] = None
        self._apart = Apart()
        self._stretches: List[Stretch] = []

    def run(self) -> Session:
        training = [self._recorded(f'training_{number}', length, _RECORDED_SEED + number)
                    for number, length in enumerate(self._plan.training, 1)]
        calibration = self._recorded('calibration', self._plan.calibration_s, _RECORDED_SEED)
        self._start_robot(seed=1)
        model = self._folder / 'live.model'
        learn(self._processes, model, training, [calibration], '--graph')
        recording = self._folder / 'session.bag'
        recorder = self._start_recorder(recording)
        self._processes.start('monitor', 'roslaunch', '--wait', 'self_awareness', 'monitor.launch',
                              f'model:={model}', f'config:={self._config()}')
        for number in range(1, self._plan.rounds + 1):
            self._round(number)
        self._processes.end(recorder)
        return Session(training, calibration, model, recording, self._stretches,
                       self._monitor.statuses)

    def _round(self, number: int) -> None:
        if number > 1:
            self._start_robot(seed=number)
        note = reset_until_quiet(self._monitor)
        with stretch(number, NORMAL, (), note, time.time(), self._over):
            wait(self._plan.normal_s, f'round {number}: normal operation')
        for kind, length in FAULTS_S.items():
            note = reset_until_quiet(self._monitor)
            effect = effect_of(self._scenario, kind)
            with self._induced(kind, effect) as onset, \
                    stretch(number, kind, effect.culprits, note, onset, self._over):
                wait(length, f'round {number}: {kind}')
            if isinstance(effect, Crash):
                self._start_component(effect.component, seed=number)

    @contextlib.contextmanager
    def _induced(self, kind: str, effect: Effect) -> Iterator[float]:
        """Induce a fault and tell its onset; lasting ones end with the with statement."""
        if isinstance(effect, Crash):
            induction.crash(effect)
            yield time.time()
        elif isinstance(effect, Silence):
            induction.silence(self._scenario)
            yield time.time()
        elif isinstance(effect, Starvation):
            with induction.starved(effect):
                yield time.time()
        elif isinstance(effect, Intruder):
            begin = time.time()
            with induction.intruding(effect):
                # It takes seconds to start: the fault begins with its first message.
                source, = effect.culprits
                await_condition(f'{source} publishes',
                                lambda: self._robot.last(source, _SHARED) > begin,
                                STARTED_WITHIN_S)
                yield self._robot.last(source, _SHARED)
        else:
            with induction.disturbed(kind):
                yield time.time()

    def _over(self, done: Stretch) -> None:
        self._stretches.append(done)
        self._told(done, self._monitor.statuses)

    def _start_robot(self, seed: int) -> None:
        if self._robot_process is not None:
            self._processes.end(self._robot_process)
        say('starting the robot')
        begin = time.time()
        self._robot_process = self._processes.start(
            'robot', 'roslaunch', '--wait', 'self_awareness', 'follow_me.launch', f'seed:={seed}')
        for topic in _REGULAR:
            self._await_heard(topic, begin)
        wait(_WARM_UP_S, 'warming up')

    def _start_component(self, name: str, seed: int) -> None:
        """Start a node that was killed as the launch file does."""
        begin = time.time()
        self._processes.start(name, 'rosrun', 'self_awareness', 'component', name,
                              '--seed', str(seed), f'__name:={name}')
        for topic in set(_REGULAR) & set(self._scenario.component(name).outputs()):
            self._await_heard(topic, begin)

    def _await_heard(self, topic: str, after: float) -> None:
        source = next(f'/{spec.name}' for spec in self._scenario.components
                      if topic in spec.outputs())
        await_condition(f'{source} publishes /{topic}',
                        lambda: self._robot.last(source, topic) > after, STARTED_WITHIN_S)

    def _recorded(self, name: str, length_s: float, seed: int) -> Path:
        """Return a recording of a start; one that is there is used again."""
        bag = self._folder / f'{name}.bag'
        if bag.exists():
            return bag
        self._start_robot(seed)
        self._apart.wait()
        recorder = self._start_recorder(bag)
        wait(length_s, f'recording {name}')
        self._processes.end(recorder)
        self._apart.ended()
        if not bag.exists():
            raise LiveError(f'{bag}: rosbag record has not written it, see '
                            f'{self._folder / "record.log"}')
        return bag

    def _start_recorder(self, bag: Path) -> subprocess.Popen:
        recorder = self._processes.start('record', 'rosbag', 'record', '--all', '--exclude',
                                         _EXCLUDED, '--output-name', str(bag), '__name:=record')
        active = Path(f'{bag}.active')
        await_condition(f'rosbag writes {bag.name}',
                        lambda: active.exists() and active.stat().st_size > 0, STARTED_WITHIN_S)
        return recorder

    def _config(self) -> Path:
        path = self._folder / 'monitor.yaml'
        path.write_text('detector: evidence\n', encoding='utf-8')
        return path
