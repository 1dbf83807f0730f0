"""Finds the limits above which evidence is abnormal, on normal operation not trained on.

Each recording is judged by itself, in any process, and the findings are added up (docs/method.md,
section 5).
"""
from __future__ import annotations

import time
from contextlib import closing
from dataclasses import dataclass
from typing import Any, Iterable, List, Optional, Sequence, Tuple

import numpy as np

from self_awareness import (EvidenceCalibration, LimitFinder, LimitFindings, TrainedModel,
                            half_of, middle_of, recordings)
from self_awareness.recordings import BagPart, RecordingEvents
from self_awareness.stamps import SECOND_NS
from self_awareness.workers import InProcess, Workers

BUDGET = 0.5
"""False alarms an hour that limits are made for, by default."""

Part = Tuple[np.ndarray, np.ndarray, Optional[int], int, Sequence[int]]
"""Stamps [ns] and ids of a recording; the half of the training it belongs to, None: neither; when
the robot was started [ns], 0: not known; where the clock was set forward [ns]."""


@dataclass(frozen=True)
class HeldOut:
    """A recording that was not trained on, by stamps [ns] and ids.

    Args:
        robot_start: when the robot was started [ns]; 0: not known.
        clock_steps: where the clock was set forward [ns].
    """

    stamps: np.ndarray
    ids: np.ndarray
    robot_start: int = 0
    clock_steps: Sequence[int] = ()

    def parts(self, _: TrainedModel, __: int) -> Iterable[Part]:
        """Return what is to be judged."""
        return [(self.stamps, self.ids, None, self.robot_start, self.clock_steps)]


@dataclass(frozen=True)
class InMemory:
    """A recording of the training, by stamps [ns] and ids.

    Args:
        fingerprint: says which half of the training it belongs to.
        robot_start: when the robot was started [ns]; 0: not known.
        clock_steps: where the clock was set forward [ns].
    """

    stamps: np.ndarray
    ids: np.ndarray
    fingerprint: int
    robot_start: int = 0
    clock_steps: Sequence[int] = ()

    def parts(self, trained: TrainedModel, settle_time: int) -> Iterable[Part]:
        """Return what is to be judged, and the half of the training that it belongs to.

        If all recordings belong to one half, the two parts of each stand for the halves. The
        second one then has a time before it in which the detector settles [ns].
        """
        if trained.only_half is None:
            halves = [(half_of(self.fingerprint), slice(None))]
        else:
            middle = middle_of(self.stamps)
            halves = [(0, slice(int(np.argmax(self.stamps >= middle)))),
                      (1, slice(int(np.argmax(self.stamps >= middle - settle_time)), None))]
        return [(self.stamps[part], self.ids[part], half, self.robot_start, self.clock_steps)
                for half, part in halves]


@dataclass(frozen=True)
class TrainedOn:
    """A recording of the training.

    Args:
        part: the bag, or the part of it.
        fingerprint: of the whole bag.
        events: of the part, by ids of their own; None: read when they are needed, as the memory
            may not hold those of all recordings.
    """

    part: BagPart
    fingerprint: int
    events: Optional[RecordingEvents] = None

    def __str__(self) -> str:
        return str(self.part)

    def parts(self, trained: TrainedModel, settle_time: int) -> Iterable[Part]:
        """Return what is to be judged, and the half of the training that it belongs to."""
        events = self.events
        if events is None:
            events = recordings.read(trained, self.part)
            ids = events.ids
        else:
            known = {kind: index for index, kind in enumerate(trained.event_types)}
            ids = np.array([known[kind] for kind in events.event_types], np.uint32)[events.ids]
        return InMemory(events.stamps, ids, self.fingerprint, events.robot_start,
                        events.clock_steps).parts(trained, settle_time)


def held_out(trained: TrainedModel, found_in: Iterable[RecordingEvents], settle_time: int,
             budget: float) -> EvidenceCalibration:
    """Return limits by recordings that were not trained on.

    Args:
        trained: the model.
        found_in: recordings of normal operation.
        settle_time: left out at the start of every recording [ns].
        budget: false alarms an hour that the limits allow.

    Raises:
        TooLittleError: the recordings are too short.
    """
    found_in = list(found_in)
    calibration = find(trained, settle_time, budget,
                       [HeldOut(recording.stamps, recording.ids, recording.robot_start,
                                recording.clock_steps)
                        for recording in found_in])
    calibration.method = 'held-out'
    calibration.recordings = [recording.recording for recording in found_in]
    return calibration


