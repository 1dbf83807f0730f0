"""The evidence of a recording, literally and slowly: docs/method.md, sections 3.2 to 3.7."""
from __future__ import annotations

from collections import defaultdict
from typing import Dict, List, Optional, Sequence, Tuple

from reference_evidence import DELAYS, MS, SECOND, Event, ReferenceModel, Track

ARMING_EVENTS = 30
MOST_FAILURES = 10
USUAL_SURPRISE = 0.3
USUAL_MISSES = 0.15
GONE_GAPS = 5
MOST_BEHIND = 3.0
"""Mean gaps."""
MOST_EVIDENCE = 200.0
MOST_OF_LIMIT = 1.5
ACCEPT_AFTER = 60 * SECOND
START_TIME = 60 * SECOND
REGIME = 120 * SECOND
SHORTEST_STALL = 50 * MS
LONGEST_STALL = 700 * MS
BETWEEN_STALLS = 30 * SECOND


class Arming:
    """Whether events have once been as in training; every failure doubles what that takes."""

    def __init__(self) -> None:
        self.failures = 0
        self.armed = False
        self._excesses: List[float] = []

    def add(self, excess: float, usual: float) -> None:
        """Add an event whose excess over training is usual up to a mean."""
        if self.armed:
            return
        self._excesses.append(excess)
        needed = ARMING_EVENTS * 2 ** min(self.failures, MOST_FAILURES)
        if len(self._excesses) == needed:
            self.armed = sum(self._excesses) <= usual * needed
            self.failures += not self.armed
            self._excesses = []

    def disarm(self) -> None:
        """Begin again."""
        self.armed = False
        self._excesses = []


class Watch:
    """The sums of a pair or of an answer."""

    def __init__(self, caps: Sequence[float]) -> None:
        self.caps = list(caps)
        self.sums = [0.0] * len(caps)
        self.arming = Arming()
        self.regime = 0.0
        self.owed = 0.0
        self.asked_at: Optional[int] = None  # since it was disarmed
        self.seen = 0
        self.abnormal_since: Optional[int] = None

    def add(self, steps: Sequence[float]) -> None:
        """Add to the sums, which stay between 0 and their caps."""
        self.sums = [min(max(value + step, 0.0), cap)
                     for value, step, cap in zip(self.sums, steps, self.caps)]

    def disarm(self) -> None:
        """Forget the sums, but not how often arming failed."""
        self.sums = [0.0] * len(self.caps)
        self.arming.disarm()
        self.regime = self.owed = 0.0
        self.asked_at = self.abnormal_since = None

    def is_abnormal(self) -> bool:
        """Whether one of the sums is above its limit."""
        return self.arming.armed and any(value * MOST_OF_LIMIT > cap
                                         for value, cap in zip(self.sums, self.caps))


