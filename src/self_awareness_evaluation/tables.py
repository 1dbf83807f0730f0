"""Tables in Markdown, and how numbers are written in them."""
from __future__ import annotations

import math
from typing import List, Sequence, Tuple

from self_awareness_evaluation.figures import Found, Quiet

NONE = '–'
"""What a table says where there is nothing to tell."""


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


def alarms(count: int, hours: float) -> str:
    """Return a number of alarms in some hours, as a rate, too."""
    return f'{count} in {hours:.3g} h ({number(count / hours)}/h)' if hours else NONE


def share(found: Found) -> str:
    """Return the share that was found, and the median latency; a dash where nothing was."""
    return f'{percent(found.share())}, {seconds(found.median_s)}' if found.within() else NONE


def shares(found: Found, within_s: Sequence[float]) -> str:
    """Return the shares that were found in some times each."""
    if not found.records:
        return NONE
    return f'{" / ".join(f"{100.0 * found.share(each):.0f}" for each in within_s)} %'


def counts(found: Found, *within_s: float) -> str:
    """Return how many were found, or in these times each, and the median latency."""
    if not found.records:
        return NONE
    told = ' / '.join(str(found.within(within)) for within in within_s or (math.inf,))
    median = f', {found.median_s:.2f} s' if math.isfinite(found.median_s) else ''
    return f'{told} of {found.records}{median}'


def part(of: Tuple[int, int], in_percent: bool = True) -> str:
    """Return the first of two counts as a share of the second, or both of them."""
    if not of[1]:
        return NONE
    return f'{100.0 * of[0] / of[1]:.3g} %' if in_percent else f'{of[0]} of {of[1]}'


def interval(found: Found) -> str:
    """Return the 95 % interval of the share that was found."""
    low, high = found.interval()
    return NONE if math.isnan(low) else f'{100.0 * low:.0f} to {100.0 * high:.0f} %'
