"""Finds from where on evidence is abnormal: on normal operation that was not trained on.

Recordings come twice, first for the limits of what is watched, then for that of the linker
(core/evidence_limits.h). They are read anew each time: those of training may not fit the memory.
"""
from __future__ import annotations

import math
import time
from typing import Callable, Iterable, Optional, Tuple

import numpy as np

from self_awareness import EvidenceCalibration, LimitFinder, TrainedModel
from self_awareness.recordings import RecordingEvents
from self_awareness.stamps import SECOND_NS

BUDGET = 0.5
"""False alarms an hour that limits are made for, if nothing else is asked for."""

Part = Tuple[np.ndarray, np.ndarray, Optional[int]]
"""Stamps [ns] and ids of a recording; the half of the training it belongs to, None: neither."""


def held_out(trained: TrainedModel, recordings: Iterable[RecordingEvents], settle_time: int,
             budget: float) -> EvidenceCalibration:
    """Return limits by recordings that were not trained on.

    Args:
        trained: the model.
        recordings: of normal operation.
        settle_time: left out at the start of every recording [ns].
        budget: false alarms an hour that the limits allow.

    Raises:
        ValueError: the recordings are too short.
    """
    recordings = list(recordings)
    calibration = find(trained, settle_time, budget,
                       lambda: ((r.stamps, r.ids, None) for r in recordings))
    calibration.method = 'held-out'
    calibration.recordings = [recording.recording for recording in recordings]
    return calibration


def cross_fit(trained: TrainedModel, read: Callable[[], Iterable[RecordingEvents]],
              settle_time: int, budget: float) -> EvidenceCalibration:
    """Return limits by the recordings of training, each judged by the half it does not belong to.

    Args:
        trained: the model.
        read: reads the recordings in the order of the training.
        settle_time: left out at the start of every recording [ns].
        budget: false alarms an hour that the limits allow.

    Raises:
        ValueError: the recordings are too short.
    """
    alone = len(trained.recordings) == 1

    def parts() -> Iterable[Part]:
        for index, recording in enumerate(read()):
            if alone:
                second = recording.stamps >= _middle(recording)
                yield recording.stamps[~second], recording.ids[~second], 0
                yield recording.stamps[second], recording.ids[second], 1
            else:
                yield recording.stamps, recording.ids, index % 2

    calibration = find(trained, settle_time, budget, parts)
    calibration.method = 'cross-fit'
    calibration.recordings = trained.recordings
    return calibration


def _middle(recording: RecordingEvents) -> int:
    """Return where the training cuts a recording that is alone [ns]."""
    start, end = recording.part.limits(recording.origin, recording.end)
    return start + (end - start) // 2


def find(trained: TrainedModel, settle_time: int, budget: float,
         parts: Callable[[], Iterable[Part]]) -> EvidenceCalibration:
    """Return limits by parts of recordings; how they were found is not said yet.

    Args:
        trained: the model.
        settle_time: left out at the start of every part [ns].
        budget: false alarms an hour that the limits allow.
        parts: reads them; called twice.

    Raises:
        ValueError: the parts are too short.
    """
    finder = LimitFinder(trained, settle_time, budget)
    for stamps, ids, half in parts():
        finder.add_events(stamps, ids, half)
    finder.start_second_pass()
    for stamps, ids, half in parts():
        finder.add_events(stamps, ids, half)
    limits = finder.limits()
    calibration = EvidenceCalibration()
    calibration.limits = limits.tracks
    calibration.linker_limit = limits.linker
    calibration.budget = budget
    calibration.false_alarms_per_hour = math.nan
    calibration.windows = finder.windows
    calibration.stamp = int(time.time()) * SECOND_NS
    return calibration
