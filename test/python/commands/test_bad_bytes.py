"""Bytes that are no text, and files made to fill the memory: one line, or nothing special."""
from __future__ import annotations

import os
import random
import time
from pathlib import Path

import pytest
from conftest import error_of, robot, trained, write_bag

from self_awareness import encoding_file, yaml_file
from self_awareness.commands import info, score, train
from self_awareness.training.robot_graph import RobotGraph

BOMB = 'a0: &a0 [x, x, x, x, x, x, x, x, x]\n' + ''.join(
    f'a{i + 1}: &a{i + 1} [{", ".join([f"*a{i}"] * 9)}]\n' for i in range(9))


def test_a_value_cut_inside_a_character_is_learned(tmp_path: Path, capsys) -> None:
    bag = write_bag(tmp_path / 'cut.bag', robot(1.0), text='x' * 63 + '\u00e4')
    encoding = tmp_path / 'e.yaml'
    encoding.write_text('type_fields: {std_msgs/Header: frame_id}\n')
    model = tmp_path / 'm'
    trained([bag], model, '--encoding', str(encoding))
    assert info.main([str(model), '--details']) == 0
    assert f'[frame_id={"x" * 63}]' in capsys.readouterr().out


def test_a_file_name_that_is_no_utf8_is_one_line(make_bag, tmp_path: Path, capsys) -> None:
    bag = make_bag('good.bag', robot(1.0))
    name = os.fsdecode(os.fsencode(str(tmp_path)) + b'/gr\xfc\xdf.bag')
    os.rename(bag, name)
    assert 'UTF-8' in error_of(train, [name, '-o', str(tmp_path / 'm')], capsys)


def test_a_file_name_with_control_characters_is_one_line(make_bag, tmp_path: Path,
                                                         capsys) -> None:
    bag = make_bag('good.bag', robot(1.0))
    for name in ('a\x1b[2J.bag', 'a\u202eb.bag', 'a\nb.bag'):
        os.rename(bag, tmp_path / name)
        bag = str(tmp_path / name)
        error = error_of(train, [bag, '-o', str(tmp_path / 'm')], capsys)
        assert 'control characters' in error
        assert '\x1b' not in error and '\u202e' not in error


def test_windows_without_end_are_refused(make_bag, model_file: str, tmp_path: Path,
                                         capsys) -> None:
    bag = make_bag('rare.bag', [(1.0 + 3000.0 * i, '/laser', '/scan') for i in range(400)])
    for program, arguments in ((train, ['-o', str(tmp_path / 'm')]),
                               (score, ['--model', model_file])):
        error = error_of(program, [bag, *arguments], capsys)
        assert bag in error and 'windows' in error
    assert train.main([bag, '--window', '1e-6', '-o', str(tmp_path / 'm')]) == 2


@pytest.mark.parametrize('text, told', [
    (BOMB, 'alias'), ('[' * 2000, 'deep'), ('- ' * 2000 + 'x', 'deep'), ('source: 2001-99-99', ''),
    ('source: !!python/object/apply:os.system [true]', ''), ('source: "\\ud800"', ''),
    (f'source: {"9" * 10000}', ''), ('source: \xff', ''),
    ('a: 1\nb: 2\na: 3\n', "'a' is there twice"),
    ('/a: {publishers: [/x], publishers: [], subscribers: []}', 'twice'),
    ('source: "\\e[2J"', 'control'), ('source: "\\u202e"', 'control'), ('? [a]\n: b', '')])
def test_a_bad_yaml_file_is_one_line_that_names_it(tmp_path: Path, text: str, told: str) -> None:
    path = tmp_path / 'e.yaml'
    path.write_bytes(text.encode('latin-1', 'replace'))
    for load in (encoding_file.load, RobotGraph.load):
        with pytest.raises(ValueError, match=str(path)) as error:
            load(str(path))
        assert told in str(error.value) and len(str(error.value)) < 1000
        assert '\x1b' not in str(error.value) and '\u202e' not in str(error.value)


def test_the_largest_yaml_file_is_read_in_seconds(tmp_path: Path) -> None:
    path = tmp_path / 'e.yaml'
    one = '- {a: x, b: y}\n'
    path.write_text(one * ((1 << 20) // len(one)))
    begin = time.process_time()
    assert len(yaml_file.load(str(path))) == (1 << 20) // len(one)
    assert time.process_time() - begin < 15.0  # by the Python loader 30 s and more
    path.write_text(one * ((1 << 20) // len(one) + 1))
    with pytest.raises(ValueError, match='larger than 1 MB'):
        yaml_file.load(str(path))


def test_many_keys_with_one_twice_are_told_at_once(tmp_path: Path) -> None:
    path = tmp_path / 'e.yaml'
    path.write_text(''.join(f'k{i}: 1\n' for i in range(60_000)) + 'k59999: 2\n')
    begin = time.process_time()
    with pytest.raises(ValueError, match="'k59999' is there twice"):
        yaml_file.load(str(path))
    assert time.process_time() - begin < 15.0  # not by comparing each with each


def test_a_changed_encoding_file_is_read_or_refused(tmp_path: Path) -> None:
    whole = (Path(__file__).resolve().parents[3] / 'config' / 'encoding.yaml').read_bytes()
    draw = random.Random(1)
    path = tmp_path / 'e.yaml'
    refused = 0
    for _ in range(150):
        data = bytearray(whole)
        for _ in range(draw.randrange(1, 20)):
            at = draw.randrange(len(data))
            data[at:at + draw.randrange(3)] = bytes(
                draw.choice(b'[]{}:,-*&!#|>\'"%@`?\n\t \xff0') for _ in range(draw.randrange(3)))
        path.write_bytes(data)
        try:
            encoding_file.load(str(path)).validate()
        except ValueError as error:
            assert str(path) in str(error)
            refused += 1
    assert 0 < refused < 150
