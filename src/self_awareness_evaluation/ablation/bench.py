"""The records that all variants learn from and judge: simulated once, and kept in memory."""
from __future__ import annotations

from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Iterator, List, Optional, Set, Tuple

from self_awareness.workers import Processes
from self_awareness_evaluation.detectors import scenario_graph
from self_awareness_evaluation.families.protocol import KINDS, Learning, Records
from self_awareness_evaluation.families.robot import CRASH, HALF_RATE, LATE
from self_awareness_evaluation.simulated import records as simulated
from self_awareness_evaluation.simulated.measures import NORMAL
from self_awareness_evaluation.windowed_events import WindowedEvents
from self_awareness_follow_me.scenario import load_scenario

FAMILIES, OWN, RECORDINGS = 'families', 'own robot', 'recordings'
"""The parts of the bench."""

CLOCKS, STARVED, OTHER = 'ac', 'rs', 'other'
"""Kinds of faults besides those of the families: asynchronous clocks, a starved CPU, others."""

AFTER_DEATH_S = 600.0
"""A record lasts for so long after the death of who speaks only when it is asked [s]."""

_OWN_LEARNING = Learning(len(simulated.TRAINING_NAMES), simulated.RECORD_S, 1, 600.0)
_WARNED_ONLY = ('extra', 'unknown', 'unsubscribed')  # a suspicion, no alarm
_OWN_KINDS = {'ac': CLOCKS, 'rs': STARVED, 'lat': LATE, 'half': HALF_RATE, 'crash': CRASH,
              'cc1': CRASH, 'cc2': CRASH}


@dataclass(frozen=True)
class Plan:
    """What the variants are measured on.

    Args:
        families: names, of families.kinds.FAMILIES.
        seeds: of the robots of each family.
        own_seeds: of the records of the own robot.
        learnings: what is learned from the robots of the families: from each one of these, in
            turn.
        hours: of normal operation that is watched, for each robot of a family.
        faults: the most of each kind, for each robot of a family.
        data: folder of the recordings of real robots; None: without them.
    """

    families: Tuple[str, ...]
    seeds: Tuple[int, ...]
    own_seeds: Tuple[int, ...]
    learnings: Tuple[Learning, ...]
    hours: float
    faults: int
    data: Optional[Path]


@dataclass(frozen=True)
class Fault:
    """A record with a fault.

    Args:
        kind: of protocol.KINDS, or CLOCKS, STARVED or OTHER.
        name: what is at fault.
        culprits: the sources to blame; empty if no single one is.
        recording: the events.
        onset: of the fault [ns].
        back: when it is over [ns]; None: it lasts.
    """

    kind: str
    name: str
    culprits: Tuple[str, ...]
    recording: WindowedEvents
    onset: int
    back: Optional[int] = None


@dataclass(frozen=True)
class Robot:
    """The records of a robot.

    Args:
        part: FAMILIES or OWN.
        name: with its seed.
        graph: see Evidence.
        learning: what is learned from, in short.
        training, calibration: that.
        normal: normal operation to watch.
        faults: see Fault.
    """

    part: str
    name: str
    graph: Set[Tuple[str, str, str]]
    learning: str
    training: List[WindowedEvents]
    calibration: List[WindowedEvents]
    normal: List[WindowedEvents]
    faults: List[Fault]


@dataclass(frozen=True)
class Bench:
    """All robots, and where the recordings of real ones are; None: they are left out."""

    robots: List[Robot]
    data: Optional[Path]


def make(plan: Plan, jobs: int) -> Bench:
    """Simulate all robots, `jobs` of them at a time."""
    turns = len(plan.learnings)
    wanted = [_Wanted(OWN, seed, _OWN_LEARNING) for seed in plan.own_seeds]
    wanted += [_Wanted(family, seed, plan.learnings[(turn + shift) % turns])
               for shift, seed in enumerate(plan.seeds)
               for turn, family in enumerate(plan.families)]
    with closing(Processes(jobs).map(_robot, plan, wanted, 'simulating')) as robots:
        return Bench(list(robots), plan.data)


@dataclass(frozen=True)
class _Wanted:
    """A robot to simulate: the own one, or one of a family."""

    name: str
    seed: int
    learning: Learning


def _robot(plan: Plan, wanted: _Wanted) -> Robot:
    return _own(wanted) if wanted.name == OWN else _of_family(plan, wanted)


def _of_family(plan: Plan, wanted: _Wanted) -> Robot:
    records = Records(wanted.name, wanted.seed)
    return Robot(
        FAMILIES, f'{wanted.name} {wanted.seed}', records.robot.graph, str(wanted.learning),
        records.training(wanted.learning), records.calibration(wanted.learning),
        list(records.watched(plan.hours)),
        [Fault(fault.kind, fault.source, (fault.source,), fault.recording, fault.onset,
               fault.back)
         for fault in records.faults(KINDS, plan.faults, AFTER_DEATH_S)])


def _own(wanted: _Wanted) -> Robot:
    scenario, seed, learning = load_scenario(), wanted.seed, wanted.learning

    def normal(name: str, length_s: float) -> WindowedEvents:
        return simulated.normal_record(scenario, seed, name, length_s)

    return Robot(
        OWN, f'{OWN} {seed}', scenario_graph(), str(learning),
        [normal(name, learning.training_s) for name in simulated.TRAINING_NAMES],
        [normal(simulated.CALIBRATION_NAME, learning.calibration_s)],
        [normal(NORMAL, simulated.NORMAL_TEST_S)], list(_own_faults(seed)))


def _own_faults(seed: int) -> Iterator[Fault]:
    scenario = load_scenario()
    for name in simulated.default_faults(scenario):
        kind = name.split(':')[0]
        if kind not in _WARNED_ONLY:
            record = simulated.fault_record(scenario, seed, name)
            yield Fault(_OWN_KINDS.get(kind, OTHER), name, record.culprits,
                        record.recording, record.onset)
