"""`learn`, `info --age` and `learn_more`: learning, how old a model is, and what came since."""
from __future__ import annotations

import json
import random
import re
from pathlib import Path
from typing import Any, Dict, List, Tuple

import pytest
from conftest import Message, error_of, printed_by
from recorded_logs import write_log

from self_awareness import Acceptance, EncodingRules, TrainedModel, accepted_file
from self_awareness.commands import calibrate, cli, info, learn, learn_more, train
from self_awareness.learning.recorder import RecorderCrash


@pytest.mark.parametrize('arguments', [
    ['--hours', '0'], ['--hours', '-1'], ['--hours', 'two'], ['--hours', 'nan'],
    ['--start-up', '-1'], ['--budget', '0'], ['--subscribe', 'model'], ['robot.model']])
def test_wrong_usage_is_an_error(arguments, capsys) -> None:
    assert learn.main(arguments) == 2
    assert arguments[-1] in capsys.readouterr().err


def test_the_node_itself_is_no_part_of_the_robot() -> None:
    assert learn.without('/robot1/self_awareness', EncodingRules.defaults()
                         ) == EncodingRules.defaults()
    rules = learn.without('/robot1/monitor', EncodingRules.defaults())
    assert rules.exclude_sources == EncodingRules.defaults().exclude_sources + ['/robot1/monitor']
    assert learn.without('/robot1/monitor', rules) == rules


def test_who_can_go_on_ends_unlike_who_cannot(monkeypatch, capsys) -> None:
    """launch/until_refused.sh lets roslaunch start it again."""
    def crash(*_) -> int:
        raise RecorderCrash('the recorder crashed (exit code -9)')
    monkeypatch.setattr(cli, 'run', crash)
    assert learn.main([]) not in (0, 1, 2)
    assert capsys.readouterr().err == 'learn: error: the recorder crashed (exit code -9)\n'


_DAY_S = 86400.0


def _robot(start: float, seed: int, period: float = 0.05, length: float = 130.0,
           dead: str = '', dead_from: float = 60.0) -> List[Message]:
    """A laser, what follows it, and a battery, with phases and delays of their own each day."""
    rng = random.Random(seed)
    messages = []
    phase = rng.uniform(0.0, period)
    for i in range(int(length / period)):
        stamp = start + phase + period * i + rng.expovariate(500.0)
        messages.append((stamp, '/laser', '/scan'))
        messages.append((stamp + 0.03 + rng.expovariate(500.0), '/slam', '/map'))
    phase = rng.uniform(0.0, 0.37)
    messages += [(start + phase + 0.37 * i + rng.expovariate(500.0), '/battery', '/charge')
                 for i in range(int(length / 0.37) + 1)]
    return sorted(each for each in messages if each[0] < start + length
                  and (each[1] != dead or each[0] < start + dead_from))


@pytest.fixture(scope='module')
def learned(tmp_path_factory: pytest.TempPathFactory) -> Tuple[str, List[str]]:
    """A calibrated model, and the recordings that it comes from."""
    folder = tmp_path_factory.mktemp('learned')
    logs = [write_log(folder / f'{day}.bag', _robot(1000.0 + _DAY_S * day, day, length=200.0))
            for day in range(4)]
    model = str(folder / 'robot.model')
    assert train.main([*logs[:3], '-o', model]) == 0
    assert calibrate.main(['--model', model, '--normal', logs[3], '-o', model]) == 0
    return model, logs


@pytest.fixture
def model(learned: Tuple[str, List[str]], tmp_path: Path) -> str:
    path = tmp_path / 'robot.model'
    path.write_bytes(Path(learned[0]).read_bytes())
    return str(path)


def _age(*arguments: str) -> Dict[str, Any]:
    return json.loads(printed_by(info, [*arguments, '--json']))


def _kept(model: str) -> Path:
    folder = Path(f'{model}.kept')
    folder.mkdir()
    return folder


def test_a_robot_that_stays_as_it_is_does_not_drift(model: str, capsys) -> None:
    folder = _kept(model)
    for day in range(8):
        write_log(folder / f'{day}.bag', _robot(_DAY_S * (10 + day), 10 + day))
    age = _age(model, '--age')
    assert (age['samples'], age['recordings'], age['drifting']) == (8, 8, [])
    assert {each['component'] for each in age['components']} == {'/laser', '/slam', '/battery'}
    assert all(0.0 <= each['usual_share'] < 1.0 for each in age['components'])
    line, = printed_by(info, [model, '--age']).splitlines()
    assert re.fullmatch(r'learned until 1970-\S+ \S+ UTC; heard since for 17 min in 8 starts of '
                        r'the robot or days of one, the last 14 days later: nothing drifts', line)
    assert info.main([model, '--age', '--details']) == 0
    assert re.search(r'^  /laser +\d+ % +\d+ % +\S+ of 300$', capsys.readouterr().out, re.M)


def test_a_rate_that_falls_from_day_to_day_is_told_before_the_alarm(model: str) -> None:
    folder = _kept(model)
    period = 0.05
    for day in range(60):
        period *= 1.005 if day >= 12 else 1.0
        write_log(folder / f'{day:02d}.bag', _robot(_DAY_S * (10 + day), 10 + day, period))
    age = _age(model, '--age')
    told = min(each['told_by_sample'] for each in age['components'] if each['told_by_sample'])
    assert age['drifting'] and 12 < told <= age['samples']
    assert {'/laser', '/slam'} >= set(age['drifting'])
    lines = printed_by(info, [model, '--age']).splitlines()
    assert lines[0].endswith(f'drifting: {", ".join(age["drifting"])}')
    assert lines[1].split() == ['component', 'usual', 'last,', 'of', 'the', 'limit']
    assert [line.split()[0] for line in lines[2:2 + len(age['drifting'])]] == age['drifting']


