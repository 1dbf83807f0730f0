"""The evaluation in simulated time: every system on the same records, seed by seed."""
from __future__ import annotations

import multiprocessing
from dataclasses import dataclass, field
from functools import partial
from typing import Dict, List, Tuple

import numpy as np

from self_awareness import Tuning, progress
from self_awareness.stamps import SECOND_NS
from self_awareness_evaluation import catalogue
from self_awareness_evaluation.simulated import tradeoff
from self_awareness_evaluation.simulated.measures import NORMAL, Row, fault_row, normal_row
from self_awareness_evaluation.simulated.records import (CALIBRATION_NAME, NORMAL_TEST_S, RECORD_S,
                                                         TRAINING_NAMES, FaultRecord, fault_record,
                                                         normal_record)
from self_awareness_evaluation.simulated.tradeoff import JudgedFault, TradeOff
from self_awareness_evaluation.systems import System, watched_by
from self_awareness_evaluation.windowed_events import WindowedEvents
from self_awareness_follow_me.scenario import Scenario

PAPER_SYSTEM = 'paper'
PAPER_FAULTS = ('cc1', 'cc2', 'rs', 'ac')
"""What Figure 2 of the paper shows."""


@dataclass(frozen=True)
class Plan:
    """What is evaluated.

    Args:
        systems: names, of catalogue.NAMES.
        faults: kinds of simulation.InducedFault.
        seeds: one repetition each.
        calibration_s: length of the record of normal operation for the threshold [s].
        training_share: systems learn once from all of the training records, and once from this
            first share of them, above 0 and below 1; 0: only from all.
        tuning: of the evidence method.
    """

    systems: Tuple[str, ...]
    faults: Tuple[str, ...]
    seeds: Tuple[int, ...]
    calibration_s: float = 600.0
    training_share: float = 0.1
    tuning: Tuning = field(default_factory=Tuning)


@dataclass(frozen=True)
class Trace:
    """The scores of a record with a fault, for Figure 2; times [s] from the fault's onset."""

    kind: str
    times: np.ndarray
    scores: np.ndarray
    threshold: float


@dataclass
class Results:
    """What was measured; traces of the first seed."""

    rows: List[Row] = field(default_factory=list)
    trade_offs: List[TradeOff] = field(default_factory=list)
    traces: List[Trace] = field(default_factory=list)


@dataclass(frozen=True)
class Records:
    """What is judged in one seed."""

    training: List[WindowedEvents]
    calibration: WindowedEvents
    normal: WindowedEvents
    faults: List[FaultRecord]


def run(plan: Plan, scenario: Scenario, jobs: int) -> Results:
    """Evaluate all seeds, `jobs` of them at a time.

    Raises:
        ValueError: a fault that there is not, or a library that is missing.
    """
    catalogue.check_libraries(plan.systems)
    results = Results()
    with multiprocessing.Pool(jobs) as pool, \
            progress.items(len(plan.seeds), 'evaluating') as one_done:
        # In the order of the seeds, so that the same command writes the same files.
        for part in pool.imap(partial(run_seed, plan, scenario), plan.seeds):
            results.rows += part.rows
            results.trade_offs += part.trade_offs
            results.traces = results.traces or part.traces
            one_done()
    return results


def run_seed(plan: Plan, scenario: Scenario, seed: int) -> Results:
    """Evaluate one seed."""
    records = make_records(plan, scenario, seed)
    results = Results()
    for name in plan.systems:
        for share in (1.0, plan.training_share):
            if share > 0.0:
                _evaluate(catalogue.make(name, plan.tuning), share, seed, records, results)
    return results


def make_records(plan: Plan, scenario: Scenario, seed: int) -> Records:
    """Simulate what one seed judges."""
    normal = partial(normal_record, scenario, seed)
    return Records(
        [normal(name, RECORD_S) for name in TRAINING_NAMES],
        normal(CALIBRATION_NAME, plan.calibration_s),
        normal(NORMAL, NORMAL_TEST_S),
        [fault_record(scenario, seed, kind) for kind in plan.faults])


def _evaluate(system: System, share: float, seed: int, records: Records, results: Results) -> None:
    """Let one system learn from a share of the training records, and measure it."""
    name = system.name
    system.train([recording.beginning(share) for recording in records.training])
    system.calibrate([records.calibration])
    normal = system.judge(records.normal)
    components = {event_type.source for event_type in records.normal.event_types}
    results.rows.append(normal_row(name, share, seed, normal, watched_by(system, components),
                                   len(components)))
    faults: Dict[str, JudgedFault] = {}
    for record in records.faults:
        judged = system.judge(record.recording)
        faults[record.kind] = JudgedFault(judged, record.onset)
        results.rows.append(fault_row(name, share, seed, record.kind, judged, record.onset,
                                      record.culprits, normal))
    if share < 1.0:
        return
    if tradeoff.FAULT in faults:
        results.trade_offs += tradeoff.trade_offs(
            name, seed, system.judge(records.calibration), normal, faults)
    if name == PAPER_SYSTEM:
        results.traces += [_trace(kind, faults[kind]) for kind in PAPER_FAULTS if kind in faults]


def _trace(kind: str, fault: JudgedFault) -> Trace:
    judged = fault.judged
    return Trace(kind, (judged.start - fault.onset) / SECOND_NS, judged.score, judged.threshold)
