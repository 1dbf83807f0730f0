"""scikit-learn's Isolation Forest on the counts of a window's events.

Its trees split between values that were trained on: a count that never varied, as that of a topic
with a multiple of 10 Hz and little jitter, is not looked at, and silence there is not seen.
"""
from __future__ import annotations

from typing import Sequence

import numpy as np
from sklearn.ensemble import IsolationForest

from self_awareness_evaluation.peers.counts import CountScorer


class IsolationForestScorer(CountScorer):
    """The forest as scikit-learn sets it up, 100 trees of 256 windows each."""

    def __init__(self) -> None:
        super().__init__()
        self._forest = IsolationForest(random_state=0)

    def _fit(self, tables: Sequence[np.ndarray]) -> None:
        self._forest.fit(np.concatenate(tables))

    def _score(self, table: np.ndarray) -> np.ndarray:
        return self._forest.score_samples(table)
