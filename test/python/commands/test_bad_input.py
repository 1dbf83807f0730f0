"""Bad input gets one line on standard error that names the file, and loses nothing."""
from __future__ import annotations

import os
import signal
import time
from pathlib import Path
from types import ModuleType
from typing import List

import pytest
from conftest import error_of, robot, trained

from self_awareness import encoding_file, yaml_file
from self_awareness.commands import calibrate, convert, diff, info, merge, score, train
from self_awareness.training.robot_graph import RobotGraph

PROGRAMS = {'train': train, 'calibrate': calibrate, 'score': score}
PIPE_S = 60
BOMB = 'a0: &a0 [x, x, x, x, x, x, x, x, x]\n' + ''.join(
    f'a{i + 1}: &a{i + 1} [{", ".join([f"*a{i}"] * 9)}]\n' for i in range(9))


def test_a_bag_with_one_event_has_no_delay(make_bag, robot_bags, tmp_path: Path) -> None:
    bag = make_bag('one.bag', [(1.0, '/a', '/b')])
    for bags in ([bag], [robot_bags[0], bag]):
        error = error_of(train, [*bags, '-o', str(tmp_path / 'm')])
        assert bag in error and 'one event' in error
    assert not (tmp_path / 'm').exists()


def test_a_bag_without_events_is_named(make_bag, model_file: str, tmp_path: Path) -> None:
    player = '/play_1795206536731453261'
    bag = make_bag('replay.bag', [(t, player, topic) for t, _, topic in robot(1.0, 2.0)])
    for program, arguments in ((train, [bag, '-o', str(tmp_path / 'm')]),
                               (score, [bag, '--model', model_file])):
        error = error_of(program, arguments)
        assert bag in error and 'rosbag play' in error and 'source: none' in error
    assert 'range' in error_of(train, [bag, '--start', '99', '-o', str(tmp_path / 'm')])


def test_bags_with_and_without_senders_do_not_mix(make_bag, robot_bags, model_file: str,
                                                  tmp_path: Path) -> None:
    nameless = make_bag('nameless.bag', robot(10.0), sources=False)
    encoding = tmp_path / 'e.yaml'
    encoding.write_text('source: callerid\n')
    output, model = ['-o', str(tmp_path / 'm')], ['--model', model_file]
    for arguments in ([robot_bags[0], nameless], [nameless, '--encoding', str(encoding)],
                      [nameless, '--add-to', model_file]):
        error = error_of(train, arguments + output)
        assert nameless in error and 'source: none' in error
    for program, arguments in ((score, [nameless, *model]),
                               (calibrate, [*model, '--normal', nameless, *output])):
        error = error_of(program, arguments)
        assert nameless in error and 'another encoding' in error and 'source: none' in error


def test_a_model_of_another_robot_is_an_error_and_one_that_knows_little_warns(
        make_bag, model_file: str, tmp_path: Path, capsys) -> None:
    def renamed(*nodes: str) -> str:
        return make_bag('other.bag', [
            (stamp, source, f'/other{topic}' if source in nodes else topic)
            for stamp, source, topic in robot(5000.0, 60.0)])

    bag, model = renamed('/laser', '/slam', '/battery'), ['--model', model_file]
    for program, arguments in ((score, [bag, *model]),
                               (calibrate, [*model, '--normal', bag, '-o', str(tmp_path / 'm')])):
        error = error_of(program, arguments)
        assert f'{bag}: the model knows none of the 3 event types of this recording' in error
        assert 'another encoding' in error
    for nodes, warned in ((['/laser', '/slam'], True), (['/laser'], False)):
        assert score.main([renamed(*nodes), *model]) == 0
        error = capsys.readouterr().err
        assert (f'score: warning: {bag}: the model knows 1 of the 3 event types' in error
                ) == warned


@pytest.mark.parametrize('contents', ['none', 'text', 'bag', 'cut'])
def test_a_bad_model_is_named(contents: str, model_file: str, robot_bags, tmp_path: Path) -> None:
    path, output = tmp_path / 'bad.model', ['-o', str(tmp_path / 'm')]
    if contents == 'text':
        path.write_text('no model')
    elif contents == 'bag':
        path.write_bytes(Path(robot_bags[0]).read_bytes())
    elif contents == 'cut':
        path.write_bytes(Path(model_file).read_bytes()[:-100])
    for program, arguments in (
            (info, [str(path)]), (score, [robot_bags[1], '--model', str(path)]),
            (calibrate, ['--model', str(path), '--normal', robot_bags[1], *output]),
            (merge, [model_file, str(path), *output])):
        assert str(path) in error_of(program, arguments)
    assert not (tmp_path / 'm').exists()


def test_a_model_or_a_result_is_no_recording(robot_bags, model_file: str, tmp_path: Path) -> None:
    results, output = str(tmp_path / 'results.bag'), str(tmp_path / 'out')
    assert score.main([robot_bags[0], '--model', model_file, '--result-bag', results]) == 0
    for path, told in ((model_file, 'is a model'), (results, 'is a result bag')):
        for program, arguments in (
                (train, [path, '-o', output]),
                (score, [path, '--model', model_file]),
                (calibrate, ['--model', model_file, '--normal', path, '-o', output])):
            error = error_of(program, arguments)
            assert f'{path}: {told}' in error and 'rosbag play' not in error


def test_a_folder_without_bags_is_named(tmp_path: Path) -> None:
    (tmp_path / '.self_awareness_part1_0.normal.bag').touch()  # somebody is writing it
    for program in (train, convert):
        error = error_of(program, [str(tmp_path), '-o', str(tmp_path / 'out')])
        assert f'{tmp_path}: a folder without bags' in error


