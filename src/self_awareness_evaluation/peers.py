"""What others would use to watch a robot's communication: a system for each.

Each watches every topic or event type against bounds of its own. The score of a window is the
largest deviation from these at its end, negated: 0 within them.

Frequency monitors do as diagnostic_updater's FrequencyStatus, which looks once a second: the
messages of every periodic topic are counted over the last 5 s; the score is -0.1 where a topic has
10 % less than its minimum, or 10 % more than its maximum.

The monitor of gaps is as somebody writes it in an afternoon: nothing in it is chosen by hand. An
event type is beyond its bounds when it has been silent for LONGER times the longest gap ever seen,
in training or in calibration, or when its events of the last 5 s are fewer or more than ever by
OUTSIDE, and by more than the one event that may fall to either side of the end of the span.
"""
from __future__ import annotations

from dataclasses import replace
from typing import Dict, Generic, List, NamedTuple, Optional, Sequence, Set, Tuple, TypeVar

import numpy as np

from self_awareness import DEFAULT_WINDOW, EventType
from self_awareness.stamps import SECOND_NS
from self_awareness_evaluation.systems import (FALSE_POSITIVE_RATE, Judged, common_threshold,
                                               persistent, required, settling)
from self_awareness_evaluation.windowed_events import WindowedEvents, stamps_by

TOLERANCE = 0.1
"""Default of FrequencyStatusParam."""

SPAN = 5 * SECOND_NS
"""Length of the time over which messages are counted [ns]: 5 updates, once a second."""

LONGER = 1.25
"""Times the longest gap ever seen, from where on an event type is silent for too long."""

OUTSIDE = 0.25
"""Share by which the events of the last 5 s may be fewer, or more, than ever seen."""

_PERIODIC = 0.2  # largest coefficient of variation of the gaps of a periodic topic
_FEWEST_GAPS = 10
_NEVER = np.empty(0, dtype=np.int64)

_Key = TypeVar('_Key', str, EventType)
_Bounds = TypeVar('_Bounds')


