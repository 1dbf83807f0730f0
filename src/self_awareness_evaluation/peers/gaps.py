"""A monitor of gaps, as somebody writes it in an afternoon: nothing in it is chosen by hand.

An event type is beyond its bounds when it has been silent for LONGER times the longest gap ever
seen, in training or in calibration, or when its events of the last 5 s are fewer or more than ever
by OUTSIDE, and by more than the one event that may fall to either side of the end of the span.
"""
from __future__ import annotations

from typing import Dict, List, NamedTuple, Sequence, Set

import numpy as np

from self_awareness import DEFAULT_WINDOW, EventType
from self_awareness_evaluation.peers.deviations import DeviationScorer
from self_awareness_evaluation.peers.frequency import SPAN, messages_in_span
from self_awareness_evaluation.systems import ScoringSystem
from self_awareness_evaluation.windowed_events import WindowedEvents, stamps_by

LONGER = 1.25
"""Times the longest gap ever seen, from where on an event type is silent for too long."""

OUTSIDE = 0.25
"""Share by which the events of the last 5 s may be fewer, or more, than ever seen."""

_WITHIN_BOUNDS = 0.0


class GapBounds(NamedTuple):
    """What was seen of an event type: its longest gap [ns], fewest and most events in SPAN.

    Where it was never heard for as long as SPAN, the fewest are more than the most.
    """

    longest: float
    fewest: float
    most: float

    def deviation(self, ages: np.ndarray, counts: np.ndarray) -> np.ndarray:
        """Return by which share windows are beyond the bounds, 0 within them.

        Args:
            ages: times since the last event at the end of the windows [ns]; NaN: there was none.
            counts: events of the last SPAN; NaN: the type has not been heard for so long.
        """
        silent = np.fmax(ages / (LONGER * self.longest) - 1.0, 0.0)
        if self.fewest > self.most:
            return silent
        fewest = min((1.0 - OUTSIDE) * self.fewest, self.fewest - 1.0)
        most = max((1.0 + OUTSIDE) * self.most, self.most + 1.0)
        few = (fewest - counts) / max(fewest, 1.0)
        many = (counts - most) / most
        return np.fmax(silent, np.fmax(few, many))


class GapScorer(DeviationScorer):
    """The bounds of every event type that came at least twice in a recording."""

    def __init__(self) -> None:
        super().__init__()
        self._bounds: Dict[EventType, GapBounds] = {}

    @property
    def bounds(self) -> Dict[EventType, GapBounds]:
        """The bounds by event type; one without is not watched."""
        return self._bounds

    @property
    def watched(self) -> Set[str]:
        """The sources of all that has bounds."""
        return {event_type.source for event_type in self._bounds}

    def train(self, recordings: Sequence[WindowedEvents]) -> None:
        """Find the bounds."""
        self._bounds = {}
        self.widen(recordings)

    def widen(self, recordings: Sequence[WindowedEvents]) -> None:
        """Widen the bounds to what further recordings of normal operation hold."""
        self._last = None
        for recording in recordings:
            ends = recording.starts() + DEFAULT_WINDOW
            for event_type, stamps in _by_type(recording).items():
                if len(stamps) < 2:
                    continue
                counts = _counts(stamps, ends[ends <= recording.end])
                counts = counts[np.isfinite(counts)]
                known = self._bounds.get(event_type, GapBounds(0.0, np.inf, 0.0))
                self._bounds[event_type] = GapBounds(
                    max(known.longest, float(np.diff(stamps).max())),
                    min(known.fewest, counts.min(initial=np.inf)),
                    max(known.most, counts.max(initial=0.0)))

    def _deviations(self, recording: WindowedEvents) -> np.ndarray:
        ends = recording.starts() + DEFAULT_WINDOW
        stamps = _by_type(recording)
        deviations = np.zeros((len(self._bounds), len(ends)))
        for row, (event_type, bounds) in enumerate(self._bounds.items()):
            if event_type in stamps:
                deviations[row] = bounds.deviation(_ages(stamps[event_type], ends),
                                                   _counts(stamps[event_type], ends))
        return deviations

    def _blamed(self, row: int) -> List[str]:
        return [list(self._bounds)[row].source]


class GapMonitor(ScoringSystem):
    """The monitor: what lies beyond the bounds is abnormal, and the calibration widens these."""

    def __init__(self) -> None:
        self._gaps = GapScorer()
        super().__init__('gaps', self._gaps, _WITHIN_BOUNDS)

    @property
    def bounds(self) -> Dict[EventType, GapBounds]:
        """See GapScorer."""
        return self._gaps.bounds

    def calibrate(self, recordings: Sequence[WindowedEvents]) -> None:
        """Widen the bounds."""
        self._gaps.widen(recordings)


def _by_type(recording: WindowedEvents) -> Dict[EventType, np.ndarray]:
    return stamps_by(recording, lambda event_type: event_type)


def _ages(stamps: np.ndarray, ends: np.ndarray) -> np.ndarray:
    """Return the times since the last event before some ends [ns]; NaN before the first one."""
    number = np.searchsorted(stamps, ends)
    return np.where(number > 0, ends - stamps[number - 1], np.nan)


def _counts(stamps: np.ndarray, ends: np.ndarray) -> np.ndarray:
    """Return the events in SPAN before some ends; NaN while SPAN holds the time before the first.
    """
    return np.where(ends - SPAN >= stamps[0], messages_in_span(stamps, ends), np.nan)
