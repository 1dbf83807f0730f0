"""A model is trained for one detector or for both, and says so where it is asked for the other."""
from __future__ import annotations

import os
import pickle
from pathlib import Path
from typing import Callable, Dict, List

import numpy as np
import pytest

from self_awareness import EvidenceModel, PaperModel, TrainedModel
from self_awareness.commands import calibrate, info, merge, score, train

Bags = List[str]


@pytest.fixture(name='models')
def _models(long_bags: Bags, tmp_path: Path) -> Dict[str, str]:
    """Return the paths of models of the same recordings, by --detector."""
    paths = {detector: str(tmp_path / detector) for detector in ('evidence', 'paper', 'both')}
    for detector, path in paths.items():
        assert train.main([*long_bags, '--detector', detector, '-o', path]) == 0
    return paths


def error_of(main: Callable[[List[str]], int], arguments: List[str],
             capsys: pytest.CaptureFixture) -> str:
    capsys.readouterr()
    assert main(arguments) == 1
    error, = capsys.readouterr().err.splitlines()
    return error


def test_evidence_is_the_default(long_bags: Bags, models: Dict[str, str], tmp_path: Path) -> None:
    path = str(tmp_path / 'default')
    assert train.main([*long_bags, '-o', path]) == 0
    assert TrainedModel.load(path).detectors == 'evidence'


def test_each_detector_learns_the_same_alone(models: Dict[str, str]) -> None:
    loaded = {detector: TrainedModel.load(path) for detector, path in models.items()}
    assert {detector: model.detectors for detector, model in loaded.items()} == {
        detector: detector for detector in models}
    both, evidence, paper = (loaded[each] for each in ('both', 'evidence', 'paper'))
    assert list(evidence.calibration.limits) == pytest.approx(
        list(both.calibration.limits), nan_ok=True, abs=0)
    assert paper.calibration is None
    np.testing.assert_array_equal(PaperModel(paper).entropies, PaperModel(both).entropies)
    for model in (evidence, paper):
        assert model.events == both.events and model.pairs == both.pairs
        assert [model.gaps(index) for index in range(3)] == [
            both.gaps(index) for index in range(3)]
        assert pickle.loads(pickle.dumps(model)).detectors == model.detectors


def test_the_file_holds_what_is_used(models: Dict[str, str]) -> None:
    assert os.path.getsize(models['evidence']) < os.path.getsize(models['both'])
    assert os.path.getsize(models['paper']) < os.path.getsize(models['both'])


def test_who_lacks_counts_says_the_way_out(long_bags: Bags, models: Dict[str, str],
                                           tmp_path: Path, capsys) -> None:
    output = ['-o', str(tmp_path / 'm')]
    for detector, other in (('evidence', 'paper'), ('paper', 'evidence')):
        model = models[detector]
        for error in (
                error_of(calibrate.main, ['--model', model, '--normal', long_bags[0],
                                          '--detector', other, *output], capsys),
                error_of(score.main, [long_bags[0], '--model', model, '--detector', other],
                         capsys)):
            assert f'{model}: it holds no counts for the {other}' in error
            assert f'--detector {other} or both' in error
    with pytest.raises(ValueError, match='no counts for the paper'):
        PaperModel(TrainedModel.load(models['evidence']))
    with pytest.raises(ValueError, match='no counts for the evidence'):
        EvidenceModel(TrainedModel.load(models['paper']))
    assert not (tmp_path / 'm').exists()


def test_models_for_different_detectors_are_not_added(
        long_bags: Bags, models: Dict[str, str], make_bag: Callable[..., str], tmp_path: Path,
        capsys) -> None:
    parts = {}
    for detector, span in (('paper', ['--end', '50']), ('evidence', ['--start', '51'])):
        parts[detector] = str(tmp_path / f'part of {detector}')
        assert train.main([long_bags[0], *span, '--detector', detector, '-o',
                           parts[detector]]) == 0
    error = error_of(merge.main, [*parts.values(), '-o', str(tmp_path / 'm')], capsys)
    assert 'trained for another detector: evidence, not paper' in error
    assert '--detector' in error
    error = error_of(train.main, ['--add-to', parts['paper'], '--detector', 'both', long_bags[1],
                                  '-o', str(tmp_path / 'm')], capsys)
    assert '--detector' in error and '--add-to' in error
    assert not (tmp_path / 'm').exists()


@pytest.mark.parametrize('detector', ['evidence', 'paper'])
def test_what_is_added_is_counted_for_the_same_detector(detector: str, long_bags: Bags,
                                                        models: Dict[str, str],
                                                        tmp_path: Path) -> None:
    output = str(tmp_path / 'm')
    assert train.main([long_bags[0], '--end', '50', '--detector', detector, '-o', output]) == 0
    assert train.main([long_bags[1], '--add-to', output, '-o', output]) == 0
    model = TrainedModel.load(output)
    assert model.detectors == detector and len(model.recordings) == 2


def test_info_shows_the_delays_of_either(models: Dict[str, str], capsys) -> None:
    for detector, model in models.items():
        capsys.readouterr()
        assert info.main([model, '--details']) == 0
        assert f'detector     {detector}' in capsys.readouterr().out
        assert info.main([model, '--pair', '/laser', '/slam']) == 0
        lines = capsys.readouterr().out.splitlines()
        assert sum('#' in line for line in lines) > 0
        assert any('entropy' in line for line in lines) == (detector != 'evidence')
