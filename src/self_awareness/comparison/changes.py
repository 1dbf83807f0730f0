"""What changed from one side to the other, by more than chance and by enough to matter.

Compared are rates, the gaps between two events of a type, and the delays between event types that
have to do with each other. A change counts if it is not chance (chance.py) and at least the
model's least effect.
"""
from __future__ import annotations

import math
from collections import defaultdict
from dataclasses import dataclass
from typing import Callable, Dict, List, Optional, Sequence, Set, Tuple

from self_awareness import RATE_SPAN, USUAL_SHARES, EvidenceModel
from self_awareness.comparison import chance
from self_awareness.comparison.sides import End, Kind, Side
from self_awareness.stamps import SECOND_NS

GONE, ENDED, NEW, RATE, GAP, DELAY = 'gone', 'ended', 'new', 'rate', 'gap', 'delay'
"""What may have changed."""

FEWEST_OF_HALF = 25  # delays are not compared if a half of a side has fewer

_LEAST_OF_RATE, _LEAST_OF_PERIOD, _LEAST_OF_GAP_S = 0.04, 0.2, 0.01  # changes that matter
_CLEARLY_LONGER = 3
_LEAST_END_S = 1.0
_SPAN_S = RATE_SPAN / SECOND_NS
_MEDIAN = 0.5


@dataclass(frozen=True)
class Change:
    """Something that changed."""

    what: str  # GONE, ENDED, NEW, RATE, GAP or DELAY
    kind: Kind  # event type
    other: Optional[Kind]  # the one that the delay counts from; None: it is no delay
    # Rate [Hz], longest usual gap [s] or median delay [s]; None: it is new.
    before: Optional[float]
    after: Optional[float]  # likewise; None: it is gone
    effect: float  # its size in units of the least effect; infinite: new, gone or ended
    whole: bool = False  # its whole source is new, gone or ended
    end: Optional[End] = None  # how it ended in a recording; None: it did not


@dataclass(frozen=True)
class Comparison:
    """All that is to be said."""

    before: Side  # one side
    after: Side  # the other
    changes: List[Change]  # what matters most comes first
    unsure: List[Kind]  # event types of one side only that the other may miss by chance
    # Number of pairs whose delays were compared; None: no side knows which event types have to do
    # with each other.
    compared_delays: Optional[int]

    @property
    def is_complete(self) -> bool:
        """Whether delays were compared, too: who answers late changes neither rates nor gaps."""
        return bool(self.compared_delays)


@dataclass(frozen=True)
class _Measured:
    """A quantity on one side: its value, its variance by chance alone, and its halves' excess."""

    value: float
    variance: float
    excess: float


@dataclass(frozen=True)
class _Candidate:
    """A change, if it is not chance: what is tested, on both sides."""

    change: Change
    before: _Measured
    after: _Measured

    def p_value(self, common: float) -> float:
        return chance.p_value(self.after.value - self.before.value,
                              self.before.variance + self.after.variance,
                              (self.before.excess, self.after.excess), common)


def compare(before: Side, after: Side) -> Comparison:
    """Return what changed from one side to the other."""
    both = [kind for kind in before.ids if kind in after.ids]
    rates = [_rate(before, after, kind) for kind in both]
    timed = [(kind, kind) for kind in both
             if all(_has_enough(side, (kind, kind)) for side in (before, after))]
    gaps = list(filter(None, (_shift(GAP, before, after, pair, USUAL_SHARES[1])
                              for pair in timed)))
    related = _related(before, after)
    delays = list(filter(None, (_shift(DELAY, before, after, pair, _MEDIAN)
                                for pair in related or [])))
    number = (len(rates) + len(timed) + len(related or [])
              + len(set(before.ids) ^ set(after.ids)))
    level = chance.LEVEL / max(number, 1)

    of_rates = _inflation(rates)
    found = _ended(before, after, both)
    ended = {change.kind for change in found}
    found += [change for change in _significant(rates, level, of_rates)
              if change.kind not in ended]
    explained = {change.kind for change in found}
    found += [change for change in _significant([*gaps, *delays], level,
                                                _inflation([*gaps, *delays]))
              if change.kind not in explained and change.other not in explained]
    unsure: List[Kind] = []
    for what, here, there in ((GONE, before, after), (NEW, after, before)):
        for kind in here.ids:
            if kind in there.ids:
                continue
            if _missing_by_chance(here, there, kind, of_rates) > level:
                unsure.append(kind)
            else:
                found.append(_one_sided(what, here, there, kind))
    return Comparison(before, after, _ranked(found, before.model.graph | after.model.graph),
                      sorted(unsure), None if related is None else len(related))


