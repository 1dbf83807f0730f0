"""The ROC of the paper, literally, and its detector in silence; test_any_stamps.py has scores."""
from __future__ import annotations

import random
from dataclasses import replace

import numpy as np
import pytest
from reference import auc

from self_awareness import DetectorParameters, EventType, Learner, PaperModel, Roc
from self_awareness.judging import paper_judge
from self_awareness.recordings import RecordingEvents

MS = 1_000_000


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
    heard = RecordingEvents([EventType('', 'A', '')], np.arange(50) * 20 * MS, np.zeros(50))
    learner.count(heard)
    trained = learner.model()
    judge = paper_judge(trained, PaperModel(trained), 0.5, DetectorParameters())
    to_end = judge(replace(heard, end=3000 * MS))
    assert len(judge(heard).start) == 10 and len(to_end.start) == 31
    assert to_end.abnormal[10:30].all()
    # The clock was set before the end: the hour between is no silence.
    assert len(judge(replace(heard, end=4000 * 1000 * MS)).start) == 10
