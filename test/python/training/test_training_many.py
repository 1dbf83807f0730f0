"""Training on more bags on top of a model."""
from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import List, Tuple

import pytest
from conftest import error_of, jittery_robot, learned, train_tuned, trained, write_bag

from self_awareness import EvidenceModel, TrainedModel, Tuning
from self_awareness.commands import train
from self_awareness.training.robot_graph import RobotGraph

LENGTH_S = 40.0


@pytest.fixture(scope='module', name='bags')
def _bags(tmp_path_factory: pytest.TempPathFactory) -> List[str]:
    folder = tmp_path_factory.mktemp('many')
    return [write_bag(folder / f'{index}.bag',
                      jittery_robot(10000.0 * (index + 1), LENGTH_S, index)) for index in range(5)]


def test_more_is_added_to_a_model(bags: List[str], tmp_path: Path, capsys) -> None:
    whole = trained(bags, tmp_path / 'whole', '--bin', '0.02', '--window', '0.2', '--horizon', '5')
    model = tmp_path / 'm'
    trained(bags[:3], model, '--bin', '0.02', '--window', '0.2', '--horizon', '5')
    continued = trained(bags[3:], model, '--add-to', str(model))
    assert learned(continued) == learned(whole)  # the halves go on in turn
    found = continued.calibration
    assert [each.bag for each in found.recordings] == ['3.bag', '4.bag']
    assert found.windows < whole.calibration.windows
    assert [path.name for path in tmp_path.iterdir() if path.name.startswith('m')] == ['m']


def test_limits_of_a_model_do_not_outlast_what_is_added(bags: List[str], robot_bags,
                                                        evidence_model: str,
                                                        tmp_path: Path) -> None:
    model = trained([robot_bags[0]], tmp_path / 'm', '--add-to', evidence_model)
    assert model.calibration is None  # 30 s are too little for others
    assert len(model.recordings) == 2


def test_the_graph_is_kept_unless_another_is_asked_for(bags: List[str], tmp_path: Path,
                                                       monkeypatch) -> None:
    output = tmp_path / 'm'
    model = trained(bags[:1], output)
    model.graph = {('/laser', '/scan', '/slam')}
    model.save(str(output))
    assert trained(bags[1:2], output, '--add-to', str(output)).graph == model.graph
    monkeypatch.setattr('self_awareness.training.live_graph.fetch',
                        lambda: RobotGraph({'/x': {'/a'}}, {'/x': {'/b'}}))
    again = trained(bags[2:3], output, '--add-to', str(output), '--graph')
    assert again.graph == {('/a', '/x', '/b')}


def test_what_is_in_the_model_already_is_not_added(bags: List[str], tmp_path: Path,
                                                   capsys) -> None:
    model = tmp_path / 'm'
    trained(bags[:2], model, '--end', '20')
    before = model.read_bytes()
    error = error_of(train, [bags[1], '--add-to', str(model), '-o', str(model)], capsys)
    assert bags[1] in error and '1.bag, which the model was trained on' in error
    assert model.read_bytes() == before
    assert len(trained([bags[1]], model, '--add-to', str(model), '--start', '21').recordings) == 3


def test_the_tuning_of_a_model_stays_when_more_is_added(bags: List[str], tmp_path: Path) -> None:
    def most_watched(model: TrainedModel) -> int:
        return max(Counter(track.to_id for track in EvidenceModel(model).tracks
                           if track.name == 'pairs').values())

    base = train_tuned(bags[:2], tmp_path / 'base', predecessors=1)
    model = trained(bags[2:4], tmp_path / 'm', '--add-to', base, '--jobs', '2')
    assert model.tuning == TrainedModel.load(base).tuning != Tuning()
    assert most_watched(model) == 1 < most_watched(trained(bags[:4], tmp_path / 'default'))


@pytest.mark.parametrize('option', [('--bin', '0.01'), ('--window', '0.1'), ('--horizon', '1'),
                                    ('--encoding', 'e.yaml'), ('--detector', 'paper'),
                                    ('--rename', '/a', '/b')])
def test_how_a_model_counts_is_not_changed(option: Tuple[str, ...], model_file: str,
                                           bags: List[str], tmp_path: Path, capsys) -> None:
    arguments = [bags[0], '--add-to', model_file, *option, '-o', str(tmp_path / 'm')]
    error = error_of(train, arguments, capsys)
    assert f'{option[0]}: leave it out' in error and model_file in error
    assert not (tmp_path / 'm').exists()
