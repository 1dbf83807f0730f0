"""Bad input gets one line on standard error that names the file, and loses nothing."""
from __future__ import annotations

from pathlib import Path

import pytest
from conftest import error_of, robot

from self_awareness.commands import calibrate, info, score, train

PROGRAMS = {'train': train, 'calibrate': calibrate, 'score': score}


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


def test_bags_with_and_without_senders_do_not_mix(make_bag, robot_bags, model_file: str,
                                                  tmp_path: Path, capsys) -> None:
    nameless = make_bag('nameless.bag', robot(10.0), sources=False)
    encoding = tmp_path / 'e.yaml'
    encoding.write_text('source: callerid\n')
    output = ['-o', str(tmp_path / 'm')]
    for arguments in ([robot_bags[0], nameless], [nameless, '--encoding', str(encoding)],
                      [nameless, '--add-to', model_file]):
        error = error_of(train, arguments + output, capsys)
        assert nameless in error and 'source: none' in error


def test_a_model_with_another_encoding_is_told(make_bag, model_file: str, tmp_path: Path,
                                               capsys) -> None:
    nameless = make_bag('nameless.bag', robot(10.0), sources=False)
    model = ['--model', model_file]
    for program, arguments in (
            (score, [nameless, *model]),
            (calibrate, [*model, '--normal', nameless, '-o', str(tmp_path / 'm')])):
        error = error_of(program, arguments, capsys)
        assert nameless in error and 'another encoding' in error and 'source: none' in error


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
