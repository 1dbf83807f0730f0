"""The package's own detectors as systems to evaluate: a class for each."""
from __future__ import annotations

from typing import List, Optional, Sequence

import numpy as np

from self_awareness import (DetectorParameters, EncodingRules, EventType, Model, Training,
                            Verdicts)
from self_awareness.evaluation.recording import WINDOW, Recording
from self_awareness.evaluation.systems import Alarm, Judged, common_threshold, distinct


class Paper:
    """The paper's detector (`detector: paper`); silence scores 0."""

    name = 'paper'

    def __init__(self) -> None:
        self._types: List[EventType] = []
        self._model: Optional[Model] = None
        self._threshold: Optional[float] = None

    def train(self, recordings: Sequence[Recording]) -> None:
        """Count the delays."""
        training = Training(EncodingRules(), window=WINDOW)
        for recording in recordings:
            training.add_events(recording.event_types, recording.stamps, recording.ids)
        trained = training.model()
        self._types = trained.event_types
        self._model = Model(trained)

    def calibrate(self, recordings: Sequence[Recording]) -> None:
        """Choose s* by the common rule."""
        verdicts = [self._verdicts(recording.encoded(self._types)) for recording in recordings]
        self._threshold = common_threshold(
            [np.nan_to_num(verdict.score[~verdict.settling]) for verdict in verdicts])

    def judge(self, recording: Recording) -> Judged:
        """Judge a recording."""
        encoded = recording.encoded(self._types)
        verdicts = self._verdicts(encoded)
        alarms = [Alarm(alarm.start, alarm.end, alarm.cleared,
                        distinct([encoded.event_types[suspect.id].source
                                  for suspect in alarm.suspects]))
                  for alarm in verdicts.alarms]
        return Judged(verdicts.start, verdicts.abnormal, np.nan_to_num(verdicts.score),
                      verdicts.settling, alarms, self._threshold)

    def _verdicts(self, encoded: Recording) -> Verdicts:
        # The window in which the recording ends is the last one, hence - 1.
        return self._model.judge(WINDOW, self._threshold, DetectorParameters(), encoded.stamps,
                                 encoded.ids, encoded.end - 1)
