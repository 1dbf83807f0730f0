"""Writes what the evaluation on families found: a page, and CSV files."""
from __future__ import annotations

import math
from pathlib import Path
from typing import Any, Dict, List

from self_awareness import DetectorParameters
from self_awareness.output_files import replacing
from self_awareness.stamps import SECOND_NS
from self_awareness_evaluation import row_files
from self_awareness_evaluation.pages import written_by
from self_awareness_evaluation.families import summary
from self_awareness_evaluation.families.experiment import Plan, Results
from self_awareness_evaluation.families.kinds import FAMILIES
from self_awareness_evaluation.families.measures import FaultRow, NormalRow
from self_awareness_evaluation.families.protocol import (AFTER_DEATH_S, AFTER_ONSET_S,
                                                         AFTER_RESTART_S, KINDS, RESTARTS_IN_S,
                                                         WATCHED_S)
from self_awareness_evaluation.families.robot import RESTART
from self_awareness_evaluation.families.summary import Found
from self_awareness_evaluation.families.tables import (budgets_table, families_table,
                                                       late_learning, main_learning, main_system)
from self_awareness_evaluation.simulated.measures import AFTERMATH_S

NAME = 'families'

FULL = 'full'
"""Folder below the page's for the rows of all recordings, which is not kept in the repository."""

_WITHIN_S = (1.0, 3.0, 5.0, 50.0)

_INTRODUCTION = """\
# Evaluation on families of robots

{written}

Simulated robots that differ in what decides on false alarms, each drawn by its seed: {seeds}.

{families}

Each robot is recorded to learn from (starts to train on + further starts to calibrate on):
{learnings}. In other starts {hours:g} h of normal operation are watched, in recordings of
{watched_s:g} s, and in recordings of their own every regular component crashes, halves its rate,
answers 60 ms later, or misses its inputs for a second now and then; the CPU is starved within
20 s; everything falls silent (the recording goes on for {after_s:g} s after the onset); every
component that speaks only when it is asked dies ({death_s:g} s; the latency counts from the first
message that is missing); and so does who speaks when something happens (three times its longest
pause within an hour). Every regular component is restarted, too: it is silent for {away_s:g} s,
and then its timers have other phases; the recording goes on for {watched_again_s:g} s, and alarms
that are raised when it is back for {aftermath_s:g} s are false. With every start all timers have
new phases; where a family is recorded or watched in one start, its line says so. All systems judge
the same recordings; the first {settle_s:g} s of each, while a detector settles, are left out. A
host that stalls is that of the recorder and the monitor, too, and the recordings say for how long
it did; that a CPU is starved they do not say.

The table is about `{system}` with limits for a budget of {budget:g} false alarms an hour. It
begins with the false alarms an hour by what was learned from, with their 95 % interval (alarms
come in clusters: it is the wider the more the robots differ), and those of other systems beside
them. All columns without a number of starts are about {main}, that of late answers about
{late}. Half rates, late answers and deaths: share of the records with an alarm after
the onset, its median latency, and how many of these alarms name the guilty component first. The
last column says what raised most of the false alarms. A system with many of them finds faults by
chance, and one whose false alarm stands at the onset raises none for the fault: read all together.

All figures, also of the other systems: [{name}.csv]({name}.csv).
"""

_BUDGETS = """\
## What the budget comes to

False alarms an hour of `{system}` in all families: what the calibrations promised on average
(95 %), and what came.
"""


def write(folder: Path, plan: Plan, results: Results, command: str) -> List[Path]:
    """Write all files, each whole or not at all; return their names.

    Args:
        folder: exists; gets the page and its figures, and a folder FULL for all rows.
        plan: what was evaluated.
        results: what was found.
        command: that the page says it was written by.

    Raises:
        OSError: a file cannot be written.
    """
    full = folder / FULL
    full.mkdir(exist_ok=True)
    paths = [full / f'{NAME}_normal.csv', full / f'{NAME}_faults.csv', folder / f'{NAME}.csv',
             folder / f'{NAME}.md']
    row_files.save(paths[0], results.normal, NormalRow)
    row_files.save(paths[1], results.faults, FaultRow)
    of_groups = figures(results)
    row_files.save_table(paths[2], of_groups, list(of_groups[0]))
    with replacing(str(paths[3])) as temporary:
        Path(temporary).write_text(page(plan, results, command), encoding='utf-8')
    return paths


def page(plan: Plan, results: Results, command: str) -> str:
    """Return the page."""
    lines = [_INTRODUCTION.format(
        written=written_by(command), name=NAME, system=main_system(plan),
        seeds=', '.join(str(seed) for seed in plan.seeds),
        families='\n'.join(f'- `{name}`: {FAMILIES[name].told}' for name in plan.families),
        learnings='; '.join(str(learning) for learning in plan.learnings),
        hours=plan.hours, watched_s=WATCHED_S, after_s=AFTER_ONSET_S, death_s=AFTER_DEATH_S,
        away_s=RESTARTS_IN_S, watched_again_s=AFTER_RESTART_S, aftermath_s=AFTERMATH_S,
        settle_s=DetectorParameters().settle_time / SECOND_NS, main=main_learning(plan),
        late=late_learning(plan), budget=plan.budgets[0]),
        *families_table(plan, results), '']
    if len(plan.budgets) > 1:
        lines += [_BUDGETS.format(system=main_system(plan)), *budgets_table(plan, results), '']
    return '\n'.join(lines)


def figures(results: Results) -> List[Dict[str, Any]]:
    """Return all figures, a row for each family, system, learning and budget."""
    rows = []
    for group, of_group in summary.groups(results.normal).items():
        quiet = summary.quiet(of_group)
        row: Dict[str, Any] = {
            'family': group.family, 'learning': group.learning, 'system': group.system,
            'budget': group.budget, 'robots': quiet.robots, 'hours': quiet.hours,
            'false_alarms': quiet.alarms, 'per_hour': quiet.per_hour,
            'per_hour_low': quiet.interval[0], 'per_hour_high': quiet.interval[1],
            'standing': quiet.standing, 'warnings_per_hour': quiet.warnings_per_hour,
            'expected_per_hour': quiet.expected_per_hour,
            'watched': quiet.watched, 'components': quiet.components,
            'evidence': '; '.join(f'{text} {number}' for text, number in quiet.evidence)}
        for kind in KINDS:
            row.update(_of_fault(kind, summary.found(results.faults, group, kind)))
        row[f'{RESTART}_alarms_after'] = summary.found(results.faults, group, RESTART).after
        rows.append({name: _short(value) for name, value in row.items()})
    return rows


def _of_fault(kind: str, found: Found) -> Dict[str, Any]:
    low, high = found.interval()
    figures_of = {
        'records': found.records, 'stood_before': found.stood_before, 'found': found.within(),
        'found_low': low, 'found_high': high, 'median_s': found.median_s, 'first': found.first,
        'among_three': found.among_three}
    figures_of.update({f'within_{within_s:g}_s': found.within(within_s)
                       for within_s in _WITHIN_S})
    return {f'{kind.split()[0]}_{name}': value for name, value in figures_of.items()}


def _short(value: Any) -> Any:
    if not isinstance(value, float):
        return value
    return '' if math.isnan(value) else f'{value:.3g}'
