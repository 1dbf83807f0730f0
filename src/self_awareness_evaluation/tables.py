"""Tables in Markdown, and how numbers are written in them."""
from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Dict, List, Mapping, Sequence, Tuple

from self_awareness_evaluation.figures import SOON_S, Found, Quiet, of_fault, part_of
from self_awareness_evaluation.rows import Row

NONE = '–'  # what a table says where there is nothing to tell
LEAST_LATENCY_S = 0.05  # medians that differ by less are told as the same [s]

OTHER = 'other faults'


def table(head: Sequence[str], body: Sequence[Sequence[str]]) -> List[str]:
    """Return the lines of a Markdown table."""
    return [f'| {" | ".join(row)} |' for row in (head, ['---'] * len(head), *body)]


def percent(value: float) -> str:
    """Return a share in percent; a dash for NaN."""
    return NONE if math.isnan(value) else f'{100.0 * value:.3g} %'


def seconds(value: float) -> str:
    """Return a time [s]; a dash for NaN, and for what never happened."""
    return f'{value:.2f} s' if math.isfinite(value) else NONE


def number(value: float) -> str:
    """Return a rate with as many digits as are worth reading; a dash for NaN."""
    if math.isnan(value):
        return NONE
    return f'{value:.0f}' if value >= 9.95 else f'{value:.2g}'


def rate(quiet: Quiet) -> str:
    """Return the false alarms an hour with their interval."""
    low, high = quiet.interval
    return f'{number(quiet.per_hour)} ({number(low)} to {number(high)})'


def share(found: Found) -> str:
    """Return the share that was found, and the median latency; a dash where nothing was."""
    return f'{percent(found.share())}, {seconds(found.median_s)}' if found.within() else NONE


def part(of: Tuple[int, int]) -> str:
    """Return the first of two counts as a share of the second."""
    return percent(part_of(of))


def of_all(counts: Tuple[int, int]) -> str:
    """Return two counts of which the first is a part of the second."""
    return f'{counts[0]} of {counts[1]}' if counts[1] else NONE


def interval(found: Found) -> str:
    """Return the 95 % interval of the share that was found."""
    low, high = found.interval
    return NONE if math.isnan(low) else f'{100.0 * low:.0f}–{100.0 * high:.0f} %'


@dataclass(frozen=True)
class Cell:
    """A figure of rows that are compared with others."""

    text: str  # in a table
    values: Tuple[float, ...]  # that are compared
    same_within: Tuple[float, ...]  # by how much each may differ and still be told as the same

    def differs(self, other: Cell) -> bool:
        """Return whether it is told as another one."""
        return self.text != other.text and any(
            one != two and not abs(one - two) <= within
            for one, two, within in zip(self.values, other.values, self.same_within))


def cells(rows: Sequence[Row], kinds: Mapping[str, Sequence[str]]) -> Dict[str, Cell]:
    """Return the figures of rows by title; kinds: of faults, by title."""
    quiet = Quiet.of(rows)
    found = {'false alarms': Cell(f'{quiet.alarms} in {quiet.hours:.1f} h',
                                  (quiet.alarms, quiet.hours), (0.0, 0.05)),
             'WARN': Cell(str(quiet.warnings), (quiet.warnings,), (1.0,))}
    known = [kind for names in kinds.values() for kind in names]
    by_title = {title: [row for kind in names for row in of_fault(rows, kind)]
                for title, names in kinds.items()}
    by_title[OTHER] = [row for row in of_fault(rows, '')
                       if not {row.fault, row.fault.partition(':')[0]} & set(known)]
    for title, of_title in by_title.items():
        each = Found.of(of_title)
        median = f', {seconds(each.median_s)}' if math.isfinite(each.median_s) else ''
        found[title] = Cell(
            f'{each.within(SOON_S)} / {each.within()} of {each.records}{median}'
            if each.records else NONE,
            (each.within(SOON_S), each.within(), each.median_s), (0.0, 0.0, LEAST_LATENCY_S))
    every = Found.of(of_fault(rows, ''))
    after, records = every.after
    found['alarms after a restart'] = Cell(f'{after} after {records}' if records else NONE,
                                           (after,), (0.0,))
    for title, named in (('guilty first', every.first), ('guilty at the end', every.at_end)):
        found[title] = Cell(of_all(named), (named[1] - named[0],), (0.0,))
    return found
