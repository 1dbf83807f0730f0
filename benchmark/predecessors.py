#!/usr/bin/python3
"""Benchmark of the number of watched predecessors: its cost and its use.

Trains the evidence detector on the simulated follow-me robot with several bounds on the number of
predecessors of an event type, and judges the same normal operation and the same faults with each.
"""
from __future__ import annotations

import argparse
import math
import multiprocessing
from functools import partial
from pathlib import Path
from typing import Any, Dict, List, Sequence

import page
from self_awareness import Tuning
from self_awareness.evaluation.detectors import Evidence, scenario_graph
from self_awareness.evaluation.simulated import experiment, summary
from self_awareness.evaluation.simulated.experiment import Plan
from self_awareness.evaluation.simulated.measures import Row, fault_row, normal_row
from self_awareness.follow_me.scenario import load_scenario

_DOCS = Path(__file__).resolve().parents[1] / 'docs'
ALL = 1000
"""More than there are event types."""
BOUNDS = (1, 2, 3, 5, 8, ALL)
FAULTS = ('cc1', 'cc2', 'rs', 'ac', 'lat')


def measure(seeds: Sequence[int], jobs: int) -> List[Dict[str, Any]]:
    """Return one row of results for every bound."""
    plan = Plan(('evidence',), FAULTS, tuple(seeds))
    with multiprocessing.Pool(jobs) as pool:
        of_seeds = pool.map(partial(_measure_seed, plan), plan.seeds, chunksize=1)
    return [_results(bound, [row for rows in of_seeds for row in rows if row.system == str(bound)])
            for bound in BOUNDS]


def _measure_seed(plan: Plan, seed: int) -> List[Row]:
    records = experiment.make_records(plan, load_scenario(), seed)
    rows = []
    for bound in BOUNDS:
        tuning = Tuning()
        tuning.set('predecessors', bound)
        system = Evidence(scenario_graph(), tuning)
        system.train(records.training)
        system.calibrate([records.calibration])
        normal = system.judge(records.normal)
        rows.append(normal_row(str(bound), 1.0, seed, normal))
        rows += [fault_row(str(bound), 1.0, seed, record.kind, system.judge(record.recording),
                           record.onset, record.culprits, normal) for record in records.faults]
    return rows


def _results(bound: int, rows: Sequence[Row]) -> Dict[str, Any]:
    faults = {kind: summary.of_fault(rows, kind) for kind in FAULTS}
    return {
        'predecessors': 'all' if bound == ALL else bound,
        'false_alarms_per_hour': summary.false_alarms(summary.normal(rows)).per_hour,
        'false_positive_rate': summary.false_positive_rate(summary.normal(rows)),
        **{f'{kind}_latency': _finite(summary.latency(faults[kind], 0.5)) for kind in FAULTS},
        **{f'{kind}_found': summary.found(faults[kind]) for kind in FAULTS},
    }


def _finite(value: float) -> Any:
    return value if math.isfinite(value) else None


def markdown(result: Dict[str, Any]) -> str:
    """Return the table."""
    def latency(row: Dict[str, Any], kind: str) -> str:
        value = row[f'{kind}_latency']
        return 'missed' if value is None else f'{value:.2f}'
    rows = [[str(row['predecessors']), f'{row["false_alarms_per_hour"]:.2f}',
             *(latency(row, kind) for kind in FAULTS)] for row in result['bounds']]
    return page.table(('predecessors', 'false alarms an hour',
                       *(f'{kind} [s]' for kind in FAULTS)), rows)


def main() -> None:
    """Measure, and write the results."""
    parser = argparse.ArgumentParser(prog='benchmark predecessors', description=__doc__)
    parser.add_argument('--output', type=Path, default=_DOCS, metavar='FOLDER',
                        help='for performance/predecessors.json and performance.md (default: '
                        'docs)')
    parser.add_argument('--seed', type=int, default=401, help='the first one (default: 401)')
    parser.add_argument('--seeds', type=int, default=20, metavar='N',
                        help='number of repetitions (default: 20)')
    parser.add_argument('--jobs', type=int, default=2, metavar='N')
    arguments = parser.parse_args()
    seeds = list(range(arguments.seed, arguments.seed + arguments.seeds))
    result = {'seeds': seeds, 'bounds': measure(seeds, arguments.jobs)}
    page.publish('predecessors', result, markdown(result), arguments.output)


if __name__ == '__main__':
    main()
