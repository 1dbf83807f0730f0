"""The evidence detector, literally and slowly: docs/method.md, section 3, and the headers.

Nothing here is shared with the package: it is what the core is compared with. Stamps in ns. An
event type is a letter, a mode of the robot a small one, a track a triple (channel, to, from).
"""
from __future__ import annotations

import math
from collections import defaultdict
from functools import cached_property, lru_cache
from typing import Dict, Iterable, List, Optional, Sequence, Tuple

Event = Tuple[int, str]
Pair = Tuple[str, str]
Track = Tuple[str, str, str]

SECOND = 10 ** 9
MS = 10 ** 6
EDGES = [round(2.5e6 * 2.0 ** (k / 4)) for k in range(49)]
BINS = 50
LABELS = {'overdue': 'overdue', 'slower': 'pace', 'faster': 'pace', 'pairs': 'pairs',
          'deadlines': 'deadlines', 'company': 'company'}
"""What people call the channels."""

RARE_MISSES = 0.02

USUAL = 0.9
LEAST_EFFECT = 5e6  # on delays, by default [ns]
LEAST_SUM = 9.0
OTHER_PACES = {'slower': {2: 1 / 2, 4: 1 / 2},
               'faster': {2: 1 / 3, 4: 1 / 3, **{bins: 1 / 132 for bins in range(5, 49)}}}
"""Their shares, by how many bins gaps are longer or shorter."""
LONGEST_GAP_OF_SERIES = 2 * SECOND
SHORTEST_STALL = 50 * MS
LONGEST_STALL_OF_TRAINING = 2 * SECOND
BETWEEN_STALLS = 30 * SECOND


def is_mode(kind: str) -> bool:
    """Return whether the event type is a mode: its event says that it begins."""
    return kind.islower()


def with_ticks(events: Sequence[Event]) -> List[Event]:
    """Return the events with those of modes in place of what tells them: one a second."""
    found: List[Event] = []
    lasted: Dict[str, int] = defaultdict(int)  # before the mode that lasts began
    ticks: Dict[str, int] = defaultdict(int)
    mode, since = '', 0

    def tick(now: int) -> None:
        while mode and since + ticks[mode] * SECOND - lasted[mode] <= now:
            found.append((since + ticks[mode] * SECOND - lasted[mode], mode))
            ticks[mode] += 1

    for t, kind in events:
        tick(t - 1 if is_mode(kind) else t)
        if not is_mode(kind):
            found.append((t, kind))
            continue
        if kind != mode:
            lasted[mode] += max(t - since, 0)
            mode, since = kind, t
        tick(t)
    return found


def log_bin(delay: int) -> int:
    """Return the bin: the number of edges at or below the delay."""
    return sum(edge <= delay for edge in EDGES)


def lower_edge(index: int) -> float:
    """Return where a bin begins; where the one after the last does: nowhere."""
    if index == BINS:
        return math.inf
    return float(EDGES[index - 1]) if index > 0 else 0.0


def numbers_below(bins: Sequence[int]) -> List[int]:
    """Return the number of delays below every bin."""
    counts = [bins.count(index) for index in range(BINS)]
    return [sum(counts[:index]) for index in range(BINS)]


def bin_at_most(bins: Sequence[int], number: float) -> int:
    """Return the last bin that so many delays at most are below."""
    return max(index for index, below in enumerate(numbers_below(bins)) if below <= number)


def bin_below(bins: Sequence[int], number: float) -> int:
    """Return the last bin that fewer delays are below; -1: there is none."""
    return max((index for index, below in enumerate(numbers_below(bins)) if below < number),
               default=-1)


def usual_bins(bins: Sequence[int]) -> Tuple[int, int]:
    """Return the first and the last bin of the usual delays; the last is -1 if there is none."""
    return (bin_at_most(bins, (1 - USUAL) / 2 * len(bins)),
            bin_below(bins, (1 + USUAL) / 2 * len(bins)))


def probabilities(bins: Sequence[int]) -> List[float]:
    """Return P of every bin, with half a count more in each."""
    return [(bins.count(index) + 0.5) / (len(bins) + 0.5 * BINS) for index in range(BINS)]


