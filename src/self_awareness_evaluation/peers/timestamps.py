"""Stamps, as diagnostic_updater's TimeStampStatus watches them (update_functions.h).

A topic is in error if, since the last update, a message came that was stamped more than
-LEAST_S in the future, more than MOST_S in the past, or with 0 where other stamps are not. The
score of a window is by how many classes of ages (9 %) the worst message is beyond, negated. It is
computed at the end of every window for the second before; diagnostic_updater looks once a second.
That no message came is its warning, not its error, and is left to the monitors of frequencies.
"""
from __future__ import annotations

from typing import List, Sequence

import numpy as np

from self_awareness import DEFAULT_WINDOW
from self_awareness_evaluation.peers.messages import (NO_HEADER, ZERO_STAMP, MessageMonitor,
                                                      age_class, ages, largest)
from self_awareness_evaluation.windowed_events import WindowedEvents

LEAST_S, MOST_S = -1.0, 5.0
"""Defaults of TimeStampStatusParam: the least and the most acceptable age [s]."""

WITHIN_BOUNDS = 0.0
"""Scores below are abnormal."""

_UPDATE_S = 1.0
_ZERO = 1.0  # how far a stamp of 0 is beyond the bounds


class TimestampMonitor(MessageMonitor):
    """Watches, as a developer sets it up, all topics whose stamps are acceptable in training."""

    def __init__(self) -> None:
        super().__init__()
        self._topics: List[str] = []
        self._least, self._most = age_class(LEAST_S), age_class(MOST_S)

    @property
    def topics(self) -> List[str]:
        """See MessageMonitor."""
        return self._topics

    def train(self, recordings: Sequence[WindowedEvents]) -> None:
        """Find the topics."""
        self._learn_sources(recordings)
        stamped, refused = set(), set()
        for recording in recordings:
            for topic, (_, classes) in ages(recording).items():
                if (classes != NO_HEADER).any():
                    stamped.add(topic)
                if self._beyond(classes).any():
                    refused.add(topic)
        self._topics = sorted(stamped - refused)

    def _deviations(self, recording: WindowedEvents) -> np.ndarray:
        ends = recording.starts() + DEFAULT_WINDOW
        of_topics = ages(recording)
        deviations = np.zeros((len(self._topics), len(ends)))
        for row, topic in enumerate(self._topics):
            if topic in of_topics:
                stamps, classes = of_topics[topic]
                deviations[row] = largest((stamps, self._beyond(classes)), ends, _UPDATE_S)
        return deviations

    def _beyond(self, classes: np.ndarray) -> np.ndarray:
        """Return by how many classes ages are beyond the bounds; 0 within."""
        beyond = np.maximum(self._least - classes, classes - self._most).clip(0).astype(float)
        beyond[classes == NO_HEADER] = 0.0
        # It tells a stamp of 0 only beside others.
        beyond[classes == ZERO_STAMP] = _ZERO if (classes > ZERO_STAMP).any() else 0.0
        return beyond