def test_what_is_not_normal_or_was_learned_says_nothing(model: str, learned: Tuple[str, List[str]],
                                                        tmp_path: Path) -> None:
    dead = write_log(tmp_path / 'dead.bag', _robot(_DAY_S * 10, 1, dead='/laser'))
    short = write_log(tmp_path / 'short.bag', _robot(_DAY_S * 11, 2, length=50.0))
    good = write_log(tmp_path / 'good.bag', _robot(_DAY_S * 12, 3))
    age = _age(model, '--age', *learned[1], dead, short, good)
    assert age['recordings'] == 1
    reasons = {Path(each['recording']).name: each['reason'] for each in age['left_out']}
    assert reasons == {'0.bag': 'learned from', '1.bag': 'learned from', '2.bag': 'learned from',
                       '3.bag': 'learned from', 'dead.bag': 'not normal', 'short.bag': 'too short'}
    assert [each['why'] for each in age['left_out'] if each['why']] == ['silent /laser']


def test_more_is_learned_and_taken_only_if_asked(model: str, learned: Tuple[str, List[str]],
                                                 tmp_path: Path, capfd) -> None:
    before = Path(model).read_bytes()
    folder = _kept(model)
    for day in range(3):
        write_log(folder / f'{day}.bag', _robot(_DAY_S * (10 + day), 10 + day, 0.055, 200.0))
    dead = write_log(tmp_path / 'dead.bag', _robot(_DAY_S * 20, 1, 0.055, dead='/battery'))
    # A rate that is a tenth lower is found at once: it is normal now.
    accepted = [Acceptance(name, at=int(_DAY_S * 9e9)) for name in ('/laser', '/slam')]
    accepted_file.keep(accepted, model)
    assert learn_more.main(['--model', model, str(folder), learned[1][3], dead]) == 0
    out = capfd.readouterr().out
    assert 'what changed' in out and 'rate    /laser /scan' in out and 'silent /battery' in out
    assert Path(model).read_bytes() == before
    new = TrainedModel.load(f'{model}.new')
    assert new.calibration.method == 'held-out'
    # The three of before, and the three days; not the one in which the battery died.
    assert len(new.recordings) == 6
    assert max(each.end for each in new.recordings) < _DAY_S * 13e9
    # The recording that it was calibrated on is calibrated on again.
    assert len(new.calibration.recordings) == 4
    assert learn_more.main(['--model', model, '--take']) == 0
    assert Path(f'{model}.before').read_bytes() == before
    assert TrainedModel.load(model).recordings != TrainedModel.load(f'{model}.before').recordings
    assert not Path(f'{model}.new').exists()
    assert len(accepted_file.beside(f'{model}.before')) == 2
    assert accepted_file.beside(model) == []  # it is learned


def test_no_model_is_lost_when_it_is_taken_again(model: str, tmp_path: Path) -> None:
    one = Path(model).read_bytes()
    for number, name in enumerate(['robot.model.before', 'robot.model.before_2']):
        Path(f'{model}.new').write_bytes(one)
        assert learn_more.main(['--model', model, '--take']) == 0
        assert (tmp_path / name).read_bytes() == one


@pytest.mark.parametrize('is_model, why', [(False, ''), (True, ': it has no limits')])
def test_what_is_no_model_or_has_no_limits_is_not_taken(
        is_model: bool, why: str, model: str, model_file: str) -> None:
    before = Path(model).read_bytes()
    Path(f'{model}.new').write_bytes(Path(model_file).read_bytes() if is_model else b'no model')
    assert f'robot.model.new{why}' in error_of(learn_more, ['--model', model, '--take'])
    assert Path(model).read_bytes() == before and not Path(f'{model}.before').exists()


@pytest.mark.parametrize('program', [info, learn_more])
def test_bad_input_is_one_line(program, model: str, model_file: str,
                               learned: Tuple[str, List[str]], tmp_path: Path) -> None:
    def run(path: str, *logs: str) -> str:
        given = [path, '--age', *logs] if program is info else ['--model', path, *logs]
        error, = error_of(program, given).splitlines()
        return error

    assert f'there is no folder {model}.kept: name event logs' in run(model)
    log = write_log(tmp_path / 'log.bag', _robot(_DAY_S * 10, 1))
    assert 'a part of a recording; name the whole one' in run(model, f'{log}@5-90')
    assert 'the same recording as' in run(model, log, log)
    assert 'has no limits that anything could drift towards' in run(model_file, log)
    assert 'no such file' in run(str(tmp_path / 'none.model'), log)


def test_nothing_to_learn_from_is_an_error(model: str, learned: Tuple[str, List[str]],
                                           tmp_path: Path) -> None:
    # Too short to be judged: whether it is normal is not known.
    short = write_log(tmp_path / 'short.bag', _robot(_DAY_S * 11, 2, length=50.0))
    assert 'no recording is left to learn from' in error_of(learn_more, ['--model', model,
                                                                         learned[1][0], short])
    assert not Path(f'{model}.new').exists()
