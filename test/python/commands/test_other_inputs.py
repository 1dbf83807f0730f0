"""What is named in place of a bag or a model: folders, pipes, files of another kind."""
from __future__ import annotations

import os
import shutil
import signal
from pathlib import Path
from types import ModuleType
from typing import List

import pytest
from conftest import error_of, trained

from self_awareness import recordings_in_event_log
from self_awareness.commands import calibrate, convert, diff, info, score, train

PIPE_S = 60


@pytest.fixture
def folder(robot_bags, tmp_path: Path) -> Path:
    """Two recordings in a folder, with something else beside them."""
    made = tmp_path / 'bags'
    made.mkdir()
    for bag in robot_bags:
        shutil.copy(bag, made)
    (made / 'notes.txt').write_text('monday, tuesday\n')
    return made


def test_a_folder_stands_for_its_bags(folder: Path, model_file: str, tmp_path: Path,
                                      capsys) -> None:
    log = str(tmp_path / 'all.bag')
    model = trained([folder], tmp_path / 'm')
    assert [Path(each.bag).name for each in model.recordings] == ['first.bag', 'second.bag']
    assert score.main([str(folder), '--model', model_file]) == 0
    out = capsys.readouterr().out
    assert f'{folder}/first.bag: ' in out and f'{folder}/second.bag: ' in out
    assert convert.main([str(folder), '-o', log]) == 0
    assert recordings_in_event_log(log) == 2


def test_a_part_of_a_folder_is_that_part_of_each_bag(folder: Path, tmp_path: Path) -> None:
    model = trained([f'{folder}@5-20'], tmp_path / 'm')
    assert all(each.end - each.start < 15.1e9 for each in model.recordings)


def test_a_folder_without_bags_is_named(tmp_path: Path, capsys) -> None:
    (tmp_path / '.self_awareness_part1_0.normal.bag').touch()  # somebody is writing it
    for program in (train, convert):
        error = error_of(program, [str(tmp_path), '-o', str(tmp_path / 'out')], capsys)
        assert f'{tmp_path}: a folder without bags' in error


@pytest.mark.parametrize('program, arguments', [
    (calibrate, ['--model', '{model}', '--normal', '{pipe}', '-o', '{out}']),
    (score, ['{bag}', '--model', '{pipe}']),
    (info, ['{pipe}']),
    (diff, ['{model}', '{pipe}'])])
def test_a_pipe_is_no_bag_and_no_model(program: ModuleType, arguments: List[str], robot_bags,
                                       model_file: str, tmp_path: Path, capsys) -> None:
    """Opened, it would let the program wait for a writer for ever."""
    pipe = tmp_path / 'pipe'
    os.mkfifo(pipe)
    names = {'pipe': str(pipe), 'out': str(tmp_path / 'out'), 'bag': robot_bags[1],
             'model': model_file}
    signal.alarm(PIPE_S)
    error = error_of(program, [each.format(**names) for each in arguments], capsys)
    signal.alarm(0)
    assert f'{pipe}: not a file' in error


def test_a_pipe_without_a_name_is_read_as_yaml(robot_bags, tmp_path: Path) -> None:
    """As the shell makes one of `--encoding <(...)`."""
    reader, writer = os.pipe()
    with open(writer, 'w', encoding='utf-8') as rules:  # fits into a pipe
        rules.write('source: none\n')
    trained([robot_bags[0]], tmp_path / 'm', '--encoding', f'/dev/fd/{reader}')
    os.close(reader)


def test_a_model_or_a_result_is_no_recording(robot_bags, model_file: str, tmp_path: Path,
                                             capsys) -> None:
    results, output = str(tmp_path / 'results.bag'), str(tmp_path / 'out')
    assert score.main([robot_bags[0], '--model', model_file, '--result-bag', results]) == 0
    capsys.readouterr()
    for path, told in ((model_file, 'is a model'), (results, 'is a result bag')):
        for program, arguments in (
                (train, [path, '-o', output]),
                (score, [path, '--model', model_file]),
                (calibrate, ['--model', model_file, '--normal', path, '-o', output])):
            error = error_of(program, arguments, capsys)
            assert f'{path}: {told}' in error and 'rosbag play' not in error
