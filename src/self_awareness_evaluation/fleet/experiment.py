"""A robot judged by what was learned on others, and by what was learned on itself."""
from __future__ import annotations

from contextlib import closing, suppress
from dataclasses import dataclass, field
from typing import Dict, List, Optional, Sequence, Tuple

import numpy as np

from self_awareness import Calibrator, DetectorParameters, TrainedModel
from self_awareness.calibration import limits
from self_awareness.stamps import SECOND_NS, nanoseconds
from self_awareness.workers import Workers
from self_awareness_evaluation.detectors import Evidence, counted
from self_awareness_evaluation.families.protocol import AFTER_ONSET_S, WATCHED_S
from self_awareness_evaluation.families.robot import CRASH, Fault, Robot
from self_awareness_evaluation.fleet.make import draw, renamed, renamed_graph, renamed_source
from self_awareness_evaluation.simulated.measures import first_alarm
from self_awareness_evaluation.windowed_events import WindowedEvents

FLEET, OWN = 'fleet', 'own'
"""What a model was learned on: other robots, or the one that is watched."""

_CALIBRATION, _WATCHED, _FAULTS = 100, 1000, 10_000  # the first start of each purpose
_ONSET_S = 60.0
_ONSET_SPREAD_S = 2.0  # the onset has no fixed phase to windows and timers


@dataclass(frozen=True)
class Plan:
    """What is measured.

    Args:
        makes: seeds of the makes.
        robots: of a make that are learned on; one more is watched.
        starts: of each of them that are trained on.
        calibrations: further starts of each that are calibrated on.
        recorded_s: length of the recording of each start [s].
        hours: of normal operation that is watched, for each make.
        budget: false alarms an hour that limits are made for.
        jobs: processes that do the work.
        dask: they are the workers of a cluster of dask.distributed on this machine.
    """

    makes: Tuple[int, ...]
    robots: int
    starts: int
    calibrations: int
    recorded_s: float
    hours: float
    budget: float
    jobs: int = 1
    dask: bool = False


@dataclass(frozen=True)
class NormalRow:
    """Hours of normal operation, as a model judged them.

    Args:
        make: seed.
        model: FLEET or OWN.
        hours: watched [h].
        alarms: raised, all of them false.
        expected: false alarms an hour that the calibration told.
        evidence: what raised each alarm.
    """

    make: int
    model: str
    hours: float
    alarms: int
    expected: float
    evidence: Tuple[str, ...]


@dataclass(frozen=True)
class DeathRow:
    """The death of a component, as a model judged it.

    Args:
        make: seed.
        model: FLEET or OWN.
        source: that died.
        watched: whether the model watches it.
        latency_s: until the first alarm [s]; None: there was none.
        first: whether that alarm names it first; None: no alarm.
    """

    make: int
    model: str
    source: str
    watched: bool
    latency_s: Optional[float]
    first: Optional[bool]


@dataclass
class Results:
    """What was measured."""

    normal: List[NormalRow] = field(default_factory=list)
    deaths: List[DeathRow] = field(default_factory=list)


@dataclass(frozen=True)
class _Start:
    """A recording of a robot that is learned on; whoever counts or judges it simulates it.

    Args:
        make: seed.
        number: of the robot.
        start: of the robot.
        seconds: length [s].
        held_out: it is not trained on.
    """

    make: int
    number: int
    start: int
    seconds: float
    held_out: bool

    def __str__(self) -> str:
        return f'start {self.start} of robot {self.number}'

    @property
    def robot(self) -> Robot:
        """Whose recording it is."""
        return draw(self.make, self.number)

    def recording(self) -> WindowedEvents:
        """Return the events, as the encoding of the make gives them."""
        return renamed(self.robot.start(self.start, self.seconds), f'r{self.number}')

    def judge(self, trained: TrainedModel, calibrator: Calibrator) -> None:
        """Let it be judged, to find limits (limits.find)."""
        recording = self.recording().encoded(trained.event_types)
        calibrator.add(recording.stamps, recording.ids,
                       None if self.held_out else recording.fingerprint, robot=recording.robot,
                       attributes=recording.attributes)


@dataclass(frozen=True)
class _Stretch:
    """A recording of normal operation that is watched, of a start."""

    start: int
    seconds: float

    def __str__(self) -> str:
        return f'start {self.start}'


@dataclass(frozen=True)
class _Crash:
    """A component that dies; number: of its recording."""

    source: str
    number: int

    def __str__(self) -> str:
        return f'the death of {self.source}'


@dataclass(frozen=True)
class _Judges:
    """What judges a make: its models, by name, and the robot that is watched."""

    make: int
    robot: Robot
    models: Dict[str, Evidence]


