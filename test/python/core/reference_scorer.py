"""The evidence of a recording, literally and slowly: docs/method.md, section 3."""
from __future__ import annotations

import math
from collections import defaultdict
from typing import Dict, List, Optional, Sequence, Tuple

from reference_evidence import (BETWEEN_STALLS, LABELS, LONGEST_STALL_OF_TRAINING, MS, SECOND,
                                SHORTEST_STALL, USUAL, Event, ReferenceModel, Track, is_mode)

ARMING_EVENTS = 30
MOST_FAILURES = 10
GONE_GAPS = 5
LATE = 2 ** 0.25  # mean gaps: a bin
MOST_BEHIND = 2.0 * SECOND
MOST_EVIDENCE = 200.0
MOST_OF_LIMIT = 1.5
ACCEPT_AFTER = 60 * SECOND
NEWS = 3  # windows
START_TIME = 60 * SECOND
LONGEST_STALL = 700 * MS


class Arming:
    """Whether events have once been as in training; every failure doubles what that takes."""

    def __init__(self) -> None:
        self.failures = 0
        self.armed = False
        self._excess: List[float] = []

    def add(self, excess: float) -> None:
        """Add an event, by what it adds to the sum beyond what is as in training."""
        if self.armed:
            return
        self._excess.append(excess)
        needed = ARMING_EVENTS * 2 ** min(self.failures, MOST_FAILURES)
        if len(self._excess) == needed:
            self.armed = sum(self._excess) <= 0.0
            self.failures += not self.armed
            self._excess = []

    def disarm(self) -> None:
        """Begin again."""
        self.armed = False
        self._excess = []


class Watch:
    """The sum of what the events of a track say."""

    def __init__(self, cap: float) -> None:
        self.cap = cap
        self.sum = 0.0
        self.arming = Arming()
        self.behind = 0.0  # [ns]
        self.since = 0  # of delays: the first one since the sum was 0
        self.gaps, self.lasted = 0, 0  # since the sum was 0 [ns]
        self.abnormal_since: Optional[int] = None
        self.abnormal_windows = 0

    def add(self, step: float) -> None:
        """Add to the sum, which stays between 0 and its cap."""
        self.sum = min(max(self.sum + step, 0.0), self.cap)

    def disarm(self) -> None:
        """Forget the sum, but not how often arming failed."""
        self.sum = 0.0
        self.arming.disarm()
        self.abnormal_since = None
        self.abnormal_windows = 0

    def is_abnormal(self) -> bool:
        """Whether the sum is above its limit."""
        return self.arming.armed and self.sum * MOST_OF_LIMIT > self.cap


