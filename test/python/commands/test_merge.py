"""`merge`: models of robots of the same kind become one."""
from __future__ import annotations

import os
from pathlib import Path
from typing import Callable, List

import pytest
from conftest import learned, robot, train_tuned

from self_awareness import TrainedModel, Tuning
from self_awareness.commands import merge, train


@pytest.fixture(name='trained')
def _trained(robot_bags, tmp_path: Path, make_bag: Callable[..., str]) -> Callable[..., str]:
    """Return a function (name, *arguments of train) that trains a model and returns its path."""
    def make(name: str, *arguments: str) -> str:
        path = str(tmp_path / name)
        assert train.main([*arguments, '-o', path]) == 0
        return path
    return make


def error_of(arguments: List[str], capsys: pytest.CaptureFixture) -> str:
    capsys.readouterr()
    assert merge.main(arguments) == 1
    error, = capsys.readouterr().err.splitlines()
    assert error.startswith('merge: error: ')
    return error


def test_models_add_up_to_a_training_on_all(trained: Callable[..., str], make_bag, tmp_path: Path,
                                            capsys) -> None:
    bags = [make_bag(f'{i}.bag', [*robot(1000.0 * i), *((1000.0 * i + 31.0 + k, f'/{i}', '/e')
                                                        for k in range(4))]) for i in range(1, 5)]
    first, second = trained('first', *bags[:2]), trained('second', *bags[2:])
    output = tmp_path / 'merged'
    capsys.readouterr()
    assert merge.main([first, second, '-o', str(output)]) == 0
    assert capsys.readouterr().out.splitlines() == [
        'learned from 4 starts, 2 min: no limits yet, so that nothing is an alarm',
        f'written: {output}, without limits and threshold',
        'next, with recordings that it was not trained on:',
        f'  rosrun self_awareness calibrate --model {output} --normal BAG -o {output}']
    merged = TrainedModel.load(str(output))
    assert learned(merged) == learned(TrainedModel.load(trained('all', *bags)))
    assert sorted(path.name for path in tmp_path.iterdir() if path.suffix != '.bag') == [
        'all', 'first', 'merged', 'second']


def test_limits_of_one_robot_are_not_those_of_all(evidence_model: str, model_file: str,
                                                  tmp_path: Path) -> None:
    assert TrainedModel.load(evidence_model).calibration is not None
    output = str(tmp_path / 'm')
    assert merge.main([evidence_model, model_file, '-o', output]) == 0
    merged = TrainedModel.load(output)
    assert merged.calibration is None and merged.paper_calibration is None


def test_the_graph_is_that_of_all(model_file: str, evidence_model: str, tmp_path: Path) -> None:
    paths = []
    for number, (path, graph) in enumerate((
            (model_file, {('/a', '/x', '/b'), ('/c', '/z', '/d')}),
            (evidence_model, {('/a', '/x', '/c'), ('/a', '/y', '/b')}))):
        model = TrainedModel.load(path)
        model.graph = graph
        paths.append(str(tmp_path / str(number)))
        model.save(paths[-1])
    output = str(tmp_path / 'm')
    assert merge.main([*paths, '-o', output]) == 0
    assert TrainedModel.load(output).graph == {
        ('/a', '/x', '/b'), ('/a', '/x', '/c'), ('/a', '/y', '/b'), ('/c', '/z', '/d')}


@pytest.mark.parametrize('options, told', [
    (['--bin', '0.02'], 'another bin size: 0.02 s, not 0.01 s'),
    (['--window', '0.25'], 'another length of the windows: 0.25 s, not 0.1 s'),
    (['--horizon', '10'], 'another horizon: 10 s, not none'),
    (['--encoding', 'source'], 'another encoding: source differs'),
    (['--encoding', 'exclude_topics'], 'another encoding: exclude_topics differs')])
def test_what_does_not_fit_is_told(options: List[str], told: str, model_file: str, robot_bags,
                                   trained: Callable[..., str], tmp_path: Path, capsys) -> None:
    if options[0] == '--encoding':
        (tmp_path / 'e').write_text({'source': 'source: none',
                                     'exclude_topics': 'exclude_topics: [/x]'}[options[1]])
        options = ['--encoding', str(tmp_path / 'e')]
    other = trained('other', robot_bags[1], '--detector', 'both', *options)
    error = error_of([model_file, other, '-o', str(tmp_path / 'm')], capsys)
    assert f'{other}: does not fit {model_file}: {told}' in error
    assert not (tmp_path / 'm').exists()


def test_models_of_different_tuning_get_that_of_this_version(robot_bags, tmp_path: Path,
                                                             capsys) -> None:
    paths = [train_tuned([bag], tmp_path / str(number), least_effect=0.003 + number / 1000)
             for number, bag in enumerate(robot_bags)]
    output = str(tmp_path / 'm')
    assert merge.main([*paths, '-o', output]) == 0
    assert 'the result has those of this version' in capsys.readouterr().out
    assert TrainedModel.load(output).tuning == Tuning()


def test_models_of_the_same_tuning_add_up(robot_bags, tmp_path: Path) -> None:
    paths = [train_tuned([bag], tmp_path / str(number), least_effect=0.003)
             for number, bag in enumerate(robot_bags)]
    output = str(tmp_path / 'm')
    assert merge.main([*paths, '-o', output]) == 0
    assert TrainedModel.load(output).tuning == TrainedModel.load(paths[0]).tuning


def test_a_recording_does_not_count_twice(robot_bags, model_file: str, trained, tmp_path: Path,
                                          capsys) -> None:
    os.symlink(robot_bags[0], tmp_path / 'renamed.bag')
    other = trained('other', robot_bags[1], str(tmp_path / 'renamed.bag'))
    error = error_of([model_file, other, '-o', str(tmp_path / 'm')], capsys)
    assert model_file in error and other in error and 'renamed.bag' in error
    assert not (tmp_path / 'm').exists()


def test_parts_of_one_recording_may_come_from_two_models(robot_bags, trained,
                                                         tmp_path: Path) -> None:
    first = trained('first', robot_bags[0], '--end', '14')
    second = trained('second', robot_bags[0], '--start', '15')
    assert merge.main([first, second, '-o', str(tmp_path / 'm')]) == 0


def test_a_bad_model_or_only_one_is_named(model_file: str, robot_bags, tmp_path: Path,
                                          capsys) -> None:
    output = ['-o', str(tmp_path / 'm')]
    missing = str(tmp_path / 'missing')
    assert missing in error_of([model_file, missing, *output], capsys)
    assert robot_bags[0] in error_of([model_file, robot_bags[0], *output], capsys)
    assert 'at least two' in error_of([model_file, *output], capsys)
    assert not (tmp_path / 'm').exists()


def test_nothing_but_a_model_is_replaced(model_file: str, evidence_model: str, robot_bags,
                                         tmp_path: Path, capsys) -> None:
    models = [model_file, evidence_model]
    bag = Path(robot_bags[1])
    contents = [path.read_bytes() for path in (*map(Path, models), bag)]
    assert 'is there already' in error_of([*models, '-o', str(bag)], capsys)
    assert 'is an input' in error_of([*models, '-o', model_file], capsys)
    assert [path.read_bytes() for path in (*map(Path, models), bag)] == contents
    output = tmp_path / 'm'
    output.write_bytes(contents[0])
    assert merge.main([*models, '-o', str(output)]) == 0
    assert len(TrainedModel.load(str(output)).recordings) == 2
