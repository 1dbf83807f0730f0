"""A model is trained for one detector or for both, and says so where it is asked for the other."""
from __future__ import annotations

from pathlib import Path
from typing import Dict, List

import pytest
from conftest import error_of, trained

from self_awareness import EvidenceModel, PaperModel, TrainedModel
from self_awareness.commands import calibrate, info, merge, score

Bags = List[str]


@pytest.fixture(name='models')
def _models(long_bags: Bags, tmp_path: Path) -> Dict[str, str]:
    """Return the paths of models of the same recordings, by --detector."""
    paths = {detector: str(tmp_path / detector) for detector in ('evidence', 'paper', 'both')}
    for detector, path in paths.items():
        trained(long_bags, Path(path), '--detector', detector)
    return paths


def test_who_lacks_counts_says_the_way_out(long_bags: Bags, models: Dict[str, str],
                                           tmp_path: Path, capsys) -> None:
    output = ['-o', str(tmp_path / 'm')]
    for detector, other in (('evidence', 'paper'), ('paper', 'evidence')):
        model = models[detector]
        for error in (
                error_of(calibrate, ['--model', model, '--normal', long_bags[0],
                                     '--detector', other, *output], capsys),
                error_of(score, [long_bags[0], '--model', model, '--detector', other], capsys)):
            assert f'{model}: it holds no counts for the {other}' in error
            assert f'--detector {other} or both' in error
    with pytest.raises(ValueError, match='no counts for the paper'):
        PaperModel(TrainedModel.load(models['evidence']))
    with pytest.raises(ValueError, match='no counts for the evidence'):
        EvidenceModel(TrainedModel.load(models['paper']))
    assert not (tmp_path / 'm').exists()


def test_models_for_different_detectors_are_not_added(long_bags: Bags, tmp_path: Path,
                                                      capsys) -> None:
    for detector, bag in zip(('paper', 'evidence'), long_bags):
        trained([bag], tmp_path / detector, '--detector', detector)
    error = error_of(merge, [str(tmp_path / 'paper'), str(tmp_path / 'evidence'), '-o',
                             str(tmp_path / 'm')], capsys)
    assert 'trained for another detector: evidence, not paper' in error
    assert '--detector' in error
    assert not (tmp_path / 'm').exists()


@pytest.mark.parametrize('detector', ['evidence', 'paper'])
def test_what_is_added_is_counted_for_the_same_detector(detector: str, long_bags: Bags,
                                                        tmp_path: Path) -> None:
    output = tmp_path / 'm'
    trained([long_bags[0]], output, '--end', '50', '--detector', detector)
    model = trained([long_bags[1]], output, '--add-to', str(output))
    assert model.detectors == detector and len(model.recordings) == 2


def test_info_says_for_which_detector_it_was_trained(models: Dict[str, str], capsys) -> None:
    for detector, model in models.items():
        capsys.readouterr()
        assert info.main([model, '--details']) == 0
        assert f'detector     {detector}' in capsys.readouterr().out
