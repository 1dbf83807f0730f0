"""False alarms against latency: the same scores, judged by stricter and laxer thresholds.

A system that alarms early and falsely is compared with one that does neither only where one of
the two is equal. The thresholds are chosen on the calibration's scores, as the common rule does.
"""
from __future__ import annotations

from dataclasses import dataclass
from typing import List, Mapping, Optional

import numpy as np

from self_awareness import DEFAULT_WINDOW, Roc
from self_awareness.stamps import SECOND_NS
from self_awareness_evaluation.simulated.measures import first_alarm
from self_awareness_evaluation.systems import Judged, SystemAlarm, persistent

FAULT = 'cc1'
"""The fault whose latency is looked at."""

_RATES = (0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001, 0.0)
_MARGINS = (0.1, 0.25, 0.5, 1.0, 2.0)  # below the lowest score, of its distance to the median


@dataclass(frozen=True)
class JudgedFault:
    """A judged record with a fault, and the fault's onset [ns]."""

    judged: Judged
    onset: int


@dataclass(frozen=True)
class TradeOff:
    """One system with one threshold on one seed.

    Args:
        system: its name.
        seed: of the evaluation.
        step: which threshold, from lax to strict.
        false_alarms: in normal operation: the normal record, and those of faults before the onset.
        hours: of normal operation.
        latency_s: of the alarm for FAULT; None: none was raised.
    """

    system: str
    seed: int
    step: int
    false_alarms: int
    hours: float
    latency_s: Optional[float]


def trade_offs(system: str, seed: int, calibration: Judged, normal: Judged,
               faults: Mapping[str, JudgedFault]) -> List[TradeOff]:
    """Judge records again by one threshold after the other.

    Args:
        system: its name.
        seed: of the evaluation.
        calibration: the record that the thresholds are chosen by.
        normal: the record of normal operation.
        faults: by kind, FAULT among them.
    """
    fault = faults[FAULT]
    parts = [(normal, ~normal.settling)]
    for other in faults.values():
        before = other.judged.start + DEFAULT_WINDOW <= other.onset
        parts.append((other.judged, ~other.judged.settling & before))
    hours = sum(int(counted.sum()) for _, counted in parts) * DEFAULT_WINDOW / SECOND_NS / 3600.0
    result = []
    for step, threshold in enumerate(_thresholds(calibration.score[~calibration.settling])):
        alarm = first_alarm(_alarms(fault.judged, threshold, ~fault.judged.settling), fault.onset)
        result.append(TradeOff(
            system, seed, step,
            sum(len(_alarms(judged, threshold, counted)) for judged, counted in parts), hours,
            None if alarm is None else (alarm.start - fault.onset) / SECOND_NS))
    return result


def _alarms(judged: Judged, threshold: float, counted: np.ndarray) -> List[SystemAlarm]:
    """Return the alarms of the windows that count."""
    return persistent(judged.start, (judged.score < threshold) & counted)


def _thresholds(scores: np.ndarray) -> List[float]:
    roc = Roc(scores, [])
    lowest = float(scores.min())
    spread = float(np.median(scores)) - lowest
    return ([roc.level(rate).cutoff for rate in _RATES]
            + [lowest - margin * spread for margin in _MARGINS])
