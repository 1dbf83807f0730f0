"""Bad input gets one line on standard error that names the file, and loses nothing."""
from __future__ import annotations

import os
from pathlib import Path
from typing import List

import pytest
from conftest import error_of, robot

from self_awareness.commands import calibrate, info, merge, score, train

PROGRAMS = {'train': train, 'calibrate': calibrate, 'score': score, 'info': info,
            'merge': merge}


def test_a_bag_with_one_event_has_no_delay(make_bag, robot_bags, tmp_path: Path, capsys) -> None:
    bag = make_bag('one.bag', [(1.0, '/a', '/b')])
    for bags in ([bag], [robot_bags[0], bag]):
        error = error_of(train, [*bags, '-o', str(tmp_path / 'm')], capsys)
        assert bag in error and 'one event' in error
    assert not (tmp_path / 'm').exists()


def test_a_bag_without_events_is_named(make_bag, model_file: str, tmp_path: Path, capsys) -> None:
    player = '/play_1795206536731453261'
    bag = make_bag('replay.bag', [(t, player, topic) for t, _, topic in robot(1.0, 2.0)])
    for program, arguments in ((train, [bag, '-o', str(tmp_path / 'm')]),
                               (score, [bag, '--model', model_file])):
        error = error_of(program, arguments, capsys)
        assert bag in error and 'rosbag play' in error and 'source: none' in error
    assert 'range' in error_of(train, [bag, '--start', '99', '-o', str(tmp_path / 'm')], capsys)


def test_a_recording_given_twice_is_refused(robot_bags, tmp_path: Path, capsys) -> None:
    os.symlink(robot_bags[0], tmp_path / 'again.bag')
    error = error_of(train, [robot_bags[0], str(tmp_path / 'again.bag'), '-o',
                             str(tmp_path / 'm')], capsys)
    assert 'again.bag' in error and robot_bags[0] in error


def test_bags_with_and_without_senders_do_not_mix(make_bag, robot_bags, tmp_path: Path,
                                                  capsys) -> None:
    nameless = make_bag('nameless.bag', robot(10.0), sources=False)
    encoding = tmp_path / 'e.yaml'
    encoding.write_text('source: callerid\n')
    output = ['-o', str(tmp_path / 'm')]
    for arguments in ([robot_bags[0], nameless], [nameless, '--encoding', str(encoding)]):
        error = error_of(train, arguments + output, capsys)
        assert nameless in error and 'source: none' in error


def test_a_model_with_another_encoding_is_told(make_bag, model_file: str, robot_bags,
                                               tmp_path: Path, capsys) -> None:
    nameless = make_bag('nameless.bag', robot(10.0), sources=False)
    error = error_of(score, [nameless, '--model', model_file], capsys)
    assert nameless in error and 'another encoding' in error and 'source: none' in error
    other_robot = make_bag('other.bag', [(t, '/x', '/y') for t, _, _ in robot(10.0)])
    for bag in (nameless, other_robot):
        by_detector: List[List[str]] = [[], ['--detector', 'paper', '--cutoff', 'fpr=0.1']]
        for options in by_detector:
            error = error_of(calibrate, ['--model', model_file, '--normal', bag, *options, '-o',
                                         str(tmp_path / 'm')], capsys)
            assert bag in error and 'another encoding' in error


def test_a_type_field_with_endless_values_is_refused(make_bag, tmp_path: Path, capsys) -> None:
    times = [(1.0 + 0.01 * i, '/a', '/b') for i in range(1500)]
    bag = make_bag('frames.bag', times, text='frame{}')
    encoding = tmp_path / 'e.yaml'
    arguments = [bag, '-o', str(tmp_path / 'm'), '--encoding', str(encoding)]
    encoding.write_text('type_fields: {std_msgs/Header: frame_id}\n')
    error = error_of(train, arguments, capsys)
    assert bag in error and 'std_msgs/Header: frame_id' in error and '1000' in error
    encoding.write_text('type_fields: {std_msgs/Header: level}\n')
    error = error_of(train, arguments, capsys)
    assert bag in error and 'std_msgs/Header' in error and 'level' in error
    assert not (tmp_path / 'm').exists()


