"""scikit-learn's one-class SVM on the counts of a window's events."""
from __future__ import annotations

from typing import Sequence

import numpy as np
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler
from sklearn.svm import OneClassSVM

from self_awareness_evaluation.peers.counts import CountScorer

_OUTLIERS = 0.01  # nu: largest share of the training windows outside


class OneClassSvmScorer(CountScorer):
    """RBF kernel of scikit-learn's default width, on counts of mean 0 and variance 1."""

    def __init__(self) -> None:
        super().__init__()
        self._svm = make_pipeline(StandardScaler(), OneClassSVM(nu=_OUTLIERS))

    def _fit(self, tables: Sequence[np.ndarray]) -> None:
        self._svm.fit(np.concatenate(tables))

    def _score(self, table: np.ndarray) -> np.ndarray:
        return self._svm.decision_function(table)