class Peer(Generic[_Key, _Bounds]):
    """A system whose windows score the largest deviation from bounds, negated; it blames whose is
    the largest. Persistence is that of all other systems.

    Args:
        threshold: None: chosen by the common rule; else its own, which stays.
        rate: share of normal windows of that rule.
    """

    name = ''

    def __init__(self, threshold: Optional[float] = None,
                 rate: float = FALSE_POSITIVE_RATE) -> None:
        self.bounds: Dict[_Key, _Bounds] = {}
        """By topic or event type; one without is not watched."""
        self._own_threshold = self._threshold = threshold
        self._rate = rate
        self._last: Optional[Tuple[WindowedEvents, np.ndarray]] = None

    @property
    def watched(self) -> Set[str]:
        """The sources of all that has bounds."""
        return {source for key in self.bounds for source in self._sources_of(key)}

    def calibrate(self, recordings: Sequence[WindowedEvents]) -> None:
        """Choose the threshold by the common rule, unless the system has its own."""
        if self._own_threshold is None:
            self._threshold = common_threshold(
                [self.scores(recording)[~settling(recording)] for recording in recordings],
                self._rate)

    def judge(self, recording: WindowedEvents) -> Judged:
        """Judge a recording.

        Raises:
            ValueError: the system is not calibrated.
        """
        threshold = required(self._threshold, self.name, 'calibrate')
        start, score = recording.starts(), self.scores(recording)
        abnormal, unsettled = score < threshold, settling(recording)
        alarms = []
        for alarm in persistent(start, abnormal & ~unsettled):
            suspects = self._suspects(recording,
                                      int((alarm.start - start[0]) // DEFAULT_WINDOW) - 1)
            alarms.append(replace(alarm, suspects=suspects, culprit=(suspects or [''])[0]))
        return Judged(start, abnormal, score, unsettled, alarms, threshold)

    def scores(self, recording: WindowedEvents) -> np.ndarray:
        """Return the scores of the windows."""
        deviations = self._deviations(recording)
        return -deviations.max(axis=0) if len(deviations) else np.zeros(len(recording.starts()))

    def _suspects(self, recording: WindowedEvents, window: int) -> List[str]:
        """Return the sources of what is beyond its bounds, the furthest first."""
        deviations, keys = self._deviations(recording)[:, window], list(self.bounds)
        return list(dict.fromkeys(source for row in np.argsort(-deviations, kind='stable')
                                  if deviations[row] > 0
                                  for source in self._sources_of(keys[row])))

    def _deviations(self, recording: WindowedEvents) -> np.ndarray:
        """Return the deviations, [key, window]."""
        # Every alarm of a recording asks for them again.
        if self._last is None or self._last[0] is not recording:
            ends, stamps = recording.starts() + DEFAULT_WINDOW, self._stamps(recording)
            deviations = [self._deviation(bounds, stamps.get(key, _NEVER), ends)
                          for key, bounds in self.bounds.items()]
            self._last = recording, np.array(deviations).reshape(len(deviations), len(ends))
        return self._last[1]

    def _stamps(self, recording: WindowedEvents) -> Dict[_Key, np.ndarray]:
        """Return the stamps of the events by topic or event type [ns]."""
        raise NotImplementedError

    def _deviation(self, bounds: _Bounds, stamps: np.ndarray, ends: np.ndarray) -> np.ndarray:
        """Return the deviation at some ends of windows; 0 within the bounds."""
        raise NotImplementedError

    def _sources_of(self, key: _Key) -> List[str]:
        """Return the sources to blame."""
        raise NotImplementedError


class Bounds(NamedTuple):
    """The fewest and the most messages of a topic in SPAN that are normal; fewest > 0."""

    fewest: float
    most: float


class FrequencyMonitor(Peer[str, Bounds]):
    """FrequencyStatus as a developer sets it up: minimum and maximum are the nominal frequency.

    The nominal frequency is the mean of the training recordings. Topics with fewer than
    2 / TOLERANCE messages in SPAN are left out: by jitter alone, a message more or less falls into
    it.
    """

    name = 'frequency'

    def __init__(self, threshold: Optional[float] = -TOLERANCE,
                 rate: float = FALSE_POSITIVE_RATE) -> None:
        super().__init__(threshold, rate)
        self._sources: Dict[str, Dict[str, None]] = {}  # by topic, in the order of their coming

    def train(self, recordings: Sequence[WindowedEvents]) -> None:
        """Find the periodic topics and their bounds."""
        self.bounds, self._sources = {}, {}
        for recording in recordings:
            for event_type in recording.event_types:
                self._sources.setdefault(event_type.scope, {})[event_type.source] = None
        by_topic = [self._stamps(recording) for recording in recordings]
        for topic in self._sources:
            stamps = [of_recording.get(topic, _NEVER) for of_recording in by_topic]
            gaps = np.concatenate([np.diff(part) for part in stamps])
            if len(gaps) >= _FEWEST_GAPS and gaps.std() <= _PERIODIC * gaps.mean():
                bounds = self._bounds_of(recordings, stamps, gaps)
                if bounds.fewest > 0:
                    self.bounds[topic] = bounds

    def _bounds_of(self, recordings: Sequence[WindowedEvents], stamps: Sequence[np.ndarray],
                   gaps: np.ndarray) -> Bounds:
        nominal = SPAN / gaps.mean()
        return Bounds(nominal, nominal) if nominal >= 2 / TOLERANCE else Bounds(0, 0)

    def _stamps(self, recording: WindowedEvents) -> Dict[str, np.ndarray]:
        return stamps_by(recording, lambda event_type: event_type.scope)

    def _deviation(self, bounds: Bounds, stamps: np.ndarray, ends: np.ndarray) -> np.ndarray:
        fewest, most = bounds
        count = messages_in_span(stamps, ends)
        return np.maximum((fewest - count) / fewest, (count - most) / most).clip(0.0)

    def _sources_of(self, key: str) -> List[str]:
        return list(self._sources[key])


class LearnedFrequencyMonitor(FrequencyMonitor):
    """The bounds are the fewest and the most messages in SPAN of the training recordings.

    They are wider by one message, which may fall to either side of the end of SPAN by its phase
    alone: without that, the slowest topics decide on the threshold, and the fast ones are found a
    second later. Periodic topics of any frequency are watched, if the fewest are 2 or more.
    """

    name = 'frequency_learned'

    def __init__(self, rate: float = FALSE_POSITIVE_RATE) -> None:
        super().__init__(None, rate)

    def _bounds_of(self, recordings: Sequence[WindowedEvents], stamps: Sequence[np.ndarray],
                   gaps: np.ndarray) -> Bounds:
        counts = np.concatenate([_settled_counts(recording, part)
                                 for recording, part in zip(recordings, stamps)])
        return Bounds(counts.min() - 1, counts.max() + 1) if len(counts) else Bounds(0, 0)


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


class GapMonitor(Peer[EventType, GapBounds]):
    """The bounds of every event type that came at least twice in a recording; what lies beyond
    them is abnormal, and the calibration widens them."""

    name = 'gaps'

    def __init__(self) -> None:
        super().__init__(threshold=0.0)

    def train(self, recordings: Sequence[WindowedEvents]) -> None:
        """Find the bounds."""
        self.bounds = {}
        self.calibrate(recordings)

    def calibrate(self, recordings: Sequence[WindowedEvents]) -> None:
        """Widen the bounds to what further recordings of normal operation hold."""
        self._last = None
        for recording in recordings:
            ends = recording.starts() + DEFAULT_WINDOW
            for event_type, stamps in self._stamps(recording).items():
                if len(stamps) < 2:
                    continue
                counts = _counts(stamps, ends[ends <= recording.end])
                counts = counts[np.isfinite(counts)]
                known = self.bounds.get(event_type, GapBounds(0.0, np.inf, 0.0))
                self.bounds[event_type] = GapBounds(
                    max(known.longest, float(np.diff(stamps).max())),
                    min(known.fewest, counts.min(initial=np.inf)),
                    max(known.most, counts.max(initial=0.0)))

    def _stamps(self, recording: WindowedEvents) -> Dict[EventType, np.ndarray]:
        return stamps_by(recording, lambda event_type: event_type)

    def _deviation(self, bounds: GapBounds, stamps: np.ndarray, ends: np.ndarray) -> np.ndarray:
        if not len(stamps):
            return np.zeros(len(ends))
        number = np.searchsorted(stamps, ends)  # of those before
        ages = np.where(number > 0, ends - stamps[number - 1], np.nan)
        return bounds.deviation(ages, _counts(stamps, ends))

    def _sources_of(self, key: EventType) -> List[str]:
        return [key.source]


def messages_in_span(stamps: np.ndarray, ends: np.ndarray) -> np.ndarray:
    """Return how many stamps lie in [end - SPAN, end), for every end [ns]."""
    return np.searchsorted(stamps, ends) - np.searchsorted(stamps, ends - SPAN)


def _settled_counts(recording: WindowedEvents, stamps: np.ndarray) -> np.ndarray:
    ends = recording.starts() + DEFAULT_WINDOW
    full = (ends - SPAN >= recording.stamps[0]) & (ends <= recording.end)
    return messages_in_span(stamps, ends[full])


def _counts(stamps: np.ndarray, ends: np.ndarray) -> np.ndarray:
    """Return the events in SPAN before some ends; NaN while SPAN holds the time before the first.
    """
    return np.where(ends - SPAN >= stamps[0], messages_in_span(stamps, ends), np.nan)