def cross_fit(trained: TrainedModel, trained_on: Sequence[TrainedOn], settle_time: int,
              budget: float, workers: Optional[Workers] = None) -> EvidenceCalibration:
    """Return limits by recordings of the training, each judged by the half it does not belong to.

    Args:
        trained: the model; its last recordings are those of trained_on.
        trained_on: all recordings of the training, or the last.
        settle_time: left out at the start of every recording [ns].
        budget: false alarms an hour that the limits allow.
        workers: who does the work; None: this process.

    Raises:
        BagError: a recording cannot be read any more.
        TooLittleError: the recordings are too short.
    """
    calibration = find(trained, settle_time, budget, trained_on, workers, keep_findings=True)
    calibration.method = 'cross-fit'
    calibration.recordings = trained.recordings[-len(trained_on):]
    return calibration


def _latest_firsts(types: int, found_in: Sequence[HeldOut]) -> List[int]:
    """Return how long after the start of a recording a type came at the latest, by id [ns].

    -1: it did not come in one of them. Empty: there is no recording.
    """
    if not found_in:
        return []
    latest = np.zeros(types, np.int64)
    for recording in found_in:
        firsts = np.full(types, -1, np.int64)
        ids, where = np.unique(recording.ids, return_index=True)
        known = ids < types
        after = recording.stamps[where] - recording.stamps[0]
        firsts[ids[known]] = np.maximum(after[known], 0)
        latest = np.where((latest < 0) | (firsts < 0), -1, np.maximum(latest, firsts))
    return [int(first) for first in latest]


def find(trained: TrainedModel, settle_time: int, budget: float, tasks: Sequence[Any],
         workers: Optional[Workers] = None, keep_findings: bool = False) -> EvidenceCalibration:
    """Return limits by recordings; without the method and the recordings, which the caller adds.

    Args:
        trained: the model.
        settle_time: left out at the start of every part of a recording [ns].
        budget: false alarms an hour that the limits allow.
        tasks: HeldOut or TrainedOn recordings.
        workers: who does the work; None: this process.
        keep_findings: the model keeps what the recordings show, for later calibrations.

    Raises:
        BagError: a recording cannot be read.
        TooLittleError: the recordings are too short.
    """
    workers = workers or InProcess()
    judging = _Judging(trained, settle_time, budget)
    if not keep_findings:
        judging.finder.merge(trained.findings)
    judging.add_all(tasks, workers, 'limits')
    if keep_findings:
        trained.findings = judging.finder.findings()
    try:
        found = judging.finder.find()
    except ValueError as error:
        raise TooLittleError(str(error)) from error
    calibration = EvidenceCalibration()
    calibration.limits = found.limits
    calibration.relations = found.relations
    calibration.budget = budget
    calibration.false_alarms_per_hour = found.expected_rate
    calibration.windows = judging.finder.windows
    calibration.firsts = _latest_firsts(len(trained.event_types),
                                        [task for task in tasks if isinstance(task, HeldOut)])
    calibration.stamp = int(time.time()) * SECOND_NS
    return calibration


def compare_halves(trained: TrainedModel, settle_time: int,
                   recordings_: Sequence[InMemory]) -> None:
    """Let a model keep what the recordings of its training show, without limits by them.

    Args:
        trained: the model.
        settle_time: left out at the start of every recording [ns].
        recordings_: all recordings of the training.
    """
    judging = _Judging(trained, settle_time, BUDGET)
    judging.add_all(recordings_, InProcess(), 'training')
    trained.findings = judging.finder.findings()


class TooLittleError(ValueError):
    """There is too little normal operation to find limits on."""


class _Judging:
    """What every recording is judged by. Another process gets it without what was found."""

    def __init__(self, trained: TrainedModel, settle_time: int, budget: float) -> None:
        self._state = (trained.watched_only(), settle_time, budget)
        self.settle_time = settle_time
        self.trained = trained
        self.finder = LimitFinder(trained, settle_time, budget)

    def __reduce__(self) -> Tuple[Any, ...]:
        return _Judging, self._state

    def add_all(self, tasks: Sequence[Any], workers: Workers, description: str) -> None:
        """Judge recordings, and add up what they say."""
        with closing(workers.map(_judge, self, tasks, description)) as findings:
            for found in findings:
                self.finder.merge(found)


def _judge(judging: _Judging, task: Any) -> LimitFindings:
    finder = judging.finder.part()
    for part in task.parts(judging.trained, judging.settle_time):
        finder.add_events(*part)
    return finder.findings()
