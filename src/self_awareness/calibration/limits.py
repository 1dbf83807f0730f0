"""Finds the limits above which evidence is abnormal, on normal operation not trained on.

Each recording is judged by itself, in any process, and the findings are added up (docs/method.md,
section 5).
"""
from __future__ import annotations

from contextlib import closing
from dataclasses import dataclass, field, replace
from typing import Any, Iterable, List, Optional, Sequence, Tuple, Union

import numpy as np

from self_awareness import (OTHER_MODE, Calibration, Calibrator, LimitFindings, TrainedModel,
                            recordings)
from self_awareness.calibration.heads_and_tails import Silences
from self_awareness.parts import BagPart
from self_awareness.recordings import RecordingEvents
from self_awareness.workers import InProcess, Workers

BUDGET = 0.5  # false alarms an hour that limits are made for, by default


@dataclass(frozen=True)
class TrainedOn:
    """A recording of the training."""

    part: BagPart  # the bag, or the part of it
    # Of the part, by ids of their own; None: read when they are needed, as the memory may not hold
    # those of all recordings.
    events: Optional[RecordingEvents] = None
    silences: Silences = field(default_factory=dict)  # the longest one of every event type

    def __str__(self) -> str:
        return str(self.part)


def _events_of(trained: TrainedModel, task: TrainedOn) -> RecordingEvents:
    """Return the events of a recording of the training, by the ids of the model."""
    if task.events is None:
        return recordings.read(trained, task.part)
    known = {kind: index for index, kind in enumerate(trained.event_types)}
    ids = np.array([known[kind] for kind in task.events.event_types], np.uint32)
    return replace(task.events, ids=ids[task.events.ids])


_Task = Union[RecordingEvents, TrainedOn]


def held_out(trained: TrainedModel, found_in: Iterable[RecordingEvents], settle_time: int,
             budgets: Sequence[float]) -> List[Calibration]:
    """Return limits by recordings that were not trained on, for each budget.

    Args:
        trained: the model.
        found_in: recordings of normal operation.
        settle_time: left out at the start of every recording [ns].
        budgets: false alarms an hour that the limits allow.

    Raises:
        TooLittleError: the recordings are too short.
    """
    found_in = list(found_in)
    found = find(trained, settle_time, budgets,
                 [replace(recording, ids=_ids(trained, recording)) for recording in found_in])
    for calibration in found:
        calibration.recordings = [recording.recording for recording in found_in]
    return found


def _ids(trained: TrainedModel, recording: RecordingEvents) -> np.ndarray:
    """Return the ids of a recording's events: modes that training never saw are one."""
    other = [index for index in recording.heard.tolist() if index >= len(trained.event_types)
             and recording.event_types[index].tells_mode]
    return (np.where(np.isin(recording.ids, other), OTHER_MODE, recording.ids).astype(np.uint32)
            if other else recording.ids)


def find(trained: TrainedModel, settle_time: int, budgets: Sequence[float],
         tasks: Sequence[_Task], workers: Optional[Workers] = None,
         keep_findings: bool = False) -> List[Calibration]:
    """Return limits by recordings, for each budget; without their names, which the caller adds.

    Args:
        trained: the model.
        settle_time: left out at the start of every part of a recording [ns].
        budgets: false alarms an hour that the limits allow.
        tasks: recordings that were not trained on, by the ids of the model, or of the training.
        workers: who does the work; None: this process.
        keep_findings: the model keeps what the recordings show, for later calibrations.

    Raises:
        BagError: a recording cannot be read.
        TooLittleError: the recordings are too short.
    """
    judging = _Judging(trained, settle_time)
    if not keep_findings:
        judging.calibrator.merge(trained.findings)
    with closing((workers or InProcess()).map(_judge, judging, tasks, 'limits')) as findings:
        for found in findings:
            judging.calibrator.merge(found)
    if keep_findings:
        trained.findings = judging.calibrator.findings()
    try:
        return [judging.calibrator.find(budget) for budget in budgets]
    except ValueError as error:
        raise TooLittleError(str(error)) from error


class TooLittleError(ValueError):
    """There is too little normal operation to find limits on."""


class _Judging:
    """What every recording is judged by. Another process gets it without what was found."""

    def __init__(self, trained: TrainedModel, settle_time: int) -> None:
        self._state = (trained.watched_only(), settle_time)
        self.trained = trained
        self.calibrator = Calibrator(trained, settle_time)

    def __reduce__(self) -> Tuple[Any, ...]:
        return _Judging, self._state


def _judge(judging: _Judging, task: _Task) -> LimitFindings:
    """Let a recording be judged; one of the training by the half that it does not belong to."""
    calibrator = judging.calibrator.part()
    if isinstance(task, TrainedOn):
        calibrator.add(_events_of(judging.trained, task), trained_on=True)
    else:
        calibrator.add(task)
    return calibrator.findings()
