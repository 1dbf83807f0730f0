"""Every system on every robot: learns from few starts or many, and judges the same recordings."""
from __future__ import annotations

import math
from contextlib import closing
from dataclasses import dataclass, field
from typing import Iterator, List, Optional, Tuple

from self_awareness import Tuning
from self_awareness.workers import Processes
from self_awareness_evaluation import catalogue
from self_awareness_evaluation.detectors import Evidence
from self_awareness_evaluation.families.measures import (FaultRow, NormalRow, Subject, fault_row,
                                                         normal_row)
from self_awareness_evaluation.families.protocol import Learning, Records, check_hours
from self_awareness_evaluation.families.robot import Robot
from self_awareness_evaluation.systems import System, watched_by

WITH_GRAPH, WITHOUT_GRAPH = 'evidence', 'evidence_no_graph'

SYSTEMS = (WITH_GRAPH, WITHOUT_GRAPH, 'gaps', 'frequency_learned')
"""Those that are evaluated by default."""


@dataclass(frozen=True)
class Plan:
    """What is evaluated.

    Args:
        families: names, of kinds.FAMILIES.
        seeds: of the robots of each family.
        learnings: what the systems learn from, in turn.
        systems: names, of catalogue.NAMES.
        budgets: false alarms an hour that limits are made for; faults are judged with the first.
        hours: of normal operation that is watched, for each robot.
        faults: kinds, of protocol.KINDS.
        tuning: of the evidence method.
    """

    families: Tuple[str, ...]
    seeds: Tuple[int, ...]
    learnings: Tuple[Learning, ...]
    systems: Tuple[str, ...]
    budgets: Tuple[float, ...]
    hours: float
    faults: Tuple[str, ...]
    tuning: Tuning = field(default_factory=Tuning)


@dataclass
class Results:
    """What was measured."""

    normal: List[NormalRow] = field(default_factory=list)
    faults: List[FaultRow] = field(default_factory=list)


@dataclass(frozen=True)
class _Learned:
    """A system that has learned; expected, watched: see NormalRow."""

    subject: Subject
    system: System
    expected: Optional[float]
    watched: Optional[int]


def run(plan: Plan, jobs: int) -> Results:
    """Evaluate all robots, `jobs` of them at a time.

    Raises:
        ValueError: see check_hours().
    """
    check_hours(plan.families, plan.hours)
    robots = [(family, seed) for family in plan.families for seed in plan.seeds]
    results = Results()
    # In the order of the robots, so that the same command writes the same files.
    with closing(Processes(jobs).map(run_robot, plan, robots, 'evaluating')) as parts:
        for part in parts:
            results.normal += part.normal
            results.faults += part.faults
    return results


def run_robot(plan: Plan, robot: Tuple[str, int]) -> Results:
    """Evaluate one robot, by its family and seed."""
    records = Records(*robot)
    learned = list(_learned(plan, robot, records))
    results = Results()
    for recording in records.watched(plan.hours):
        results.normal += [normal_row(each.subject, each.system.judge(recording), each.expected,
                                      each.watched, len(records.robot.sources))
                           for each in learned]
    for fault in records.faults(plan.faults):
        results.faults += [fault_row(each.subject, fault, each.system.judge(fault.recording))
                           for each in learned
                           if each.subject.budget in (None, plan.budgets[0])]
    return results


def _learned(plan: Plan, robot: Tuple[str, int], records: Records) -> Iterator[_Learned]:
    for learning in plan.learnings:
        training, calibration = records.training(learning), records.calibration(learning)
        for name in plan.systems:
            for budget, system in _systems(name, records.robot, plan):
                system.train(training)
                system.calibrate(calibration)
                yield _Learned(Subject(*robot, str(learning), name, budget), system,
                               _expected(system), watched_by(system, records.robot.sources))


def _systems(name: str, robot: Robot, plan: Plan) -> List[Tuple[Optional[float], System]]:
    """Return new systems of a name, and their budgets."""
    if name not in (WITH_GRAPH, WITHOUT_GRAPH):
        return [(None, catalogue.make(name))]
    graph = robot.graph if name == WITH_GRAPH else set()
    return [(budget, Evidence(graph, budget=budget, tuning=plan.tuning))
            for budget in plan.budgets]


def _expected(system: System) -> Optional[float]:
    if not isinstance(system, Evidence) or math.isnan(system.expected_per_hour):
        return None
    return system.expected_per_hour