class ReferenceScorer:
    """Evidence of one recording: `rows` holds that of all tracks for every window.

    It also counts the stalls of the whole robot, and how often what was armed failed.

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
        self._requests: Dict[Track, List[int]] = defaultdict(list)  # without an answer
        self._told: List[Tuple[int, str]] = []  # modes
        self._watches = {track: Watch(self._caps.get(track, MOST_EVIDENCE))
                         for track in model.tracks if LABELS[track[0]] in ('pairs', 'pace')}
        self._misses = {track: Watch(self._caps.get(track, MOST_EVIDENCE))
                        for track in model.tracks
                        if track[0] == 'deadlines' and model.counts_requests(track)}
        self._usual_silence = max(model.both.longest_silence * 5 // 4, SHORTEST_STALL)
        self._longest_stall = max(LONGEST_STALL, min(model.both.longest_stall * 5 // 4,
                                                     LONGEST_STALL_OF_TRAINING))
        self._start: Optional[int] = None  # the first event
        self._newest: Optional[int] = None
        self._stall: Optional[Tuple[int, int]] = None  # the last one that is over
        self.stalls = 0
        self.failed = 0
        self.rows: List[List[float]] = []
        index = events[0][0] // window
        for number, (t, kind) in enumerate(events):
            while (index + 1) * window <= t:
                self.rows.append(self._row(index))
                index += 1
            if kind in model.types:
                self._start = t if self._start is None else self._start
                self._note_stall(t)
                if is_mode(kind):
                    self._told.append((t, kind))
                    continue
                self._add(t, kind)
                self._last[kind] = (t, number)
        self.rows.append(self._row(index))

    def _note_stall(self, t: int) -> None:
        if self._newest is not None:
            silence = t - self._newest
            if (self._usual_silence < silence <= self._longest_stall
                    and (self._stall is None or t - self._stall[1] > BETWEEN_STALLS)):
                self._stall = (self._newest, t)
                self.stalls += 1
                for watch in self._watches.values():
                    watch.disarm()
        self._newest = max(t, self._newest or t)

    def _has_waited(self, t: int) -> bool:
        """Return whether what comes now may have waited for the end of a stall."""
        return self._stall is not None and t < 2 * self._stall[1] - self._stall[0]

    def _add(self, t: int, kind: str) -> None:
        own = self._last.get(kind)
        for track, watch in self._watches.items():
            if track[1] == kind and track[0] == 'pairs':
                self._add_delay(watch, t, track)
            elif track[1] == kind and own is not None:
                self._add_gap(watch, t - own[0], track,
                              t == own[0] or self._has_waited(t))
        for track in self._model.tracks:
            if track[0] in ('deadlines', 'company'):
                if track[1] == kind:
                    self._answer(track)
                if track[2] == kind and not self._has_waited(t):  # never a mode
                    self._ask(t, track)
        if own is not None and t - own[0] > GONE_GAPS * self._model.longest[kind]:
            for track, watch in self._watches.items():
                if kind in track[1:]:
                    watch.disarm()

    def _answer(self, track: Track) -> None:
        if track in self._misses:
            self._misses[track].add(-math.log(2.0) if self._requests[track]
                                    else -self._model.step_of_miss(track))
        self._requests[track] = []

    def _ask(self, t: int, track: Track) -> None:
        channel, to, other = track
        requests, last = self._requests[track], self._last.get(to)
        if channel == 'deadlines':
            usual = int(SECOND * self._model.both.usual_delay(other, to, 0.95))
            if track not in self._misses:
                if last is not None and t - last[0] < usual:
                    return
            elif requests and last is not None and t - requests[-1] >= usual:
                self._misses[track].add(self._model.step_of_miss(track))
        requests.append(t)

    def _add_gap(self, watch: Watch, gap: int, track: Track, waited: bool) -> None:
        step = self._model.step(track, gap)
        mean = self._model.both.mean_gap(track[1])
        catches_up = step > 0.0 and gap < mean and watch.behind > 0.0
        watch.behind = (min(max(watch.behind + gap - mean, 0.0), MOST_BEHIND)
                        if catches_up or gap > LATE * mean else 0.0)
        step = 0.0 if catches_up or waited else step
        if watch.sum <= 0.0:
            watch.gaps, watch.lasted = 0, 0
        watch.gaps += 1
        watch.lasted += gap
        watch.add(step)

    def _add_delay(self, watch: Watch, t: int, track: Track) -> None:
        _, to, other = track
        own, before = self._last.get(to), self._last.get(other)
        if before is None or (own is not None and before[1] < own[1]):
            return
        if self._has_waited(t):
            return
        step = self._model.step(track, t - before[0])
        watch.since = t if watch.sum <= 0.0 else watch.since
        watch.add(step)
        watch.arming.add(step - USUAL * self._model.usual(track))

    def _fail(self, end: int) -> None:
        for track, watch in self._watches.items():
            if LABELS[track[0]] != 'pairs':
                continue
            if watch.is_abnormal():
                watch.abnormal_windows += 1
                if watch.abnormal_since is None:
                    watch.abnormal_since = end
            if watch.abnormal_since is None:
                continue
            calm = watch.sum <= 0.0
            if calm and watch.abnormal_windows < NEWS:
                watch.abnormal_since = None
                watch.abnormal_windows = 0
            elif calm or end - watch.abnormal_since >= ACCEPT_AFTER:
                watch.arming.failures += 1
                watch.disarm()
                self.failed += 1

    def _row(self, index: int) -> List[float]:
        end = (index + 1) * self._window
        slow = [watch for track, watch in self._watches.items() if track[0] == 'pairs'
                and watch.sum * MOST_OF_LIMIT <= watch.cap and end - watch.since > ACCEPT_AFTER]
        if self._has_limits:
            self._fail(end)
        for watch in slow:
            watch.sum = 0.0
        silence = end - self._newest if self._newest is not None else 0
        stall = silence if self._usual_silence < silence <= self._longest_stall else 0
        stalled = stall > 0 or self._has_waited(end - 2 * SECOND)
        return [self._evidence(track, end, stall, stalled)
                for track in self._model.tracks]

    def _lasted(self, mode: str, since: int, end: int) -> int:
        """Return how long a mode has lasted."""
        begins = [t for t, _ in self._told] + [end]
        return sum(max(min(after, end) - max(begin, since), 0)
                   for (begin, kind), after in zip(self._told, begins[1:]) if kind == mode)

    def _stood_still(self, since: int, stall: int, stalled: bool) -> int:
        """Return how long the whole robot did."""
        if stalled and not stall and self._stall is not None and since <= self._stall[0]:
            return self._stall[1] - self._stall[0]
        return stall

    def _evidence(self, track: Track, end: int, stall: int, stalled: bool) -> float:
        channel, kind, other = track
        last = self._last.get(kind)
        if is_mode(other):
            since = last[0] if last is not None else self._start
            if since is None or (last is None and end - since < START_TIME):
                return 0.0
            return max(self._lasted(other, since, end)
                       - self._stood_still(since, stall, stalled), 0) / SECOND
        if track in self._misses:
            return self._misses[track].sum
        if channel in ('deadlines', 'company'):
            started = self._start is not None and end - self._start >= START_TIME
            requests = self._requests[track]
            owes = last is not None or (channel == 'company' and started)
            if not requests or not owes:
                return 0.0
            return (float(len(requests))
                    if channel == 'company' else (end - requests[0]) / SECOND)
        if last is None:
            return 0.0
        if channel == 'overdue':
            stood_still = self._stood_still(last[0], stall, stalled)
            return max(end - last[0] - stood_still, 0) / SECOND
        watch = self._watches[track]
        if LABELS[channel] == 'pace':
            is_other = self._model.is_other_rate(track, watch.gaps, watch.lasted)
            return watch.sum if is_other else 0.0
        return watch.sum if watch.arming.armed else 0.0