def _inflation(candidates: Sequence[_Candidate]) -> float:
    return chance.common_inflation([side.excess for each in candidates
                                    for side in (each.before, each.after)])


def _significant(candidates: Sequence[_Candidate], level: float, common: float) -> List[Change]:
    return [each.change for each in candidates
            if each.change.effect >= 1.0 and each.p_value(common) <= level]


def _rate(before: Side, after: Side, kind: Kind) -> _Candidate:
    first, second = _measured_rate(before, kind), _measured_rate(after, kind)
    effect = abs(math.log(second.value / first.value)) / math.log1p(_LEAST_OF_RATE)
    return _Candidate(Change(RATE, kind, None, first.value, second.value, effect), first, second)


def _measured_rate(side: Side, kind: Kind) -> _Measured:
    index = side.ids[kind]
    spread = side.all.rate_variance(index)

    def rate(counts: EvidenceModel) -> Tuple[float, float]:
        duration = max(counts.duration / SECOND_NS, _SPAN_S)
        return (counts.events(index) / duration,
                chance.rate_variance(spread, _SPAN_S, duration))

    return _measured(side, rate)


def _measured(side: Side,
              measure: Callable[[EvidenceModel], Tuple[float, float]]) -> _Measured:
    """Measure value and variance of all counts of a side, and of its halves."""
    value, variance = measure(side.all)
    halves, variances = zip(*map(measure, side.halves))
    return _Measured(value, variance, chance.excess(halves, variances))


