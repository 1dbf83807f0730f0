"""Recordings as a calibration judges them: as they were, or with a fault; and what that shows.

The windows of normal recordings are normal; those of a faulty one are abnormal while the fault
lasts. Those before and after count as neither: nobody knows whether they are normal. Windows while
the detector settles are left out everywhere. A window without events scores 0 (docs/method.md,
section 2.3).
"""
from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Dict, List, NamedTuple, Optional, Sequence

import numpy as np

from self_awareness import Roc, TrainedModel, Verdicts, progress
from self_awareness.calibration import confidence, fault_injection, heads_and_tails
from self_awareness.calibration.confidence import Interval
from self_awareness.calibration.fault_injection import InjectedFault, of_each_source
from self_awareness.judging import Judge
from self_awareness.recordings import DistinctRecordings, RecordingEvents, overlap
from self_awareness.stamps import SECOND_NS, nanoseconds

NORMAL, ABNORMAL, LEFT_OUT = 0, 1, -1  # labels of windows
RECORDED = 'recorded'  # what a fault is called that was recorded, not injected

_BEFORE, _AFTER = 3 * SECOND_NS, 5 * SECOND_NS  # of an alarm: what led to it, and what is left
_HOUR = 3600 * SECOND_NS
_SHORTEST = 30 * SECOND_NS  # recording that a fault is injected into, if an excuse shortens it


@dataclass(frozen=True)
class Run:
    """A recording, as it was or with a fault injected, to be judged."""

    source: RecordingEvents  # the recording
    fault: str = ''  # empty: normal operation; RECORDED, or the fault injected
    onset: int = 0  # when the fault begins [ns]; not for normal operation
    relief: int = 0  # when it ends [ns]; not for normal operation
    injected: Optional[InjectedFault] = None  # the fault injected; None: it is judged as it was

    def events(self) -> RecordingEvents:
        """Return what is judged.

        With a fault, it is made here, and not kept: a fault of every source of a robot in every
        recording would not fit into the memory. Nobody knows which attributes messages would have
        that it makes late or seldom.
        """
        if self.injected is None:
            return self.source
        stamps, ids = fault_injection.inject(
            self.injected, self.source.event_types, self.source.stamps, self.source.ids,
            self.onset, self.source.end)
        return replace(self.source, stamps=stamps, ids=ids, attributes=None, senders=())


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
            if self.run.onset < alarm.begin <= self.run.relief:
                return (alarm.begin - self.run.onset) / SECOND_NS
        return None

    @property
    def stood_before(self) -> bool:
        """Whether a false alarm stood when the fault began, and hides that of the fault."""
        return any(alarm.begin <= self.run.onset < alarm.end for alarm in self.verdicts.alarms)


def recorded_fault(whole: RecordingEvents, window: int) -> Run:
    """Return a run with the fault of a recording, in the part that was asked for.

    Args:
        whole: the events of the whole recording, for the detector to settle before the fault.
        window: length of the windows [ns].

    Raises:
        ValueError: the recording has no such part.
    """
    onset, relief = whole.part.span(whole.origin, whole.end)
    if not onset < relief:
        raise ValueError(f'{whole.part}: no part of the recording, which lasts '
                         f'{(whole.end - whole.origin) / SECOND_NS:.1f} s')
    # The window in which the recording ends is as faulty as those before it.
    return Run(whole, RECORDED, onset, relief + window if relief == whole.end else relief)


def injected_fault(recording: RecordingEvents, fault: InjectedFault, window: int) -> Run:
    """Return a run with the fault injected in the middle of a normal recording.

    Raises:
        ValueError: it would change nothing, see fault_injection.inject().
    """
    run = Run(recording, str(fault), _middle(recording, window), recording.end + window, fault)
    try:
        run.events()
    except ValueError as error:
        raise ValueError(f'{recording.part}: {error}') from error
    return run


class Injections(NamedTuple):
    """Faults in recordings."""

    runs: List[Run]  # every fault in every recording that can show it
    silent: List[str]  # the faults that no recording can show
    excused: List[str]  # the recordings that are left out, as an excuse held all the time


