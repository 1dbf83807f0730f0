"""A first-order Markov chain over events, with the durations between them.

The score of an event is the log-likelihood of its type given that of the event before it, plus
that of the delay between the two, in bins of its logarithm, given both types. The score of a
window is the mean over its events. A window without events scores as if it had the least likely
event that there can be.
"""
from __future__ import annotations

from typing import List, Optional, Sequence, Tuple

import numpy as np

from self_awareness import EventType
from self_awareness_evaluation.windowed_events import WindowedEvents, known_ids, vocabulary

_SHORTEST_NS = 100_000  # delays up to it share the first bin
_BINS_AN_OCTAVE = 2
_BINS = 36  # to 26 s

_LAPLACE = 1.0  # added to every count


class MarkovScorer:
    """The chain; it cannot tell whom to blame."""

    def __init__(self) -> None:
        self._types: List[EventType] = []
        self._transitions = np.empty((0, 0))  # log-likelihood, [before, current]
        self._delays = np.empty((0, 0, 0))  # log-likelihood, [before, current, bin]

    def train(self, recordings: Sequence[WindowedEvents]) -> None:
        """Count transitions and delays."""
        self._types = vocabulary(recordings)
        size = len(self._types) + 1  # and one for the types not trained on
        counts = np.zeros((size, size, _BINS))
        for recording in recordings:
            np.add.at(counts, self._steps(recording), 1.0)
        transitions = counts.sum(axis=2)
        self._transitions = _log_likelihood(transitions)
        self._delays = _log_likelihood(counts)

    def scores(self, recording: WindowedEvents) -> np.ndarray:
        """Return the scores of the windows."""
        before, current, bins = self._steps(recording)
        events = self._transitions[before, current] + self._delays[before, current, bins]
        windows = recording.window_of_events()[1:]
        size = len(recording.starts())
        count = np.bincount(windows, minlength=size)
        total = np.bincount(windows, weights=events, minlength=size)
        least = self._transitions.min() + self._delays.min()
        return np.where(count > 0, total / np.maximum(count, 1), least)

    def suspects(self, recording: WindowedEvents, window: int) -> Optional[List[str]]:
        """Return None: the chain cannot tell whom to blame."""
        return None

    def _steps(self, recording: WindowedEvents) -> Tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the types before, the current types, and the bins of the delays between."""
        ids = known_ids(recording, self._types)
        delays = np.maximum(np.diff(recording.stamps), _SHORTEST_NS)
        bins = (np.log2(delays / _SHORTEST_NS) * _BINS_AN_OCTAVE).astype(np.int64)
        return ids[:-1], ids[1:], np.minimum(bins, _BINS - 1)


def _log_likelihood(counts: np.ndarray) -> np.ndarray:
    """Return the logarithm of counts as smoothed shares along the last axis."""
    smoothed = counts + _LAPLACE
    return np.log(smoothed / smoothed.sum(axis=-1, keepdims=True))
