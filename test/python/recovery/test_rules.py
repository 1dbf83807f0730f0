"""The files of a recovery: its rules, the example among the configurations, and what was done."""
from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any, Dict

import pytest
import yaml
from hypothesis import given, settings, strategies

from self_awareness.msg import SelfAwareness
from self_awareness.recovery import history, rules
from self_awareness.recovery.history import MOST, Action, History, Hold
from self_awareness.recovery.rules import KINDS, Call, Rule, Rules, Stop

ROOT = Path(__file__).resolve().parents[3]
EXAMPLE = ROOT / 'config' / 'recovery.yaml'
MONITOR, RECOVERY = '/self_awareness', '/self_awareness_recovery'
GOOD: Dict[str, Any] = {'component': '/player', 'kinds': ['silent'],
                        'steps': [{'stop': ['/player']}]}


def load(folder: Path, data: Any) -> Rules:
    path = folder / 'r.yaml'
    path.write_text(data if isinstance(data, str) else json.dumps(data))
    return rules.load(str(path), MONITOR, RECOVERY)


def rule(**changed: Any) -> Dict[str, Any]:
    return {'rules': [{**GOOD, **changed}]}


def step(**keys: Any) -> Dict[str, Any]:
    return rule(steps=[keys])


def test_the_example_has_the_defaults_and_shows_every_key() -> None:
    read = rules.load(str(EXAMPLE), MONITOR, RECOVERY)
    assert read == Rules(read.rules)
    assert set(yaml.safe_load(EXAMPLE.read_text())) == {
        'delay', 'wait', 'grace', 'limit', 'limit_of_all', 'dry_run', 'rules'}
    assert re.findall(r'What is wrong with it:\n +# (.*)\.\n', EXAMPLE.read_text()) == [
        ', '.join(KINDS)]


def test_all_is_read(tmp_path: Path) -> None:
    read = load(tmp_path, {
        'delay': 1, 'wait': 2, 'grace': 0.5, 'limit': 4, 'limit_of_all': 5, 'dry_run': True,
        'rules': [{'component': '/a/b', 'kinds': ['silent', 'slow', 'silent'],
                   'steps': [{'call': '/a/reset'}, {'stop': ['/c', '/a/b']}]}, GOOD]})
    assert read == Rules(
        (Rule('/a/b', ('silent', 'slow'), (Call('/a/reset'), Stop(('/c', '/a/b')))),
         Rule('/player', ('silent',), (Stop(('/player',)),))), 1.0, 2.0, 0.5, 4, 5, True)
    assert read.nodes == ('/c', '/a/b', '/player')


def test_the_kinds_are_those_of_the_monitor_that_blame_somebody() -> None:
    of_monitor = {value for name, value in vars(SelfAwareness).items()
                  if name.isupper() and isinstance(value, str)}
    assert of_monitor - set(KINDS) == {'stranger', 'not subscribed', 'busy machine', 'all silent',
                                       'new mode', 'two senders', 'slower clock'}
    assert set(KINDS) < of_monitor


@pytest.mark.parametrize('data, key, told', [
    ({}, 'rules', 'missing'),
    ('# nothing\n', 'rules', 'missing'),
    ({'rules': []}, 'rules', 'at least one'),
    ({'rules': ['/player']}, 'rules[0]', 'expected keys'),
    ({**rule(), 'delays': 1}, 'delays', 'unknown key; allowed are: delay, dry_run'),
    ({**rule(), 'delay': -1}, 'delay', 'from 0 to 86400'),
    ({**rule(), 'wait': 0}, 'wait', 'from 1 to 86400'),
    ({**rule(), 'grace': 0}, 'grace', 'from 0.1 to 60'),
    ({**rule(), 'limit': 201}, 'limit', 'from 1 to 200'),
    ({**rule(), 'limit_of_all': True}, 'limit_of_all', 'an integer'),
    ({**rule(), 'dry_run': 'yes please'}, 'dry_run', 'true or false'),
    (rule(component='player'), 'rules[0].component', 'no full name'),
    (rule(component='/*'), 'rules[0].component', 'patterns are not allowed'),
    (rule(kinds=[]), 'rules[0].kinds', 'at least one'),
    (rule(kinds=['dead']), 'rules[0].kinds', 'choose from silent, topic silent'),
    (rule(kinds=['all silent']), 'rules[0].kinds', 'blames no component'),
    (step(), 'rules[0].steps[0].call', 'give call or stop'),
    (step(call='/a', stop=['/b']), 'rules[0].steps[0].call', 'give call or stop'),
    (step(call='/a', wait=3), 'rules[0].steps[0].wait', 'unknown key'),
    (step(call='reset'), 'rules[0].steps[0].call', 'no full name'),
    (step(call='/self_awareness/clear'), 'rules[0].steps[0].call', 'it is the monitor'),
    (step(call='/self_awareness_recovery/hold'), 'rules[0].steps[0].call', 'recovery itself'),
    (step(stop=['/player', '/player']), 'rules[0].steps[0].stop', 'twice'),
    (step(stop=['/.*']), 'rules[0].steps[0].stop', 'patterns are not allowed'),
    (step(stop=['/']), 'rules[0].steps[0].stop', 'no full name'),
    (step(stop=['/self_awareness']), 'rules[0].steps[0].stop', 'it is the monitor'),
    (step(stop=['/self_awareness_manager']), 'rules[0].steps[0].stop', "monitor's nodelet"),
    (step(stop=['/self_awareness_recovery']), 'rules[0].steps[0].stop', 'recovery itself'),
    (step(stop=['/rosout']), 'rules[0].steps[0].stop', "ROS's own"),
    (step(stop=[f'/n{i}' for i in range(6)]), 'rules[0].steps[0].stop', 'never all of it'),
    ({'rules': [GOOD, {**GOOD, 'kinds': ['slow', 'silent']}]}, 'rules', 'two rules for /player'),
])
def test_an_error_names_the_file_the_key_and_the_way_out(tmp_path: Path, data: Any, key: str,
                                                         told: str) -> None:
    with pytest.raises(ValueError, match=re.escape(f'r.yaml: {key}: ')) as caught:
        load(tmp_path, data)
    assert told in str(caught.value)
    assert '\n' not in str(caught.value)


