"""A robot judged by what was learned on others, and by what was learned on itself."""
from __future__ import annotations

from contextlib import closing
from dataclasses import dataclass, field
from typing import Dict, List, Optional, Sequence, Set, Tuple

import numpy as np

from self_awareness.stamps import SECOND_NS, nanoseconds
from self_awareness.workers import Processes
from self_awareness_evaluation.detectors import Evidence
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
    """

    makes: Tuple[int, ...]
    robots: int
    starts: int
    calibrations: int
    recorded_s: float
    hours: float
    budget: float


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


def run(plan: Plan, jobs: int) -> Results:
    """Measure all makes, `jobs` of them at a time."""
    results = Results()
    with closing(Processes(jobs).map(run_make, plan, plan.makes, 'evaluating')) as parts:
        for part in parts:
            results.normal += part.normal
            results.deaths += part.deaths
    return results


def run_make(plan: Plan, make: int) -> Results:
    """Measure one make."""
    watched = draw(make, plan.robots + make % 2)  # one that has an arm, or one that has none
    models = {FLEET: _learned(plan, make, list(range(plan.robots))),
              OWN: _learned(plan, make, [plan.robots + make % 2] * plan.robots)}
    results = Results()
    for name, alarms in _alarms(plan, watched, models).items():
        results.normal.append(NormalRow(make, name, plan.hours, len(alarms),
                                        models[name].expected_per_hour, tuple(alarms)))
    for number, source in enumerate(watched.regular):
        results.deaths += _death(make, watched, source, number, models)
    return results


def _learned(plan: Plan, make: int, numbers: Sequence[int]) -> Evidence:
    """Return what is learned on robots; each further time that one is named, on other starts."""
    robots = {number: draw(make, number) for number in numbers}
    graph: Set[Tuple[str, str, str]] = set()
    training: List[WindowedEvents] = []
    calibration: List[WindowedEvents] = []
    for place, number in enumerate(numbers):
        turn = list(numbers[:place]).count(number)
        robot = robots[number]
        graph |= renamed_graph(robot)
        for recordings, first, starts in ((training, 0, plan.starts),
                                          (calibration, _CALIBRATION, plan.calibrations)):
            recordings += [renamed(robot.start(first + turn * starts + start, plan.recorded_s),
                                   f'r{number}') for start in range(starts)]
    system = Evidence(graph, budget=plan.budget)
    system.train(training)
    system.calibrate(calibration)
    return system


def _alarms(plan: Plan, robot: Robot, models: Dict[str, Evidence]) -> Dict[str, List[str]]:
    """Return what raised each alarm of each model in normal operation."""
    found: Dict[str, List[str]] = {name: [] for name in models}
    left = plan.hours * 3600.0
    start = _WATCHED
    while left > 0.0:
        recording = renamed(robot.start(start, min(WATCHED_S, left)), '')
        for name, model in models.items():
            found[name] += [alarm.evidence for alarm in model.judge(recording).alarms]
        left -= WATCHED_S
        start += 1
    return found


def _death(make: int, robot: Robot, source: str, number: int,
           models: Dict[str, Evidence]) -> List[DeathRow]:
    spread = np.random.default_rng((robot.seed, number)).uniform(0.0, _ONSET_SPREAD_S)
    onset_s = _ONSET_S + float(spread)
    recording = renamed(robot.start(_FAULTS + number, onset_s + AFTER_ONSET_S,
                                    Fault(CRASH, source, onset_s)), '')
    onset = recording.end - nanoseconds(AFTER_ONSET_S)
    name = renamed_source(source)
    rows = []
    for of, model in models.items():
        alarm = first_alarm(model.judge(recording).alarms, onset)
        rows.append(DeathRow(make, of, name, name in model.watched,
                             None if alarm is None else (alarm.start - onset) / SECOND_NS,
                             None if alarm is None else (alarm.suspects or [])[:1] == [name]))
    return rows
