"""A threshold on the size of messages, as somebody writes it in an afternoon.

A topic is beyond its bounds when its newest message is smaller than the smallest, or larger than
the largest one of the training, by more than OUTSIDE, the margin of the monitor of gaps. The score
of a window is by how many octaves, negated.
"""
from __future__ import annotations

from typing import Dict, List, NamedTuple, Sequence

import numpy as np

from self_awareness import DEFAULT_WINDOW
from self_awareness_evaluation.peers.gaps import OUTSIDE
from self_awareness_evaluation.peers.messages import (CLASSES_AN_OCTAVE, MessageMonitor, newest,
                                                      sizes)
from self_awareness_evaluation.windowed_events import WindowedEvents

WITHIN_BOUNDS = 0.0
"""Scores below are abnormal."""

_SMALLER = -np.log2(1.0 - OUTSIDE)  # octaves
_LARGER = np.log2(1.0 + OUTSIDE)


class SizeBounds(NamedTuple):
    """The classes of the smallest and of the largest message that were seen."""

    smallest: int
    largest: int

    def deviation(self, classes: np.ndarray) -> np.ndarray:
        """Return by how many octaves sizes are beyond the bounds, 0 within; NaN: no message."""
        below = (self.smallest - classes) / CLASSES_AN_OCTAVE - _SMALLER
        above = (classes - self.largest) / CLASSES_AN_OCTAVE - _LARGER
        return np.fmax(np.fmax(below, above), 0.0)


class SizeMonitor(MessageMonitor):
    """The bounds of every topic."""

    def __init__(self) -> None:
        super().__init__()
        self._bounds: Dict[str, SizeBounds] = {}

    @property
    def topics(self) -> List[str]:
        """See MessageMonitor."""
        return list(self._bounds)

    @property
    def bounds(self) -> Dict[str, SizeBounds]:
        """The bounds by topic."""
        return self._bounds

    def train(self, recordings: Sequence[WindowedEvents]) -> None:
        """Find the bounds."""
        self._learn_sources(recordings)
        self._bounds = {}
        for recording in recordings:
            for topic, (_, classes) in sizes(recording).items():
                known = self._bounds.get(topic, SizeBounds(int(classes[0]), int(classes[0])))
                self._bounds[topic] = SizeBounds(min(known.smallest, int(classes.min())),
                                                 max(known.largest, int(classes.max())))

    def _deviations(self, recording: WindowedEvents) -> np.ndarray:
        ends = recording.starts() + DEFAULT_WINDOW
        of_topics = sizes(recording)
        deviations = np.zeros((len(self._bounds), len(ends)))
        for row, (topic, bounds) in enumerate(self._bounds.items()):
            if topic in of_topics:
                deviations[row] = bounds.deviation(newest(of_topics[topic], ends))
        return deviations