_VALUES = strategies.recursive(
    strategies.none() | strategies.booleans() | strategies.integers() | strategies.floats()
    | strategies.sampled_from(['/player', '/*', 'silent', '/rosout', ' ', '']),
    lambda inner: strategies.lists(inner, max_size=3) | strategies.dictionaries(
        strategies.sampled_from(['rules', 'component', 'kinds', 'steps', 'stop', 'call', 'delay']),
        inner, max_size=4), max_leaves=12)


@settings(deadline=None, derandomize=True, database=None)
@given(data=_VALUES)
def test_any_values_are_rules_or_an_error_with_the_name_of_the_file(
        data: Any, tmp_path_factory: pytest.TempPathFactory) -> None:
    try:
        read = load(tmp_path_factory.getbasetemp(), data)
    except ValueError as error:
        assert 'r.yaml: ' in str(error)
    else:
        assert read.rules and '/rosout' not in read.nodes


def action(incident: int = 7, **fields: Any) -> Action:
    values: Dict[str, Any] = {'begin': 1_600_000_000_000_000_001, 'dry_run': False, **fields}
    return Action(incident, '/player', 'silent', 1, 2, 'stop /player', **values)


def test_what_is_written_is_read(tmp_path: Path) -> None:
    path = str(tmp_path / 'new' / 'a.actions')
    assert history.load(path) == History(), 'there is no file yet'
    written = History([], Hold(5 * 10 ** 18))
    for number in range(3):
        written.begin(action(number))
        written.end(bool(number), f'"{number}": äß\U0001f600\nand more\x07')
        written.save(path)
        assert history.load(path) == written
    assert written.actions[0].result == '"0": äß\U0001f600 and more\ufffd'
    History().save(path)
    assert history.load(path) == History()


def test_the_steady_times_are_of_one_boot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = str(tmp_path / 'a.actions')
    written = History([action(steady=5)], Hold(7, 6))
    written.save(path)
    assert history.load(path) == written
    boot = tmp_path / 'boot_id'
    boot.write_text('another\n')
    for other in (boot, tmp_path / 'none'):
        monkeypatch.setattr(history, '_BOOT_ID', other)
        assert history.load(path) == History([action()], Hold(7))


def test_the_steady_clock_tells_the_time_of_this_boot() -> None:
    """The clock that all see may have been set."""
    hour = 3600 * 10 ** 9
    kept = History([action(begin=9 * hour, steady=2 * hour), action(begin=9 * hour)])
    assert kept.ages(3 * hour, 100 * hour) == [hour, 91 * hour]
    assert kept.ages(3 * hour, hour) == [hour, 0]
    assert kept.ages(hour, 10 * hour) == [hour, hour], 'it cannot be of this boot'
    hold = Hold(9 * hour, 5 * hour)
    assert hold.left(3 * hour, 100 * hour) == 2 * hour and hold.left(6 * hour, hour) == 0
    hold = Hold(9 * hour)
    assert hold.left(3 * hour, 8 * hour) == hour and hold.left(3 * hour, 100 * hour) == 0


def test_the_last_ones_are_kept_and_long_results_are_cut(tmp_path: Path) -> None:
    written = History()
    for number in range(MOST + 10):
        written.begin(action(number))
        written.end(False, 'x' * 10_000)
    assert [each.incident for each in written.actions] == list(range(10, MOST + 10))
    assert len(written.actions[0].result) == 500
    written.save(str(tmp_path / 'a.actions'))
    assert history.load(str(tmp_path / 'a.actions')) == written


def test_it_lies_where_the_monitor_keeps_its_incidents(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv('HOME', '/home/me')
    monkeypatch.delenv('ROS_HOME', raising=False)
    default = '$ROS_HOME/self_awareness/$NAME'
    assert history.beside_incidents(default, '/r1/watch') == (
        '/home/me/.ros/self_awareness/r1_watch/r1_watch.actions')
    monkeypatch.setenv('ROS_HOME', '/ros')
    assert history.beside_incidents(default, '/watch') == '/ros/self_awareness/watch/watch.actions'
    assert history.beside_incidents('/data', '/watch') == '/data/watch.actions'
    assert history.beside_incidents('~/x', '/watch') == '/home/me/x/watch.actions'
