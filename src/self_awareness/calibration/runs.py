"""Finds the threshold s* of eq. 5 by the ROC over windows not trained on (section III-D).

The windows of normal recordings are normal; those of a faulty one are abnormal while the fault
lasts, and are left out before and after, where nobody vouches for them. Windows while the detector
settles are left out everywhere. A window without events scores 0 (METHOD.md, section 1).
"""
from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import Callable, Dict, List, Optional, Sequence

import numpy as np

from self_awareness import (DetectorParameters, EvidenceModel, Model, Roc, RocPoint, TrainedModel,
                            Verdicts, judge_by_evidence, progress)
from self_awareness.calibration import confidence, fault_injection
from self_awareness.calibration.confidence import Interval
from self_awareness.calibration.fault_injection import Fault
from self_awareness.recordings import RecordingEvents, overlap
from self_awareness.stamps import SECOND_NS

NORMAL, ABNORMAL, LEFT_OUT = 0, 1, -1
"""Labels of windows."""

RECORDED = 'recorded'
"""What a fault is called that was recorded, not injected."""

_HOUR = 3600 * SECOND_NS


@dataclass(frozen=True)
class Cutoff:
    """How the threshold is chosen: youden, closest, or fpr with a rate from 0 to less than 1."""

    method: str
    rate: float = 0.0

    @classmethod
    def parse(cls, text: str) -> Cutoff:
        """Read youden, closest or fpr=RATE.

        Raises:
            ValueError: another word, or a rate out of range.
        """
        if text in ('youden', 'closest'):
            return cls(text)
        match = re.fullmatch(r'fpr=(\d*\.?\d+(?:[eE]-?\d+)?)', text)
        if match is None or not float(match[1]) < 1.0:
            raise ValueError('expected youden, closest or fpr=RATE with 0 <= RATE < 1, '
                             f'not {text}')
        return cls('fpr', float(match[1]))

    def __str__(self) -> str:
        return f'fpr={self.rate:g}' if self.method == 'fpr' else self.method

    def choose(self, roc: Roc) -> RocPoint:
        """Return the point of the ROC.

        Raises:
            ValueError: the method needs abnormal windows and there are none, or no finite cut-off
                is better than calling everything normal, or everything abnormal, or more normal
                windows are silent than may be called abnormal.
        """
        if self.method != 'fpr' and math.isnan(roc.auc):
            raise ValueError(f'--cutoff {self} needs abnormal windows: name recordings of faults '
                             '(--faulty), let some be made (--inject), or choose by normal '
                             'windows alone (--cutoff fpr=RATE)')
        if self.method == 'fpr':
            return self._level(roc)
        point = roc.youden() if self.method == 'youden' else roc.closest()
        if not math.isfinite(point.cutoff):
            raise ValueError(f'--cutoff {self} finds no threshold: the scores of abnormal windows '
                             f'are not below the normal ones (AUC {roc.auc:.3f}); these faults '
                             'cannot be told by the score, so leave them out or choose by normal '
                             'windows alone (--cutoff fpr=RATE)')
        return point

    def _level(self, roc: Roc) -> RocPoint:
        point = roc.level(self.rate)
        # No score is below that of silence, 0: such a threshold would never be reached.
        if point.cutoff <= 0.0:
            raise ValueError(f'--cutoff {self} finds no threshold: a larger share of the normal '
                             'windows than this scores 0, as silence does, and none scores less; '
                             'allow a higher rate')
        return point


@dataclass(frozen=True)
class Run:
    """A recording, as it was or with a fault injected, to be judged.

    Args:
        source: the recording.
        fault: empty for normal operation, RECORDED, or the fault injected.
        stamps: int64 [ns]; those of the source unless a fault was injected.
        ids: uint32, one for each stamp.
        onset: when the fault begins [ns]; not for normal operation.
        relief: when it ends [ns]; not for normal operation.
    """

    source: RecordingEvents
    fault: str
    stamps: np.ndarray
    ids: np.ndarray
    onset: int = 0
    relief: int = 0


@dataclass(frozen=True)
class JudgedRun:
    """A run with what the detector says of its windows; arrays with one entry a window."""

    run: Run
    verdicts: Verdicts
    scores: np.ndarray
    labels: np.ndarray

    @property
    def latency(self) -> Optional[float]:
        """Seconds from a fault's onset to the alarm; None if none was raised while it lasted."""
        for alarm in self.verdicts.alarms:
            if self.run.onset < alarm.start <= self.run.relief:
                return (alarm.start - self.run.onset) / SECOND_NS
        return None

    @property
    def stood_before(self) -> bool:
        """Whether the alarm stood when the fault began: a false one that hides the fault's."""
        return any(alarm.start <= self.run.onset < alarm.end for alarm in self.verdicts.alarms)


@dataclass(frozen=True)
class FaultResult:
    """How well one fault, or all of them, is told from normal operation."""

    fault: str
    windows: int
    roc: Roc
    auc_interval: Interval
    true_positive_rate: float
    true_positive_interval: Interval
    recordings: int
    latencies: List[float]  # [s], of the recordings in which the alarm was raised
    stood_before: int  # recordings in which it stood already


