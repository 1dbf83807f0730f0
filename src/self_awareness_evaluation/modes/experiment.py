"""Deaths in a mode, judged by a model of all modes, and by one that was learned in that one alone.

A robot is in one of two modes: in all of its activities, or in none. What is recorded in a mode
alone is the same robot, in the same starts, that never leaves the mode.
"""
from __future__ import annotations

from contextlib import closing
from dataclasses import dataclass, field
from typing import Dict, Iterator, List, Tuple

from self_awareness.calibration.limits import BUDGET
from self_awareness.workers import Processes
from self_awareness_evaluation.detectors import Evidence
from self_awareness_evaluation.families.experiment import WITH_GRAPH
from self_awareness_evaluation.families.measures import (FaultRow, NormalRow, Subject, fault_row,
                                                         normal_row)
from self_awareness_evaluation.families.protocol import DEATH, FaultRecord, Learning, Records
from self_awareness_evaluation.families.robot import CRASH

FAMILIES = ('driving_docked', 'long_pauses', 'events_only', 'dialogue')
"""Families whose robots have modes that last for longer than silence takes to be found."""

MODES: Dict[str, bool] = {'active': True, 'idle': False}
"""By name, whether the robot is in its activities."""

BOTH, ALONE = 'both modes', 'the mode alone'
"""What a model was learned in."""

AFTER_DEATH_S = 300.0
"""A recording goes on for so long after a component died that speaks when it is asked [s]."""


@dataclass(frozen=True)
class Plan:
    """What is measured.

    Args:
        families: names, of FAMILIES.
        seeds: of the robots of each.
        learning: what is learned from, in both modes and in each alone.
        hours: of normal operation in changing modes that is watched, for each robot.
    """

    families: Tuple[str, ...]
    seeds: Tuple[int, ...]
    learning: Learning
    hours: float


@dataclass(frozen=True)
class DeathRow:
    """A death in a mode, as a model judged it.

    Args:
        mode: of MODES.
        model: BOTH or ALONE.
        fault: what was found.
    """

    mode: str
    model: str
    fault: FaultRow


@dataclass
class Results:
    """What was measured; normal: by the model of both modes."""

    normal: List[NormalRow] = field(default_factory=list)
    deaths: List[DeathRow] = field(default_factory=list)


def run(plan: Plan, jobs: int) -> Results:
    """Measure all robots, `jobs` of them at a time."""
    robots = [(family, seed) for family in plan.families for seed in plan.seeds]
    results = Results()
    # In the order of the robots, so that the same command writes the same files.
    with closing(Processes(jobs).map(run_robot, plan, robots, 'evaluating')) as parts:
        for part in parts:
            results.normal += part.normal
            results.deaths += part.deaths
    return results


def run_robot(plan: Plan, robot: Tuple[str, int]) -> Results:
    """Measure one robot, by its family and seed."""
    records = Records(*robot)
    of_all = _learned(plan, records)
    subject = Subject(*robot, str(plan.learning), WITH_GRAPH, BUDGET)
    results = Results()
    for recording in records.watched(plan.hours):
        results.normal.append(normal_row(subject, of_all.judge(recording),
                                         of_all.expected_per_hour, len(of_all.watched),
                                         len(records.robot.sources)))
    for mode, on in MODES.items():
        in_mode = Records(*robot, on)
        models = {BOTH: of_all, ALONE: _learned(plan, in_mode)}
        for death in _deaths(in_mode):
            results.deaths += [
                DeathRow(mode, name, fault_row(subject, death, model.judge(death.recording)))
                for name, model in models.items()]
    return results


def _learned(plan: Plan, records: Records) -> Evidence:
    system = Evidence(records.robot.graph, budget=BUDGET)
    system.train(records.training(plan.learning))
    system.calibrate(records.calibration(plan.learning))
    return system


def _deaths(records: Records) -> Iterator[FaultRecord]:
    """Yield the deaths of all that sends in a mode, or would be asked to."""
    return records.faults((CRASH, DEATH), after_death_s=AFTER_DEATH_S)
