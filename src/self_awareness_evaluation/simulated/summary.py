"""Means over the seeds of what was measured of one system."""
from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Callable, Iterable, List, NamedTuple, Optional, Sequence, Tuple

from self_awareness import DEFAULT_WINDOW
from self_awareness.calibration import confidence
from self_awareness.stamps import SECOND_NS
from self_awareness_evaluation.simulated.measures import NORMAL, Row
from self_awareness_evaluation.simulated.tradeoff import TradeOff

_HOUR_S = 3600.0


@dataclass(frozen=True)
class AlarmRate:
    """Alarms in normal operation, an hour, with their 95 % confidence interval."""

    count: int
    hours: float
    per_hour: float
    interval: Tuple[float, float]


def false_alarms(rows: Sequence[Row]) -> AlarmRate:
    """Return the false alarms of rows; settling windows are no part of the time."""
    count = sum(row.false_alarms for row in rows)
    hours = sum(row.normal_windows for row in rows) * DEFAULT_WINDOW / SECOND_NS / _HOUR_S
    return AlarmRate(count, hours, count / hours, confidence.poisson_rate(count, hours))


def false_suspicions(rows: Sequence[Row]) -> AlarmRate:
    """Return the times that a suspicion or an alarm began, as the false alarms."""
    count = sum(row.false_suspicions for row in rows)
    hours = sum(row.normal_windows for row in rows) * DEFAULT_WINDOW / SECOND_NS / _HOUR_S
    return AlarmRate(count, hours, count / hours, confidence.poisson_rate(count, hours))


def watched(rows: Sequence[Row]) -> Tuple[float, float]:
    """Return the mean number of components that are watched, and of all; NaN of a system that
    judges all of them together.
    """
    return (_mean([row.watched for row in rows if row.watched is not None]),
            _mean([row.components for row in rows if row.components is not None]))


def noticed(rows: Sequence[Row], within_s: float) -> float:
    """Return the share of the records with a suspicion or an alarm in this time [s]."""
    return _mean([row.noticed_s is not None and row.noticed_s <= within_s for row in rows])


def false_positive_rate(rows: Sequence[Row]) -> float:
    """Return the mean share of the windows of normal operation that are abnormal."""
    return _mean([row.false_windows / row.normal_windows for row in rows])


def normal(rows: Sequence[Row]) -> List[Row]:
    """Return the rows of normal operation."""
    return [row for row in rows if row.record == NORMAL]


def of_fault(rows: Sequence[Row], kind: str) -> List[Row]:
    """Return the rows of a kind of fault; `crash` stands for those of every component."""
    return [row for row in rows if row.record == kind or row.record.startswith(f'{kind}:')]


def latency(rows: Sequence[Row], fraction: float) -> float:
    """Return a quantile of the latency [s] by nearest rank; what was not found is infinite."""
    return quantile([row.latency_s for row in rows], fraction)


def found(rows: Sequence[Row], within_s: float = math.inf) -> float:
    """Return the share of the records in which the alarm was raised in this time [s]."""
    return _mean([row.latency_s is not None and row.latency_s <= within_s for row in rows])


def missed_raw(rows: Sequence[Row]) -> float:
    """Return the mean share of the windows after the onset that the bare verdict misses."""
    return _mean_share((row.missed_raw, row.windows) for row in rows)


def missed(rows: Sequence[Row]) -> float:
    """Return the same of windows without standing alarm, the false negative rate."""
    return _mean_share((row.missed, row.windows) for row in rows)


def missed_after_alarm(rows: Sequence[Row]) -> float:
    """Return the mean share of the windows after the alarm's first one in which it is down.

    NaN if no alarm was raised.
    """
    return _mean_share((row.missed_after_alarm, row.windows_after_alarm) for row in rows)


def auc(rows: Sequence[Row]) -> float:
    """Return the mean area under the ROC."""
    return _mean([row.auc for row in rows if row.auc is not None])


def guilty_first(rows: Sequence[Row]) -> float:
    """Return the share of the alarms that name a guilty source first; NaN if none names any."""
    return _mean([row.top1 for row in rows if row.top1 is not None])


def guilty_among_three(rows: Sequence[Row]) -> float:
    """Return the share of the alarms that name a guilty source among the first three, or NaN."""
    return _mean([row.top3 for row in rows if row.top3 is not None])


class OperatingPoint(NamedTuple):
    """A system with one of its thresholds: false alarms an hour, and the median latency [s]."""

    false_alarms_per_hour: float
    latency_s: float


def operating_points(trade_offs: Sequence[TradeOff]) -> List[OperatingPoint]:
    """Return the points of one system over all seeds, from lax to strict."""
    points = []
    for step in sorted({trade_off.step for trade_off in trade_offs}):
        of_step = [trade_off for trade_off in trade_offs if trade_off.step == step]
        points.append(OperatingPoint(
            sum(trade_off.false_alarms for trade_off in of_step)
            / sum(trade_off.hours for trade_off in of_step),
            quantile([trade_off.latency_s for trade_off in of_step], 0.5)))
    return points


def false_alarms_at(points: Sequence[OperatingPoint], latency_s: float) -> float:
    """Return the fewest false alarms an hour at no more than a latency [s]; NaN: never so fast."""
    return min((point.false_alarms_per_hour for point in points if point.latency_s <= latency_s),
               default=math.nan)


def quantile(values: Sequence[Optional[float]], fraction: float) -> float:
    """Return a quantile by nearest rank; None counts as infinite."""
    ordered = sorted(math.inf if value is None else value for value in values)
    return ordered[max(0, math.ceil(fraction * len(ordered)) - 1)] if ordered else math.nan


def _mean_share(parts: Iterable[Tuple[Optional[int], Optional[int]]]) -> float:
    """Return the mean of parts of a whole, where there are both."""
    return _mean([part / whole for part, whole in parts if part is not None and whole])


def _mean(values: Sequence[float]) -> float:
    return sum(values) / len(values) if values else math.nan


Measure = Callable[[Sequence[Row]], float]
"""One of the functions above, of the rows of a fault."""
