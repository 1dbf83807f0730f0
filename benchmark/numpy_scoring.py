"""Scores events as the detectors do, with the sums of numpy: the speed that a vectorised
implementation in Python reaches. Writes the nanoseconds of an event by detector and number of
event types.
"""
from __future__ import annotations

import argparse
import json
import time
from pathlib import Path
from typing import Tuple, Union

import numpy as np

from self_awareness import EventType, Learner, PaperModel

SIZES = (15, 60, 150, 300, 1000)
BIN_SIZE = 10_000_000  # [ns]
BINS = 256  # the last one for all longer delays
TRAINING = 30.0  # [s]
SCORED = 2000  # events
ROUNDS = 5


def events_of(types: int, duration: float) -> Tuple[np.ndarray, np.ndarray]:
    """Return stamps [ns] and ids of timers of 50 ms to 2 s with chains of two answers each."""
    random = np.random.default_rng(1)
    stamps, ids = [], []
    for timer in range(0, types, 3):
        period = 0.05 * 40.0 ** random.random()
        times = 2.0 * random.random() + np.cumsum(
            period * random.normal(1.0, 0.05, int(duration / period)))
        for kind in range(timer, min(timer + 3, types)):
            stamps.append(times)
            ids.append(np.full(len(times), kind))
            delay = 0.002 + 0.038 * random.random()
            times = times + delay * random.normal(1.0, 0.05, len(times))
    order = np.argsort(np.concatenate(stamps), kind='stable')
    return ((np.concatenate(stamps)[order] * 1e9).astype(np.int64),
            np.concatenate(ids)[order].astype(np.uint32))


