"""The limits of the evidence, literally and slowly: docs/method.md, section 5."""
from __future__ import annotations

import math
from typing import Dict, List, Sequence, Tuple

from reference_evidence import (DELAYS, KINDS, SECOND, Counts, Event, Pair, ReferenceModel,
                                ReferenceScorer, Track, gain)


def rounded(maximum: float) -> float:
    """Return the nearest of 256 values between two powers of two."""
    if maximum < 1 / 1024:
        return 0.0
    step = 2.0 ** math.floor(math.log2(maximum)) / 256
    return math.floor(maximum / step + 0.5) * step


def gumbel_limit(maxima: Sequence[float], probability: float) -> float:
    """Return what maxima exceed with the probability, by L-moments taken pair by pair."""
    n = len(maxima)
    mean = math.fsum(maxima) / n
    differences = [abs(a - b) for k, a in enumerate(maxima) for b in maxima[:k]]
    scale = math.fsum(differences) / len(differences) / 2 / math.log(2.0)
    location = mean - 0.57721566490153286 * scale
    return location - scale * math.log(-math.log(1.0 - probability))


class ReferenceLimits:
    """Limits by recordings of normal operation, each with the model that judges it.

    Args:
        model: whose limits they are.
        recordings: events, and the model that judges them.
        window, settle_time: [ns].
        budget: false alarms an hour.
    """

    def __init__(self, model: ReferenceModel,
                 recordings: Sequence[Tuple[Sequence[Event], ReferenceModel]], window: int,
                 settle_time: int, budget: float) -> None:
        self._model = model
        self._recordings = recordings
        self._window = window
        self._budget = budget
        self._settle_time = settle_time
        self.windows = sum(len(self._settled(*recording, ())) for recording in recordings)
        self._blocks = self._in_blocks(())
        self._misleading = self._misleading_pairs()
        self.tracks = [self._limit(n) for n in range(len(model.tracks))]
        linked = [rounded(max(self._linker(row) for row in block))
                  for block in self._in_blocks(self.tracks)]
        self.linker = max(1.0, 1.5 * max(linked),
                          gumbel_limit(linked, min(budget * 10 / 3600, 0.5)))

    def _settled(self, events: Sequence[Event], judging: ReferenceModel,
                 limits: Sequence[float]) -> List[List[float]]:
        # The last window lasts longer than the recording.
        rows = ReferenceScorer(judging, events, self._window, limits).rows[:-1]
        first = events[0][0] // self._window
        return [row for n, row in enumerate(rows)
                if (first + n) * self._window >= events[0][0] + self._settle_time]

    def _in_blocks(self, limits: Sequence[float]) -> List[List[List[float]]]:
        length = 10 * SECOND // self._window
        blocks = []
        for recording in self._recordings:
            settled = self._settled(*recording, limits)
            blocks += [settled[begin:begin + length]
                       for begin in range(0, len(settled) - length + 1, length)]
        return blocks

    def _misleading_pairs(self) -> List[Pair]:
        pairs = []
        for events, _ in self._recordings:
            for chunk in self._chunks(events):
                now = Counts([chunk], self._model.types, self._window)
                pairs += [(i, j) for i in self._model.types for j in self._model.types
                          if len(now.delays[i, j]) >= 50 and gain(self._model.both, now, i, j)
                          < 0.7 * gain(self._model.both, self._model.both, i, j)]
        return pairs

    @staticmethod
    def _chunks(events: Sequence[Event]) -> List[List[Event]]:
        chunks: List[List[Event]] = [[]]
        for event in events:
            chunks[-1].append(event)
            if event[0] - chunks[-1][0][0] >= 100 * SECOND:
                chunks.append([])
        return [chunk for chunk in chunks if chunk]

    def _limit(self, index: int) -> float:
        channel, kind, other = track = self._model.tracks[index]
        of_kind = [t for t in self._model.tracks if KINDS[t[0]] == KINDS[channel]]
        per_hour = self._budget / 4 / len(of_kind)
        if channel == 'overdue':
            age = self._overdue_age(kind, per_hour)
            irregular = age > 10 * SECOND and age > 3 * self._model.both.mean_gap(kind)
            return math.nan if irregular else self._model.overdue(kind, round(age))
        maxima = [rounded(max(row[index] for row in block)) for block in self._blocks]
        found = max(self._least(track), 1.25 * max(maxima),
                    gumbel_limit(maxima, min(per_hour * 10 / 3600, 0.5)))
        if channel in DELAYS:
            useless = (other, kind) in self._misleading or found > 100
        else:
            useless = channel == 'answer' and (found / self._model.answer_step(track, True)
                                               * self._model.both.mean_gap(other) > 10 * SECOND)
        return math.nan if useless else found

    def _least(self, track: Track) -> float:
        if track[0] == 'answer':
            return max(4 * self._model.answer_step(track, True), 5.0)
        return 13.0 if track[0] in DELAYS else 3.0

    def _overdue_age(self, kind: str, per_hour: float) -> float:
        gaps = list(self._model.both.gaps[kind])
        duration = self._model.both.duration
        for events, _ in self._recordings:
            own = [t for t, other in events if other == kind]
            gaps += [b - a for a, b in zip(own, own[1:])]
            duration += events[-1][0] - events[0][0]
        longest = sorted(gaps)[-20:]
        excess = sum(gap - longest[0] for gap in longest) / len(longest)
        rarer = len(longest) / (duration / SECOND) / (per_hour / 3600)
        return max(longest[0] + excess * max(math.log(rarer), 0.0), 1.1 * longest[-1])

    def _linker(self, row: Sequence[float]) -> float:
        shares: Dict[str, float] = {}
        for (channel, kind, _), value, limit in zip(self._model.tracks, row, self.tracks):
            if channel in ('slow delay', 'answer') and not math.isnan(limit):
                shares[kind] = max(shares.get(kind, 0.0), min(value / limit, 1.0))
        return sum(shares.values())
