"""The limits of the evidence, literally and slowly: docs/method.md, section 5."""
from __future__ import annotations

import math
from typing import Dict, List, NamedTuple, Optional, Sequence, Set, Tuple

import numpy as np
from reference_evidence import (FEWEST_GAPS, LABELS, SECOND, Counts, Event, ReferenceModel, Seen,
                                Track, gain, is_mode)
from reference_relations import ReferenceRelations, Relation, Span, starts_of
from reference_scorer import MOST_EVIDENCE, ReferenceScorer

HOUR = 3600 * SECOND
PART = 30 * SECOND
LEAST_MARGIN = {'deadlines': 2.0, 'company': 2.0, 'own gaps': 2.0}
"""By pool; 1.25 elsewhere."""
MOST_MARGIN, MOST_MARGIN_OF_DELAYS = 4.0, 2.0
MOST_GAP_MARGIN = 1.6
MOST_OWN_MARGIN = 2.0
MOST_TAIL_MARGIN = {False: 2.0, True: 8.0}
"""By whether there are several starts."""
SCALE = {'timers': 0.05, 'fast timers': 0.05}
"""By pool; 0.2 elsewhere."""
LONGEST_STALL = 700 * SECOND // 1000
REGULAR = 1.5
FAST = 2
MOST_MEAN_GAPS = 3.0
PAUSES = 10
PRIOR_PAUSES = 2
PAUSES_IN_RECORDING = 25
OWED_OF_SILENCE = 0.9
RATE_SPAN = 2 * SECOND
QUIETEST = 0.58
HOURS_OF_ROBOTS = 0.5
POOLS_OF_GAPS = ('fast timers', 'timers', 'others')
POOLS_OF_TIMERS = POOLS_OF_GAPS[:2]
POOLS = ('fast timers', 'timers', 'others', 'rate', 'pairs', 'deadlines')
SHARE_OF_ITS_OWN = 0.02
CHUNK = 120 * SECOND
LEAST_GAIN_LEFT = 0.7

LEAST_SHARE = 0.5
PRIOR_EXCEEDANCES = 5
FEWEST = 0.5
"""Exceedances, where there was none."""
LEAST_EXCESS = math.log(1.1)


def single(value: float) -> float:
    """Return the nearest number of single precision."""
    return float(np.float32(value))


class Part(NamedTuple):
    """A part of a recording: the start that it belongs to, and its length."""

    start: int
    hours: float


class HeldOut:
    """What parts show beyond the others.

    Args:
        parts: all of them.
        tracks: the largest values of every track by part, and its least limit.
        scale: that is believed before anything is seen.
    """

    def __init__(self, parts: Sequence[Part], tracks: Sequence[Tuple[Sequence[float], float]],
                 scale: float) -> None:
        self._parts = parts
        self._levels = []  # eligible hours, logarithms of the exceedances, their scale
        for groups in ([part.start for part in parts], list(range(len(parts)))):
            found = [self._exceedance(groups, largest, least) for largest, least in tracks]
            logs = [log for log in found if log > LEAST_EXCESS]
            believed = ((sum(log - LEAST_EXCESS for log in logs) + scale * PRIOR_EXCEEDANCES)
                        / (len(logs) + PRIOR_EXCEEDANCES))
            eligible = sum(self._hours(groups, group) for group in set(groups)
                           if self._is_eligible(groups, group))
            if eligible > 0:
                self._levels.append((eligible, logs, believed))

    def _hours(self, groups: Sequence[int], group: int) -> float:
        return sum(part.hours for part, other in zip(self._parts, groups) if other == group)

    def _is_eligible(self, groups: Sequence[int], group: int) -> bool:
        return self._hours(groups, group) <= sum(part.hours for part in self._parts) / 2

    def _exceedance(self, groups: Sequence[int], largest: Sequence[float], least: float) -> float:
        of_group = {group: max(value for value, other in zip(largest, groups) if other == group)
                    for group in sorted(set(groups))}
        worst = max(of_group, key=lambda group: of_group[group])
        if of_group[worst] <= least or not self._is_eligible(groups, worst):
            return 0.0
        second = max((value for group, value in of_group.items() if group != worst), default=0.0)
        known = max(second, LEAST_SHARE * least)
        return math.log(of_group[worst] / known) if known > 0 else 0.0

    def excess(self, largest: Sequence[float], least: float) -> float:
        """Return by how much the worst start exceeds the others."""
        return math.exp(self._exceedance([part.start for part in self._parts], largest, least))

    def margin(self, rate: float) -> float:
        """Return the margin that is exceeded so often an hour."""
        margin = 1.0
        for hours, logs, scale in self._levels:
            expected = max(len(logs), FEWEST) / (hours * rate)
            log = LEAST_EXCESS + scale * max(math.log(expected), 0.0)
            margin = max(margin, math.exp(log))
        return margin