def run(plan: Plan, workers: Workers) -> Results:
    """Measure all makes; the robots that are learned on and what is judged, by the workers."""
    results = Results()
    for make in plan.makes:
        _measure(plan, make, workers, results)
    return results


def _measure(plan: Plan, make: int, workers: Workers, results: Results) -> None:
    number = plan.robots + make % 2  # one that has an arm, or one that has none
    judges = _Judges(make, draw(make, number), {
        FLEET: learned(plan, make, range(plan.robots), workers),
        OWN: learned(plan, make, [number] * plan.robots, workers)})
    raised: Dict[str, List[str]] = {name: [] for name in judges.models}
    with closing(workers.map(_watch, judges, _stretches(plan.hours), 'watching')) as watched:
        for alarms in watched:
            for name, evidence in alarms.items():
                raised[name] += evidence
    results.normal += [NormalRow(make, name, plan.hours, len(alarms),
                                 judges.models[name].expected_per_hour, tuple(alarms))
                       for name, alarms in raised.items()]
    crashes = [_Crash(source, index) for index, source in enumerate(judges.robot.regular)]
    with closing(workers.map(_death, judges, crashes, 'deaths')) as deaths:
        for rows in deaths:
            results.deaths += rows


def learned(plan: Plan, make: int, numbers: Sequence[int], workers: Workers) -> Evidence:
    """Return what is learned on robots; each further time that one is named, on other starts."""
    with closing(workers.map(_count, None, training_of(plan, make, numbers),
                             'learning')) as counts:
        trained = next(counts)
        for more in counts:
            trained.merge(more)
    trained.watch()
    settle_time = DetectorParameters().settle_time
    with suppress(limits.TooLittleError):  # as after a training: others are added
        limits.find(trained, settle_time, [plan.budget], training_of(plan, make, numbers), workers,
                    keep_findings=True)
    trained.calibration, = limits.find(trained, settle_time, [plan.budget],
                                       calibration_of(plan, make, numbers), workers)
    system = Evidence(trained.graph, budget=plan.budget)
    system.take(trained)
    return system


def training_of(plan: Plan, make: int, numbers: Sequence[int]) -> List[_Start]:
    """Return what is trained on."""
    return _starts(plan, make, numbers, 0, plan.starts, held_out=False)


def calibration_of(plan: Plan, make: int, numbers: Sequence[int]) -> List[_Start]:
    """Return what is calibrated on."""
    return _starts(plan, make, numbers, _CALIBRATION, plan.calibrations, held_out=True)


def _starts(plan: Plan, make: int, numbers: Sequence[int], first: int, each: int,
            held_out: bool) -> List[_Start]:
    """Return so many starts of each robot, from the first one on."""
    turns = [list(numbers[:place]).count(number) for place, number in enumerate(numbers)]
    return [_Start(make, number, first + turn * each + start, plan.recorded_s, held_out)
            for number, turn in zip(numbers, turns) for start in range(each)]


def _count(_: None, start: _Start) -> TrainedModel:
    trained = counted([start.recording()])
    trained.graph = renamed_graph(start.robot)
    return trained


def _stretches(hours: float) -> List[_Stretch]:
    """Return the recordings that are watched, of WATCHED_S, and a shorter last one."""
    seconds = hours * 3600.0
    return [_Stretch(_WATCHED + number, min(WATCHED_S, seconds - number * WATCHED_S))
            for number in range(int(np.ceil(seconds / WATCHED_S)))]


def _watch(judges: _Judges, stretch: _Stretch) -> Dict[str, List[str]]:
    """Return what raised each alarm of each model in normal operation."""
    recording = renamed(judges.robot.start(stretch.start, stretch.seconds), '')
    return {name: [alarm.evidence for alarm in model.judge(recording).alarms]
            for name, model in judges.models.items()}


def _death(judges: _Judges, crash: _Crash) -> List[DeathRow]:
    robot = judges.robot
    spread = np.random.default_rng((robot.seed, crash.number)).uniform(0.0, _ONSET_SPREAD_S)
    onset_s = _ONSET_S + float(spread)
    recording = renamed(robot.start(_FAULTS + crash.number, onset_s + AFTER_ONSET_S,
                                    Fault(CRASH, crash.source, onset_s)), '')
    onset = recording.end - nanoseconds(AFTER_ONSET_S)
    name = renamed_source(crash.source)
    rows = []
    for of, model in judges.models.items():
        alarm = first_alarm(model.judge(recording).alarms, onset)
        rows.append(DeathRow(judges.make, of, name, name in model.watched,
                             None if alarm is None else (alarm.start - onset) / SECOND_NS,
                             None if alarm is None else (alarm.suspects or [])[:1] == [name]))
    return rows
