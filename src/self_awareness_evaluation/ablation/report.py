"""Writes what the ablation found: a page with two tables, and a CSV file of all figures."""
from __future__ import annotations

from pathlib import Path
from typing import Any, Dict, List, Sequence, Tuple

from self_awareness import METHOD, Tuning
from self_awareness.output_files import replacing
from self_awareness_evaluation import row_files
from self_awareness_evaluation.ablation import figures
from self_awareness_evaluation.ablation.bench import (AFTER_DEATH_S, FAMILIES, OWN,
                                                      RECORDINGS, Plan)
from self_awareness_evaluation.ablation.experiment import Results
from self_awareness_evaluation.ablation.variants import DEFAULT, NUMBER, Variant
from self_awareness_evaluation.families.protocol import RESTARTS_IN_S
from self_awareness_evaluation.pages import written_by
from self_awareness_evaluation.simulated.measures import AFTERMATH_S
from self_awareness_evaluation.simulated.tables import table
from self_awareness_evaluation.tally import NONE

NAME = 'ablation'

FULL = 'full'
"""Folder below the page's for the rows of all records, which is not kept in the repository."""

_INTRODUCTION = """\
# What each part of the method buys

{written}

The evidence detector (method {method}) with one change at a time: a channel left out, a rule
switched off, a number halved or doubled. All variants learn from and judge the same records:

- robots of the families {families} ([what they are](families.md)), seeds {seeds}, which learn in
  turn from {learnings}; {hours:g} h of normal operation each, and up to {faults} faults of every
  kind (after a death, the record goes on for {death_s:g} s; who is restarted is silent for
  {away_s:g} s, and comes back with other phases);
- the project's own robot ([what is recorded](simulated.md)), seeds {own}: all faults but those
  that are a suspicion only; AC: a host's clock is out of step, RS: the CPU is taken away;
- {recordings}.

What is counted in the recordings is the same in all variants; what is watched, the limits and the
verdicts are each variant's own. False alarms and WARN also count what comes before the onset of a
fault. Of faults, how many of all were found, and the median latency of all of them, which is left
out where fewer than half were. *Alarms after a restart*: for who is back for {aftermath_s:g} s,
all of them false. *Guilty first*: alarms after an onset that name the guilty one first, of those
where one is.

All figures, apart for families, own robot and recordings: [{name}.csv]({name}.csv).
"""

_PARTS = """\
## Channels and rules

Bold: differs from the method as it is. Medians that differ by less than {latency_s:g} s and
WARN by one are told as the same.
"""

_NUMBERS = """\
## Numbers

What changes when a number is halved and doubled (within its range; a count stays whole). A dash:
nothing does.
"""


def write(folder: Path, plan: Plan, results: Results, command: str) -> List[Path]:
    """Write the page and the figures, each file whole or not at all; return their names.

    Args:
        folder: exists.
        plan: what was judged.
        results: what was found.
        command: that the page says it was written by.

    Raises:
        OSError: a file cannot be written.
    """
    paths = [folder / f'{NAME}.csv', folder / f'{NAME}.md']
    of_parts = [_figures(variant, part, results) for variant in results
                for part in (FAMILIES, OWN, RECORDINGS)
                if any(row.part == part for row in results[variant])]
    row_files.save_table(paths[0], of_parts, list(of_parts[0]))
    with replacing(str(paths[1])) as temporary:
        Path(temporary).write_text(page(plan, results, command), encoding='utf-8')
    return paths


def page(plan: Plan, results: Results, command: str) -> str:
    """Return the page."""
    lines = [_INTRODUCTION.format(
        written=written_by(command), name=NAME, method=METHOD,
        families=', '.join(f'`{name}`' for name in plan.families),
        seeds=', '.join(str(seed) for seed in plan.seeds),
        own=', '.join(str(seed) for seed in plan.own_seeds), death_s=AFTER_DEATH_S,
        away_s=RESTARTS_IN_S, aftermath_s=AFTERMATH_S,
        learnings=' and '.join(str(learning) for learning in plan.learnings), hours=plan.hours,
        faults=plan.faults, recordings='the recordings of real robots '
        '([which](recordings.md))' if plan.data else 'without the recordings of real robots'),
        _PARTS.format(latency_s=figures.LEAST_LATENCY_S),
        *_parts_table(results), '']
    if any(variant.kind == NUMBER for variant in results):
        lines += [_NUMBERS, *_numbers_table(results), '']
    unable = {variant: told for variant, rows in results.items()
              if (told := figures.refused(rows))}
    if unable:
        lines += ['## Without limits', '', 'Too little to find limits on, so nothing was judged:',
                  '', *(f'- {variant}: {"; ".join(told)}' for variant, told in unable.items()), '']
    return '\n'.join(lines)


def _figures(variant: Variant, part: str, results: Results) -> Dict[str, Any]:
    return {'variant': str(variant), 'part': part,
            **figures.numbers([row for row in results[variant] if row.part == part])}


def _parts_table(results: Results) -> List[str]:
    default = figures.cells(results[Variant(DEFAULT)])
    body = []
    for variant, of_variant in results.items():
        if variant.kind == NUMBER:
            continue
        found = figures.cells(of_variant)
        body.append([_named(variant), *(
            f'**{found[title].text}**' if found[title].differs(default[title])
            else found[title].text for title in default)])
    return table(['', *default], body)


def _named(variant: Variant) -> str:
    if variant.kind == DEFAULT:
        return 'as it is'
    return str(variant) if variant.value is None else f'{variant.name} off'


def _numbers_table(results: Results) -> List[str]:
    """Return the table of the numbers that matter, and a sentence about the others."""
    changed: Dict[str, List[Tuple[float, str]]] = {}
    for variant in results:
        if variant.kind == NUMBER and variant.value is not None:
            changed.setdefault(variant.name, []).append((variant.value,
                                                         _changes(results, variant)))
    body, same = [], []
    for number in Tuning.numbers():
        told = changed.get(number.name)
        if told is None:
            continue
        if not any(text for _, text in told):
            same.append(f'`{number.name}` ({", ".join(_value(value) for value, _ in told)})')
            continue
        unit = f' {number.unit}' if number.unit else ''
        body.append([f'`{number.name}`', f'{number.default:g}{unit}',
                     _cell(told, lambda value: value < number.default),
                     _cell(told, lambda value: value > number.default)])
    lines = table(['number', 'value', 'half', 'double'], body)
    if same:
        lines += ['', f'Changed nothing: {", ".join(same)}.']
    return lines


def _cell(told: Sequence[Tuple[float, str]], chosen: Any) -> str:
    return '; '.join(f'{_value(value)}: {text or NONE}'
                     for value, text in told if chosen(value)) or NONE


def _changes(results: Results, variant: Variant) -> str:
    default, found = figures.cells(results[Variant(DEFAULT)]), figures.cells(results[variant])
    return ', '.join(f'{title} {found[title].text}' for title in default
                     if found[title].differs(default[title]))


def _value(value: float) -> str:
    return f'{value:g}'
