"""The page about modes, and its rows as CSV files."""
from __future__ import annotations

import math
from pathlib import Path
from typing import Dict, List, Sequence, Tuple

from self_awareness.calibration import confidence, limits
from self_awareness.output_files import replacing
from self_awareness_evaluation import row_files
from self_awareness_evaluation.families.kinds import FAMILIES
from self_awareness_evaluation.families.measures import FaultRow, NormalRow
from self_awareness_evaluation.families.report import FULL
from self_awareness_evaluation.modes.experiment import (AFTER_DEATH_S, ALONE, BOTH, MODES,
                                                        DeathRow, Plan, Results)
from self_awareness_evaluation.pages import written_by
from self_awareness_evaluation.simulated.summary import quantile
from self_awareness_evaluation.simulated.tables import percent, table
from self_awareness_evaluation.tally import NONE, Tally, alarms

NAME = 'modes'

FOUND, FOUND_S = 0.98, 50.0
"""The share of the deaths that is to be found in a time [s]."""

LATER = 1.2
"""How many times as late as by a model of the mode alone, at most."""

FALSE_PER_HOUR = 0.05
"""False alarms an hour, at most."""

_WITHIN_S = (1.0, 5.0, FOUND_S)
_ALL = 'all'

_TEXT = """\
# Evaluation of robots with modes

{written}

What a robot does only at times, it is silent about at all others ([modes](../modes.md)). Here,
robots of some [families](families.md), drawn by the seeds {seeds}, are in one of two modes:
*active*, in all that they do at times, or *idle*, in none of it. All that sends in a mode dies in
it, and so does who would be asked in it ({after:g} s; the latency counts from the first message
that is missing). Two models judge the same deaths, with limits for {budget:g} false alarms an
hour:

- *{both}*: learned from {learning} of the robot that changes its mode as it does;
- *{alone}*: learned from as much of the same robot, in the same starts, that never leaves the
  mode.

{families}

| what | aim | came | |
| --- | --- | --- | --- |
{aims}

{rows}

*Times as late*: {both} against {alone}, of each death that the latter found; one that the former
did not find is infinitely late. The median, and what nine in ten are below. False alarms: of
{both}, in {hours:g} h of each robot, in recordings of 30 minutes with changing modes.

What is silent at times by itself, and not with others, cannot be missed sooner than it is silent
when all is well: a joystick of `long_pauses` is put down for up to some minutes, whatever the
others do, and who alone hears it is silent with it. In the mode alone it is never put down.

The command also writes a row for each death and recording to `{full}/{name}_deaths.csv` and
`{full}/{name}_normal.csv`.
"""


def write(folder: Path, plan: Plan, results: Results, command: str) -> List[Path]:
    """Write the page, and the rows to a folder FULL below; return their names.

    Raises:
        OSError: a file cannot be written.
    """
    full = folder / FULL
    full.mkdir(exist_ok=True)
    paths = [full / f'{NAME}_normal.csv', full / f'{NAME}_deaths.csv', folder / f'{NAME}.md']
    row_files.save(paths[0], results.normal, NormalRow)
    row_files.save(paths[1], results.deaths, DeathRow)
    with replacing(str(paths[2])) as temporary:
        Path(temporary).write_text(_page(plan, results, command), encoding='utf-8')
    return paths


def _page(plan: Plan, results: Results, command: str) -> str:
    return _TEXT.format(
        written=written_by(command), name=NAME, full=FULL, both=BOTH, alone=ALONE,
        after=AFTER_DEATH_S,
        seeds=', '.join(map(str, plan.seeds)), budget=limits.BUDGET, learning=plan.learning,
        families='\n'.join(f'- `{name}`: {FAMILIES[name].told}' for name in plan.families),
        aims='\n'.join(_aims(results)), rows='\n'.join(_rows(plan, results)), hours=plan.hours)


def _aims(results: Results) -> List[str]:
    tally = _tally([row.fault for row in results.deaths if row.model == BOTH])
    found = tally.within(FOUND_S) / len(tally.latencies_s)
    late = _times_as_late(results.deaths)
    middle = quantile(late, 0.5)
    within = sum(each <= LATER for each in late)
    count, hours = _false(results.normal)
    low, high = confidence.poisson_rate(count, hours)
    return [
        f'| deaths found within {FOUND_S:g} s | {percent(FOUND)} | {percent(found)}, '
        f'{tally.within(FOUND_S)} of {len(tally.latencies_s)} | {_met(found >= FOUND)} |',
        f'| times as late as by the mode alone, median | {LATER:g} | {_times(middle)}; '
        f'{within} of {len(late)} no more | {_met(middle <= LATER)} |',
        f'| false alarms an hour (95 %) | {FALSE_PER_HOUR:g} | {count / hours:.2g} ({low:.2g} to '
        f'{high:.2g}), {count} in {hours:.3g} h | {_met(count / hours <= FALSE_PER_HOUR)} |']


def _rows(plan: Plan, results: Results) -> List[str]:
    head = ['family', 'mode', *(f'found by {model}: within {_within()} s, median'
                                for model in (BOTH, ALONE)),
            'times as late', f'named first by {BOTH}', 'false alarms']
    body = []
    for family in [*plan.families, _ALL]:
        normal = [row for row in results.normal if family in (_ALL, row.subject.family)]
        false = alarms(*_false(normal))
        for mode in MODES:
            deaths = [row for row in results.deaths if row.mode == mode
                      and family in (_ALL, row.fault.subject.family)]
            tallies = [_tally([row.fault for row in deaths if row.model == model])
                       for model in (BOTH, ALONE)]
            late = _times_as_late(deaths)
            body.append([family, mode, *(each.found(*_WITHIN_S) for each in tallies),
                         f'{_times(quantile(late, 0.5))}, {_times(quantile(late, 0.9))}'
                         if late else NONE, tallies[0].named_first, false])
            false = ''  # of all modes, and told once
    return table(head, body)


def _within() -> str:
    return ' / '.join(f'{within_s:g}' for within_s in _WITHIN_S)


def _tally(faults: Sequence[FaultRow]) -> Tally:
    return Tally.of((row.latency_s, row.first) for row in faults)


def _times_as_late(deaths: Sequence[DeathRow]) -> List[float]:
    """Return how many times as late BOTH found each death that ALONE found."""
    found: Dict[str, Dict[Tuple[str, str, int, str, str], float]] = {BOTH: {}, ALONE: {}}
    for row in deaths:
        subject, fault = row.fault.subject, row.fault
        if fault.latency_s is not None:
            key = (row.mode, subject.family, subject.seed, fault.kind, fault.source)
            found[row.model][key] = fault.latency_s
    return [found[BOTH].get(key, math.inf) / alone_s for key, alone_s in found[ALONE].items()]


def _false(normal: Sequence[NormalRow]) -> Tuple[int, float]:
    return sum(row.alarms for row in normal), sum(row.hours for row in normal)


def _times(value: float) -> str:
    return f'{value:.2f}' if math.isfinite(value) else 'not found'


def _met(is_met: bool) -> str:
    return 'met' if is_met else 'not met'
