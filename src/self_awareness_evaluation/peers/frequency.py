"""Frequency monitors, as diagnostic_updater's FrequencyStatus does it.

The messages of every periodic topic are counted over the last 5 s; the score of a window is the
largest relative deviation beyond the bounds, negated: 0 within them, -0.1 where a topic has 10 %
less than its minimum, or 10 % more than its maximum. It is computed at the end of every window;
diagnostic_updater looks once a second.
"""
from __future__ import annotations

from typing import Dict, List, NamedTuple, Sequence, Set

import numpy as np

from self_awareness import DEFAULT_WINDOW
from self_awareness.stamps import SECOND_NS
from self_awareness_evaluation.peers.deviations import DeviationScorer
from self_awareness_evaluation.windowed_events import WindowedEvents, stamps_by

TOLERANCE = 0.1
"""Default of FrequencyStatusParam."""

SPAN = 5 * SECOND_NS
"""Length of the time over which messages are counted [ns]: 5 updates, once a second."""

_PERIODIC = 0.2  # largest coefficient of variation of the gaps of a periodic topic
_FEWEST_GAPS = 10
_NEVER = np.empty(0, dtype=np.int64)


class Bounds(NamedTuple):
    """The fewest and the most messages of a topic in SPAN that are normal; fewest > 0."""

    fewest: float
    most: float


class _FrequencyMonitor(DeviationScorer):
    """What both monitors share: counting, and the deviation from the bounds."""

    def __init__(self) -> None:
        super().__init__()
        self._bounds: Dict[str, Bounds] = {}
        self._sources: Dict[str, List[str]] = {}

    @property
    def bounds(self) -> Dict[str, Bounds]:
        """The bounds by topic; a topic without is not watched."""
        return self._bounds

    @property
    def watched(self) -> Set[str]:
        """The publishers of all topics that have bounds."""
        return {source for topic in self._bounds for source in self._sources[topic]}

    def train(self, recordings: Sequence[WindowedEvents]) -> None:
        """Find the periodic topics and their bounds."""
        self._bounds, self._sources = {}, {}
        for recording in recordings:
            for event_type in recording.event_types:
                sources = self._sources.setdefault(event_type.scope, [])
                if event_type.source not in sources:
                    sources.append(event_type.source)
        by_topic = [_by_topic(recording) for recording in recordings]
        for topic in self._sources:
            stamps = [of_recording.get(topic, _NEVER) for of_recording in by_topic]
            gaps = np.concatenate([np.diff(part) for part in stamps])
            if len(gaps) >= _FEWEST_GAPS and gaps.std() <= _PERIODIC * gaps.mean():
                bounds = self._bounds_of(recordings, stamps, gaps)
                if bounds.fewest > 0:
                    self._bounds[topic] = bounds

    def _bounds_of(self, recordings: Sequence[WindowedEvents], stamps: Sequence[np.ndarray],
                   gaps: np.ndarray) -> Bounds:
        raise NotImplementedError

    def _deviations(self, recording: WindowedEvents) -> np.ndarray:
        """Return by how much topics are beyond their bounds."""
        ends = recording.starts() + DEFAULT_WINDOW
        stamps = _by_topic(recording)
        rows = []
        for topic, (fewest, most) in self._bounds.items():
            count = messages_in_span(stamps.get(topic, _NEVER), ends)
            rows.append(np.maximum((fewest - count) / fewest, (count - most) / most).clip(0.0))
        return np.array(rows).reshape(len(rows), len(ends))

    def _blamed(self, row: int) -> List[str]:
        """Return the publishers of a topic."""
        return self._sources[list(self._bounds)[row]]


class FrequencyMonitor(_FrequencyMonitor):
    """FrequencyStatus as a developer sets it up: minimum and maximum are the nominal frequency.

    The nominal frequency is the mean of the training recordings. Topics with fewer than
    2 / TOLERANCE messages in SPAN are left out: by jitter alone, a message more or less falls into
    it.
    """

    def _bounds_of(self, recordings: Sequence[WindowedEvents], stamps: Sequence[np.ndarray],
                   gaps: np.ndarray) -> Bounds:
        nominal = SPAN / gaps.mean()
        return Bounds(nominal, nominal) if nominal >= 2 / TOLERANCE else Bounds(0, 0)


class LearnedFrequencyMonitor(_FrequencyMonitor):
    """The bounds are the fewest and the most messages in SPAN of the training recordings.

    They are wider by one message, which may fall to either side of the end of SPAN by its phase
    alone: without that, the slowest topics decide on the threshold, and the fast ones are found a
    second later. Periodic topics of any frequency are watched, if the fewest are 2 or more.
    """

    def _bounds_of(self, recordings: Sequence[WindowedEvents], stamps: Sequence[np.ndarray],
                   gaps: np.ndarray) -> Bounds:
        counts = np.concatenate([_settled_counts(recording, part)
                                 for recording, part in zip(recordings, stamps)])
        return Bounds(counts.min() - 1, counts.max() + 1) if len(counts) else Bounds(0, 0)


def messages_in_span(stamps: np.ndarray, ends: np.ndarray) -> np.ndarray:
    """Return how many stamps lie in [end - SPAN, end), for every end [ns]."""
    return np.searchsorted(stamps, ends) - np.searchsorted(stamps, ends - SPAN)


def _settled_counts(recording: WindowedEvents, stamps: np.ndarray) -> np.ndarray:
    ends = recording.starts() + DEFAULT_WINDOW
    full = (ends - SPAN >= recording.stamps[0]) & (ends <= recording.end)
    return messages_in_span(stamps, ends[full])


def _by_topic(recording: WindowedEvents) -> Dict[str, np.ndarray]:
    return stamps_by(recording, lambda event_type: event_type.scope)
