"""What the page says of the method with one thing changed after the other."""
from __future__ import annotations

from typing import Dict, List, Sequence, Tuple

from self_awareness import Tuning
from self_awareness_evaluation.families.protocol import DEATH, SELDOM
from self_awareness_evaluation.families.scene import (CRASH, HALF_RATE, LATE, MISSES, RESTART,
                                                      SILENT, STARVED)
from self_awareness_evaluation.figures import NONE, Cell, cells, grouped, table
from self_awareness_evaluation.outages import OUTAGE
from self_awareness_evaluation.pages import RESEARCH, Section
from self_awareness_evaluation.rows import Row
from self_awareness_evaluation.variants import Variant

NAME = 'ablation'

_KINDS: Dict[str, Tuple[str, ...]] = {
    'crashes': (CRASH, 'cc1', 'cc2'), 'half rates': (HALF_RATE, 'half'),
    'late answers': (LATE, 'lat'), 'deaths when asked': (DEATH,), 'AC': (MISSES, 'ac'),
    'RS': (STARVED, 'rs'), 'all silent': (SILENT, 'silence'), 'seldom': (SELDOM,),
    'outages': (OUTAGE,), 'restarts': (RESTART,)}


def section(rows: Sequence[Row], variants: Sequence[Variant]) -> Section:
    """Return what is written of rows; variants: that judged, the method as it is first."""
    of_changes = grouped(rows, lambda row: row.subject.change)
    found = {variant: cells(of_changes[variant.change], _KINDS) for variant in variants}
    default = found[variants[0]]
    robots = ', '.join(grouped(rows, lambda row: f'`{row.subject.robot}`'))
    lines = [f'Of {robots}.', '', '### Channels and rules', '', *table(['', *default], [
        [variant.change or 'as it is', *(
            f'**{of_variant[title].text}**' if of_variant[title].differs(default[title])
            else of_variant[title].text for title in default)]
        for variant, of_variant in found.items() if not variant.is_number])]
    if any(variant.is_number for variant in variants):
        lines += ['', '### Numbers', '', *_numbers_table(found)]
    refused = {f'- {row.subject.change or "as it is"}: {row.subject.robot}: {row.refused}'
               for row in rows if row.refused}
    if refused:
        lines += ['', '### Without limits', '', *sorted(refused)]
    return Section(NAME, 'What each part of the method buys', {RESEARCH: lines})


def _numbers_table(found: Dict[Variant, Dict[str, Cell]]) -> List[str]:
    """Return the table of the numbers that matter, and a sentence about the others."""
    default = next(iter(found.values()))
    changed: Dict[str, List[Tuple[float, str]]] = {}
    for variant, of_variant in found.items():
        if variant.is_number:
            name, _, value = variant.change.partition('=')
            changed.setdefault(name, []).append((float(value), ', '.join(
                f'{title} {of_variant[title].text}' for title in default
                if of_variant[title].differs(default[title]))))
    body, same = [], []
    for number in Tuning.numbers():
        told = changed.get(number.name, [])
        if any(text for _, text in told):
            body.append([f'`{number.name}`', f'{number.default:g} {number.unit}'.strip(), *(
                '; '.join(f'{value:g}: {text or NONE}' for value, text in told
                          if (value < number.default) == is_less) or NONE
                for is_less in (True, False))])
        elif told:
            same.append(f'`{number.name}` ({", ".join(f"{value:g}" for value, _ in told)})')
    lines = table(['number', 'value', 'half', 'double'], body)
    return [*lines, '', f'Changed nothing: {", ".join(same)}.'] if same else lines
