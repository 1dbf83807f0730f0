"""What the page says of the method with one thing changed after the other."""
from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Dict, List, Sequence, Tuple

from self_awareness import Tuning
from self_awareness_evaluation.families.protocol import DEATH, SELDOM
from self_awareness_evaluation.families.robot import (CRASH, HALF_RATE, LATE, MISSES, RESTART,
                                                      SILENT, STARVED)
from self_awareness_evaluation.figures import SOON_S, Found, Quiet, grouped, of_fault
from self_awareness_evaluation.recordings.outages import OUTAGE
from self_awareness_evaluation.rows import Row
from self_awareness_evaluation.sections.page import RESEARCH, Section
from self_awareness_evaluation.tables import NONE, counts, part, table
from self_awareness_evaluation.variants import NUMBER, Variant

NAME = 'ablation'

LEAST_LATENCY_S = 0.05
"""Medians that differ by less are told as the same [s]."""

_KINDS: Dict[str, Tuple[str, ...]] = {
    'crashes': (CRASH, 'cc1', 'cc2'), 'half rates': (HALF_RATE, 'half'),
    'late answers': (LATE, 'lat'), 'deaths when asked': (DEATH,), 'AC': (MISSES, 'ac'),
    'RS': (STARVED, 'rs'), 'all silent': (SILENT, 'silence'), 'seldom': (SELDOM,),
    'outages': (OUTAGE,), 'restarts': (RESTART,)}
_OTHER = 'other faults'


@dataclass(frozen=True)
class Cell:
    """A figure of a variant.

    Args:
        text: in a table.
        values: that are compared.
        same_within: by how much each may differ and still be told as the same.
    """

    text: str
    values: Tuple[float, ...]
    same_within: Tuple[float, ...]

    def differs(self, other: Cell) -> bool:
        """Return whether it is told as another one."""
        return self.text != other.text and any(
            one != two and not abs(one - two) <= within
            for one, two, within in zip(self.values, other.values, self.same_within))


def section(rows: Sequence[Row], variants: Sequence[Variant]) -> Section:
    """Return what is written of rows; variants: that judged, the method as it is first."""
    of_changes = grouped(rows, lambda row: row.subject.change)
    found = {variant: cells(of_changes[variant.change]) for variant in variants}
    default = found[variants[0]]
    robots = ', '.join(grouped(rows, lambda row: f'`{row.subject.robot}`'))
    lines = [f'Of {robots}.', '', '### Channels and rules', '', *table(['', *default], [
        [variant.change or 'as it is', *(
            f'**{of_variant[title].text}**' if of_variant[title].differs(default[title])
            else of_variant[title].text for title in default)]
        for variant, of_variant in found.items() if variant.kind != NUMBER])]
    if any(variant.kind == NUMBER for variant in variants):
        lines += ['', '### Numbers', '', *_numbers_table(found)]
    refused = {f'- {row.subject.change or "as it is"}: {row.subject.robot}: {row.refused}'
               for row in rows if row.refused}
    if refused:
        lines += ['', '### Without limits', '', *sorted(refused)]
    return Section(NAME, 'What each part of the method buys', {RESEARCH: lines})


def cells(rows: Sequence[Row]) -> Dict[str, Cell]:
    """Return the figures of a variant by title, from its rows."""
    quiet = Quiet.of(rows)
    found = {'false alarms': Cell(f'{quiet.alarms} in {quiet.hours:.1f} h',
                                  (quiet.alarms, quiet.hours), (0.0, 0.05)),
             'WARN': Cell(str(quiet.warnings), (quiet.warnings,), (1.0,))}
    known = [kind for kinds in _KINDS.values() for kind in kinds]
    by_title = {title: [row for kind in kinds for row in of_fault(rows, kind)]
                for title, kinds in _KINDS.items()}
    by_title[_OTHER] = [row for row in of_fault(rows, '')
                        if row.fault.partition(':')[0] not in known]
    found.update({title: _found(Found.of(of_kind)) for title, of_kind in by_title.items()})
    every = Found.of(of_fault(rows, ''))
    after, records = every.after
    found['alarms after a restart'] = Cell(f'{after} after {records}' if records else NONE,
                                           (after,), (0.0,))
    for title, named in (('guilty first', every.first), ('guilty at the end', every.at_end)):
        found[title] = Cell(part(named, in_percent=False), (named[1] - named[0],), (0.0,))
    return found


def _found(found: Found) -> Cell:
    return Cell(counts(found, SOON_S, math.inf),
                (found.within(SOON_S), found.within(), found.median_s),
                (0.0, 0.0, LEAST_LATENCY_S))


def _numbers_table(found: Dict[Variant, Dict[str, Cell]]) -> List[str]:
    """Return the table of the numbers that matter, and a sentence about the others."""
    default = next(iter(found.values()))
    changed: Dict[str, List[Tuple[float, str]]] = {}
    for variant, of_variant in found.items():
        if variant.kind == NUMBER:
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
