"""Makes faulty recordings out of normal ones, so that a calibration needs no broken robot.

A recording is two arrays, stamps (int64 [ns], in order) and ids of event types; what is returned
is of the same kind and ends when the recording does. Nothing here is random.
"""
from __future__ import annotations

import math
import re
from dataclasses import dataclass, replace
from typing import List, Optional, Sequence, Tuple

import numpy as np

from self_awareness import EventType, resolved_name
from self_awareness.stamps import SECOND_NS, nanoseconds

STARVATION_DOUBLING_S = 20.0
"""Sources that starve take twice as long at this time of the undisturbed recording [s]."""

EACH = '*'  # stands for each source in turn

FORMS = 'crash:SOURCE, slow:SOURCE:FACTOR, starve, late:SOURCE:SECONDS'
_FORM = re.compile(r'(?P<crash>crash):(?P<crash_source>[^:]+)'
                   r'|(?P<starve>starve)'
                   r'|(?P<other>slow|late):(?P<source>[^:]+):(?P<amount>[^:]+)')


@dataclass(frozen=True)
class InjectedFault:
    """A fault to inject."""

    # crash: the source falls silent. slow: its delays stretch by a factor. starve: the delays of
    # all sources stretch, growing from 1 to twice as long after STARVATION_DOUBLING_S. late: its
    # events come some seconds later (negative: earlier) in relation to all others; what would come
    # after the end comes at the onset instead, so that only order and delays are wrong: no
    # silence, and the usual rate.
    kind: str
    source: Optional[str] = None  # that it hits; None for starve, which hits all
    amount: float = 0.0  # the factor of slow, > 1; the seconds of late, not 0; else 0

    @classmethod
    def parse(cls, text: str) -> InjectedFault:
        """Read one of FORMS.

        Raises:
            ValueError: another form, or a factor or time out of range.
        """
        match = _FORM.fullmatch(text)
        if match is None:
            raise ValueError(f'{text}: not a fault; expected one of: {FORMS}')
        if match['crash']:
            return cls('crash', match['crash_source'])
        if match['starve']:
            return cls('starve')
        try:
            amount = float(match['amount'])
        except ValueError:
            amount = math.nan
        if match['other'] == 'slow' and not 1.0 < amount < math.inf:
            raise ValueError(f'{text}: the factor must be a number above 1')
        if match['other'] == 'late' and not 0.0 < abs(amount) < math.inf:
            raise ValueError(f'{text}: the seconds must be a number other than 0')
        return cls(match['other'], match['source'], amount)

    def __str__(self) -> str:
        if self.source is None:
            return self.kind
        return f'{self.kind}:{self.source}' + (f':{self.amount:g}' if self.amount else '')


def of_each_source(fault: InjectedFault, event_types: Sequence[EventType]) -> List[InjectedFault]:
    """Return the fault, or where its source is EACH the same of every source in turn."""
    if fault.source != EACH:
        return [fault]
    return [replace(fault, source=source)
            for source in sorted({event_type.source for event_type in event_types} - {''})]


def of_known_source(fault: InjectedFault, event_types: Sequence[EventType]) -> InjectedFault:
    """Return the fault with the source as the model names it: `player` is `/player`.

    Raises:
        ValueError: there is none of that name; the message lists all sources.
    """
    sources = sorted({event_type.source for event_type in event_types})
    if fault.source in (None, EACH, *sources):
        return fault
    if fault.source is not None and resolved_name(fault.source) in sources:
        return replace(fault, source=resolved_name(fault.source))
    if sources == ['']:
        raise ValueError(f'{fault}: the model does not tell sources apart (source: none); only '
                         'starve can be injected')
    raise ValueError(f'{fault}: no such source in the model; it has: {", ".join(sources)}')


def inject(fault: InjectedFault, event_types: Sequence[EventType], stamps: np.ndarray,
           ids: np.ndarray, onset: int, end: int) -> Tuple[np.ndarray, np.ndarray]:
    """Return stamps and ids of a recording that the fault hits at `onset`, up to `end` [ns].

    Raises:
        ValueError: the fault changes nothing, because its source does nothing after the onset or
            because it comes later by more than is left of the recording.
    """
    if fault.source is None:
        hit = stamps >= onset
    else:
        of_source = [i for i, kind in enumerate(event_types) if kind.source == fault.source]
        hit = (stamps >= onset) & np.isin(ids, of_source)
    if not hit.any():
        raise ValueError(f'{fault}: {fault.source or "the recording"} has no event after the '
                         'onset in the middle of the recording; nothing would change')
    if fault.kind == 'crash':
        return stamps[~hit], ids[~hit]
    moved = stamps.copy()
    moved[hit] = onset + _moved(fault, stamps[hit] - onset, end - onset)
    order = np.argsort(moved, kind='stable')
    order = order[moved[order] <= end]
    return moved[order], ids[order]


def _moved(fault: InjectedFault, since_onset: np.ndarray, left: int) -> np.ndarray:
    """Return when, after the onset [ns], the events come; `left`: rest of the recording [ns]."""
    if fault.kind == 'slow':
        return (since_onset * fault.amount).astype(np.int64)
    if fault.kind == 'starve':
        # The integral of the stretch 1 + t / doubling time.
        t = since_onset / SECOND_NS
        return ((t + t * t / (2.0 * STARVATION_DOUBLING_S)) * SECOND_NS).astype(np.int64)
    shift = nanoseconds(fault.amount)
    if abs(shift) >= left:
        raise ValueError(f'{fault}: only {left / SECOND_NS:.1f} s of the recording are left '
                         'after the onset in its middle; shift by less')
    return (since_onset + shift) % (left + 1)
