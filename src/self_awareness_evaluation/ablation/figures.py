"""The figures of a variant, as the tables tell them and as they are compared."""
from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Callable, Dict, List, Sequence, Tuple

from self_awareness_evaluation.ablation.bench import CLOCKS, OTHER, STARVED
from self_awareness_evaluation.ablation.rows import OUTAGE, Row
from self_awareness_evaluation.families.protocol import DEATH
from self_awareness_evaluation.families.robot import CRASH, HALF_RATE, LATE, RESTART
from self_awareness_evaluation.simulated.measures import NORMAL
from self_awareness_evaluation.simulated.summary import quantile
from self_awareness_evaluation.tally import NONE, Tally

SOON_S = 5.0
"""Crashes are told by how many are found in this time [s]."""

LEAST_LATENCY_S = 0.05
"""Medians that differ by less are told as the same [s]."""

KINDS = (CRASH, HALF_RATE, LATE, DEATH, CLOCKS, STARVED, OTHER, OUTAGE, RESTART)
"""Kinds of faults in the order of the tables."""

_TITLES = {CRASH: f'crashes, within {SOON_S:g} s / at all', HALF_RATE: 'half rates',
           LATE: 'late answers', DEATH: 'deaths when asked', CLOCKS: 'AC', STARVED: 'RS',
           OTHER: 'other faults', OUTAGE: 'outages',
           RESTART: 'restarts'}


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


def cells(rows: Sequence[Row]) -> Dict[str, Cell]:
    """Return the figures of a variant by title, from its rows."""
    found = {'false alarms': _alarms(rows, lambda row: row.alarms, 0.0),
             'WARN': _alarms(rows, lambda row: row.warnings, 1.0)}
    found.update({_TITLES[kind]: _found(_tally(rows, kind), kind) for kind in KINDS})
    found['alarms after a restart'] = _after(rows)
    every = _tally(rows, '')
    found['guilty first'] = Cell(every.named_first, (every.named - every.first,), (0.0,))
    return found


def refused(rows: Sequence[Row]) -> List[str]:
    """Return where nothing could be judged, and why, each once."""
    return list(dict.fromkeys(f'{row.robot}, {row.learning}: {row.refused}'
                              for row in rows if row.refused))


def numbers(rows: Sequence[Row]) -> Dict[str, Any]:
    """Return the figures as columns of a CSV file."""
    found: Dict[str, Any] = {
        'hours': f'{sum(row.hours for row in rows):.3f}',
        'false_alarms': sum(row.alarms for row in rows),
        'warnings': sum(row.warnings for row in rows)}
    for kind in KINDS:
        tally, name = _tally(rows, kind), kind.split()[0]
        median = quantile(tally.latencies_s, 0.5)
        found.update({f'{name}_records': len(tally.latencies_s),
                      f'{name}_within_{SOON_S:g}_s': tally.within(SOON_S),
                      f'{name}_found': tally.within(),
                      f'{name}_median_s': f'{median:.3f}' if math.isfinite(median) else ''})
    found[f'{RESTART}_alarms_after'] = sum(_alarms_after(rows))
    every = _tally(rows, '')
    found.update({'named': every.named, 'guilty_first': every.first})
    return found


def _tally(rows: Sequence[Row], kind: str) -> Tally:
    return Tally.of((row.latency_s, row.first) for row in rows
                    if row.kind == kind or not kind and row.kind != NORMAL)


def _alarms(rows: Sequence[Row], of: Callable[[Row], int], within: float) -> Cell:
    count, hours = sum(of(row) for row in rows), sum(row.hours for row in rows)
    return Cell(f'{count} in {hours:.1f} h', (count, hours), (within, 0.05))


def _alarms_after(rows: Sequence[Row]) -> List[int]:
    return [row.after for row in rows if row.after is not None]


def _after(rows: Sequence[Row]) -> Cell:
    alarms = _alarms_after(rows)
    return Cell(f'{sum(alarms)} after {len(alarms)}' if alarms else NONE, (sum(alarms),), (0.0,))


def _found(tally: Tally, kind: str) -> Cell:
    soon, found = tally.within(SOON_S), tally.within()
    median = quantile(tally.latencies_s, 0.5)
    values = (soon if kind == CRASH else found, found, median)
    return Cell(tally.found(SOON_S, math.inf) if kind == CRASH else tally.found(), values,
                (0.0, 0.0, LEAST_LATENCY_S))
