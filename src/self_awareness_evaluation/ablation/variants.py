"""The variants of the method: one thing changed in each."""
from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Iterator, List, Optional, Sequence

from self_awareness import Tuning, TuningNumber
from self_awareness_evaluation import tunings

DEFAULT, CHANNEL, RULE, NUMBER = 'default', 'channel', 'rule', 'number'
"""Kinds of variants."""

KINDS = (CHANNEL, RULE, NUMBER)
"""Those with a change."""

_HALF, _DOUBLE = 0.5, 2.0


@dataclass(frozen=True)
class Variant:
    """The method with one change.

    Args:
        kind: DEFAULT: none. CHANNEL: one is left out. RULE: a number switches it off. NUMBER: one
            has another value.
        name: of the channel or the number; empty: DEFAULT.
        value: of the number.
    """

    kind: str
    name: str = ''
    value: Optional[float] = None

    def __str__(self) -> str:
        if self.kind == CHANNEL:
            return f'without {self.name}'
        return self.kind if self.value is None else f'{self.name}={self.value:.10g}'

    def tuning(self) -> Tuning:
        """Return the method with the change."""
        if self.kind == CHANNEL:
            return tunings.changed([], [self.name])
        return tunings.changed([] if self.value is None else [(self.name, self.value)], [])


def variants(channels: Optional[Sequence[str]] = None,
             numbers: Optional[Sequence[str]] = None,
             kinds: Sequence[str] = KINDS) -> List[Variant]:
    """Return the method as it is, and the variants.

    Args:
        channels: that are left out in turn; None: all.
        numbers: that are switched off, halved and doubled; None: all.
        kinds: that are returned, besides DEFAULT.

    Raises:
        ValueError: there is no such channel or number.
    """
    for name in channels or ():
        Tuning().leave_out(name)
    for name in numbers or ():
        Tuning().get(name)
    known = [number for number in Tuning.numbers() if numbers is None or number.name in numbers]
    found = [Variant(DEFAULT)]
    found += [Variant(CHANNEL, name) for name in
              (Tuning.channels() if channels is None else channels)]
    found += [Variant(RULE, number.name, number.off) for number in known
              if number.off is not None and number.off != number.default]
    found += [Variant(NUMBER, number.name, value) for number in known
              for value in _values(number)]
    return [variant for variant in found if variant.kind in (DEFAULT, *kinds)]


def _values(number: TuningNumber) -> Iterator[float]:
    """Yield half of a number and twice that, within its range, unless that is known already.

    A pure number that is whole stays whole: it counts something.
    """
    default = float(number.default)
    seen = {default, number.off}
    for factor in (_HALF, _DOUBLE):
        value = min(max(factor * default, number.least), number.most)
        if not number.unit and default.is_integer():
            value = float(math.floor(value + 0.5))
        if value not in seen:
            seen.add(value)
            yield value