@pytest.mark.parametrize('program, arguments', [
    (calibrate, ['--model', '{model}', '--normal', '{pipe}', '-o', '{out}']),
    (score, ['{bag}', '--model', '{pipe}']),
    (info, ['{pipe}']),
    (diff, ['{model}', '{pipe}'])])
def test_a_pipe_is_no_bag_and_no_model(program: ModuleType, arguments: List[str], robot_bags,
                                       model_file: str, tmp_path: Path) -> None:
    """Opened, it would let the program wait for a writer for ever."""
    pipe = tmp_path / 'pipe'
    os.mkfifo(pipe)
    names = {'pipe': str(pipe), 'out': str(tmp_path / 'out'), 'bag': robot_bags[1],
             'model': model_file}
    signal.alarm(PIPE_S)
    error = error_of(program, [each.format(**names) for each in arguments])
    signal.alarm(0)
    assert f'{pipe}: not a file' in error


def test_a_pipe_without_a_name_is_read_as_yaml(robot_bags, tmp_path: Path) -> None:
    """As the shell makes one of `--encoding <(...)`."""
    reader, writer = os.pipe()
    with open(writer, 'w', encoding='utf-8') as rules:  # fits into a pipe
        rules.write('source: none\n')
    trained([robot_bags[0]], tmp_path / 'm', '--encoding', f'/dev/fd/{reader}')
    os.close(reader)


@pytest.mark.parametrize('program, option, value', [
    *(('train', option, value) for option in ('--bin', '--window')
      for value in ('nan', '0', '-1', 'inf', 'soon', '1e9', '')),
    ('train', '--start', '-1'), ('train', '--end', 'nan'), ('train', '--horizon', '-5'),
    ('train', '--jobs', '0'), ('train', '--jobs', 'many'), ('train', '--jobs', '1.5'),
    ('score', '--settle-time', 'nan'), ('train', '--jobs', '99999999999999999999'),
    ('score', '--plot', 'p.jpg'), ('score', '--detector', 'scores'),
    ('calibrate', '--budget', '0'), ('calibrate', '--budget', '-1'),
    ('calibrate', '--budget', 'nan'), ('calibrate', '--budget', 'few'),
    ('score', '--unknown', 'never'),
    ('calibrate', '--cutoff', 'fpr=nan'), ('calibrate', '--inject', 'slow:/laser:nan'),
    ('calibrate', '--settle-time', '-0.1')])
def test_values_out_of_range_are_wrong_usage(program: str, option: str, value: str,
                                             model_file: str, robot_bags, tmp_path: Path,
                                             capsys) -> None:
    arguments = {'train': [robot_bags[0], '-o', str(tmp_path / 'm')],
                 'score': [robot_bags[0], '--model', model_file],
                 'calibrate': ['--model', model_file, '--normal', robot_bags[1], '-o',
                               str(tmp_path / 'm')]}[program]
    assert PROGRAMS[program].main([*arguments, f'{option}={value}']) == 2
    error, = capsys.readouterr().err.splitlines()
    assert error.startswith(f'{program}: error: ') and option in error
    assert error.endswith(f' ({program} --help says more)')
    assert not (tmp_path / 'm').exists()


def test_a_range_or_horizon_that_does_not_fit_is_told(robot_bags, tmp_path: Path) -> None:
    output = ['-o', str(tmp_path / 'm')]
    for options, told in ((['--start', '5', '--end', '4'], 'start < end'),
                          (['--horizon', '0.015'], 'multiple')):
        assert told in error_of(train, [robot_bags[0], *options, *output])


@pytest.mark.parametrize('name, told', [
    (b'gr\xfc\xdf.bag', 'UTF-8'), (b'a\x1b[2J.bag', 'control characters'),
    ('a\u202eb.bag'.encode(), 'control characters'), (b'a\nb.bag', 'control characters')])
def test_a_file_name_that_no_terminal_should_get_is_one_line(name: bytes, told: str, make_bag,
                                                             tmp_path: Path) -> None:
    bag = os.fsdecode(os.fsencode(str(tmp_path)) + b'/' + name)
    os.rename(make_bag('good.bag', robot(1.0)), bag)
    error = error_of(train, [bag, '-o', str(tmp_path / 'm')])
    assert told in error and '\x1b' not in error and '\u202e' not in error


def test_windows_without_end_are_refused(make_bag, model_file: str, tmp_path: Path) -> None:
    bag = make_bag('rare.bag', [(1.0 + 3000.0 * i, '/laser', '/scan') for i in range(400)])
    for program, arguments in ((train, ['-o', str(tmp_path / 'm')]),
                               (score, ['--model', model_file])):
        error = error_of(program, [bag, *arguments])
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


def test_the_largest_yaml_file_is_read_in_seconds_and_a_key_that_is_there_twice_is_found(
        tmp_path: Path) -> None:
    path = tmp_path / 'e.yaml'
    one = '- {a: x, b: y}\n'
    path.write_text(one * ((1 << 20) // len(one)))
    begin = time.process_time()
    assert len(yaml_file.load(str(path))) == (1 << 20) // len(one)
    assert time.process_time() - begin < 15.0  # by the Python loader 30 s and more
    path.write_text(one * ((1 << 20) // len(one) + 1))
    with pytest.raises(ValueError, match='larger than 1 MB'):
        yaml_file.load(str(path))
    path.write_text(''.join(f'k{i}: 1\n' for i in range(60_000)) + 'k59999: 2\n')
    begin = time.process_time()
    with pytest.raises(ValueError, match="'k59999' is there twice"):
        yaml_file.load(str(path))
    assert time.process_time() - begin < 15.0  # not by comparing each with each
