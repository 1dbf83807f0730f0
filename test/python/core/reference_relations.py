"""What is watched and why, literally and slowly: docs/method.md, section 3.

The graph is not known here: no message reaches anybody.
"""
from __future__ import annotations

import math
from typing import Dict, List, NamedTuple, Sequence, Tuple

from reference_evidence import (BINS, DEADLINES, EDGES, FEWEST_DELAYS_OF_PAIR, FEWEST_GAPS,
                                LEAST_GAIN, LEAST_RATE, MOST_MISSES, PREDECESSORS, SECOND, USUAL,
                                Counts, Track, bin_below, gain, is_mode, log_bin, lower_edge,
                                middle, usual_bins)

SAME_START = 60 * SECOND
CHANCE_OF_ANY = 0.1
LEAST_OF_LONGEST = 0.1
CHANCE_OF_ONE = 0.05
IRREGULAR = 2.0
LEAST_CHANCE_MISSES = 0.2
LEAST_CHANCE_MISSES_OF_PAUSING = 0.02
MOST_MEAN_GAPS = 3.0
MOST_OF_CHANCE_MISSES = 0.75
TAIL_POINTS = 8
LONGEST_GAPS = 32

Span = Tuple[int, int]


class Relation(NamedTuple):
    """What speaks for a relation, as the package tells it."""

    watched: bool
    reaches: bool = False
    irregular: bool = False
    spread: float = 1.0
    starts: int = 0
    starts_needed: int = 0


def number_of_starts(spans: Sequence[Span]) -> int:
    """Return the number of spans that begin a minute or more after all that began before."""
    spans = sorted(spans)
    return sum(all(first - end >= SAME_START for _, end in spans[:n])
               for n, (first, _) in enumerate(spans))


def starts_of(spans: Sequence[Span]) -> List[int]:
    """Return the number of the start that each belongs to, from 0."""
    return [number_of_starts([other for other in spans if other <= span]) - 1 for span in spans]


