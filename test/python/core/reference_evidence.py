"""The evidence detector, literally and slowly: docs/method.md, sections 3 and 4, and the headers.

Nothing here is shared with the package: it is what the core is compared with. Stamps in ns. An
event type is a letter, a track a triple (channel, to, from).
"""
from __future__ import annotations

import math
from collections import defaultdict
from typing import Dict, Iterable, List, Sequence, Tuple

Event = Tuple[int, str]
Pair = Tuple[str, str]
Track = Tuple[str, str, str]

SECOND = 10 ** 9
EDGES = [round(2.5e6 * 2.0 ** (k / 4)) for k in range(49)]
BINS = 50
DELAYS = {'delay': 1.0, 'slow delay': 0.5}
"""Channels of delays, and what usual delays take from their sum."""
KINDS = {'overdue': 'overdue', 'fewer': 'rate', 'more': 'rate', 'delay': 'pairs',
         'slow delay': 'pairs', 'answer': 'answers'}
"""What people call the channels."""


def log_bin(delay: int) -> int:
    """Return the bin: the number of edges at or below the delay."""
    return sum(edge <= delay for edge in EDGES)


def middle(index: int) -> float:
    """Return what stands for the delays in a bin."""
    if index == 0:
        return EDGES[0] / 2
    return math.sqrt(EDGES[index - 1] * EDGES[index]) if index < BINS - 1 else EDGES[-1]


def log_probabilities(bins: Sequence[int]) -> List[float]:
    """Return log P of every bin, with one more count in each."""
    return [math.log((bins.count(index) + 1) / (len(bins) + BINS)) for index in range(BINS)]


