"""The recovery as a node, without ROS: what it keeps, survives and says, and its exit codes."""
from __future__ import annotations

import time
from pathlib import Path
from types import SimpleNamespace
from typing import Any, List
from unittest.mock import MagicMock

import pytest
import rospy

from self_awareness.commands import recovery
from self_awareness.recovery import history, words
from self_awareness.recovery.history import Action, History, Hold
from self_awareness.recovery.ladder import Climb, Fault, Order
from self_awareness.recovery.node import Recovery
from self_awareness.recovery.rules import Rule, Rules, Stop

RULE = Rule('/player', ('silent',), (Stop(('/player',)),))
FAULT = Fault(7, '/player', 'silent', True)
SECOND = 10 ** 9
UNEXPECTED = UnicodeError('label empty or too long')


@pytest.fixture(name='recovery')
def made(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Recovery:
    for name in ('Publisher', 'Subscriber', 'Service'):
        monkeypatch.setattr(rospy, name, MagicMock())
    monkeypatch.setattr(rospy, 'get_param', lambda name, default: default)
    monkeypatch.setattr(rospy, 'get_name', lambda: '/recovery')
    monkeypatch.setattr(rospy.Time, 'now', lambda: rospy.Time(1))
    made = Recovery(Rules((RULE,)), '/monitor')
    monkeypatch.setattr(made._calls, 'parameter', lambda name: str(tmp_path))
    return made


@pytest.fixture
def path(tmp_path: Path) -> str:
    return str(tmp_path / 'monitor.actions')


def hold(recovery: Recovery, seconds: float, by: str = '/me') -> str:
    return recovery._on_hold(SimpleNamespace(
        duration=seconds, _connection_header={'callerid': by})).message


def action(**fields: Any) -> Action:
    return Action(7, '/player', 'silent', 1, 1, 'stop /player', time.time_ns(), False, **fields)


def read(recovery: Recovery) -> None:
    recovery._find_path()
    recovery._advance(0.0)


def test_where_the_actions_are_kept_is_known_when_the_monitor_is_there(
        recovery: Recovery, path: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    directories: List[Any] = [None]
    monkeypatch.setattr(recovery._calls, 'parameter', lambda name: directories[0])
    History([action(over=True)]).save(path)
    read(recovery)
    assert recovery._history.actions == [], 'it may be set when the monitor is started'
    directories[0] = str(tmp_path)
    read(recovery)
    assert len(recovery._history.actions) == 1
    directories[0] = '/other'
    read(recovery)
    assert recovery._path == path


def test_a_monitor_without_the_parameter_has_the_usual_place(
        recovery: Recovery, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv('ROS_HOME', '/ros')
    monkeypatch.setattr(recovery._calls, 'parameter', lambda name: None)
    recovery._find_path()
    assert recovery._found_path == ''
    recovery._on_status(MagicMock())
    recovery._find_path()
    assert recovery._found_path == '/ros/self_awareness/monitor/monitor.actions'


def test_a_step_of_another_start_is_over(recovery: Recovery, path: str) -> None:
    done = action(over=True, success=True, result='done')
    History([done, action()]).save(path)
    read(recovery)
    assert recovery._history.actions[0] == done
    assert recovery._history.actions[1].result == 'the recovery ended meanwhile'
    assert history.load(path).actions == recovery._history.actions


def test_a_hold_counts_before_it_is_known_where_it_is_kept(recovery: Recovery, path: str) -> None:
    History([], Hold(time.time_ns() + 600 * SECOND)).save(path)
    assert hold(recovery, 0.0) == 'goes on'
    recovery._advance(0.0)
    read(recovery)
    assert recovery._why_held() == ''
    assert history.load(path).hold.until <= time.time_ns()


def test_a_hold_that_is_not_kept_yet_says_so(recovery: Recovery) -> None:
    assert 'not kept yet' in hold(recovery, 60.0)
    read(recovery)
    assert 'not kept' not in hold(recovery, 60.0)


def test_who_holds_it_is_shown_in_short(recovery: Recovery) -> None:
    hold(recovery, 60.0, '/\x1b[31m' + 5000 * 'x')
    why = recovery._why_held()
    assert '\x1b' not in why and len(why) < 300


def test_a_hold_says_what_is_still_being_done(recovery: Recovery) -> None:
    assert 'stop' not in hold(recovery, 60.0)
    recovery._history.begin(action())
    assert 'still ends what it does: stop /player (step 1 of 1)' in hold(recovery, 60.0)
    assert recovery._why_held() == 'it is held, by /me'
    assert hold(recovery, 0.0) == 'goes on'
    assert recovery._why_held() == ''


@pytest.mark.parametrize('dry_run, does, success, told', [
    (True, 'would_do', True, 'nothing, since this is a dry run: ended'),
    (False, 'do', True, 'ended'),
    (True, 'would_do', False, f'it failed unexpectedly: {UNEXPECTED!r}'),
    (False, 'do', False, f'it failed unexpectedly: {UNEXPECTED!r}')])
def test_in_a_dry_run_nothing_is_done_and_what_fails_unexpectedly_has_failed(
        recovery: Recovery, dry_run: bool, does: str, success: bool, told: str) -> None:
    recovery._rules = Rules((RULE,), dry_run=dry_run)
    recovery._actions = MagicMock(**{f'{does}.side_effect': ['ended' if success else UNEXPECTED]})
    recovery._do(Order(RULE, 1, RULE.steps[0], FAULT))
    assert recovery._done == (success, told)


def test_a_look_that_fails_unexpectedly_is_followed_by_another(
        recovery: Recovery, monkeypatch: pytest.MonkeyPatch) -> None:
    looks: List[int] = []

    def fail() -> None:
        looks.append(1)
        raise UNEXPECTED

    monkeypatch.setattr('self_awareness.recovery.node._LOOK_EVERY_S', 0.0)
    monkeypatch.setattr(recovery._actions, 'look', fail)
    monkeypatch.setattr(rospy, 'is_shutdown', lambda: len(looks) == 2)
    recovery._look()
    assert len(looks) == 2


RULES = Path(__file__).resolve().parents[3] / 'config' / 'recovery.yaml'


@pytest.fixture(autouse=True)
def without_ros(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(rospy, 'init_node', lambda name: None)
    monkeypatch.setattr(rospy, 'get_name', lambda: '/recovery')
    monkeypatch.setattr(recovery.ros_node, 'limit_goodbye', lambda: None)
    monkeypatch.setattr(recovery, 'Recovery', MagicMock())


def test_rules_that_it_cannot_use_are_refused(tmp_path: Path) -> None:
    assert recovery.main([str(RULES)]) == 0
    assert recovery.main([str(tmp_path / 'none.yaml')]) == 1
    (tmp_path / 'r.yaml').write_text('rules: []')
    assert recovery.main([str(tmp_path / 'r.yaml')]) == 1
    assert recovery.main([]) == 2


@pytest.mark.parametrize('error', [OSError('no master'), ValueError('odd'), RuntimeError('odd'),
                                   rospy.ROSException('odd'), MemoryError()])
@pytest.mark.parametrize('where', ['begin', 'run'])
def test_what_may_go_well_the_next_time_is_not(error: Exception, where: str,
                                               monkeypatch: pytest.MonkeyPatch,
                                               capsys: pytest.CaptureFixture[str]) -> None:
    failing = MagicMock(side_effect=error)
    if where == 'begin':
        monkeypatch.setattr(rospy, 'init_node', failing)
    else:
        monkeypatch.setattr(recovery, 'Recovery', failing)
    assert recovery.main([str(RULES)]) not in (0, 1, 2)
    assert type(error).__name__ in capsys.readouterr().err


NOW = 100.0
TWO_STEPS = Rule('/player', ('silent',), (Stop(('/player',)), Stop(('/player', '/slam'))))
DONE = Action(7, '/player', 'silent', 1, 2, 'stop /player', 1_600_000_000_000_000_000, False, True,
              True, '/player ended by SIGKILL')
DOING = Action(7, '/player', 'silent', 2, 2, 'stop /player, /slam', 1_600_000_020_000_000_000,
               False)
WAITING, GAVE_UP = Climb(TWO_STEPS, NOW + 12.4, 1), Climb(TWO_STEPS, NOW, 3, gave_up='3 actions')
DOES = 'stop /player, /slam (step 2 of 2), since /player: silent'


@pytest.mark.parametrize('climbs, actions, blind, held, level, told', [
    ([], [DONE], '', '', words.OK, 'watches 3 components; 1 actions so far'),
    ([WAITING], [DONE], '', '', words.WARN,
     '/player is to be mended by step 2 of 2 in 12 s, if it does not recover'),
    ([Climb(TWO_STEPS, NOW, 1)], [DONE], '', '', words.WARN,
     '/player is to be mended by step 2 of 2 as soon as it fails so again'),
    ([WAITING], [DONE, DOING], '', '', words.WARN, DOES),
    ([GAVE_UP], [DONE], '', '', words.ERROR, 'gave up on /player: 3 actions'),
    ([GAVE_UP], [], 'not heard', '', words.ERROR,
     'gave up on /player: 3 actions; does nothing: not heard'),
    ([], [], 'not heard', '', words.WARN, 'does nothing: not heard'),
    ([], [], '', 'until noon, by /me', words.WARN, 'does nothing until noon, by /me'),
    ([], [DONE, DOING], '', 'until noon', words.WARN, f'{DOES}; does nothing more until noon'),
    ([], [DONE, DOING], 'not heard', 'until noon', words.WARN,
     f'{DOES}; does nothing more until noon; does nothing: not heard'),
    ([], [], 'not heard', 'until noon', words.WARN,
     'does nothing until noon; does nothing: not heard')])
def test_what_is_and_will_be_done_is_told_or_why_nothing_is(
        climbs: List[Climb], actions: List[Action], blind: str, held: str, level: int,
        told: str) -> None:
    assert words.status(NOW, 3, climbs, actions, blind, held) == (level, told)


def test_the_last_actions_are_values() -> None:
    shown = words.values([DONE] * 11 + [DOING], ['/x was not started by roslaunch'], True)
    assert shown['dry run'] == 'true'
    assert shown['cannot stop 1'] == '/x was not started by roslaunch'
    assert shown['action 1'] == (
        '2020-09-13 12:27:00 UTC, stop /player, /slam (step 2 of 2), since /player: silent')
    assert shown['action 2'] == ('2020-09-13 12:26:40 UTC, stop /player (step 1 of 2), since '
                                 '/player: silent: done: /player ended by SIGKILL')
    assert 'action 11' not in shown
