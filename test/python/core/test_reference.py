"""The core against a literal, slow implementation of the paper, on random sequences."""
from __future__ import annotations

import random
from typing import List

import numpy as np
import pytest
from reference import Event, Reference, auc

from self_awareness import DetectorParameters, EventType, Learner, PaperModel, Roc

MS = 1_000_000
THRESHOLD = 0.4


def random_recording(chance: random.Random, alphabet: str, start: int) -> List[Event]:
    """Events with equal stamps, gaps of several windows, and types that are first seen late."""
    stamp = start
    events = []
    for n in range(chance.randint(2, 60)):
        late = n < 20 and len(alphabet) > 1
        events.append((stamp, chance.choice(alphabet[1:] if late else alphabet)))
        stamp += chance.choice([0, 0, 1, 7, 10, 10, 33, 100, 250]) * MS + chance.choice([0, 1])
    return events


@pytest.mark.parametrize('seed', range(60))
def test_the_core_does_what_the_paper_says(seed: int) -> None:
    chance = random.Random(seed)
    letters = 'ABCDE'[:chance.randint(1, 5)]
    recordings = [random_recording(chance, letters, chance.randrange(10 ** 12))
                  for _ in range(chance.randint(1, 3))]
    bin_size = chance.choice([1, 5, 10, 30]) * MS
    horizon_bins = chance.choice([0, 0, 1, 8])
    window = chance.choice([20, 100]) * MS
    reference = Reference(recordings, bin_size, horizon_bins)

    learner = Learner(window=window, bin_size=bin_size, horizon_bins=horizon_bins, paper=True)
    every_type = [EventType('', letter, '') for letter in 'ABCDEU']
    for recording in recordings:
        learner.count(every_type, np.array([t for t, _ in recording]),
                      np.array(['ABCDEU'.index(kind) for _, kind in recording]))
    trained = learner.model()
    model = PaperModel(trained)
    ids = {kind.scope: index for index, kind in enumerate(trained.event_types)}

    assert sorted(ids) == reference.types
    for i in ids:
        for j in ids:
            assert trained.histogram(ids[i], ids[j]) == dict(reference.counts[i, j])
            assert model.entropies[ids[i], ids[j]] == pytest.approx(reference.entropy(i, j),
                                                                    abs=1e-12)
            assert model.weight(ids[i], ids[j]) == pytest.approx(
                reference.weight(i, j, reference.types), abs=1e-12)

    test = random_recording(chance, letters + 'U', chance.randrange(10 ** 12))
    stamps = np.array([t for t, _ in test])
    test_ids = np.array([ids.get(kind, len(ids)) for _, kind in test])
    assert model.score_events(stamps, test_ids) == pytest.approx(reference.event_scores(test),
                                                                 abs=1e-12)
    verdicts = model.judge(window, THRESHOLD, DetectorParameters(), stamps, test_ids)
    expected = reference.windows(test, window)
    assert list(zip(verdicts.start.tolist(), verdicts.events.tolist(),
                    verdicts.unknown.tolist())) == [row[:3] for row in expected]
    assert verdicts.score == pytest.approx(
        [np.nan if row[3] is None else row[3] for row in expected], abs=1e-12, nan_ok=True)
    assert verdicts.abnormal.tolist() == [(row[3] or 0.0) < THRESHOLD for row in expected]


@pytest.mark.parametrize('seed', range(20))
def test_the_roc_is_that_of_all_pairs(seed: int) -> None:
    chance = random.Random(seed)
    normal = [chance.randint(2, 9) / 2 for _ in range(chance.randint(1, 30))]
    abnormal = [chance.randint(0, 7) / 2 for _ in range(chance.randint(1, 30))]
    roc = Roc(normal, abnormal)
    assert roc.auc == pytest.approx(auc(normal, abnormal), abs=1e-12)
    for point in roc.points:
        assert point.true_positive_rate == pytest.approx(
            sum(score < point.cutoff for score in abnormal) / len(abnormal))
        assert point.false_positive_rate == pytest.approx(
            sum(score < point.cutoff for score in normal) / len(normal))
    best = max(point.true_positive_rate - point.false_positive_rate for point in roc.points)
    youden = roc.youden()
    assert youden.true_positive_rate - youden.false_positive_rate == pytest.approx(best)


def test_silence_to_the_end_of_the_recording_has_windows_only_where_it_is_asked_for() -> None:
    learner = Learner(window=100 * MS, bin_size=10 * MS, paper=True)
    types = [EventType('', 'A', '')]
    stamps = np.arange(50) * 20 * MS
    learner.count(types, stamps, np.zeros(50))
    trained = learner.model()
    model = PaperModel(trained)
    parameters = DetectorParameters()
    heard = model.judge(trained.window, 0.5, parameters, stamps, np.zeros(50))
    to_end = model.judge(trained.window, 0.5, parameters, stamps, np.zeros(50), 3000 * MS)
    assert len(heard.start) == 10 and len(to_end.start) == 31
    assert to_end.abnormal[10:30].all()
    # The clock was set before the end: the hour between is no silence.
    assert len(model.judge(trained.window, 0.5, parameters, stamps, np.zeros(50),
                           4000 * 1000 * MS).start) == 10