class Counts:
    """What was seen in recordings, as lists."""

    def __init__(self, recordings: Iterable[Sequence[Event]], types: Sequence[str],
                 window: int) -> None:
        self.types = types
        self.gaps: Dict[str, List[int]] = defaultdict(list)
        self.delays: Dict[Pair, List[int]] = defaultdict(list)
        self.answers: Dict[Pair, int] = defaultdict(int)
        self.rates: Dict[str, List[int]] = defaultdict(list)
        self.duration = 0
        for events in recordings:
            self._count_delays(events)
            self._count_answers(events)
            self._count_rates(events, window)
            self.duration += max(t for t, _ in events) - events[0][0]

    def _count_delays(self, events: Sequence[Event]) -> None:
        last: Dict[str, int] = {}
        for t, kind in events:
            for other, before in last.items():
                self.delays[other, kind].append(log_bin(t - before))
            if kind in last:
                self.gaps[kind].append(max(t - last[kind], 0))
            last[kind] = t

    def _count_answers(self, events: Sequence[Event]) -> None:
        for kind in self.types:
            own = [n for n, (_, other) in enumerate(events) if other == kind]
            for begin, end in zip(own, own[1:]):
                for answer in {other for _, other in events[begin + 1:end]}:
                    self.answers[kind, answer] += 1

    def _count_rates(self, events: Sequence[Event], window: int) -> None:
        # A late event counts in the window that is open.
        newest, windows_of = events[0][0], []
        for t, kind in events:
            newest = max(newest, t)
            windows_of.append((newest // window, kind))
        span = max(2 * SECOND // window, 1)
        for last in range(events[0][0] // window + span - 1, newest // window):
            inside = [kind for index, kind in windows_of if last - span < index <= last]
            for kind in self.types:
                self.rates[kind].append(inside.count(kind))

    def miss_rate(self, asking: str, answer: str) -> float:
        """Return the share of the gaps of `asking` without the other."""
        gaps = len(self.gaps[asking])
        return (gaps - self.answers[asking, answer] + 0.5) / (gaps + 1)

    def mean_gap(self, kind: str) -> float:
        """Return the mean gap [ns]."""
        return sum(self.gaps[kind]) / len(self.gaps[kind])


def gain(learned: Counts, measured: Counts, e_i: str, e_j: str) -> float:
    """Return the mean of log P_ij - log Q_i over the delays of other recordings [nat]."""
    delays = measured.delays[e_i, e_j]
    if not learned.delays[e_i, e_j] or len(delays) < 50:
        return 0.0
    p_ij = log_probabilities(learned.delays[e_i, e_j])
    q_i = log_probabilities([b for k in learned.types for b in learned.delays[e_i, k]])
    return math.fsum(p_ij[b] - q_i[b] for b in delays) / len(delays)


class ReferenceModel:
    """What normal operation lets expect.

    Args:
        first, second: counts of the two halves of the training.
        both: counts of all of it.
        learned: those that probabilities are taken from.
    """

    def __init__(self, first: Counts, second: Counts, both: Counts, learned: Counts) -> None:
        self.both = both
        self.learned = learned
        self.types = both.types
        self._halves = (first, second)
        self.gains = {(i, j): (gain(first, second, i, j) + gain(second, first, i, j)) / 2
                      for i in self.types for j in self.types}
        self.tracks: List[Track] = []
        for kind in self.types:
            if len(both.gaps[kind]) >= 30:
                often = sum(both.rates[kind]) >= 1.5 * len(both.rates[kind])
                self.tracks += [(channel, kind, kind) for channel in
                                (('overdue', 'fewer', 'more') if often else ('overdue',))]
        for kind in self.types:
            self.tracks += [(channel, kind, other) for other in self._predecessors(kind)
                            for channel in DELAYS]
        for kind in self.types:
            self.tracks += [('answer', kind, other) for other in self._asking(kind)]
        self.longest = {kind: max(both.gaps[kind], default=0) for kind in self.types}
        self._gaps = {kind: self._binned(learned.gaps[kind]) for kind in self.types}
        self._surprises = {track: self._standardised(track[2], track[1])
                           for track in self.tracks if track[0] in DELAYS}

    def _predecessors(self, e_j: str) -> List[str]:
        good = [i for i in self.types
                if self.gains[i, e_j] >= 0.3 and len(self.both.delays[i, e_j]) >= 200]
        return sorted(good, key=lambda i: -self.gains[i, e_j])[:3]

    def _asking(self, answer: str) -> List[str]:
        def time_of_a_miss(kind: str) -> float:
            return self.both.mean_gap(kind) / (1 - self.both.miss_rate(kind, answer))

        return sorted([kind for kind in self.types
                       if kind != answer and len(self.both.gaps[kind]) >= 100
                       and len(self.both.gaps[answer]) >= 100
                       and self.both.miss_rate(kind, answer) <= 0.6
                       and self.gains[answer, kind] <= self.gains[kind, answer] + 0.3],
                      key=time_of_a_miss)[:8]

    def _standardised(self, e_i: str, e_j: str) -> List[float]:
        first, second = (half.delays[e_i, e_j] for half in self._halves)
        held_out: List[float] = []
        if first and second:
            for learned, measured in ((first, second), (second, first)):
                logs = log_probabilities(learned)
                held_out += [-logs[b] for b in measured]
        mean = math.fsum(held_out) / len(held_out) if held_out else 0.0
        variance = (math.fsum((s - mean) ** 2 for s in held_out) / len(held_out)
                    if held_out else 0.0)
        return [min((-log - mean) / max(math.sqrt(variance), 0.5), 6.0)
                for log in log_probabilities(self.learned.delays[e_i, e_j])]

    @staticmethod
    def _binned(gaps: Sequence[int]) -> List[float]:
        longest = max(gaps, default=0)
        return [min(middle(log_bin(gap)), longest) for gap in gaps]

    def overdue(self, kind: str, age: float) -> float:
        """Return -log of the probability of such an age at a random moment."""
        gaps = self._gaps[kind]
        if not gaps:
            return 0.0
        longest = max(self.learned.gaps[kind])
        left = math.fsum(gap - age for gap in gaps if gap > age)
        if left == 0.0:  # the same, but the exponential would underflow
            return math.log(math.fsum(gaps) + longest) - math.log(longest) + age / longest
        return -math.log((left + longest * math.exp(-age / longest))
                         / (math.fsum(gaps) + longest))

    def rate(self, kind: str, count: int) -> float:
        """Return how many spreads more than usual came in 2 s."""
        counts = self.learned.rates[kind]
        mean = sum(counts) / max(len(counts), 1)
        variance = sum((n - mean) ** 2 for n in counts) / max(len(counts), 1)
        return (count - mean) / math.sqrt(variance + min(1.0, mean / 4) + 0.25)

    def surprise(self, track: Track, delay: int) -> float:
        """Return how unusual a delay is [standard deviations]."""
        return self._surprises[track][log_bin(delay)]

    def usual_misses(self, track: Track) -> float:
        """Return the share of answers that are usually left out."""
        return min(max(self.learned.miss_rate(track[2], track[1]), 0.1), 0.95)

    def answer_step(self, track: Track, missed: bool) -> float:
        """Return the log-likelihood ratio of half of the answers being taken away."""
        usual = self.usual_misses(track)
        faulty = usual + (1 - usual) / 2
        return math.log(faulty / usual if missed else (1 - faulty) / (1 - usual))


class Cusum:
    """A sum from 0 to a cap that counts once events were as in training."""

    def __init__(self, cap: float) -> None:
        self.sum = 0.0
        self._cap = cap
        self._armed = False
        self._excesses: List[float] = []

    def add(self, step: float, excess: float, usual: float) -> None:
        """Add an event whose excess over training is usual up to a mean."""
        self.sum = min(max(self.sum + step, 0.0), self._cap)
        self._excesses.append(excess)
        if len(self._excesses) == 30:
            self._armed = self._armed or sum(self._excesses) / 30 <= usual
            self._excesses = []

    @property
    def evidence(self) -> float:
        """The sum, once armed."""
        return self.sum if self._armed else 0.0


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
        self._last: Dict[str, Tuple[int, int]] = {}  # stamp and number of the event
        self._in_window: Dict[str, List[int]] = defaultdict(list)
        self._caps = {track: 1.5 * limit for track, limit in zip(model.tracks, limits)
                      if limit > 0.0}
        self._sums = {track: self._cusum(track) for track in model.tracks}
        self.rows: List[List[float]] = []
        self._first = index = events[0][0] // window
        for number, (t, kind) in enumerate(events):
            while (index + 1) * window <= t:
                self.rows.append(self._row(index))
                index += 1
            if kind in model.types:
                self._add(t, kind)
                self._last[kind] = (t, number)
                self._in_window[kind].append(index)
        self.rows.append(self._row(index))

    def _cusum(self, track: Track) -> Cusum:
        return Cusum(self._caps.get(track, 200.0))

    def _add(self, t: int, kind: str) -> None:
        own = self._last.get(kind)
        for track in self._model.tracks:
            channel, to, other = track
            if channel in DELAYS and to == kind:
                before = self._last.get(other)
                if before is not None and (own is None or before[1] >= own[1]):
                    surprise = self._model.surprise(track, t - before[0])
                    self._sums[track].add(surprise - DELAYS[channel], surprise, 0.3)
            if channel == 'answer' and other == kind:
                answer = self._last.get(to)
                if own is not None and answer is not None:
                    missed = answer[1] < own[1]
                    self._sums[track].add(self._model.answer_step(track, missed),
                                          missed - self._model.usual_misses(track), 0.15)
        if own is not None and t - own[0] > 5 * self._model.longest[kind]:
            for track in self._model.tracks:
                if kind in track[1:]:
                    self._sums[track] = self._cusum(track)

    def _row(self, index: int) -> List[float]:
        end = (index + 1) * self._window
        span = max(2 * SECOND // self._window, 1)
        row = []
        for track in self._model.tracks:
            channel, kind, _ = track
            last = self._last.get(kind)
            value = 0.0
            if channel == 'overdue' and last is not None:
                value = self._model.overdue(kind, max(end - last[0], 0))
            elif channel in ('fewer', 'more'):
                if last is not None and index - self._first + 1 >= span:
                    count = sum(n > index - span for n in self._in_window[kind])
                    more = self._model.rate(kind, count)
                    value = max(more if channel == 'more' else -more, 0.0)
            elif channel in DELAYS or channel == 'answer':
                value = self._sums[track].evidence
            row.append(value)
        return row
