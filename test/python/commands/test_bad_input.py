"""Bad input gets one line on standard error that names the file, and hides and loses nothing."""
from __future__ import annotations

import json
import os
import shutil
import signal
import time
from pathlib import Path
from types import ModuleType
from typing import Callable, Dict, List

import pytest
import rosbag
from conftest import error_of, printed_by, robot, trained, write_bag

from self_awareness import TrainedModel, encoding_file, recordings_in_event_log, yaml_file
from self_awareness.commands import calibrate, convert, diff, info, learn_more, merge, score, train
from self_awareness.training.robot_graph import RobotGraph

PROGRAMS: Dict[str, Callable[[List[str]], int]] = {
    'train': train.main, 'calibrate': calibrate.main, 'score': score.main, 'info': info.main,
    'convert': convert.main, 'diff': diff.main, 'learn_more': learn_more.main}
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
    assert PROGRAMS[program]([*arguments, f'{option}={value}']) == 2
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


BAD = {'active.bag.active': 'is still being written, or its recorder was killed; in that case '
                            'mend it with: rosbag reindex',
       'cut.bag': 'rosbag reindex',
       'foreign.bag': 'not a bag',
       'nothing.bag': 'not a bag',
       'empty.bag': 'the bag is empty: it holds no messages; leave it out',
       'other.mcap': 'not a bag of ROS 1: MCAP',
       'old.orig.bag': 'before rosbag reindex; remove it',
       'packed.bag.gz': 'compressed by gzip; unpack it first',
       'ros2.db3': 'a recording of ROS 2 (SQLite)'}


@pytest.fixture
def day(tmp_path: Path) -> Path:
    """A folder with two good recordings, and bad ones between them."""
    made = tmp_path / 'day'
    made.mkdir()
    whole = Path(write_bag(made / 'zz.bag', robot(40000.0, 100.0)))
    write_bag(made / 'a.bag', robot(30000.0, 100.0))
    unindexed = rosbag.Bag(str(made / 'active.bag.active'), 'w')
    unindexed._file.close()
    (made / 'cut.bag').write_bytes(whole.read_bytes()[:9000])
    with rosbag.Bag(str(made / 'empty.bag'), 'w'):
        pass
    (made / 'foreign.bag').write_text('something else\n' * 100)
    (made / 'nothing.bag').touch()
    (made / 'other.mcap').write_bytes(b'\x89MCAP0\r\n')
    write_bag(made / 'old.bag', robot(50000.0, 100.0))
    (made / 'old.orig.bag').write_bytes(whole.read_bytes()[:9000])
    (made / 'packed.bag.gz').write_bytes(b'\x1f\x8b\x08')
    (made / 'ros2.db3').write_bytes(b'SQLite format 3\0')
    (made / 'notes.txt').write_text('monday\n')
    return made


def arguments(program: str, named: str, model: str, output: str) -> List[str]:
    return {'train': [named, '-o', output],
            'calibrate': ['--model', model, '--normal', named, '-o', output],
            'score': [named, '--model', model, '--json', output],
            'info': [named],
            'convert': [named, '-o', output],
            'diff': [model, named],
            'learn_more': [named, '--model', model, '--start-up', '0', '-o', output]}[program]


@pytest.mark.parametrize('program', sorted(PROGRAMS))
def test_all_bad_ones_are_named_at_once_and_are_skipped_if_asked(
        program: str, day: Path, evidence_model: str, tmp_path: Path, capfd) -> None:
    output = tmp_path / 'out'
    named = arguments(program, str(day), evidence_model, str(output))

    def check(kind: str) -> str:
        captured = capfd.readouterr()
        assert captured.err.count(f'{program}: {kind}: ') == len(BAD), captured.err
        for name, told in BAD.items():
            assert len([line for line in captured.err.splitlines()
                        if line.startswith(f'{program}: {kind}: {day}/{name}: ')
                        and told in line]) == 1, captured.err
        return captured.out

    assert PROGRAMS[program](named) == 1
    said = check('error')
    # What says something of each recording by itself goes on; what needs all of them does nothing.
    assert output.exists() == (program == 'score')
    if program in ('score', 'info'):
        assert f'{day}/a.bag: ' in said and f'{day}/zz.bag: ' in said
    assert PROGRAMS[program]([*named, '--skip-bad']) == 0
    check('warning: skipped')
    if program == 'train':
        assert [each.bag for each in TrainedModel.load(str(output)).recordings] == [
            'a.bag', 'old.bag', 'zz.bag']
    elif program == 'convert':
        assert recordings_in_event_log(str(output)) == 3
    elif program == 'score':
        assert len(json.loads(output.read_text(encoding='utf-8'))['skipped']) == len(BAD)


def test_a_damage_that_is_found_late_hides_nothing(evidence_model: str, tmp_path: Path,
                                                   capsys) -> None:
    """In the middle of a file, where nobody looks before the work begins."""
    day = tmp_path / 'day'
    day.mkdir()
    for name in ('a.bag', 'b.bag', 'c.bag'):
        write_bag(day / name, robot(30000.0 + 1000 * ord(name[0]), 100.0))
    content = bytearray((day / 'b.bag').read_bytes())
    middle = len(content) // 2
    content[middle:middle + 2000] = bytes(2000)
    (day / 'b.bag').write_bytes(content)
    for program in sorted(PROGRAMS):
        output = tmp_path / program
        named = arguments(program, str(day), evidence_model, str(output))
        assert PROGRAMS[program](named) == 1
        captured = capsys.readouterr()
        assert captured.err.count(f'{day}/b.bag: ') == 1, captured.err
        if program in ('score', 'info'):
            assert f'{day}/c.bag: ' in captured.out
        assert PROGRAMS[program]([*named, '--skip-bad']) == 0
        assert f'{program}: warning: skipped: {day}/b.bag: ' in capsys.readouterr().err


def test_where_none_is_left_nothing_is_done(day: Path, model_file: str, tmp_path: Path,
                                            capsys) -> None:
    for good in ('a.bag', 'old.bag', 'old.orig.bag', 'zz.bag'):
        os.remove(day / good)
    for program in sorted(PROGRAMS):
        output = tmp_path / program
        assert PROGRAMS[program]([*arguments(program, str(day), model_file, str(output)),
                                  *([] if program == 'info' else ['--skip-bad'])]) == 1
        assert capsys.readouterr().err.count(f'{program}: error: {day}/') == len(BAD) - 1
        assert not output.exists()


def test_a_recorder_that_was_killed_is_read_once_it_is_mended(day: Path, tmp_path: Path) -> None:
    shutil.copy(day / 'a.bag', tmp_path / 'a.bag.active')  # rosbag reindex leaves the name
    assert f'{tmp_path}/a.bag.active: 100.0 s' in printed_by(info, [str(tmp_path)])
