"""The systems that are evaluated: the package's own detectors, and what others would use.

Each peer watches every topic or event type against bounds of its own. The score of a window is the
largest deviation from these at its end, negated: 0 within them.

The frequency monitor does as diagnostic_updater's FrequencyStatus: the messages of every periodic
topic are counted over the last 5 s; the score is -0.1 where a topic has 10 % less than its
minimum, or 10 % more than its maximum.

The monitor of gaps is as somebody writes it in an afternoon: nothing in it is chosen by hand. An
event type is beyond its bounds when it has been silent for LONGER times the longest gap ever seen,
in training or in calibration, or when its events of the last 5 s are fewer or more than ever by
OUTSIDE, and by more than the one event that may fall to either side of the end of the span.
"""
from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import Any, Callable, Dict, Hashable, List, NamedTuple, Optional, Sequence, Set, Tuple

import numpy as np

from self_awareness import (DEFAULT_WINDOW, Alarm, Coverage, DetectorParameters, EventType,
                            EvidenceModel, Learner, PaperModel, Tuning, Verdicts,
                            judge_by_evidence)
from self_awareness.calibration import limits
from self_awareness.stamps import SECOND_NS
from self_awareness_evaluation.records import (FALSE_POSITIVE_RATE, Judged, SystemAlarm,
                                               WindowedEvents, common_threshold, persistent,
                                               settling, stamps_by)

SPAN = 5 * SECOND_NS  # over which messages are counted [ns]: 5 updates, once a second
LONGER = 1.25  # times the longest gap ever seen, an event type is silent for too long
OUTSIDE = 0.25  # share by which the events of the last 5 s may be fewer, or more, than ever seen
_PERIODIC = 0.2  # largest coefficient of variation of the gaps of a periodic topic
_FEWEST_GAPS = 10
_NEVER = np.empty(0, dtype=np.int64)


@dataclass
class Paper:
    """The paper's detector (`detector: paper`); silence scores 0."""

    # Share of the normal windows of the calibration that may score below the threshold, and the
    # largest share of them that may be silent; where more than `rate` are, twice that share is
    # taken, and so on, and where more than this, no window is abnormal.
    rate: float = FALSE_POSITIVE_RATE
    most_silent: float = 0.0
    threshold: Optional[float] = field(default=None, init=False)
    watched = None  # it judges all together
    expected_per_hour = None

    def train(self, recordings: Sequence[WindowedEvents]) -> None:
        learner = Learner(evidence=False, paper=True)
        for recording in recordings:
            learner.count(recording.events)
        trained = learner.model(watch=False)
        self._types = trained.event_types
        self._model = PaperModel(trained)

    def calibrate(self, recordings: Sequence[WindowedEvents]) -> None:
        """Choose s* by the common rule."""
        verdicts = [self.verdicts(recording) for recording in recordings]
        scores = [np.nan_to_num(verdict.score[~verdict.settling]) for verdict in verdicts]
        rate, self.threshold = self.rate, common_threshold(scores, self.rate)
        while self.threshold <= 0.0 and 2.0 * rate <= self.most_silent:
            rate *= 2.0
            self.threshold = common_threshold(scores, rate)

    def judge(self, recording: WindowedEvents) -> Judged:
        return judged_of(self.verdicts(recording), recording.encoded(self._types).event_types)

    def verdicts(self, recording: WindowedEvents) -> Verdicts:
        """Return what the detector says of a recording."""
        encoded = recording.encoded(self._types)
        return self._model.judge(DEFAULT_WINDOW, self.threshold, DetectorParameters(),
                                 replace(encoded.events, event_types=()))


@dataclass
class Evidence:
    """The evidence detector (`detector: evidence`)."""

    # Publisher, topic and subscriber, as the model holds it after a training while the robot runs;
    # empty: it was trained on bags alone.
    graph: Set[Tuple[str, str, str]]
    tuning: Tuning = field(default_factory=Tuning)  # the numbers of the method
    budget: float = limits.BUDGET  # false alarms an hour that the limits allow

    def train(self, recordings: Sequence[WindowedEvents]) -> None:
        learner = Learner(self.tuning, self.graph)
        for recording in recordings:
            learner.add(recording.events)
        self._trained = learner.learn()
        for recording in recordings:
            states = [set(present) for _, present in recording.subscriptions]
            if states:  # what nodes subscribe to all the time
                self._trained.add_subscriptions(set.intersection(*states))
        self._model = EvidenceModel(self._trained)

    def calibrate(self, recordings: Sequence[WindowedEvents]) -> None:
        self._trained.calibration, = limits.find(
            self._trained, DetectorParameters().settle_time, [self.budget],
            [recording.encoded(self._trained.event_types).events for recording in recordings])

    def judge(self, recording: WindowedEvents) -> Judged:
        trained = self._trained
        return judged_of(self.verdicts(recording),
                         recording.encoded(trained.event_types).event_types)

    @property
    def expected_per_hour(self) -> Optional[float]:
        calibration = self._trained.calibration
        expected = math.nan if calibration is None else calibration.false_alarms_per_hour
        return None if math.isnan(expected) else expected

    @property
    def watched(self) -> Set[str]:
        return {each.component for each in self.coverage() if each.is_watched}

    def coverage(self) -> List[Coverage]:
        """Return what is found of each component."""
        return self._trained.coverage()

    def verdicts(self, recording: WindowedEvents) -> Verdicts:
        """Return what the detector says of a recording, suspicions included."""
        encoded = recording.encoded(self._trained.event_types)
        expected = self._trained.subscriptions
        return judge_by_evidence(
            self._trained, self._model, DetectorParameters(),
            replace(encoded.events, missing=[(stamp, expected - present)
                                             for stamp, present in encoded.subscriptions]))