class ReferenceRelations:
    """Reasons to watch what two event types do together, by the counts of the whole training."""

    def __init__(self, counts: Counts) -> None:
        self._counts = counts
        types = sum(len(counts.gaps[kind]) >= FEWEST_GAPS and not is_mode(kind)
                    for kind in counts.types)
        self._looked_at = max(types * (types - 1), 1)

    def delays(self, e_i: str, e_j: str, more: Sequence[Span] = ()) -> Relation:
        """Return the reasons to watch the delays."""
        of_all = sum(seen.events[e_j] for seen in self._counts.recordings)
        spans, shares = list(more), [1.0]
        for seen in self._counts.recordings:
            if min(seen.events[e_i], seen.events[e_j]) >= FEWEST_GAPS:
                shares.append(seen.events[e_j] / of_all)
                spans.append((seen.start, seen.end))
        starts = number_of_starts(spans)
        spread = self._spread(e_i, e_j, min(1 - USUAL, min(shares) / 2))
        irregular = self._is_irregular(e_i, e_j)
        level = CHANCE_OF_ONE if irregular else CHANCE_OF_ANY / self._looked_at
        late = self._is_late(e_i, e_j)
        watched = not late and spread ** (max(starts, 1) - 1) <= level
        needed = (0 if watched or late or spread >= 1
                  else 1 + math.ceil(math.log(level) / math.log(spread)))
        return Relation(watched, False, irregular, spread, starts, needed)

    def owed(self, e_i: str, e_j: str) -> Relation:
        """Return the reasons to watch whether e_j comes in time after e_i."""
        misses = self._counts.miss_rate(e_i, e_j)
        by_chance = self.misses_by_chance(e_i, e_j)
        gaps = self._counts.gaps[e_j]
        pauses = max(gaps, default=0) > MOST_MEAN_GAPS * self._counts.mean_gap(e_j)
        least = LEAST_CHANCE_MISSES_OF_PAUSING if pauses else LEAST_CHANCE_MISSES
        irregular = (by_chance >= least
                     and misses <= MOST_OF_CHANCE_MISSES * by_chance)
        bins = self._counts.delays[e_i, e_j]
        first, last = usual_bins(bins)
        in_order = last < 0 or middle(first) >= LEAST_OF_LONGEST * middle(last)
        return Relation(irregular and in_order
                        and self._divergence(e_i, misses, by_chance)
                        > math.log(self._looked_at / CHANCE_OF_ANY), False, irregular)

    def _longer_than(self, kind: str) -> float:
        """Return what a pause is longer than [ns]."""
        return max(MOST_MEAN_GAPS * self._counts.mean_gap(kind), 2.0 * SECOND)

    def _pauses(self, kind: str) -> List[int]:
        longest = sorted(self._counts.gaps[kind], reverse=True)[:LONGEST_GAPS]
        return [gap for gap in longest if gap > self._longer_than(kind)]

    def pauses_in_starts(self, kind: str) -> bool:
        """Return whether two starts hold pauses."""
        spans = [(seen.start, seen.end) for seen in self._counts.recordings
                 if seen.longest_gaps[kind] > self._longer_than(kind)]
        return number_of_starts(spans) >= 2

    def share_gone_on(self, kind: str, other: str) -> float:
        """Return how much of the pauses of one is none of the other."""
        pauses = self._pauses(kind)
        if not pauses:
            return math.inf
        # Ages are counted by bins.
        begin = max(index for index in range(BINS)
                    if index == 0 or lower_edge(index) < self._longer_than(kind))
        events = sum(index >= begin for index in self._counts.delays[kind, other])
        return ((events + len(pauses)) * self._counts.mean_gap(other)
                + len(pauses) * self._longer_than(kind)) / sum(pauses)

    def is_company(self, kind: str, other: str, chance: float) -> bool:
        """Return whether two pause at the same times beyond chance."""
        shares = self.share_gone_on(kind, other), self.share_gone_on(other, kind)
        return max(shares) < 1 and (len(self._pauses(kind)) * math.log(shares[0])
                                    + len(self._pauses(other)) * math.log(shares[1])
                                    <= math.log(chance))

    def misses_by_chance(self, e_i: str, e_j: str) -> float:
        """Return the share of the gaps of e_i without an e_j, if they had nothing to do with it.

        Where a gap of e_j begins is then random: a gap of e_i fits into it in as much of the time
        as it is longer.
        """
        mean = self._counts.mean_gap(e_j)
        if mean <= 0:
            return 0.0
        left = math.fsum(asked_share * share * max(gap - asked, 0.0)
                         for asked, asked_share in self._lengths(e_i).items()
                         for gap, share in self._lengths(e_j).items())
        return min(left / mean, 1.0)

    def _lengths(self, kind: str) -> Dict[float, float]:
        """Return what stands for the gaps, and the share of them that each length stands for."""
        gaps = self._counts.gaps[kind]
        beyond = [gap for gap in gaps if log_bin(gap) == BINS - 1]
        others = [min(middle(log_bin(gap)), max(gaps)) for gap in gaps
                  if log_bin(gap) < BINS - 1]
        shares = {length: others.count(length) / len(gaps) for length in set(others)}
        if beyond:  # that bin has no middle, but all gaps together are known
            mean = max((sum(gaps) - math.fsum(others)) / len(beyond) - EDGES[-1], 0.0)
            quantiles = [-math.log(1 - (k + 0.5) / TAIL_POINTS) for k in range(TAIL_POINTS)]
            for quantile in quantiles:
                length = EDGES[-1] + mean * quantile / (sum(quantiles) / TAIL_POINTS)
                shares[length] = (shares.get(length, 0.0)
                                  + len(beyond) / len(gaps) / TAIL_POINTS)
        return shares

    def _divergence(self, e_i: str, observed: float, expected: float) -> float:
        return len(self._counts.gaps[e_i]) * (
            observed * math.log(observed / expected)
            + (1 - observed) * math.log((1 - observed) / (1 - expected)))

    def _is_irregular(self, e_i: str, e_j: str) -> bool:
        def range_of(first: str, second: str, widest: bool) -> float:
            bins = self._counts.delays[first, second]
            low, high = usual_bins(bins)
            high = max(high, 0)
            if widest:
                return lower_edge(high + 1) - lower_edge(low)
            return max(lower_edge(high) - lower_edge(low + 1), 0.0)

        return (min(range_of(e_i, e_i, False), range_of(e_j, e_j, False))
                > IRREGULAR * range_of(e_i, e_j, True))

    def _period(self, e_i: str, e_j: str) -> float:
        return min(self._counts.mean_gap(e_i), self._counts.mean_gap(e_j))

    def _is_late(self, e_i: str, e_j: str) -> bool:
        bins = self._counts.delays[e_i, e_j]
        median = next(index for index in range(BINS)
                      if not bins or sum(other <= index for other in bins) >= len(bins) / 2)
        return middle(median) > self._period(e_i, e_j) / 2

    def _spread(self, e_i: str, e_j: str, left_out: float) -> float:
        bins = self._counts.delays[e_i, e_j]
        period = self._period(e_i, e_j)
        if not bins or period <= 0:
            return 1.0
        circle = [(min(lower_edge(index + 1), period) - lower_edge(index), bins.count(index))
                  for index in range(BINS) if lower_edge(index) < period]
        arcs = [[circle[(begin + k) % len(circle)] for k in range(length)]
                for begin in range(len(circle)) for length in range(1, len(circle) + 1)]
        return min((math.fsum(width for width, _ in arc) for arc in arcs
                    if sum(count for _, count in arc) >= (1 - left_out) * len(bins)),
                   default=period) / period


