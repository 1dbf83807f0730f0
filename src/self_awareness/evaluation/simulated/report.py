"""Writes what the evaluation found: a CSV file of all rows, a page of tables, and plots."""
from __future__ import annotations

import csv
from dataclasses import astuple, fields
from pathlib import Path
from typing import Any, Dict, List, Sequence

from self_awareness import DEFAULT_WINDOW
from self_awareness.calibration import limits
from self_awareness.evaluation.simulated import figures, tables
from self_awareness.evaluation.simulated.experiment import Plan, Results
from self_awareness.evaluation.simulated.measures import Row
from self_awareness.evaluation.simulated.records import (NORMAL_NAMES, NORMAL_TEST_S, RECORD_S,
                                                         TRAINING_NAMES)
from self_awareness.evaluation.systems import FALSE_POSITIVE_RATE
from self_awareness.output_files import replacing

NAME = 'simulated'

_INTRODUCTION = """\
# Evaluation in simulated time

Written by `{command}`; do not edit.

Seeds {seeds}.

For each seed, records of the simulated follow-me robot: {training} of {record_s:g} s to learn
from, one of {calibration_s:g} s to choose the threshold by, one of {normal_s:g} s of normal
operation to count false alarms on, and one of {record_s:g} s for each fault, which begins between
50 and 52 s. Each record has a seed of its own, the first four bytes of the SHA-256 of
`SEED/RECORD`; the records are called {names} and as the faults. All systems learn from, and judge,
the same records.

Each system gives every window of {window_ms:g} ms a score. The threshold is the one that a share
of {rate:g} of the calibration's windows falls below; `frequency` has bounds of its own, those of
diagnostic_updater's FrequencyStatus, and `evidence` the limits that `calibrate` finds on the same
record for a budget of {budget:g} false alarms an hour. Three abnormal windows of five raise the
alarm, 2 s without one clear it, and none is raised in the first 5 s, by the same code for all;
`evidence` raises it at once for a silence that has lasted 0.1 s beyond its limit, and for the
linker.
`evidence` knows who subscribes to what, as after `train --graph`; `evidence_no_graph` was trained
on bags alone. Events never seen in training are a suspicion, not an alarm (`~unknown: warn`).

Figures are means over the seeds, intervals of 95 %. A latency is that of the first alarm raised
after the onset; where none was raised, it is infinite (–). An alarm that stood at the onset is a
false one. Blame is counted where an alarm was raised and a source is guilty, and is – for systems
that name no suspects. A system with many false alarms finds faults by chance: read the latencies
together with the false alarms.

All numbers: [{name}.csv]({name}.csv), a row for each system, seed and record.

![Scores of the paper's detector](figure2.png)
![False alarms and latency](overview.png)
"""


def write(folder: Path, plan: Plan, results: Results, command: str) -> List[Path]:
    """Write all files, each whole or not at all; return their names.

    Args:
        folder: exists.
        plan: what was evaluated.
        results: what was found.
        command: that the page says it was written by.

    Raises:
        OSError: a file cannot be written.
    """
    paths = [folder / f'{NAME}.csv', folder / f'{NAME}.md', folder / 'figure2.png',
             folder / 'overview.png']
    _save_csv(paths[0], results.rows)
    with replacing(str(paths[1])) as temporary:
        Path(temporary).write_text(page(plan, results, command), encoding='utf-8')
    figures.save_figure2(str(paths[2]), results.traces)
    figures.save_overview(str(paths[3]), _by_system(_whole(results.rows)),
                          _by_system(results.trade_offs))
    return paths


def page(plan: Plan, results: Results, command: str) -> str:
    """Return the page of tables."""
    rows = _by_system(_whole(results.rows))
    lines = [_INTRODUCTION.format(
        command=command, name=NAME, rate=FALSE_POSITIVE_RATE,
        seeds=', '.join(str(seed) for seed in plan.seeds),
        names=', '.join(f'`{name}`' for name in NORMAL_NAMES),
        training=len(TRAINING_NAMES), record_s=RECORD_S,
        calibration_s=plan.calibration_s, normal_s=NORMAL_TEST_S, window_ms=DEFAULT_WINDOW / 1e6,
        budget=limits.BUDGET),
        '## Targets', '', *tables.targets(rows), '']
    if results.trade_offs:
        lines += ['## False alarms an hour at equal latency', '',
                  'For cc1, with thresholds from lax to strict, in all normal operation; – where '
                  'none is so fast.', '',
                  *tables.trade_offs(_by_system(results.trade_offs)), '']
    lines += ['## Every fault', '', *tables.faults(rows), '']
    few = [row for row in results.rows if row.training_share < 1.0]
    if few:
        lines += [f'## With {plan.training_share:.3g} of the training data', '',
                  'The first part of each record; the calibration is the same.', '',
                  *tables.targets(_by_system(few)), '', *tables.faults(_by_system(few)), '']
    return '\n'.join(lines)


def _whole(rows: Sequence[Row]) -> List[Row]:
    return [row for row in rows if row.training_share == 1.0]


def _by_system(items: Sequence[Any]) -> Dict[str, List[Any]]:
    groups: Dict[str, List[Any]] = {}
    for item in items:
        groups.setdefault(item.system, []).append(item)
    return groups


def _save_csv(path: Path, rows: Sequence[Row]) -> None:
    with replacing(str(path)) as temporary:
        with open(temporary, 'w', encoding='utf-8', newline='') as file:
            writer = csv.writer(file, lineterminator='\n')
            writer.writerow([field.name for field in fields(Row)])
            writer.writerows(astuple(row) for row in rows)
