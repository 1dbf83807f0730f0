"""The paper's model, literally and slowly, with the mends of docs/method.md, section 2.3.

Nothing here is shared with the package: it is what the core is compared with. Stamps in ns.
"""
from __future__ import annotations

import math
from collections import Counter
from typing import Dict, List, Sequence, Tuple

Event = Tuple[int, str]
Pair = Tuple[str, str]


class Reference:
    """M = {P_ij}, by listing 1 run once for every pair."""

    def __init__(self, recordings: Sequence[Sequence[Event]], bin_size: int,
                 horizon_bins: int = 0) -> None:
        self.bin_size = bin_size
        self.horizon_bins = horizon_bins
        self.types = sorted({kind for recording in recordings for _, kind in recording})
        self.counts: Dict[Pair, Counter] = {
            (i, j): self._distribution(i, j, recordings) for i in self.types for j in self.types}

    def _distribution(self, e_i: str, e_j: str, recordings: Sequence[Sequence[Event]]) -> Counter:
        counts: Counter = Counter()
        for recording in recordings:
            t_i = None
            for t, kind in recording:
                if kind == e_j and t_i is not None:
                    counts[self.bin(t - t_i)] += 1
                if kind == e_i:
                    t_i = t
        return counts

    def bin(self, delay: int) -> int:
        """b = floor(delay / s_b), or the overflow bin."""
        index = max(0, delay) // self.bin_size
        return min(index, self.horizon_bins) if self.horizon_bins else index

    def probability(self, i: str, j: str, delay: int) -> float:
        """P_ij of a delay."""
        total = sum(self.counts[i, j].values())
        return self.counts[i, j][self.bin(delay)] / total if total else 0.0

    def entropy(self, i: str, j: str) -> float:
        """h_ij [bit]."""
        total = sum(self.counts[i, j].values())
        return -math.fsum(n / total * math.log2(n / total) for n in self.counts[i, j].values())

    def weight(self, i: str, j: str, tracked: Sequence[str]) -> float:
        """w_ij of eq. 4 over the tracked event types."""
        all_entropies = math.fsum(self.entropy(k, j) for k in tracked)
        return 1.0 - self.entropy(i, j) / all_entropies if all_entropies else 1.0

    def event_scores(self, events: Sequence[Event]) -> List[float]:
        """s_j of eq. 3, event by event; an unknown one scores 0."""
        scores = []
        for n, (t, j) in enumerate(events):
            last = {kind: stamp for stamp, kind in events[:n] if kind in self.types}
            scores.append(math.fsum(
                self.weight(i, j, sorted(last)) * self.probability(i, j, t - t_i)
                for i, t_i in last.items()) if j in self.types else 0.0)
        return scores


def auc(normal: Sequence[float], abnormal: Sequence[float]) -> float:
    """P(abnormal < normal) + P(tie) / 2, pair by pair."""
    wins = sum((a < n) + (a == n) / 2 for n in normal for a in abnormal)
    return wins / (len(normal) * len(abnormal))
