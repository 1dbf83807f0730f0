"""Counts of what was found, as the tables of several evaluations tell them."""
from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Iterable, Optional, Tuple

from self_awareness_evaluation.simulated.summary import quantile

Outcome = Tuple[Optional[float], Optional[bool]]
"""Of a record with a fault: from the onset to the first alarm after it [s], None: there was none;
and whether that alarm names the guilty one first, None: no alarm, or nobody to name."""

NONE = '–'
"""What a table says where there is nothing to tell."""


@dataclass(frozen=True)
class Tally:
    """How faults were found.

    Args:
        latencies_s: of each record; infinite where no alarm was raised [s].
        first: alarms that name the guilty one first.
        named: alarms where there is somebody to name.
    """

    latencies_s: Tuple[float, ...]
    first: int
    named: int

    @classmethod
    def of(cls, outcomes: Iterable[Outcome]) -> Tally:
        """Return the counts of records with a fault."""
        known = list(outcomes)
        firsts = [first for _, first in known if first is not None]
        return cls(tuple(math.inf if latency is None else latency for latency, _ in known),
                   sum(firsts), len(firsts))

    def within(self, seconds: float = math.inf) -> int:
        """Return how many were found in this time [s]."""
        return sum(latency <= seconds and latency < math.inf for latency in self.latencies_s)

    def found(self, *within_s: float) -> str:
        """Return how many were found, or in these times each, and the median latency."""
        if not self.latencies_s:
            return NONE
        counts = ' / '.join(str(self.within(within)) for within in within_s or (math.inf,))
        median = quantile(self.latencies_s, 0.5)
        told = f', {median:.2f} s' if math.isfinite(median) else ''
        return f'{counts} of {len(self.latencies_s)}{told}'

    @property
    def named_first(self) -> str:
        """How many alarms name the guilty one first."""
        return f'{self.first} of {self.named}' if self.named else NONE


def alarms(count: int, hours: float) -> str:
    """Return a number of alarms in some hours, as a rate, too."""
    if hours <= 0.0:
        return NONE
    rate = count / hours
    told = f'{rate:.0f}' if rate >= 9.95 else f'{rate:.2g}'
    return f'{count} in {hours:.3g} h ({told}/h)'
