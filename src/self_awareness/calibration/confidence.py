"""95 % confidence intervals of what a calibration measures. All assume independent windows."""
from __future__ import annotations

import math
from typing import Callable, Tuple

_Z = 1.959963984540054  # 97.5 % quantile of the normal distribution
_HALVINGS = 60

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


def auc(area: float, normal: int, abnormal: int) -> Interval:
    """Return an interval of the area under a ROC by Hanley and McNeil's variance (1982).

    Its ends are the areas from which the measured one is as far as their own standard error
    says (Newcombe 2006): with the standard error of the measured area, an area of 1 would have
    the interval [1, 1] after a handful of windows.

    Args:
        area: measured, 0 to 1.
        normal: number of normal windows, > 0.
        abnormal: number of abnormal windows, > 0.
    """
    def inside(candidate: float) -> bool:
        return abs(candidate - area) <= _Z * _standard_error(candidate, normal, abnormal)

    return _boundary(area, 0.0, inside), _boundary(area, 1.0, inside)


def _standard_error(area: float, normal: int, abnormal: int) -> float:
    two_abnormal = area / (2.0 - area)
    two_normal = 2.0 * area * area / (1.0 + area)
    variance = (area * (1.0 - area) + (abnormal - 1) * (two_abnormal - area * area)
                + (normal - 1) * (two_normal - area * area)) / (normal * abnormal)
    return math.sqrt(max(0.0, variance))


def _boundary(within: float, beyond: float, inside: Callable[[float], bool]) -> float:
    """Return the last point on the way from `within` to `beyond` that is still inside."""
    for _ in range(_HALVINGS):
        middle = (within + beyond) / 2.0
        if inside(middle):
            within = middle
        else:
            beyond = middle
    return within
