"""Whether a difference may be chance, by how much the halves of both sides differ themselves.

Counts of a robot are no independent draws: its activity changes from minute to minute. So the
variance that counts by themselves would have is inflated by what the two halves of each side show.
They are few: what all quantities show together counts as a prior, as in Smyth (2004).
"""
from __future__ import annotations

import math
from statistics import median
from typing import Sequence, Tuple

LEVEL = 0.01  # probability that chance alone lists anything, all quantities together

_PRIOR = 8
_MEDIAN_OF_CHI_SQUARE = 0.4549
_LEAST_COUNT_VARIANCE = 0.25


def rate_variance(variance: float, span: float, duration: float) -> float:
    """Return the variance of a rate [Hz^2].

    Args:
        variance: of the number of events in `span` [s].
        span: [s].
        duration: that was counted [s], > 0.
    """
    # Half an event at each end, as of a timer that a span cuts.
    return (variance + _LEAST_COUNT_VARIANCE) / (span * duration)


def share_variance(share: float, number: int) -> float:
    """Return the variance of a share (0 to 1) of a number of things, > 0, by chance alone."""
    # One more of each kind: a share of 0 in 30 is not certain.
    smooth = (share * number + 1.0) / (number + 2.0)
    return smooth * (1.0 - smooth) / number


def excess(halves: Sequence[float], variances: Sequence[float]) -> float:
    """Return the square of the difference of two halves, in units of its variance by chance."""
    return (halves[0] - halves[1]) ** 2 / (variances[0] + variances[1])


def common_inflation(excesses: Sequence[float]) -> float:
    """Return by how much variances are larger than by chance, as all quantities say; at least 1.

    A quantity that really changed between the halves does not count: the median does not see it.
    """
    if not excesses:
        return 1.0
    return max(1.0, median(excesses) / _MEDIAN_OF_CHI_SQUARE)


def p_value(difference: float, variance: float, own: Tuple[float, float], common: float) -> float:
    """Return the probability of a difference of at least this size by chance, 0 to 1.

    Args:
        difference: of the two sides.
        variance: of it by chance alone, > 0.
        own: what excess() says of each side.
        common: what common_inflation() says.
    """
    inflation = max((_PRIOR * common + sum(own)) / (_PRIOR + len(own)), 1.0)
    return student_tail(abs(difference) / math.sqrt(inflation * variance), _PRIOR + len(own))


def student_tail(t: float, freedom: int) -> float:
    """Return P(|T| >= t) of Student's distribution with an even number of degrees of freedom.

    The finite series of Abramowitz and Stegun, 26.7.4.

    Args:
        t: 0 or more.
        freedom: degrees of freedom, even and at least 2.
    """
    cosine2 = freedom / (freedom + t * t)
    term = total = 1.0
    for k in range(1, freedom // 2):
        term *= cosine2 * (2 * k - 1) / (2 * k)
        total += term
    # 1 - sin * total loses all digits where t is large: sin is nearly 1, and so is the product.
    return max(1.0 - math.sqrt(1.0 - cosine2) * total, 0.0)
