"""The hand-checkable cases of vectors.json, through the Python module."""
from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path
from typing import Any, Dict, List, Tuple, Union

import numpy as np
import pytest

from self_awareness import DetectorParameters, EventType, Learner, PaperModel, Roc

MS = 1_000_000


@pytest.fixture(scope='module')
def vectors(shared: Path) -> Dict[str, Any]:
    return json.loads((shared / 'vectors.json').read_text())


def number(value: Union[str, float]) -> float:
    return float(Fraction(value))


def types_of(case: Dict[str, Any]) -> List[EventType]:
    return [EventType('', letter, '') for letter in case['alphabet']]


def arrays(case: Dict[str, Any], events: List[Tuple[int, str]]) -> Tuple[np.ndarray, np.ndarray]:
    return (np.array([t * MS for t, _ in events], dtype=np.int64),
            np.array([case['alphabet'].index(kind) for _, kind in events], dtype=np.uint32))


@pytest.mark.parametrize('name', ['alternating', 'two_bags', 'edges_and_overflow'])
def test_a_case_is_reproduced(vectors: Dict[str, Any], name: str) -> None:
    case = next(case for case in vectors['cases'] if case['name'] == name)
    learner = Learner(window=case['window_ms'] * MS, bin_size=case['bin_ms'] * MS,
                      horizon_bins=case.get('horizon_bins', 0), paper=True)
    for bag in case['train_bags']:
        learner.count(types_of(case), *arrays(case, bag))
    trained = learner.model()
    model = PaperModel(trained)
    ids = {kind.scope: index for index, kind in enumerate(trained.event_types)}

    found = {f'{i}>{j}': {str(b): n for b, n in trained.histogram(ids[i], ids[j]).items()}
             for i in ids for j in ids}
    assert {pair: counts for pair, counts in found.items() if pair in case['counts']} \
        == case['counts']
    assert not any(counts for pair, counts in found.items() if pair not in case['counts'])
    for pair, entropy in case['entropy_bits'].items():
        i, j = (ids[letter] for letter in pair.split('>'))
        assert model.entropies[i, j] == pytest.approx(number(entropy), abs=1e-12)
    for pair, weight in case['weights_all_tracked'].items():
        i, j = (ids[letter] for letter in pair.split('>'))
        assert model.weight(i, j) == pytest.approx(number(weight), abs=1e-12)

    stamps, letters = arrays(case, case['test'])
    unknown = len(ids)
    test_ids = np.array([ids.get(case['alphabet'][letter], unknown) for letter in letters])
    assert model.score_events(stamps, test_ids) == pytest.approx(
        [number(score) for score in case['event_scores']], abs=1e-12)

    verdicts = model.judge(trained.window, number(case['threshold']), DetectorParameters(), stamps,
                           test_ids)
    assert (verdicts.start // trained.window).tolist() == [w['k'] for w in case['windows']]
    assert verdicts.events.tolist() == [w['n'] for w in case['windows']]
    expected = [np.nan if w['score'] is None else number(w['score']) for w in case['windows']]
    assert verdicts.score == pytest.approx(expected, abs=1e-12, nan_ok=True)
    abnormal = (verdicts.start // trained.window)[verdicts.abnormal]
    assert abnormal.tolist() == case['abnormal_windows_empty_as_zero']


def test_no_case_is_left_out(vectors: Dict[str, Any]) -> None:
    names = [case['name'] for case in vectors['cases']]
    assert names == ['alternating', 'two_bags', 'edges_and_overflow']


def test_the_roc_cases_are_reproduced(vectors: Dict[str, Any]) -> None:
    assert vectors['roc']
    for case in vectors['roc']:
        roc = Roc(case['normal'], case['abnormal'])
        assert roc.auc == pytest.approx(number(case['auc']), abs=1e-15)
        assert roc.youden().cutoff == number(case['youden_cut'])
        assert roc.closest().cutoff == number(case['closest_cut'])