@dataclass(frozen=True)
class FalseAlarms:
    """Alarms after persistence on the normal recordings."""

    count: int
    hours: float

    @property
    def per_hour(self) -> float:
        """Alarms an hour."""
        return self.count / self.hours

    @property
    def interval(self) -> Interval:
        """Its 95 % confidence interval."""
        return confidence.poisson_rate(self.count, self.hours)


def normal_run(recording: RecordingEvents) -> Run:
    """Return a run of normal operation."""
    return Run(recording, '', recording.stamps, recording.ids)


def recorded_fault(whole: RecordingEvents, window: int) -> Run:
    """Return a run with the fault of a recording, in the part that was asked for.

    Args:
        whole: the events of the whole recording, for the detector to settle before the fault.
        window: length of the windows [ns].

    Raises:
        ValueError: the part is none of the recording.
    """
    onset, relief = whole.part.limits(whole.origin, whole.end)
    if not onset < relief:
        raise ValueError(f'{whole.part}: no part of the recording, which lasts '
                         f'{(whole.end - whole.origin) / SECOND_NS:.1f} s')
    # The window in which the recording ends is as faulty as those before.
    return Run(whole, RECORDED, whole.stamps, whole.ids, onset,
               relief + window if relief == whole.end else relief)


def injected_fault(recording: RecordingEvents, fault: Fault, window: int) -> Run:
    """Return a run with the fault injected in the middle of a normal recording.

    The onset is put on the grid of windows [ns], so that none is half faulty.
    """
    middle = int(recording.stamps[0]) + (recording.end - int(recording.stamps[0])) // 2
    onset = -(-middle // window) * window
    try:
        stamps, ids = fault_injection.inject(fault, recording.event_types, recording.stamps,
                                             recording.ids, onset, recording.end)
    except ValueError as error:
        raise ValueError(f'{recording.part}: {error}') from error
    return Run(recording, str(fault), stamps, ids, onset, recording.end + window)


Judge = Callable[[np.ndarray, np.ndarray, int], Verdicts]
"""Judges stamps and ids of a recording, and the silence up to its end [ns]."""


def paper_judge(trained: TrainedModel, model: Model, threshold: Optional[float],
                parameters: DetectorParameters) -> Judge:
    """Return what judges by the paper's score; threshold None: scores only, no alarms."""
    return lambda stamps, ids, end: model.judge(trained.window, threshold, parameters, stamps, ids,
                                                end)


def evidence_judge(trained: TrainedModel, parameters: DetectorParameters) -> Judge:
    """Return what judges by evidence and the model's limits.

    Raises:
        ValueError: the limits are not those of the model.
    """
    model = EvidenceModel(trained)
    return lambda stamps, ids, end: judge_by_evidence(trained, model, parameters, stamps, ids, end)


def judge(judge_recording: Judge, window: int, runs: Sequence[Run]) -> List[JudgedRun]:
    """Let a detector judge runs in windows of a length [ns]."""
    judged = []
    for run in progress.each(runs, 'scoring'):
        verdicts = judge_recording(run.stamps, run.ids, run.source.end)
        judged.append(JudgedRun(run, verdicts, np.nan_to_num(verdicts.score),
                                _labels(run, verdicts, window)))
    return judged


def check_unseen(trained: TrainedModel, recordings: Sequence[RecordingEvents]) -> None:
    """Check that recordings were not trained on, and that none is there twice.

    Raises:
        ValueError: names the recording.
    """
    for index, recording in enumerate(recordings):
        for other in trained.recordings:
            if overlap(recording.recording, other):
                raise ValueError(f'{recording.part}: the model was trained on it (as '
                                 f'{other.bag}), so that it looks better than it is; name '
                                 'another recording, or a part that was not trained on '
                                 '(BAG@START-END)')
        for before in recordings[:index]:
            if overlap(recording.recording, before.recording):
                raise ValueError(f'{recording.part}: the same recording as {before.part}; name it '
                                 'once')


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
    return FalseAlarms(sum(len(run.verdicts.alarms) for run in normal), windows * window / _HOUR)


def _labels(run: Run, verdicts: Verdicts, window: int) -> np.ndarray:
    labels = np.full(len(verdicts.start), LEFT_OUT, dtype=np.int8)
    if run.fault:
        labels[(verdicts.start >= run.onset) & (verdicts.start + window <= run.relief)] = ABNORMAL
    else:
        labels[:] = NORMAL
    labels[verdicts.settling] = LEFT_OUT
    return labels


def _fault_result(name: str, normal: np.ndarray, runs: Sequence[JudgedRun],
                  threshold: float) -> FaultResult:
    abnormal = labelled(runs, ABNORMAL)
    roc = Roc(normal, abnormal)
    rate = roc.at(threshold).true_positive_rate
    return FaultResult(
        name, len(abnormal), roc, confidence.auc(roc.auc, len(normal), len(abnormal)), rate,
        confidence.wilson(round(rate * len(abnormal)), len(abnormal)),
        len(runs), [run.latency for run in runs if run.latency is not None],
        sum(run.stood_before for run in runs))
