"""False alarms against latency: the same scores, judged by stricter and laxer thresholds.

A system that alarms early and falsely is compared with one that does neither only where one of
the two is equal. The thresholds are chosen on the calibration's scores, as the common rule does.
"""
from __future__ import annotations

from dataclasses import dataclass
from typing import List, Optional

import numpy as np

from self_awareness import Roc
from self_awareness.evaluation.measures import first_alarm
from self_awareness.evaluation.recording import WINDOW
from self_awareness.evaluation.systems import Alarm, Judged, persistent
from self_awareness.stamps import SECOND_NS

FAULT = 'cc1'
"""The fault whose latency is looked at."""

_RATES = (0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001, 0.0)
_MARGINS = (0.1, 0.25, 0.5, 1.0, 2.0)  # below the lowest score, of its distance to the median


@dataclass(frozen=True)
class TradeOff:
    """One system with one threshold on one seed.

    Args:
        system: its name.
        seed: of the evaluation.
        step: which threshold, from lax to strict.
        false_alarms: on the normal record.
        hours: of the normal record.
        latency_s: of the alarm for FAULT; None: none was raised.
    """

    system: str
    seed: int
    step: int
    false_alarms: int
    hours: float
    latency_s: Optional[float]


def trade_offs(system: str, seed: int, calibration: Judged, normal: Judged, fault: Judged,
               onset: int) -> List[TradeOff]:
    """Judge two records again by one threshold after the other; onset: of the fault [ns]."""
    hours = float((~normal.settling).sum()) * WINDOW / SECOND_NS / 3600.0
    result = []
    for step, threshold in enumerate(_thresholds(calibration.score[~calibration.settling])):
        alarm = first_alarm(_alarms(fault, threshold), onset)
        result.append(TradeOff(system, seed, step, len(_alarms(normal, threshold)), hours,
                               None if alarm is None else (alarm.start - onset) / SECOND_NS))
    return result


def _alarms(judged: Judged, threshold: float) -> List[Alarm]:
    return persistent(judged.start, (judged.score < threshold) & ~judged.settling)


def _thresholds(scores: np.ndarray) -> List[float]:
    roc = Roc(scores, [])
    lowest = float(scores.min())
    spread = float(np.median(scores)) - lowest
    return ([roc.level(rate).cutoff for rate in _RATES]
            + [lowest - margin * spread for margin in _MARGINS])
