"""95 % confidence intervals of what a calibration measures. All assume independent windows."""
from __future__ import annotations

import math
from typing import Tuple

_Z = 1.959963984540054  # 97.5 % quantile of the normal distribution

Interval = Tuple[float, float]


def wilson(found: int, of: int) -> Interval:
    """Return Wilson's score interval of a proportion; `of` > 0."""
    share = found / of
    scale = 1.0 + _Z * _Z / of
    centre = (share + _Z * _Z / (2.0 * of)) / scale
    half = _Z / scale * math.sqrt(share * (1.0 - share) / of + _Z * _Z / (4.0 * of * of))
    return max(0.0, centre - half), min(1.0, centre + half)


def poisson_rate(count: float, time: float) -> Interval:
    """Return the score interval of a rate by the number of events in a time > 0."""
    centre = count + _Z * _Z / 2.0
    half = _Z * math.sqrt(count + _Z * _Z / 4.0)
    return max(0.0, centre - half) / time, (centre + half) / time