def watched(first: Counts, second: Counts, both: Counts) -> List[Track]:
    """Return the tracks by the counts of the halves of the training, and of all of it."""
    types = [kind for kind in both.types if not is_mode(kind)]
    relations = ReferenceRelations(both)
    gains = {(i, j): (gain(first, second, i, j) + gain(second, first, i, j)) / 2
             for i in types for j in types}

    def says_enough(e_i: str, e_j: str) -> bool:
        return (gains[e_i, e_j] >= LEAST_GAIN
                and len(both.delays[e_i, e_j]) >= FEWEST_DELAYS_OF_PAIR)

    def predecessors(e_j: str) -> List[str]:
        return sorted([i for i in types if i != e_j and says_enough(i, e_j)],
                      key=lambda i: (not relations.delays(i, e_j).watched,
                                     -gains[i, e_j]))[:PREDECESSORS]

    def requesting(answer: str) -> List[str]:
        return sorted([kind for kind in types
                       if kind != answer and both.answers[kind, answer] >= FEWEST_GAPS
                       and both.miss_rate(kind, answer) <= MOST_MISSES
                       and relations.owed(kind, answer).watched],
                      key=lambda kind: bin_below(both.delays[kind, answer],
                                                 len(both.delays[kind, answer]) / 2))[:DEADLINES]

    judged = [kind for kind in types if len(both.gaps[kind]) >= FEWEST_GAPS]
    looked_at = max(len(judged) * (len(judged) - 1), 1)

    known = [kind for kind in both.types if len(both.gaps[kind]) >= FEWEST_GAPS]

    def company(kind: str) -> List[str]:
        kept = [(relations.share_gone_on(kind, other), other) for other in both.types
                if kind != other and {kind, other} <= set(known)
                and relations.pauses_in_starts(kind) and relations.pauses_in_starts(other)
                and both.delays[kind, other] and both.delays[other, kind]
                and relations.is_company(kind, other, CHANCE_OF_ANY / looked_at)]
        best = [other for _, other in sorted(kept)]
        kept_of_types = [other for other in best if not is_mode(other)][:DEADLINES]
        return [other for other in best if is_mode(other) or other in kept_of_types]

    often = [kind for kind in judged
             if sum(both.rates[kind]) >= LEAST_RATE * len(both.rates[kind])]
    return ([('overdue', kind, kind) for kind in judged]
            + [('fewer', kind, kind) for kind in often]
            + [('more', kind, kind) for kind in often]
            + [('own gaps', kind, kind) for kind in types if says_enough(kind, kind)]
            + [('pairs', kind, other) for kind in types for other in predecessors(kind)]
            + [('deadlines', kind, other) for kind in types for other in requesting(kind)]
            + [('company', kind, other) for kind in types for other in company(kind)])