def judged_of(verdicts: Verdicts, event_types: Sequence[EventType]) -> Judged:
    """Return what one of the package's detectors says of a recording as all systems do."""
    def told(found: Sequence[Alarm]) -> List[SystemAlarm]:
        return [SystemAlarm(alarm.begin, alarm.end, alarm.over,
                            list(dict.fromkeys(event_types[suspect.id].source
                                               for suspect in alarm.suspects)), alarm.evidence,
                            alarm.level, alarm.culprit, alarm.kind)
                for alarm in found]

    return Judged(verdicts.start, verdicts.settling, told(verdicts.alarms), verdicts.suspicion,
                  told(verdicts.suspicions))


class Peer:
    """A system whose windows score the largest deviation from bounds, negated; it blames whose is
    the largest. Persistence is that of all other systems. What has bounds, the topic or the event
    type itself, is what `key` returns."""

    threshold = 0.0
    expected_per_hour = None

    def __init__(self, key: Callable[[EventType], Hashable]) -> None:
        self._key = key
        self.bounds: Dict[Hashable, Any] = {}  # by topic or event type; one without is not watched
        self._sources: Dict[Hashable, Dict[str, None]] = {}  # likewise, as they came
        self._last: Optional[Tuple[WindowedEvents, np.ndarray]] = None

    @staticmethod
    def deviation(bounds: Any, stamps: np.ndarray, ends: np.ndarray) -> np.ndarray:
        """Return the deviation at some ends of windows; 0 within the bounds."""
        raise NotImplementedError

    @property
    def watched(self) -> Set[str]:
        return {source for key in self.bounds for source in self._sources[key]}

    def judge(self, recording: WindowedEvents) -> Judged:
        start, unsettled = recording.starts(), settling(recording)
        alarms = []
        for alarm in persistent(start, self.abnormal(recording) & ~unsettled):
            suspects = self._suspects(recording,
                                      int((alarm.start - start[0]) // DEFAULT_WINDOW) - 1)
            alarms.append(replace(alarm, suspects=suspects, culprit=(suspects or [''])[0]))
        return Judged(start, unsettled, alarms)

    def abnormal(self, recording: WindowedEvents) -> np.ndarray:
        return self.scores(recording) < self.threshold

    def scores(self, recording: WindowedEvents) -> np.ndarray:
        deviations = self._deviations(recording)
        return -deviations.max(axis=0) if len(deviations) else np.zeros(len(recording.starts()))

    def _suspects(self, recording: WindowedEvents, window: int) -> List[str]:
        """Return the sources of what is beyond its bounds, the furthest first."""
        deviations, keys = self._deviations(recording)[:, window], list(self.bounds)
        return list(dict.fromkeys(source for row in np.argsort(-deviations, kind='stable')
                                  if deviations[row] > 0
                                  for source in self._sources[keys[row]]))

    def _deviations(self, recording: WindowedEvents) -> np.ndarray:
        """Return the deviations, [key, window]."""
        # Every alarm of a recording asks for them again.
        if self._last is None or self._last[0] is not recording:
            ends, stamps = recording.starts() + DEFAULT_WINDOW, stamps_by(recording, self._key)
            deviations = [self.deviation(bounds, stamps.get(key, _NEVER), ends)
                          for key, bounds in self.bounds.items()]
            self._last = recording, np.array(deviations).reshape(len(deviations), len(ends))
        return self._last[1]

    def learned(self, recording: WindowedEvents) -> Dict[Hashable, np.ndarray]:
        """Return the stamps of the events by topic or event type [ns]; note their sources."""
        for event_type in recording.event_types:
            self._sources.setdefault(self._key(event_type), {})[event_type.source] = None
        return stamps_by(recording, self._key)


class FrequencyMonitor(Peer):
    """FrequencyStatus; the bounds are the fewest and the most messages in SPAN of the training.

    They are wider by one message, which may fall to either side of the end of SPAN by its phase
    alone: without that, the slowest topics decide on the threshold, and the fast ones are found a
    second later. Periodic topics of any frequency are watched, if the fewest are 2 or more. The
    share `rate` of the normal windows of the calibration are below the threshold.
    """

    def __init__(self, rate: float = FALSE_POSITIVE_RATE) -> None:
        super().__init__(lambda event_type: event_type.scope)
        self._rate = rate

    @staticmethod
    def deviation(bounds: Tuple[int, int], stamps: np.ndarray, ends: np.ndarray) -> np.ndarray:
        count, (fewest, most) = messages_in_span(stamps, ends), bounds
        return np.maximum((fewest - count) / fewest, (count - most) / most).clip(0.0)

    def train(self, recordings: Sequence[WindowedEvents]) -> None:
        """Find the periodic topics and their bounds."""
        by_topic = [self.learned(recording) for recording in recordings]
        full = []
        for recording in recordings:
            ends = recording.starts() + DEFAULT_WINDOW
            full.append(ends[(ends - SPAN >= recording.stamps[0]) & (ends <= recording.end)])
        for topic in self._sources:
            stamps = [of_recording.get(topic, _NEVER) for of_recording in by_topic]
            gaps = np.concatenate([np.diff(part) for part in stamps])
            if len(gaps) < _FEWEST_GAPS or gaps.std() > _PERIODIC * gaps.mean():
                continue
            counts = np.concatenate(list(map(messages_in_span, stamps, full)))
            if len(counts) and counts.min() > 1:
                self.bounds[topic] = counts.min() - 1, counts.max() + 1

    def calibrate(self, recordings: Sequence[WindowedEvents]) -> None:
        """Choose the threshold by the common rule."""
        self.threshold = common_threshold(
            [self.scores(each)[~settling(each)] for each in recordings], self._rate)


class GapBounds(NamedTuple):
    """What was seen of an event type: its longest gap [ns], fewest and most events in SPAN. Where
    it was never heard for as long as SPAN, the fewest are more than the most."""

    longest: float
    fewest: float
    most: float

    def deviation(self, ages: np.ndarray, counts: np.ndarray) -> np.ndarray:
        """Return by which share windows are beyond the bounds, 0 within them; by the times since
        the last event [ns], NaN without one, and the events of the last SPAN, NaN where the type
        has not been heard for so long."""
        silent = np.fmax(ages / (LONGER * self.longest) - 1.0, 0.0)
        if self.fewest > self.most:
            return silent
        fewest = min((1.0 - OUTSIDE) * self.fewest, self.fewest - 1.0)
        most = max((1.0 + OUTSIDE) * self.most, self.most + 1.0)
        return np.fmax(silent, np.fmax((fewest - counts) / max(fewest, 1.0),
                                       (counts - most) / most))


class GapMonitor(Peer):
    """The bounds of every event type that came at least twice in a recording; what lies beyond
    them is abnormal, and the calibration widens them."""

    def __init__(self) -> None:
        super().__init__(lambda event_type: event_type)

    @staticmethod
    def deviation(bounds: GapBounds, stamps: np.ndarray, ends: np.ndarray) -> np.ndarray:
        if not len(stamps):
            return np.zeros(len(ends))
        number = np.searchsorted(stamps, ends)  # of those before
        ages = np.where(number > 0, ends - stamps[number - 1], np.nan)
        return bounds.deviation(ages, _counts(stamps, ends))

    def train(self, recordings: Sequence[WindowedEvents]) -> None:
        """Find the bounds, or widen them to what further recordings of normal operation hold."""
        self._last = None
        for recording in recordings:
            ends = recording.starts() + DEFAULT_WINDOW
            for event_type, stamps in self.learned(recording).items():
                if len(stamps) < 2:
                    continue
                counts = _counts(stamps, ends[ends <= recording.end])
                counts = counts[np.isfinite(counts)]
                longest, fewest, most = self.bounds.get(event_type, (0.0, np.inf, 0.0))
                self.bounds[event_type] = GapBounds(max(longest, float(np.diff(stamps).max())),
                                                    counts.min(initial=fewest),
                                                    counts.max(initial=most))

    calibrate = train


def messages_in_span(stamps: np.ndarray, ends: np.ndarray) -> np.ndarray:
    """Return how many stamps lie in [end - SPAN, end), for every end [ns]."""
    return np.searchsorted(stamps, ends) - np.searchsorted(stamps, ends - SPAN)


def _counts(stamps: np.ndarray, ends: np.ndarray) -> np.ndarray:
    """Return the events in SPAN before some ends; NaN while SPAN holds the time before the first.
    """
    return np.where(ends - SPAN >= stamps[0], messages_in_span(stamps, ends), np.nan)