def _shift(what: str, before: Side, after: Side, pair: Tuple[Kind, Kind],
           share: float) -> Optional[_Candidate]:
    """Return the delay that a share of the delays does not exceed; None: no change can be seen.

    Tested is the share of the delays beyond an edge of the bins between the two. At least a whole
    bin lies between them: within one, nobody knows where the delays are.
    """
    sides = (before, after)
    pairs = [(side.ids[pair[0]], side.ids[pair[1]]) for side in sides]
    first, second = (side.all.usual_delay(*ids, share) for side, ids in zip(sides, pairs))
    edges = [edge for edge, _ in before.all.delays(*pairs[0])
             if min(first, second) * SECOND_NS < edge <= max(first, second) * SECOND_NS]
    if len(edges) < 2:
        return None
    least = before.model.tuning.get('least_effect')
    if what == GAP:
        period = before.duration / before.all.events(pairs[0][0])
        least = max(_LEAST_OF_GAP_S, _LEAST_OF_PERIOD * period)
    change = Change(what, pair[1], None if what == GAP else pair[0], first, second,
                    abs(second - first) / max(least, 1.0 / SECOND_NS))
    return _Candidate(change, *(_measured_share(side, ids, edges[len(edges) // 2])
                                for side, ids in zip(sides, pairs)))


def _measured_share(side: Side, pair: Tuple[int, int], edge: int) -> _Measured:
    def share(counts: EvidenceModel) -> Tuple[float, float]:
        number = counts.delay_count(*pair)
        beyond = sum(count for begin, count in counts.delays(*pair) if begin >= edge)
        return beyond / number, chance.share_variance(beyond / number, number)

    return _measured(side, share)


def _related(before: Side, after: Side) -> Optional[List[Tuple[Kind, Kind]]]:
    """Return the pairs whose delays are compared, the cause first; None: nobody knows any."""
    # What is slower now may no longer be watched: what was related before decides.
    known = before.relations if before.relations is not None else after.relations
    if known is None:
        return None

    def median(pair: Tuple[Kind, Kind]) -> float:
        return before.all.usual_delay(before.ids[pair[0]], before.ids[pair[1]], _MEDIAN)

    pairs = {pair for pair in known
             if all(_has_enough(side, pair) for side in (before, after))}
    # Of a question and its answer, both orders may be watched; the answer comes soon.
    return sorted(pair for pair in pairs
                  if pair[::-1] not in pairs or median(pair) <= median(pair[::-1]))


def _has_enough(side: Side, pair: Tuple[Kind, Kind]) -> bool:
    if not all(kind in side.ids for kind in pair):
        return False
    ids = side.ids[pair[0]], side.ids[pair[1]]
    return min(half.delay_count(*ids) for half in side.halves) >= FEWEST_OF_HALF


def _missing_by_chance(here: Side, there: Side, kind: Kind, common: float) -> float:
    """Return the probability that all events of a type fall on one side by chance.

    Of n independent ones, each lies on this side with its share of the time. Events that come in
    series count as fewer, by the variance of their counts (index of dispersion).
    """
    index = here.ids[kind]
    independent = here.all.events(index) / max(1.0, common * here.all.dispersion(index))
    return (here.duration / max(here.duration + there.duration, 1e-9)) ** independent


def _ended(before: Side, after: Side, both: Sequence[Kind]) -> List[Change]:
    """Return who fell silent in a recording, until its end: that is no other rate."""
    found: Dict[Kind, End] = {}
    for side in (before, after):
        for kind in both:
            end = side.ends.get(kind)
            longest = max(_longest_gap(each, kind) for each in (before, after))
            least = max(_CLEARLY_LONGER * longest, _LEAST_END_S)
            if end is not None and end.silent > least:
                found[kind] = end
    return [Change(ENDED, kind, None, before.all.events(before.ids[kind]) / before.duration,
                   after.all.events(after.ids[kind]) / after.duration, math.inf,
                   bool(kind[0]) and all(other in found for other in both if other[0] == kind[0]),
                   end) for kind, end in found.items()]


def _longest_gap(side: Side, kind: Kind) -> float:
    """Return the begin of the bin that holds the longest gap of an event type [s]."""
    counted = side.all.delays(side.ids[kind], side.ids[kind])
    return max((begin / SECOND_NS for begin, count in counted if count > 0), default=0.0)


def _one_sided(what: str, here: Side, there: Side, kind: Kind) -> Change:
    rate = here.all.events(here.ids[kind]) / max(here.duration, _SPAN_S)
    whole = bool(kind[0]) and all(other[0] != kind[0] for other in there.ids)
    return Change(what, kind, None, rate if what == GONE else None,
                  rate if what == NEW else None, math.inf, whole)


def _ranked(changes: Sequence[Change], graph: Set[Tuple[str, str, str]]) -> List[Change]:
    """Return who is gone, ended or new, then the largest effects; of equal ones, the root."""
    upstream = _upstream({change.kind[0] for change in changes}, graph)
    order = (GONE, ENDED, NEW, RATE, DELAY, GAP)
    # Victims change as much as the root does, but for some per cent.
    return sorted(changes, key=lambda each: (
        -round(4.0 * math.log2(each.effect)) if math.isfinite(each.effect) else -math.inf,
        not each.whole, order.index(each.what), len(upstream[each.kind[0]]), each.kind))


def _upstream(sources: Set[str], graph: Set[Tuple[str, str, str]]) -> Dict[str, Set[str]]:
    """Return which of the sources send messages to each one, directly or through others."""
    followers: Dict[str, Set[str]] = defaultdict(set)
    for publisher, _, subscriber in graph:
        followers[publisher].add(subscriber)
    upstream: Dict[str, Set[str]] = defaultdict(set)
    for source in sources:
        reached, ways = {source}, [source]
        while ways:
            for follower in followers[ways.pop()] - reached:
                reached.add(follower)
                ways.append(follower)
                upstream[follower].add(source)
    return upstream