class NumpyDetector:
    """Equations 3 and 4 of the paper on dense histograms [e_j, e_i, bin]."""

    def __init__(self, types: int) -> None:
        self._counts = np.zeros((types, types, BINS), np.uint32)
        self.restart()

    def restart(self) -> None:
        """Forget what was seen."""
        self._last = np.zeros(len(self._counts), np.int64)
        self._seen = np.zeros(0, np.intp)

    def _bins(self, stamp: int) -> np.ndarray:
        return np.minimum((stamp - self._last[self._seen]) // BIN_SIZE, BINS - 1)

    def _track(self, stamp: int, kind: int) -> None:
        if kind not in self._seen:
            self._seen = np.sort(np.append(self._seen, kind))
        self._last[kind] = stamp

    def train(self, stamps: np.ndarray, ids: np.ndarray) -> None:
        """Count the delays of a recording."""
        for stamp, kind in zip(stamps, ids):
            self._counts[kind, self._seen, self._bins(stamp)] += 1
            self._track(stamp, kind)

    def finish(self) -> None:
        """Compute the entropies [bit] and scales from the counts, row by row to save memory."""
        types = len(self._counts)
        self._scales = np.zeros((types, types))
        self._entropies = np.zeros((types, types))
        for kind, counts in enumerate(self._counts):
            totals = counts.sum(axis=1)
            self._scales[kind] = 1.0 / np.maximum(totals, 1)
            p = counts * self._scales[kind][:, np.newaxis]
            self._entropies[kind] = -(p * np.log2(np.where(p > 0, p, 1.0))).sum(axis=1)

    def score(self, stamp: int, kind: int) -> float:
        """Score the event, then track it."""
        seen = self._seen
        p = self._counts[kind, seen, self._bins(stamp)] * self._scales[kind, seen]
        entropies = self._entropies[kind, seen]
        total = entropies.sum()
        score = p.sum() - (entropies @ p / total if total > 0 else 0.0)
        self._track(stamp, kind)
        return float(score)


class NumpyEvidence:
    """The sums of the delays and answers that the evidence detector updates at an event."""

    PREDECESSORS = 3
    ASKED = 8

    def __init__(self, types: int) -> None:
        random = np.random.default_rng(1)
        self._stamps = np.zeros(types, np.int64)
        self._numbers = np.zeros(types, np.int64)
        self._number = 0
        self._edges = np.round(2.5e6 * 2.0 ** (np.arange(49) / 4.0)).astype(np.int64)
        self._from = random.integers(0, types, (types, self.PREDECESSORS))
        self._surprises = random.normal(0.0, 1.0, (types, self.PREDECESSORS, 50))
        self._rows = np.arange(self.PREDECESSORS)
        self._delays = np.zeros((2, types, self.PREDECESSORS))
        self._drifts = np.array([[1.0], [0.5]])
        self._asked = random.integers(0, types, (types, self.ASKED))
        self._steps = np.array([-0.6, 1.2])
        self._answers = np.zeros((types, self.ASKED))

    def restart(self) -> None:
        """Forget what was seen."""
        for array in (self._stamps, self._numbers, self._delays, self._answers):
            array.fill(0)

    def score(self, stamp: int, kind: int) -> None:
        """Add up what the event says."""
        others = self._from[kind]
        first = self._numbers[others] >= self._numbers[kind]
        bins = np.searchsorted(self._edges, stamp - self._stamps[others], side='right')
        steps = first * (self._surprises[kind, self._rows, bins] - self._drifts)
        self._delays[:, kind] = np.clip(self._delays[:, kind] + steps, 0.0, 200.0)
        missed = self._numbers[self._asked[kind]] <= self._numbers[kind]
        self._answers[kind] = np.clip(self._answers[kind] + self._steps[missed.astype(np.intp)],
                                      0.0, 200.0)
        self._number += 1
        self._stamps[kind] = stamp
        self._numbers[kind] = self._number


def check(detector: NumpyDetector, types: int, stamps: np.ndarray, ids: np.ndarray) -> None:
    """Raise AssertionError unless the sums equal those of the package."""
    learner = Learner(bin_size=BIN_SIZE, horizon_bins=BINS - 1, paper=True)
    kinds = [EventType('', f'/topic_{kind}', 'T') for kind in range(types)]
    learner.count(kinds, stamps, ids)
    trained = learner.model()
    here = {kind.scope: index for index, kind in enumerate(trained.event_types)}
    mapped = np.array([here[kinds[kind].scope] for kind in ids], dtype=np.uint32)
    expected = PaperModel(trained).score_events(stamps, mapped)
    detector.restart()
    scores = [detector.score(stamp, kind) for stamp, kind in zip(stamps, ids)]
    np.testing.assert_allclose(scores, expected, rtol=1e-9, atol=1e-12)


def nanoseconds(types: int) -> Tuple[float, float]:
    """Return the time of an event with the paper's detector and with evidence [ns].

    They are medians of some rounds, after all event types were seen.
    """
    stamps, ids = events_of(types, TRAINING)
    detector = NumpyDetector(types)
    detector.train(stamps, ids)
    detector.finish()
    if types == SIZES[0]:
        check(detector, types, stamps, ids)
    return _measure(detector, types, stamps, ids), _measure(NumpyEvidence(types), types, stamps,
                                                            ids)


def _measure(detector: Union[NumpyDetector, NumpyEvidence], types: int, stamps: np.ndarray,
             ids: np.ndarray) -> float:
    durations = []
    for _ in range(ROUNDS):
        detector.restart()
        before, scored = slice(0, -SCORED), slice(-SCORED, None)
        for stamp, kind in zip(stamps[before][-20 * types:], ids[before][-20 * types:]):
            detector.score(stamp, kind)
        start = time.process_time_ns()
        for stamp, kind in zip(stamps[scored], ids[scored]):
            detector.score(stamp, kind)
        durations.append((time.process_time_ns() - start) / len(stamps[scored]))
    return float(np.median(durations))


def main() -> None:
    """Write the results."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('output', type=Path, help='JSON file')
    arguments = parser.parse_args()
    results = {types: nanoseconds(types) for types in SIZES}
    arguments.output.write_text(json.dumps(
        {detector: {types: both[index] for types, both in results.items()}
         for index, detector in enumerate(('paper', 'evidence'))}))


if __name__ == '__main__':
    main()
