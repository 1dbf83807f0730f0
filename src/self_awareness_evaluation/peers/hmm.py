"""hmmlearn's hidden Markov model of the counts of a window's events, Poisson in every state.

The score of a window is the log-likelihood of its counts given all windows before it.
"""
from __future__ import annotations

import logging
from math import lgamma
from typing import Sequence

import numpy as np
from hmmlearn.hmm import PoissonHMM

from self_awareness_evaluation.peers.counts import CountScorer

_STATES = 8
_ITERATIONS = 30

# An event never seen in a state is unlikely there, not impossible: half an event in all training.
_FEWEST_EVENTS = 0.5


class HmmScorer(CountScorer):
    """A Poisson HMM of 8 states."""

    def __init__(self) -> None:
        super().__init__()
        self._start = np.empty(0)
        self._transitions = np.empty((0, 0))
        self._rates = np.empty((0, 0))

    def _fit(self, tables: Sequence[np.ndarray]) -> None:
        # It warns where the last iterations of the fit still change the likelihood a little.
        logging.getLogger('hmmlearn').setLevel(logging.ERROR)
        table = np.concatenate(tables).astype(int)
        model = PoissonHMM(n_components=_STATES, n_iter=_ITERATIONS, random_state=0)
        model.fit(table, [len(part) for part in tables])
        self._start, self._transitions = model.startprob_, model.transmat_
        self._rates = np.maximum(model.lambdas_, _FEWEST_EVENTS / len(table))

    def _score(self, table: np.ndarray) -> np.ndarray:
        emission = _log_poisson(table, self._rates)
        scores = np.empty(len(table))
        state = self._start
        for window, likelihoods in enumerate(emission):
            # Scaled by the largest, since the likelihoods themselves underflow.
            largest = likelihoods.max()
            joint = state * np.exp(likelihoods - largest)
            total = joint.sum()
            if total > 0.0:
                scores[window] = largest + np.log(total)
                state = joint / total @ self._transitions
            else:  # no state that is possible now explains the window: start again
                scores[window] = likelihoods.min()
                state = self._start
        return scores


def _log_poisson(table: np.ndarray, rates: np.ndarray) -> np.ndarray:
    """Return the log-probability of the counts of every window in every state."""
    log_factorials = np.array([lgamma(count + 1.0) for count in range(int(table.max()) + 1)])
    return (table @ np.log(rates).T - rates.sum(axis=1)
            - log_factorials[table.astype(int)].sum(axis=1)[:, np.newaxis])