def left_out(parts: Sequence[Part], tracks: Sequence[Tuple[Sequence[float], Sequence[float],
                                                           float, float]]) -> Tuple[int, float]:
    """Return how many parts would have exceeded limits that the others say, and their hours.

    Args:
        parts: all of them.
        tracks: the largest values by part, these as far as most starts agree, the least limit,
            and the limit's margin.
    """
    all_hours = sum(part.hours for part in parts)
    exceeded, hours = 0, 0.0
    for number, part in enumerate(parts):
        of_start = sum(other.hours for other in parts if other.start == part.start)
        if of_start <= all_hours / 2:
            others = [k for k, other in enumerate(parts) if other.start != part.start]
        elif part.hours <= all_hours / 2:
            others = [k for k in range(len(parts)) if k != number]
        else:
            continue
        hours += part.hours
        limits = [max(least, margin * max([LEAST_SHARE * least] + [agreed[k] for k in others]))
                  for _, agreed, least, margin in tracks]
        exceeded += any(0 < limit < largest[number]
                        for limit, (largest, *_) in zip(limits, tracks))
    return exceeded, hours or all_hours


def highest_rate(exceeded: int, hours: float) -> float:
    """Return the rate that is not below the true one in 95 %."""
    if exceeded == 0:
        return QUIETEST / (HOURS_OF_ROBOTS + hours)
    shape = exceeded / 2
    chi = 1.0 - 1.0 / (9.0 * shape) + 1.6449 / (3.0 * math.sqrt(shape))
    return shape * chi ** 3 / (HOURS_OF_ROBOTS + hours)


class Tail(NamedTuple):
    """The longest gaps: the shortest, mean excess, how many an hour, by how many samples."""

    shortest: float
    excess: float
    all: float
    samples: float

    def gap(self, rate: float) -> float:
        """Return the gap that is reached so often an hour."""
        times = max(self.all / rate, 1.0) ** (1 / self.samples) - 1
        return self.shortest + self.samples * self.excess * times


class Judged(NamedTuple):
    """A recording of normal operation, and the model that judges it."""

    events: Sequence[Event]
    judging: ReferenceModel
    trained_on: bool

    @property
    def span(self) -> Span:
        """First and last stamp."""
        return self.events[0][0], self.events[-1][0]


