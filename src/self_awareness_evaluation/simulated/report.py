"""Writes what the evaluation found: a page with plots, and in a folder below all numbers."""
from __future__ import annotations

from pathlib import Path
from typing import Any, Dict, List, Sequence

from self_awareness import DEFAULT_WINDOW
from self_awareness.calibration import limits
from self_awareness.output_files import replacing
from self_awareness_evaluation import row_files
from self_awareness_evaluation.pages import written_by
from self_awareness_evaluation.simulated import figures, tables
from self_awareness_evaluation.simulated.experiment import Plan, Results
from self_awareness_evaluation.simulated.measures import Row
from self_awareness_evaluation.simulated.records import (NORMAL_NAMES, NORMAL_TEST_S, RECORD_S,
                                                         TRAINING_NAMES)
from self_awareness_evaluation.systems import FALSE_POSITIVE_RATE

NAME = 'simulated'

FULL = 'full'
"""Folder below the page's for all numbers: too long to read, and not kept in the repository."""

_INTRODUCTION = """\
# Evaluation in simulated time

{written}

Seeds {seeds}.

For each seed there are records of the simulated follow-me robot: {training} of {record_s:g} s to
learn from, one of {calibration_s:g} s to choose the threshold by, one of {normal_s:g} s of normal
operation to count false alarms on, and one of {record_s:g} s for each fault, which begins between
50 and 52 s (longer where a fault is a finding only after a minute). All have the attributes of the
messages and who subscribes to what, as event logs have. Each record has a seed of its own, the
first four bytes of the SHA-256 of `SEED/RECORD`; the records are called {names},
and as the faults. All systems learn from and judge the same records.

Each system gives every window of {window_ms:g} ms a score. The threshold is chosen on the
calibration record: a share of {rate:g} of its windows falls below. Five systems differ:
`frequency` and `timestamps` have bounds of their own, those of diagnostic_updater's
FrequencyStatus and TimeStampStatus; `sizes` has those of the training, and `gaps` those of both
training and calibration, wider by a quarter; and `evidence` has the limits that
`calibrate` finds on the same record for a budget of {budget:g} false alarms an hour. Three
abnormal windows of five raise the alarm, 2 s without one clear it, and none is raised in the first
5 s, by the same code for all; `evidence` raises it at once for a silence that has lasted a
window beyond its limit. `evidence` knows who subscribes to what, as after `train --graph`;
`evidence_no_graph` was trained on bags alone. Events never seen in training are a suspicion, not
an alarm (`~unknown: warn`).

Figures are means over the seeds, intervals of 95 %. A latency is that of the first alarm raised
after the onset; where none was raised, it is infinite (–). An alarm that stood at the onset is a
false one. Blame is counted where an alarm was raised and a source is guilty, and is – for systems
that name no suspects. A system with many false alarms finds faults by chance: read the latencies
together with the false alarms.

The command also writes `{full}/{name}.csv`, a row for each system, seed and record, and
`{full}/{name}.md`, tables of every quantity for every fault.

![Scores of the paper's detector](figure2.png)
![False alarms and latency](overview.png)
"""


def write(folder: Path, plan: Plan, results: Results, command: str) -> List[Path]:
    """Write all files, each whole or not at all; return their names.

    Args:
        folder: exists; gets the page and the plots, and a folder FULL for all numbers.
        plan: what was evaluated.
        results: what was found.
        command: that the pages say they were written by.

    Raises:
        OSError: a file cannot be written.
    """
    full = folder / FULL
    full.mkdir(exist_ok=True)
    paths = [full / f'{NAME}.csv', full / f'{NAME}.md', folder / f'{NAME}.md',
             folder / 'figure2.png', folder / 'overview.png']
    row_files.save(paths[0], results.rows, Row)
    _save_text(paths[1], full_page(plan, results, command))
    _save_text(paths[2], page(plan, results, command))
    figures.save_figure2(str(paths[3]), results.traces)
    figures.save_overview(str(paths[4]), _by_system(_whole(results.rows)),
                          _by_system(results.trade_offs))
    return paths


def page(plan: Plan, results: Results, command: str) -> str:
    """Return the page that is read: targets, false alarms, latencies and blame."""
    rows = _by_system(_whole(results.rows))
    lines = [_INTRODUCTION.format(
        written=written_by(command), name=NAME, full=FULL, rate=FALSE_POSITIVE_RATE,
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
    lines += ['## Alarms', '', 'Records in which the alarm was raised, and its median latency.',
              '', *tables.alarms(rows), '']
    lines += ['## Blame', '', 'Alarms that blame a guilty source first / among the first three.',
              '', *tables.blame(rows), '']
    few = _by_system(_part(results.rows))
    if few:
        lines += [*_few_heading(plan), *tables.targets(few), '']
    return '\n'.join(lines)


def full_page(plan: Plan, results: Results, command: str) -> str:
    """Return the page of a table of every quantity for every fault."""
    lines = ['# Evaluation in simulated time: all tables', '', written_by(command),
             '', f'What was done, and how to read it: [{NAME}.md](../{NAME}.md). All numbers: '
             f'[{NAME}.csv]({NAME}.csv).', '',
             '## With all of the training data', '',
             *tables.faults(_by_system(_whole(results.rows))), '']
    few = _by_system(_part(results.rows))
    if few:
        lines += [*_few_heading(plan), *tables.faults(few), '']
    return '\n'.join(lines)


def _few_heading(plan: Plan) -> List[str]:
    return [f'## With {plan.training_share:.3g} of the training data', '',
            'The first part of each record; the calibration is the same.', '']


def _part(rows: Sequence[Row]) -> List[Row]:
    return [row for row in rows if row.training_share < 1.0]


def _whole(rows: Sequence[Row]) -> List[Row]:
    return [row for row in rows if row.training_share == 1.0]


def _by_system(items: Sequence[Any]) -> Dict[str, List[Any]]:
    groups: Dict[str, List[Any]] = {}
    for item in items:
        groups.setdefault(item.system, []).append(item)
    return groups


def _save_text(path: Path, text: str) -> None:
    with replacing(str(path)) as temporary:
        Path(temporary).write_text(text, encoding='utf-8')