def stalls_of(pieces: Sequence[Sequence[Event]]) -> List[Dict[int, int]]:
    """Return how long the machine stood still [ns] before events, by their place.

    Args:
        pieces: of a recording, cut where the clock was set.
    """
    stamps = [[t for t, _ in events] for events in pieces]
    silences = [{n: own[n] - max(own[:n]) for n in range(1, len(own))} for own in stamps]
    often = sum(max(own) - own[0] for own in stamps) // BETWEEN_STALLS
    usual = (sorted((silence for each in silences for silence in each.values()), reverse=True)
             + [0] * (often + 1))[often]
    stalls: List[Dict[int, int]] = []
    for own, own_silences in zip(stamps, silences):
        stalls.append({})
        for n, silence in own_silences.items():
            alone = all(own[n] - own[other] > BETWEEN_STALLS for other in stalls[-1])
            if (alone and SHORTEST_STALL < silence <= LONGEST_STALL_OF_TRAINING
                    and silence > usual * 5 // 4):
                stalls[-1][n] = silence
    return stalls


class Counts:
    """What was seen in recordings, as lists.

    Args:
        recordings: their events.
        types: event types.
        window: in which rates are counted [ns].
        stalls: of the recordings, as stalls_of() returns them; None: what it returns.
    """

    def __init__(self, recordings: Iterable[Sequence[Event]], types: Sequence[str], window: int,
                 stalls: Optional[Sequence[Dict[int, int]]] = None) -> None:
        self.types = types
        self.gaps: Dict[str, List[int]] = defaultdict(list)
        self.delays: Dict[Pair, List[int]] = defaultdict(list)
        self.answers: Dict[Pair, int] = defaultdict(int)
        self.rates: Dict[str, List[int]] = defaultdict(list)
        self.longest_silence = self.longest_stall = 0  # [ns]
        for place, events in enumerate(recordings):
            stood_still = stalls_of([events])[0] if stalls is None else stalls[place]
            ran = [(t - sum(length for before, length in stood_still.items() if before <= n), kind)
                   for n, (t, kind) in enumerate(events)]
            self.longest_silence = max(self.longest_silence, longest_gap([t for t, _ in ran]))
            self.longest_stall = max(self.longest_stall, *stood_still.values(), 0)
            ticking = with_ticks(ran)
            self._count_delays(ticking)
            self._count_answers(ticking)
            self._count_rates(ran, window, {n: (ran[n - 1][0], length)
                                            for n, length in stood_still.items()})

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

    def _count_rates(self, events: Sequence[Event], window: int,
                     stalls: Dict[int, Tuple[int, int]]) -> None:
        # A late event counts in the window that is open.
        newest, windows_of = events[0][0], []
        for t, kind in events:
            newest = max(newest, t)
            windows_of.append((newest // window, kind))
        span = max(2 * SECOND // window, 1)
        for last in range(events[0][0] // window + span - 1, newest // window):
            if any(windows_of[n][0] <= last and begin + length > (last - span + 1) * window
                   for n, (begin, length) in stalls.items()):
                continue  # what waited came at once
            inside = [kind for index, kind in windows_of if last - span < index <= last]
            for kind in self.types:
                self.rates[kind].append(inside.count(kind))

    @lru_cache(maxsize=None)
    def miss_rate(self, asking: str, answer: str) -> float:
        """Return the share of the gaps of `asking` without the other."""
        gaps = len(self.gaps[asking])
        return (gaps - self.answers[asking, answer] + 0.5) / (gaps + 1)

    @lru_cache(maxsize=None)
    def mean_gap(self, kind: str) -> float:
        """Return the mean gap [ns]; 0 if there is none."""
        return sum(self.gaps[kind]) / max(len(self.gaps[kind]), 1)

    @lru_cache(maxsize=None)
    def usual_delay(self, e_i: str, e_j: str, share: float) -> float:
        """Return the delay [s] that this share of the delays did not exceed."""
        bins = self.delays[e_i, e_j]
        wanted = share * len(bins)
        longest = float(EDGES[-1])
        if e_i == e_j and self.gaps[e_j]:
            gaps = sorted(self.gaps[e_j], reverse=True)
            longer = int(len(gaps) - wanted)
            if longer < min(len(gaps), 32):
                return gaps[longer] / SECOND
            longest = float(gaps[0])
        for index in sorted(set(bins)):
            below = sum(other < index for other in bins)
            if below + bins.count(index) >= wanted:
                lower = lower_edge(index)
                upper = lower_edge(index + 1) if index + 1 < BINS else longest
                width = min(upper, max(longest, lower)) - lower
                return (lower + width * (wanted - below) / bins.count(index)) * 1e-9
        return 0.0


def longest_gap(stamps: Sequence[int]) -> int:
    """Return the longest time from one stamp to the next, 0 or more."""
    return max((b - a for a, b in zip(stamps, stamps[1:]) if b > a), default=0)


class ReferenceModel:
    """What normal operation lets expect.

    Args:
        tracks: what is watched.
        first, second: counts of the two halves of the training.
        both: counts of all of it.
        least_effect: on delays [ns].
    """

    def __init__(self, tracks: Sequence[Track], first: Counts, second: Counts, both: Counts,
                 least_effect: float = LEAST_EFFECT) -> None:
        self.tracks = tracks
        self.both = both
        self.types = both.types
        self._halves = (first, second)
        self._least_effect = least_effect
        self.longest = {kind: max(both.gaps[kind], default=0) for kind in self.types}
        self._steps = {track: self._steps_of_delays(track[2], track[1])
                       if track[0] == 'pairs' else self._steps_of(track)
                       for track in tracks if LABELS[track[0]] in ('pairs', 'pace')}

    def _steps_of_delays(self, e_i: str, e_j: str) -> List[float]:
        """Return what a delay of every bin adds to the sum [nat]."""
        bins = self.both.delays[e_i, e_j]
        last = max(usual_bins(bins)[1], log_bin(int(self.both.mean_gap(e_i))))
        return [min(math.log(0.5 + 0.5 / (last + 1) / usual if index <= last else 0.5),
                    LEAST_SUM / 2)
                for index, usual in enumerate(probabilities(bins))]

    def _is_harmless(self, e_i: str, e_j: str, delay: float) -> bool:
        """Return whether a delay differs by little from the usual ones."""
        first, last = usual_bins(self.both.delays[e_i, e_j])
        period = self.both.mean_gap(e_i)
        effect = self._least_effect
        return any(lower_edge(first) - effect <= delay + turn <= lower_edge(last + 1) + effect
                   for turn in (-period, 0.0, period))

    def _steps_of(self, track: Track) -> List[float]:
        """Return what a gap of every bin adds to the sum of another pace [nat]."""
        channel, kind, _ = track
        found = probabilities(self.both.delays[kind, kind])

        def moved(by: int, shares: Sequence[float]) -> List[float]:
            to = [min(max(index + by, 0), BINS - 1) for index in range(BINS)]
            return [math.fsum(share for share, place in zip(shares, to) if place == index)
                    for index in range(BINS)]

        usual = [(2 * here + longer + shorter) / 4
                 for here, longer, shorter in zip(found, moved(1, found), moved(-1, found))]
        others = [[share * each for each in moved(by if channel == 'slower' else -by, usual)]
                  for by, share in OTHER_PACES[channel].items()]
        return [min(math.log(0.5 + 0.5 * math.fsum(shares) / share), LEAST_SUM / 2)
                for share, *shares in zip(usual, *others)]

    def is_other_rate(self, track: Track, gaps: int, time: int) -> bool:
        """Return whether so many gaps in such a time [ns] are fewer, or more, than usual."""
        channel, kind, _ = track
        if channel == 'slower':
            return gaps < 0.9 * time / (SECOND * self.both.usual_delay(kind, kind, 0.5))
        return gaps > 1.1 * time / self.both.mean_gap(kind)

    def step(self, track: Track, delay: int) -> float:
        """Return what a gap or a delay adds to the sum of its track [nat]."""
        channel, e_j, e_i = track
        step = self._steps[track][log_bin(delay)]
        if channel == 'pairs' and self._is_harmless(e_i, e_j, delay):
            return min(step, self.usual(track))
        return step

    @lru_cache(maxsize=None)
    def usual(self, track: Track) -> float:
        """Return what delays of training add on average [nat]."""
        _, e_j, e_i = track
        steps = [self._steps[track][index] for index in self.both.delays[e_i, e_j]]
        return math.fsum(steps) / len(steps)

    @lru_cache(maxsize=None)
    def counts_requests(self, track: Track) -> bool:
        """Return whether a deadline counts requests, not seconds."""
        _, to, other = track
        return (self._fail or self._are_series(other)
                or self.both.miss_rate(other, to) > self._too_soon(to, other) + RARE_MISSES)

    @cached_property
    def _fail(self) -> bool:
        """Return whether answers that are not asked for in series fail now and then."""
        missing, asked = 0.5, 1.0
        for track in self.tracks:
            if track[0] == 'deadlines' and not self._are_series(track[2]):
                requests, missed = self._requests(track)
                missing += missed
                asked += requests
        return missing / asked > RARE_MISSES

    def _requests(self, track: Track) -> Tuple[float, float]:
        """Return how many requests an answer may be expected to, and how many have none."""
        _, to, other = track
        requests = len(self.both.gaps[other]) * (1 - self._too_soon(to, other))
        return requests, max(requests - self.both.answers[other, to], 0.0)

    @lru_cache(maxsize=None)
    def step_of_miss(self, track: Track) -> float:
        """Return what a request without an answer adds to the sum [nat]."""
        requests, missed = self._requests(track)
        n, share = requests + 1, (missed + 0.5) / (requests + 1)
        likely = ((share + 0.5 / n + math.sqrt(share * (1 - share) / n + 0.25 / n ** 2))
                  / (1 + 1 / n))
        return min(math.log((1 + 1 / likely) / 2), LEAST_SUM / 2)

    def _are_series(self, other: str) -> bool:
        return self.both.mean_gap(other) < LONGEST_GAP_OF_SERIES

    def _too_soon(self, to: str, other: str) -> float:
        gaps = [log_bin(gap) for gap in self.both.gaps[other]]
        _, latest = usual_bins(self.both.delays[other, to])
        return sum(gap <= latest for gap in gaps) / max(len(gaps), 1)

    def least_limit(self, track: Track) -> float:
        """Return the least limit that the track may have."""
        label = LABELS[track[0]]
        if label == 'overdue':
            return 0.0
        if label == 'deadlines':
            return LEAST_SUM if self.counts_requests(track) else max(
                0.5, 4.0 * self.both.usual_delay(track[2], track[1], 0.95))
        if label == 'company':
            gap = 1.0 if is_mode(track[2]) else self.both.usual_delay(track[2], track[2], 0.5)
            return max(3.0, 0.5 / gap) if gap > 0 else 3.0
        return LEAST_SUM
