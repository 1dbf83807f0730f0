"""Numbers as people read them."""
from __future__ import annotations

import math
from typing import Optional


def rounded(value: float, digits: int) -> str:
    """Return a number with so many significant digits; without an exponent from 0.0001 to 999999.

    As `{value:.2g}`, which makes 1200 s to `1.2e+03 s`.
    """
    return f'{float(f"{value:.{digits}g}"):g}'


def percent(share: float) -> str:
    """Return a share as people read it: '110 %'."""
    return f'{100.0 * share + 0.0:.0f} %'  # never -0


def of_limit(lowest: float, threshold: Optional[float]) -> str:
    """Return how far a score went: '110 % of the limit', which only the evidence detector has.

    Args:
        lowest: the score; NaN: there is none.
        threshold: of the score, below 0 of the evidence detector; None: not calibrated.
    """
    if threshold is not None and threshold < 0.0:
        return f'{percent(lowest / threshold)} of the limit'
    score = 'none' if math.isnan(lowest) else f'{lowest:.4g}'
    return f'lowest score {score}' + ('' if threshold is None else f', threshold {threshold:.4g}')
