"""`merge`: models of robots of the same kind become one."""
from __future__ import annotations

import os
from pathlib import Path
from typing import List

import pytest
from conftest import error_of, learned, printed_by, robot, train_tuned, trained

from self_awareness import TrainedModel, Tuning
from self_awareness.commands import merge


def test_models_add_up_to_a_training_on_all(make_bag, tmp_path: Path, capsys) -> None:
    bags = [make_bag(f'{i}.bag', [*robot(1000.0 * i), *((1000.0 * i + 31.0 + k, f'/{i}', '/e')
                                                        for k in range(4))]) for i in range(1, 5)]
    first, second, output = (tmp_path / name for name in ('first', 'second', 'merged'))
    trained(bags[:2], first)
    trained(bags[2:], second)
    capsys.readouterr()
    assert merge.main([str(first), str(second), '-o', str(output)]) == 0
    assert capsys.readouterr().out.splitlines() == [
        'learned from 4 starts, 2 min: no limits yet, so that nothing is an alarm',
        f'written: {output}, without limits and threshold',
        'next, with recordings that it was not trained on:',
        f'  rosrun self_awareness calibrate --model {output} --normal BAG -o {output}']
    merged = TrainedModel.load(str(output))
    assert learned(merged) == learned(trained(bags, tmp_path / 'all'))
    assert sorted(path.name for path in tmp_path.iterdir() if path.suffix != '.bag') == [
        'all', 'first', 'merged', 'second']


def test_models_of_different_tuning_get_that_of_this_version(robot_bags, tmp_path: Path) -> None:
    paths = [train_tuned([bag], tmp_path / str(number), least_effect=0.003 + number / 1000)
             for number, bag in enumerate(robot_bags)]
    output = str(tmp_path / 'm')
    assert 'the result has those of this version' in printed_by(merge, [*paths, '-o', output])
    assert TrainedModel.load(output).tuning == Tuning()


@pytest.mark.parametrize('options, why', [
    (['--detector', 'both', '--bin', '0.02'], 'another bin size: 0.02 s, not 0.01 s'),
    (['--detector', 'paper'], 'trained for another detector: paper, not both')])
def test_what_does_not_fit_is_told(options: List[str], why: str, model_file: str, robot_bags,
                                   tmp_path: Path) -> None:
    other = str(tmp_path / 'other')
    trained([robot_bags[1]], tmp_path / 'other', *options)
    error = error_of(merge, [model_file, other, '-o', str(tmp_path / 'm')])
    assert f'{other}: does not fit {model_file}: {why}' in error
    assert not (tmp_path / 'm').exists()


def test_a_recording_does_not_count_twice(robot_bags, model_file: str, tmp_path: Path) -> None:
    os.symlink(robot_bags[0], tmp_path / 'renamed.bag')
    other = str(tmp_path / 'other')
    trained([robot_bags[1], tmp_path / 'renamed.bag'], tmp_path / 'other')
    error = error_of(merge, [model_file, other, '-o', str(tmp_path / 'm')])
    assert model_file in error and other in error and 'renamed.bag' in error
    assert 'at least two' in error_of(merge, [other, '-o', str(tmp_path / 'm')])
    assert not (tmp_path / 'm').exists()


def test_parts_of_one_recording_may_come_from_two_models(robot_bags, tmp_path: Path) -> None:
    models = [str(tmp_path / name) for name in ('first', 'second')]
    for model, option in zip(models, (['--end', '14'], ['--start', '15'])):
        trained([robot_bags[0]], Path(model), *option)
    assert merge.main([*models, '-o', str(tmp_path / 'm')]) == 0
