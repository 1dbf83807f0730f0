"""How well a calibrated model tells faults from normal operation, and how often it is wrong."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Dict, List, Sequence

import numpy as np

from self_awareness import Roc
from self_awareness.calibration import confidence, heads_and_tails
from self_awareness.calibration.confidence import Interval
from self_awareness.calibration.runs import ABNORMAL, NORMAL, RECORDED, JudgedRun
from self_awareness.stamps import SECOND_NS

_HOUR = 3600 * SECOND_NS


@dataclass(frozen=True)
class FaultResult:
    """How well one fault, or all of them, is told from normal operation."""

    fault: str
    windows: int
    roc: Roc
    true_positive_rate: float
    recordings: int
    latencies: List[float]  # [s], of the recordings in which the alarm was raised
    stood_before: int  # recordings in which it stood already


@dataclass(frozen=True)
class FalseAlarms:
    """Alarms after persistence on the normal recordings."""

    count: int  # of them
    hours: float  # of normal operation
    # Further ones, of who stopped before the recording ended: that is no false alarm.
    at_end: int = 0

    @property
    def per_hour(self) -> float:
        """Alarms an hour."""
        return self.count / self.hours

    @property
    def interval(self) -> Interval:
        """Its 95 % confidence interval."""
        return confidence.poisson_rate(self.count, self.hours)


def labelled(runs: Sequence[JudgedRun], label: int) -> np.ndarray:
    """Return the scores of all windows with a label."""
    return np.concatenate([run.scores[run.labels == label] for run in runs] or [np.empty(0)])


def fault_results(normal: np.ndarray, faulty: Sequence[JudgedRun],
                  threshold: float) -> List[FaultResult]:
    """Return the result of every fault, and of all together at the end if they are several."""
    groups: Dict[str, List[JudgedRun]] = {}
    for judged in faulty:
        run = judged.run
        groups.setdefault(str(run.source.part) if run.fault == RECORDED else run.fault,
                          []).append(judged)
    results = [_fault_result(name, normal, runs, threshold) for name, runs in groups.items()]
    if len(groups) > 1:
        results.append(_fault_result('all together', normal, faulty, threshold))
    return results


def false_alarms(normal: Sequence[JudgedRun], window: int) -> FalseAlarms:
    """Count the alarms on the normal recordings; `window` [ns]."""
    windows = sum(int((run.labels == NORMAL).sum()) for run in normal)
    alarms = [heads_and_tails.stopped_before_end(run.run.source, alarm) is None
              for run in normal for alarm in run.verdicts.alarms]
    return FalseAlarms(sum(alarms), windows * window / _HOUR, len(alarms) - sum(alarms))


def _fault_result(name: str, normal: np.ndarray, runs: Sequence[JudgedRun],
                  threshold: float) -> FaultResult:
    abnormal = labelled(runs, ABNORMAL)
    roc = Roc(normal, abnormal)
    return FaultResult(name, len(abnormal), roc, roc.at(threshold).true_positive_rate, len(runs),
                       [run.latency for run in runs if run.latency is not None],
                       sum(run.stood_before for run in runs))