def injections(faults: Sequence[InjectedFault], trained: TrainedModel,
               normal: Sequence[JudgedRun]) -> Injections:
    """Return every fault in every recording, where no excuse held.

    Where a fault stands for each source, those that say nothing after the middle of a recording
    are left out: many only speak when the robot starts.

    Args:
        faults: to inject.
        trained: the model.
        normal: the recordings, judged.

    Raises:
        ValueError: a fault of a source that is named would change nothing.
    """
    parts = {str(judged.run.source.part): without_excuses(judged) for judged in normal}
    able = [recording for recording in parts.values() if recording is not None]
    runs: Dict[str, List[Run]] = {}
    for each in dict.fromkeys(each for fault in faults
                              for each in of_each_source(fault, trained.event_types)):
        runs[str(each)] = [injected_fault(recording, each, trained.window) for recording in able
                           if each in faults
                           or acts_after_middle(each.source or '', recording, trained.window)]
    return Injections([run for of_fault in runs.values() for run in of_fault],
                      [fault for fault, of_fault in runs.items() if able and not of_fault],
                      [part for part, recording in parts.items() if faults and recording is None])


def without_excuses(judged: JudgedRun) -> Optional[RecordingEvents]:
    """Return the longest part of a recording in which no excuse held: nobody is to blame where the
    machine is busy, or all fall silent. None: it is too short.
    """
    source, verdicts = judged.run.source, judged.verdicts
    excuses = sorted((alarm.begin - _BEFORE, alarm.end + _AFTER)
                     for alarm in [*verdicts.alarms, *verdicts.suspicions]
                     if alarm.busy is not None or alarm.silent is not None)
    if not excuses:
        return source
    begins = [int(source.stamps[0]), *(end for _, end in excuses)]
    ends = [*(begin for begin, _ in excuses), source.end]
    length, begin = max((end - max(begins[:number]), max(begins[:number]))
                        for number, end in enumerate(ends, 1))
    if length < _SHORTEST:
        return None
    within = (source.stamps >= begin) & (source.stamps <= begin + length)
    return replace(
        source, part=replace(source.part, start=(begin - source.origin) / SECOND_NS,
                             end=(begin + length - source.origin) / SECOND_NS),
        stamps=source.stamps[within], ids=source.ids[within], end=begin + length,
        attributes=None if source.attributes is None else source.attributes[within])


def acts_after_middle(source: str, recording: RecordingEvents, window: int) -> bool:
    """Return whether a source has an event where a fault would be injected, or later."""
    of_source = [i for i, kind in enumerate(recording.event_types) if kind.source == source]
    later = np.bincount(recording.ids[recording.stamps >= _middle(recording, window)],
                        minlength=len(recording.event_types))
    return bool(later[of_source].any())


def _middle(recording: RecordingEvents, window: int) -> int:
    """Return the onset of injected faults, on the grid of windows [ns]: none is half faulty."""
    first = int(recording.stamps[0])
    return -(-(first + (recording.end - first) // 2) // window) * window


def judge_runs(judge: Judge, window: int, runs: Sequence[Run]) -> List[JudgedRun]:
    """Let a detector judge runs in windows of a length [ns]."""
    judged = []
    for run in progress.each(runs, 'scoring'):
        verdicts = judge(run.events())
        judged.append(JudgedRun(run, verdicts, np.nan_to_num(verdicts.score),
                                _labels(run, verdicts, window)))
    return judged


def check_unseen(trained: TrainedModel, recordings: Sequence[RecordingEvents]) -> None:
    """Check that recordings were not trained on, and that none is there twice.

    Raises:
        ValueError: names the recording.
    """
    distinct = DistinctRecordings()
    for recording in recordings:
        for other in trained.recordings:
            if overlap(recording.recording, other):
                raise ValueError(f'{recording.part}: the model was trained on it (as '
                                 f'{other.bag}), so that it looks better than it is; name '
                                 'another recording, or a part that was not trained on '
                                 '(BAG@START-END)')
        distinct.add(str(recording.part), recording.recording)


def _labels(run: Run, verdicts: Verdicts, window: int) -> np.ndarray:
    labels = np.full(len(verdicts.start), LEFT_OUT, dtype=np.int8)
    if run.fault:
        labels[(verdicts.start >= run.onset) & (verdicts.start + window <= run.relief)] = ABNORMAL
    else:
        labels[:] = NORMAL
        for before_s in filter(None, (heads_and_tails.stopped_before_end(run.source, alarm)
                                      for alarm in verdicts.alarms)):
            labels[verdicts.start + window > run.source.end - nanoseconds(before_s)] = LEFT_OUT
    labels[verdicts.settling] = LEFT_OUT
    return labels


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