class ReferenceScorer:
    """Evidence of one recording: `rows` holds that of all tracks for every window.

    Args:
        model: that judges.
        events: of the recording.
        window: [ns].
        limits: of the tracks; none: not known.
    """

    def __init__(self, model: ReferenceModel, events: Sequence[Event], window: int,
                 limits: Sequence[float] = ()) -> None:
        self._model = model
        self._window = window
        self._has_limits = bool(limits)
        self._caps = {track: MOST_OF_LIMIT * limit
                      for track, limit in zip(model.tracks, limits) if limit > 0.0}
        self._last: Dict[str, Tuple[int, int]] = {}  # stamp and number of the event
        self._first_stamps: Dict[str, int] = {}
        self._number: Dict[str, int] = defaultdict(int)  # of events, by type
        self._behind: Dict[str, float] = defaultdict(float)  # [ns]
        self._in_window: Dict[str, List[int]] = defaultdict(list)
        self._requests: Dict[Track, List[int]] = defaultdict(list)  # without an answer
        self._pairs = {track[1:]: Watch([self._cap((channel, *track[1:])) for channel in DELAYS])
                       for track in model.tracks if track[0] == 'delay'}
        self._answers = {track[1:]: Watch([self._cap(track)])
                         for track in model.tracks if track[0] == 'answer'}
        self._usual_silence = max(model.longest_silence * 5 // 4, SHORTEST_STALL)
        self._start: Optional[int] = None  # the first event
        self._newest: Optional[int] = None
        self._stall: Optional[Tuple[int, int]] = None  # the last one that is over
        self.rows: List[List[float]] = []
        self._first = index = events[0][0] // window
        for number, (t, kind) in enumerate(events):
            while (index + 1) * window <= t:
                self.rows.append(self._row(index))
                index += 1
            if kind in model.types:
                self._start = t if self._start is None else self._start
                self._note_stall(t)
                self._add(t, kind)
                self._last[kind] = (t, number)
                self._first_stamps.setdefault(kind, t)
                self._number[kind] += 1
                self._in_window[kind].append(index)
        self.rows.append(self._row(index))

    def _cap(self, track: Track) -> float:
        return self._caps.get(track, MOST_EVIDENCE)

    def _note_stall(self, t: int) -> None:
        if self._newest is not None:
            silence = t - self._newest
            if (self._usual_silence < silence <= LONGEST_STALL
                    and (self._stall is None or t - self._stall[1] > BETWEEN_STALLS)):
                self._stall = (self._newest, t)
        self._newest = max(t, self._newest or t)

    def _has_waited(self, t: int) -> bool:
        """Return whether what comes now may have waited for the end of a stall."""
        return self._stall is not None and t < 2 * self._stall[1] - self._stall[0]

    def _add(self, t: int, kind: str) -> None:
        own = self._last.get(kind)
        catches_up = own is not None and self._catches_up(t - own[0], kind)
        for (to, other), pair in self._pairs.items():
            if to == kind:
                self._add_delay(pair, t, to, other, catches_up)
        for (to, other), answer in self._answers.items():
            if other == kind:
                self._ask(answer, t, ('answer', to, other))
        for track in self._model.tracks:
            if track[0] == 'deadline':
                if track[1] == kind:
                    self._requests[track] = []
                if track[2] == kind:
                    self._requests[track].append(t)
        if own is not None and t - own[0] > GONE_GAPS * self._model.longest[kind]:
            for watched in (self._pairs, self._answers):
                for types, watch in watched.items():
                    if kind in types:
                        watch.disarm()

    def _catches_up(self, gap: int, kind: str) -> bool:
        """Return whether a gap is short because the type was behind its mean gaps."""
        mean = self._model.both.mean_gap(kind)
        catches_up = mean - 2 * self._behind[kind] < gap < mean
        self._behind[kind] = min(max(self._behind[kind] + gap - mean, 0.0), MOST_BEHIND * mean)
        return catches_up

    def _add_delay(self, pair: Watch, t: int, to: str, other: str, catches_up: bool) -> None:
        own, before = self._last.get(to), self._last.get(other)
        if before is None or (own is not None and before[1] < own[1]):
            return
        surprise = self._model.surprise(('delay', to, other), t - before[0])
        if not self._has_waited(t):
            sign = -1.0 if to == other and catches_up and surprise > 0.0 else 1.0
            pair.add([sign * (surprise - max(pair.regime, 0.0) - drift)
                      for drift in DELAYS.values()])
            elapsed = min(max(t - own[0], 0), REGIME) if own is not None else 0
            pair.regime += (surprise - pair.regime) * elapsed / REGIME
        if to == other and pair.arming.failures == 0:
            pair.arming.armed = True
        else:
            pair.arming.add(surprise, USUAL_SURPRISE)

    def _ask(self, answer: Watch, t: int, track: Track) -> None:
        asked_at, number = answer.asked_at, self._number[track[1]]
        if asked_at is not None and t - asked_at < self._model.usual_answer(track):
            return
        came = number - answer.seen
        answer.asked_at, answer.seen = t, number
        if asked_at is None or number == 0:
            return
        late = min(came - 1.0, answer.owed) if came else 0.0
        answer.owed += -late if came else 1.0
        answer.add([self._model.answer_step(track, False)
                    - late * self._model.answer_step(track, True) if came
                    else self._model.answer_step(track, True)])
        answer.arming.add((-late if came else 1.0) - self._model.usual_misses(track),
                          USUAL_MISSES)

    def _accept(self, end: int) -> None:
        for watched, must_come in ((self._pairs, False), (self._answers, True)):
            for (to, _), watch in watched.items():
                since = watch.abnormal_since
                if not watch.is_abnormal():
                    watch.abnormal_since = None
                elif since is None:
                    watch.abnormal_since = end
                elif end - since >= ACCEPT_AFTER and (not must_come
                                                      or self._last[to][0] > since):
                    watch.arming.failures += 1
                    watch.disarm()

    def _row(self, index: int) -> List[float]:
        end = (index + 1) * self._window
        if self._has_limits:
            self._accept(end)
        silence = end - self._newest if self._newest is not None else 0
        stall = silence if self._usual_silence < silence <= LONGEST_STALL else 0
        stalled = stall > 0 or self._has_waited(end - 2 * SECOND)
        return [self._evidence(track, index, end, stall, stalled)
                for track in self._model.tracks]

    def _evidence(self, track: Track, index: int, end: int, stall: int, stalled: bool) -> float:
        channel, kind, other = track
        last = self._last.get(kind)
        if last is None and (channel != 'deadline' or self._start is None
                             or end - self._start < START_TIME):
            return 0.0
        if channel == 'deadline':
            requests = self._requests[track]
            if self._model.counts_requests(track):
                return float(len(requests))
            return (end - requests[0]) / SECOND if requests else 0.0
        assert last is not None
        if channel == 'overdue':
            if not stall and self._stall is not None and last[0] <= self._stall[0]:
                stall = self._stall[1] - self._stall[0]
            return self._model.overdue(kind, max(end - last[0] - stall, 0))
        if channel in ('fewer', 'more'):
            span = max(2 * SECOND // self._window, 1)
            if (stalled or index - self._first + 1 < span
                    or end - self._first_stamps[kind] < 2 * SECOND):
                return 0.0
            more = self._model.rate(kind, sum(n > index - span for n in self._in_window[kind]))
            return max(more if channel == 'more' else -more, 0.0)
        watch = self._pairs[kind, other] if channel in DELAYS else self._answers[kind, other]
        value = watch.sums[list(DELAYS).index(channel) if channel in DELAYS else 0]
        return value if watch.arming.armed else 0.0
