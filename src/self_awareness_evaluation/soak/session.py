"""One soak: a fast robot, a model of it, the monitor, and fault after fault."""
from __future__ import annotations

import os
import threading
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Callable, List, Sequence

import rospy

from self_awareness.msg import SelfAwareness
from self_awareness_evaluation.live.learning import learn
from self_awareness_evaluation.live.listeners import STARTED_WITHIN_S, MonitorListener
from self_awareness_evaluation.live.master import own_master
from self_awareness_evaluation.live.passing import say, wait
from self_awareness_evaluation.live.processes import Processes, await_condition, becomes_true
from self_awareness_evaluation.live.samples import Status
from self_awareness_evaluation.soak.measures import Happened
from self_awareness_evaluation.soak.memory import MemoryWatch, Usage
from self_awareness_evaluation.soak.robot import Robot
from self_awareness_evaluation.soak.schedule import Fault, faults
from self_awareness_follow_me.induction import process_id
from self_awareness_follow_me.scenario import load_scenario

NAME = '/self_awareness'

_QUIET_S = 3.0  # without an alarm, before the next fault may come
_CLEARED_WITHIN_S = 90.0


@dataclass(frozen=True)
class SoakPlan:
    """What a soak does.

    Args:
        minutes: how long the monitor runs.
        seed: of the faults, and of what is random in the robot.
        speed: of the robot, in its usual one.
        starts: of the robot, each recorded to learn from.
        training_s: length of each of these recordings [s].
        calibrations: further starts, each recorded to find the limits by.
        calibration_s: length of each of these recordings [s].
        budget: false alarms an hour that the limits allow.
    """

    minutes: float
    seed: int
    speed: float
    starts: int
    training_s: float
    calibrations: int
    calibration_s: float
    budget: float


@dataclass(frozen=True)
class Soak:
    """What happened in a soak.

    Args:
        begin, end: [s since 1970].
        happened: the faults.
        statuses: of the monitor since the beginning.
        memory: of the monitor's process.
        events: that the monitor judged.
        loads: the machine's load averages of the last minute, one at every fault.
    """

    begin: float
    end: float
    happened: List[Happened]
    statuses: List[Status]
    memory: List[Usage]
    events: int
    loads: List[float]


def run(plan: SoakPlan, folder: Path, told: Callable[[str], None] = say) -> Soak:
    """Run a soak under a master of its own; nothing of it runs on afterwards.

    Args:
        plan: what to do.
        folder: exists; for recordings, the model and logs. Recordings that it holds are used
            again.
        told: called after every fault.

    Raises:
        LiveError: a program failed, or something does not happen in time.
        InduceError: a fault cannot be induced.
    """
    with own_master(folder) as processes:
        return _Session(plan, folder, processes, told).run()


class _EventCount:
    """How many events the monitor has judged."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._events = 0  # Guarded by _lock.
        rospy.Subscriber(f'{NAME}/status', SelfAwareness, self._on_status, queue_size=1000)

    @property
    def events(self) -> int:
        """So many so far."""
        with self._lock:
            return self._events

    def _on_status(self, status: SelfAwareness) -> None:
        with self._lock:
            self._events += status.events


class _Session:
    def __init__(self, plan: SoakPlan, folder: Path, processes: Processes,
                 told: Callable[[str], None]) -> None:
        self._plan = plan
        self._folder = folder
        self._processes = processes
        self._told = told
        self._scenario = load_scenario()
        self._robot = Robot(self._scenario, plan.speed, folder, processes)
        self._monitor = MonitorListener()
        self._count = _EventCount()
        self._happened: List[Happened] = []
        self._loads: List[float] = []

    def run(self) -> Soak:
        model = self._model()
        self._robot.start(self._seed(0))
        say('starting the monitor')
        self._processes.start('monitor', 'rosrun', 'self_awareness', 'self_awareness_node',
                              f'__name:={NAME[1:]}', f'_model:={model}',
                              f'_recorder/directory:={self._folder / "alarms"}')
        await_condition('the monitor has settled', lambda: self._monitor.quiet_for() > _QUIET_S,
                        STARTED_WITHIN_S)
        with MemoryWatch(process_id(NAME)) as memory:
            begin, first, events = time.time(), len(self._monitor.statuses), self._count.events
            self._break_for(60.0 * self._plan.minutes)
            end = time.time()
            statuses = self._monitor.statuses[first:]
        return Soak(begin, end, self._happened, statuses, memory.seen,
                    self._count.events - events, self._loads)

    def _model(self) -> Path:
        model = self._folder / 'soak.model'
        training = [self._robot.recorded(f'training_{n}', self._seed(n), self._plan.training_s)
                    for n in range(1, self._plan.starts + 1)]
        normal = [self._robot.recorded(f'calibration_{n}', self._seed(100 + n),
                                       self._plan.calibration_s)
                  for n in range(1, self._plan.calibrations + 1)]
        learn(self._processes, model, training, normal, budget=self._plan.budget)
        return model

    def _seed(self, number: int) -> int:
        """Return a seed for a start of the robot."""
        return 1000 * self._plan.seed + number

    def _break_for(self, seconds: float) -> None:
        until = time.monotonic() + seconds
        for number, fault in enumerate(faults(self._scenario, self._plan.seed)):
            left = until - time.monotonic()
            if fault.after_s + fault.lasts_s > left:
                wait(max(0.0, left), 'normal operation')
                return
            wait(fault.after_s, 'normal operation')
            self._loads.append(os.getloadavg()[0])
            self._break(fault, self._seed(200 + number))

    def _break(self, fault: Fault, seed: int) -> None:
        with self._robot.broken(fault, seed) as onset:
            wait(fault.lasts_s, fault.name)
        happened = Happened(fault.name, f'/{fault.component}', onset, time.time())
        self._happened.append(happened)
        # Where it does not clear in time, the alarm that stands is not the next fault's.
        becomes_true(lambda: self._monitor.quiet_for() >= _QUIET_S, _CLEARED_WITHIN_S)
        self._told(f'  {_brief(happened, self._monitor.statuses)}')


def _brief(happened: Happened, statuses: Sequence[Status]) -> str:
    alarm = next((status for status in statuses
                  if status.stamp > happened.onset and status.level >= SelfAwareness.ERROR), None)
    if alarm is None:
        return 'no alarm'
    return f'{alarm.stamp - happened.onset:.2f} s: {alarm.message}'