@pytest.mark.parametrize('contents', ['none', 'text', 'bag', 'cut'])
def test_a_bad_model_is_named(contents: str, model_file: str, robot_bags, tmp_path: Path,
                              capsys) -> None:
    path = tmp_path / 'bad.model'
    if contents == 'text':
        path.write_text('no model')
    elif contents == 'bag':
        path.write_bytes(Path(robot_bags[0]).read_bytes())
    elif contents == 'cut':
        path.write_bytes(Path(model_file).read_bytes()[:-100])
    for program, arguments in (
            (info, [str(path)]), (score, [robot_bags[1], '--model', str(path)]),
            (calibrate, ['--model', str(path), '--normal', robot_bags[1], '-o',
                         str(tmp_path / 'm')])):
        assert str(path) in error_of(program, arguments, capsys)
    assert not (tmp_path / 'm').exists()


@pytest.mark.parametrize('value', ['nan', '0', '-1', 'inf', 'soon', '1e9', ''])
@pytest.mark.parametrize('option', ['--bin', '--window'])
def test_bins_and_windows_have_a_length(robot_bags, tmp_path: Path, option: str, value: str,
                                        capsys) -> None:
    assert train.main([robot_bags[0], '-o', str(tmp_path / 'm'), f'{option}={value}']) == 2
    error, = capsys.readouterr().err.splitlines()
    assert error.startswith(f'train: error: argument {option}: expected ')
    assert error.endswith(' (train --help says more)')
    assert not (tmp_path / 'm').exists()


@pytest.mark.parametrize('program, option, value', [
    ('train', '--start', '-1'), ('train', '--end', 'nan'), ('train', '--horizon', '-5'),
    ('score', '--settle-time', 'nan'), ('score', '--hold-time', '-1'),
    ('score', '--alarm-windows', '0'), ('score', '--alarm-of', '99999999999999999999'),
    ('score', '--plot', 'p.jpg'), ('score', '--detector', 'scores'),
    ('calibrate', '--budget', '0'), ('calibrate', '--budget', '-1'),
    ('calibrate', '--budget', 'nan'), ('calibrate', '--budget', 'few'),
    ('score', '--unknown', 'never'),
    ('calibrate', '--cutoff', 'fpr=nan'), ('calibrate', '--inject', 'slow:/laser:nan'),
    ('calibrate', '--settle-time', '-0.1'), ('info', '--pair', 'one')])
def test_values_out_of_range_are_wrong_usage(program: str, option: str, value: str,
                                             model_file: str, robot_bags, tmp_path: Path,
                                             capsys) -> None:
    arguments = {'train': [robot_bags[0], '-o', str(tmp_path / 'm')],
                 'score': [robot_bags[0], '--model', model_file],
                 'calibrate': ['--model', model_file, '--normal', robot_bags[1], '-o',
                               str(tmp_path / 'm')],
                 'info': [model_file]}[program]
    assert PROGRAMS[program].main([*arguments, f'{option}={value}']) == 2
    error, = capsys.readouterr().err.splitlines()
    assert error.startswith(f'{program}: error: ') and option in error
    assert not (tmp_path / 'm').exists()


def test_a_range_or_horizon_that_does_not_fit_is_told(robot_bags, tmp_path: Path, capsys) -> None:
    output = ['-o', str(tmp_path / 'm')]
    for options, told in ((['--start', '5', '--end', '4'], 'start < end'),
                          (['--horizon', '0.015'], 'multiple')):
        assert told in error_of(train, [robot_bags[0], *options, *output], capsys)


def test_ctrl_c_ends_it(monkeypatch, model_file: str, capsys) -> None:
    def interrupted(_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(info.verdict, 'lines', interrupted)
    assert info.main([model_file]) == 130