class ReferenceLimits:
    """Limits by recordings of normal operation.

    Args:
        model: whose limits they are.
        recordings: of normal operation.
        window, settle_time: [ns].
        budget: false alarms an hour.
    """

    def __init__(self, model: ReferenceModel, recordings: Sequence[Judged], window: int,
                 settle_time: int, budget: float) -> None:
        self._model = model
        self._recordings = recordings
        self._window = window
        self._settle_time = settle_time
        spans = [(seen.start, seen.end) for seen in self._training()]
        starts = starts_of(spans + [recording.span for recording in recordings])
        self._starts_of_training = starts[:len(spans)]
        self._starts = starts[len(spans):]
        self._rows = [self._settled(recording) for recording in recordings]
        self.windows = sum(len(rows) for rows in self._rows)
        if all(recording.trained_on for recording in recordings):
            # The training alone promises no less than one in ten times the time that was seen.
            budget = max(budget, HOUR / (10 * self.windows * window))
        self._rates = {**dict.fromkeys(POOLS, budget / len(POOLS)),
                       'company': SHARE_OF_ITS_OWN * budget}
        self.relations = [self._relation(track) for track in model.tracks]
        self.limits, self.promised_rate = self._find()

    def _training(self) -> List[Seen]:
        return sorted(self._model.both.recordings, key=lambda seen: (seen.start, seen.end))

    def _settled(self, recording: Judged) -> List[List[float]]:
        # The last window lasts longer than the recording.
        rows = ReferenceScorer(recording.judging, recording.events, self._window).rows[:-1]
        return self._until_heard(recording, rows)[self._unsettled(recording):]

    def _until_heard(self, recording: Judged, rows: List[List[float]]) -> List[List[float]]:
        """Return evidence where its type is heard, the largest since it was heard before."""
        heard: Dict[str, Set[int]] = {}
        newest = recording.events[0][0]
        for t, kind in recording.events:
            newest = max(newest, t)
            heard.setdefault(kind, set()).add(newest // self._window)
        first = recording.events[0][0] // self._window
        unsettled = self._unsettled(recording)
        counted = [[0.0] * len(row) for row in rows]
        for index, (_, kind, _) in enumerate(self._model.tracks):
            windows = sorted(window - first for window in heard.get(kind, ()))
            before = windows[0] - 1 if windows else 0
            if windows and self._is_often_silent(kind):
                windows = [before, *windows, len(rows) - 1]
                before = -1
            for now in windows:
                if 0 <= now < len(rows):
                    counted[now][index] = max([counted[now][index], *(
                        rows[k][index] for k in range(before + 1, now + 1) if k >= unsettled)])
                before = now
        return counted

    def _unsettled(self, recording: Judged) -> int:
        """Return the number of windows that begin before the detector has settled."""
        first = recording.events[0][0]
        return -(-(first + self._settle_time) // self._window) - first // self._window

    def _in_parts(self, rows: Sequence[List[float]]) -> List[Sequence[List[float]]]:
        length = PART // self._window
        return [rows[begin:begin + length] for begin in range(0, len(rows), length)]

    def _parts_of(self, number: int, start: int) -> List[Part]:
        return [Part(start, len(part) * self._window / HOUR)
                for part in self._in_parts(self._rows[number])]

    def _relation(self, track: Track) -> Relation:
        channel, to, other = track
        relations = ReferenceRelations(self._model.both)
        if channel == 'deadlines':
            return relations.owed(other, to)
        if channel != 'pairs':
            return Relation(True)
        said = [self._said(recording, other, to) for recording in self._recordings]
        as_usual = [recording.span for recording, what in zip(self._recordings, said)
                    if what is True and not recording.trained_on]
        relation = relations.delays(other, to, as_usual)
        return relation._replace(watched=relation.watched and False not in said)

    def _said(self, recording: Judged, e_i: str, e_j: str) -> Optional[bool]:
        """Return whether delays say as much as in training; None: there are too few."""
        known = [event for event in recording.events
                 if event[1] in self._model.types and not is_mode(event[1])]
        chunks: List[List[Event]] = [[]]
        for event in known:
            chunks[-1].append(event)
            if event[0] - chunks[-1][0][0] >= CHUNK:
                chunks.append([])
        both = self._model.both
        found = []
        for chunk in filter(None, chunks):
            now = Counts([chunk], self._model.types, self._window)
            if len(now.delays[e_i, e_j]) >= FEWEST_GAPS:
                found.append(gain(both, now, e_i, e_j)
                             >= LEAST_GAIN_LEFT * gain(both, both, e_i, e_j))
        return all(found) if found else None

    def _longest_gaps(self, kind: str) -> List[float]:
        """Return the longest gaps of the recordings of the training, and of parts of others."""
        longest = [float(max(seen.longest_gaps[kind] if seen.events[kind] else 0,
                             self._edge(kind, seen))) for seen in self._training()]
        for number, recording in enumerate(self._recordings):
            if not recording.trained_on:
                parts = self._longest_gaps_of_parts(number, kind)
                stamps = [t for t, _ in recording.events]
                never = (self._is_often_silent(kind)
                         and all(other != kind for _, other in recording.events))
                longest += [float(stamps[-1] - stamps[0])] * len(parts) if never else parts
        return [gap + self._window if gap > 0 else 0.0 for gap in longest]

    def _agreed(self, kind: str) -> List[float]:
        """Return the same, without what one of five starts or more shows alone."""
        gaps = self._longest_gaps(kind)
        starts = [part.start for part in self._parts_with_gaps()]
        agreed = []
        for gap, start in zip(gaps, starts):
            others = {}
            for other, its_start in zip(gaps, starts):
                if other > 0 and its_start != start:
                    others[its_start] = max(other, others.get(its_start, 0.0))
            fault = len(others) >= 4 and (
                gap > MOST_MEAN_GAPS * max(others.values()) + LONGEST_STALL)
            agreed.append(max(others.values()) if fault else gap)
        return agreed

    def _parts_with_gaps(self) -> List[Part]:
        parts = [Part(start, (seen.end - seen.start) / HOUR)
                 for seen, start in zip(self._training(), self._starts_of_training)]
        for number, (recording, start) in enumerate(zip(self._recordings, self._starts)):
            parts += [] if recording.trained_on else self._parts_of(number, start)
        return parts

    def _is_often_silent(self, kind: str) -> bool:
        both = self._model.both
        longest = sorted(both.gaps[kind])[-32:]
        pauses = sum(gap for gap in longest if gap > REGULAR * both.mean_gap(kind))
        heard = sum(seen.end - seen.start for seen in self._heard_in(kind))
        return sum(both.gaps[kind]) - pauses < 0.75 * heard

    def _heard_in(self, kind: str) -> List[Seen]:
        return [seen for seen in self._training() if seen.events[kind]]

    def _cut_off(self, kind: str) -> float:
        """Return the length of the pauses that recordings of the training cut off."""
        if not self._is_often_silent(kind):
            return 0.0
        both = self._model.both
        lengths = sum(seen.end - seen.start - 2 * REGULAR * both.mean_gap(kind)
                      for seen in self._heard_in(kind))
        return max(lengths - sum(both.gaps[kind]), 0.0)

    def _edge(self, kind: str, seen: Seen) -> int:
        """Return the longest silence that a recording of the training cuts off."""
        if not self._is_often_silent(kind):
            return 0
        if not seen.events[kind]:
            return seen.end - seen.start
        heard = self._heard_in(kind)
        tails = self._cut_off(kind) - sum(each.firsts[kind] for each in heard)
        return max(seen.firsts[kind], int(tails / len(heard)))

    def _longest_gaps_of_parts(self, number: int, kind: str) -> List[float]:
        # A gap belongs to the part of the window that was closed last.
        recording = self._recordings[number]
        longest = [0.0] * len(self._in_parts(self._rows[number]))
        newest = recording.events[0][0]
        silent, came = self._is_often_silent(kind), False
        last: Optional[int] = newest if silent else None
        for t, other in recording.events:
            newest = max(newest, t)
            if other == kind:
                closed = (newest // self._window - recording.events[0][0] // self._window
                          - self._unsettled(recording))
                part = max(closed - 1, 0) // (PART // self._window)
                longest[part] = max(longest[part], t - last if last is not None else 0)
                last, came = t, True
        if silent and came and last is not None:
            longest[-1] = max(longest[-1], recording.events[-1][0] - last)
        return longest

    def _largest(self, index: int) -> List[float]:
        return [single(max(row[index] for row in part))
                for rows in self._rows for part in self._in_parts(rows)]

    def _pool(self, index: int) -> str:
        channel, kind, _ = self._model.tracks[index]
        if channel != 'overdue':
            return LABELS[channel]
        longest = sorted(gap for gap in self._agreed(kind) if gap > 0)
        second = longest[-2:][0] - self._window
        mean = self._model.both.mean_gap(kind)
        if second >= REGULAR * mean or self._is_often_silent(kind):
            return 'others'
        return 'fast timers' if mean < FAST * self._window else 'timers'

    def _find(self) -> Tuple[List[float], float]:
        with_gaps = self._parts_with_gaps()
        judged = [part for number, start in enumerate(self._starts)
                  for part in self._parts_of(number, start)]
        pools: Dict[str, List[int]] = {}
        for index, relation in enumerate(self.relations):
            if relation.watched:
                pools.setdefault(self._pool(index), []).append(index)
        limits = [math.nan] * len(self._model.tracks)
        judged_tracks: Dict[bool, List[Tuple[Sequence[float], Sequence[float], float, float]]] = {
            True: [], False: []}
        silent_for: Dict[str, float] = {}
        lost = self._lost([self._model.tracks[index][1] for index in pools.get('timers', [])])
        # Silences first: what they bring by themselves is no evidence of a rate.
        for pool in sorted(pools, key=lambda pool: pool not in POOLS_OF_GAPS):
            tracks, of_gaps = pools[pool], pool in POOLS_OF_GAPS
            shown = [self._longest_gaps(self._model.tracks[index][1]) if of_gaps
                     else self._largest(index) for index in tracks]
            seen = [(self._agreed(self._model.tracks[index][1]) if pool in POOLS_OF_TIMERS
                     else largest, self._model.least_limit(self._model.tracks[index]))
                    for index, largest in zip(tracks, shown)]
            held_out = HeldOut(with_gaps if of_gaps else judged, seen, SCALE.get(pool, 0.2))
            told = held_out.margin(self._rates[pool])
            for index, all_shown, (largest, least) in zip(tracks, shown, seen):
                least_margin = LEAST_MARGIN.get(self._model.tracks[index][0], 1.25)
                most_margin = (MOST_MARGIN_OF_DELAYS
                               if self._model.tracks[index][0] in ('pairs', 'own gaps')
                               else MOST_MARGIN)
                margin = min(max(told, least_margin),
                             MOST_GAP_MARGIN if of_gaps else most_margin)
                own = (margin if of_gaps else
                       max(margin, min(held_out.excess(largest, least), MOST_OWN_MARGIN)))
                track = self._model.tracks[index]
                found = max(least, own * max(*largest, LEAST_SHARE * least),
                            self._of_silence(track, silent_for.get(track[1], 0.0)))
                if of_gaps:
                    hours = sum(part.hours for part in with_gaps)
                    starts = len({part.start for part, gap in zip(with_gaps, largest) if gap > 0})
                    longest_gap = max(largest) - self._window
                    tail = self._tail(track[1], hours, starts, longest_gap)
                    rare = self._window + tail.gap(self._rates[pool] / len(tracks))
                    longest = self._window + (MOST_TAIL_MARGIN[starts > 1]
                                              * (max(largest) - self._window))
                    if pool == 'others':
                        found = max(found, min(rare, longest))
                    mean = self._model.both.mean_gap(track[1])
                    if (pool == 'timers' and lost * HOUR / mean > self._rates[pool] / len(tracks)
                            and max(largest) - self._window < REGULAR * mean):
                        found = max(found, max(largest) + mean)
                    recorded = self._longest_recording()
                    again = max(sorted(largest)[-2:][0] - self._window if len(largest) > 1 else 0,
                                *sorted(self._gaps(track[1], longest_gap))[-2:-1])
                    if again > max(recorded / PAUSES_IN_RECORDING, MOST_MEAN_GAPS * mean):
                        all_time = min(hours * HOUR, PAUSES_IN_RECORDING * recorded)
                        found = max(found, rare, self._window + all_time)
                    silent_for[track[1]] = found - self._window
                limits[index] = self._limit(track, max(largest), found)
                if not math.isnan(limits[index]):
                    judged_tracks[of_gaps].append(
                        (all_shown, largest, least,
                         found / max(largest) if of_gaps else margin))
        gaps, gap_hours = left_out(with_gaps, judged_tracks[True])
        evidence, hours = left_out(judged, judged_tracks[False])
        return limits, highest_rate(gaps + evidence, max(gap_hours, hours))

    def _lost(self, kinds: Sequence[str]) -> float:
        """Return the share of the messages of slow timers of which one at a time was lost."""
        lost, came = 0, 0.0
        for kind in kinds:
            mean = self._model.both.mean_gap(kind)
            loss, more = (beyond * mean + self._window for beyond in (REGULAR, REGULAR + 1))
            largest = self._agreed(kind)
            lost += sum(loss <= gap < more for gap in largest)
            came += len(self._model.both.gaps[kind])
            for number, recording in enumerate(self._recordings):
                if not recording.trained_on:
                    parts = self._in_parts(self._rows[number])
                    came += sum(len(part) * self._window / mean for part, gap
                                in zip(parts, self._longest_gaps_of_parts(number, kind)) if gap)
        return lost / came if came else 0.0

    def _gaps(self, kind: str, most: float) -> List[int]:
        """Return all gaps of the training, and the longest of parts of others, up to a length."""
        gaps = list(self._model.both.gaps[kind])
        for number, recording in enumerate(self._recordings):
            if not recording.trained_on:
                gaps += [int(gap) for gap in self._longest_gaps_of_parts(number, kind)]
        return [gap for gap in gaps if gap <= most]

    def _of_silence(self, track: Track, age: float) -> float:
        """Return the evidence that a silence that is normal brings by itself."""
        if track[0] != 'fewer':
            return 0.0
        counts = self._model.learned.rates[track[1]]
        mean = sum(counts) / max(len(counts), 1)
        return -self._model.rate(track[1], mean * max(1.0 - age / RATE_SPAN, 0.0))

    def _tail(self, kind: str, hours: float, starts: int, most: float) -> Tail:
        gaps = self._gaps(kind, most)
        usual = REGULAR * self._model.both.mean_gap(kind)
        longest = [gap for gap in sorted(gaps)[-PAUSES:] if gap > usual]
        shortest = float(longest[0]) if len(longest) == PAUSES else usual
        excess = (sum(gap - shortest for gap in longest)
                  + max(self._cut_off(kind) - (shortest - usual), 0.0)) / max(len(longest), 1)
        return Tail(shortest, excess if longest else 0.0, len(longest) / hours,
                    min(len(longest), starts) + PRIOR_PAUSES)

    def _longest_recording(self) -> float:
        judged = [sum(part.hours for part in self._parts_of(number, 0)) * HOUR
                  for number in range(len(self._recordings))]
        return max([float(seen.end - seen.start) for seen in self._training()] + judged)

    def _limit(self, track: Track, largest: float, found: float) -> float:
        channel, kind, other = track
        both = self._model.both
        if channel == 'overdue':
            return self._model.overdue(kind, round(found - self._window))
        if channel == 'fewer':
            return found if found < -self._model.rate(kind, 0) else math.nan
        if channel in ('deadlines', 'company'):
            in_number = channel == 'company' or self._model.counts_requests(track)
            wait = largest * (both.mean_gap(other) if in_number and not is_mode(other)
                              else SECOND)
            return found if wait < OWED_OF_SILENCE * max(both.gaps[kind]) else math.nan
        if channel in ('own gaps', 'pairs') and largest >= MOST_EVIDENCE:
            return math.nan
        return found
