"""What `score` says of the cases of ../shared/cases, by one model of their robot."""
from __future__ import annotations

from pathlib import Path
from typing import Any, Callable, Dict, List

import pytest

from self_awareness.commands import info

# Recordings that were cut, or that have a bad one among them

SPLIT = '17_split_bags_death_before_a_split'
EMPTY = '28_empty_bag_in_a_folder'
NAME = 'run_2026-03-04-10-11-12_{}.bag'
DEATH_S = 59.7


@pytest.fixture(scope='module', name='bags')
def _bags(cases: Any, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the bags of both cases."""
    out = tmp_path_factory.mktemp('cut')
    for name in (SPLIT, EMPTY):
        cases.make(name, out)
    return out


def check_death(said: Dict[str, Any]) -> None:
    """Check that there is one alarm, to the end, and one incident, since the death."""
    alarm, = [alarm for alarm in said['alarms'] if alarm['level'] == 'ERROR']
    assert alarm['culprit'] == '/lidar' and alarm['kind'] == 'silent' and not alarm['over']
    incident, = said['incidents']
    assert incident['level'] == 'ERROR' and incident['cause'] == '/lidar'
    since = min(each['from_s'] for each in incident['silent'] if each['component'] == '/lidar')
    assert since == pytest.approx(DEATH_S, abs=0.1)


def test_a_death_before_a_split_is_one_alarm(scored, bags: Path, tmp_path: Path, capsys) -> None:
    said, = scored(str(bags / 'run'))
    check_death(said)
    out = capsys.readouterr().out
    assert f'{NAME.format(0)}..4: 5 files of one recording' in out
    assert f'/lidar and /amcl stopped sending at 59.6 s. (29.6 s of {NAME.format(1)})' in out
    assert f'29.6 s of {NAME.format(1)}' in (tmp_path / 'r.html').read_text(encoding='utf-8')
    assert info.main([str(bags / 'run')]) == 0
    assert f'from 30.0 s on: {NAME.format(1)}' in capsys.readouterr().out


def test_an_empty_bag_hides_nothing_behind_it(scored, bags: Path, tmp_path: Path, capsys) -> None:
    day = bags / 'day'
    quiet, dead = scored(str(day), code=1)
    assert quiet['bag'] == str(day / 'a.bag') and not quiet['alarms']
    assert dead['bag'] == str(day / 'c.bag')
    assert {alarm['culprit'] for alarm in dead['alarms'] if alarm['level'] == 'ERROR'} == {
        '/lidar'}
    error = capsys.readouterr().err
    assert error.startswith(f'score: error: {day}/b.bag: the bag is empty'), error
    assert error.count('\n') == 1
    scored(str(day), '--skip-bad')
    assert f'warning: skipped: {day}/b.bag: the bag is empty' in capsys.readouterr().err


# What began before an excuse stays what it was

def test_a_stall_takes_no_death_away(cases, scored, tmp_path: Path) -> None:
    recording, = scored(str(cases.make('01_stall_hides_a_death', tmp_path) / 'crash.bag'))
    assert recording['incidents'][0]['headline'] == '/lidar and /amcl stopped sending at 50.0 s.'
    alarm, = [each for each in recording['alarms'] if each['level'] == 'ERROR']
    assert (alarm['kind'], alarm['culprit'], alarm['over']) == ('silent', '/lidar', False)


# Who sends what: another node, two of one name, a player

SOON_S = 2.0
"""So long after it begins, what is wrong with senders is told at the latest."""


@pytest.fixture
def judged(scored, capsys) -> Callable[[str], List[Dict[str, Any]]]:
    """Return a function that scores a bag, and returns its alarms and suspicions."""
    def judge(bag: str) -> List[Dict[str, Any]]:
        recording, = scored(bag)
        recording['alarms'][0]['headline'] = recording['incidents'][0]['headline']
        capsys.readouterr()
        return list(recording['alarms'])
    return judge


def _written(robot: Any, made: Any, path: Path) -> str:
    robot.write(made, str(path))
    return str(path)


def _doubled(robot: Any, sources: Callable[[str], bool], begin: float,
             one_connection: bool) -> Any:
    """Return a robot of 40 s some of whose nodes are there twice from a time on."""
    first, second = robot.standard(31, 40.0), robot.standard(32, 40.0 - begin)
    second.epoch = first.epoch + begin
    twin = '' if one_connection else '#2'
    for each in second.ev:
        if sources(each.caller):
            def make(event: Any, of: Any = each) -> Any:
                return of.make(of)
            first.ev.append(robot.Ev(each.t + begin, each.caller + twin, each.topic, make))
    return first


def test_a_topic_that_comes_from_another_node_is_one_suspicion(cases, judged,
                                                               tmp_path: Path) -> None:
    alarms = judged(str(cases.make('26_topic_comes_from_another_node', tmp_path) / 'renamed.bag'))
    assert [each['level'] for each in alarms] == ['WARN']
    assert alarms[0]['culprit'] == '/laser_nodelet_manager'
    assert alarms[0]['reason'] == (
        '/scan comes from /laser_nodelet_manager now, in training from /lidar; not watched until '
        'you train again with --rename /laser_nodelet_manager /lidar; to accept it: ~accept '
        '"{component: /laser_nodelet_manager, kind: stranger}"')
    assert not alarms[0]['over']
    assert alarms[0]['headline'].startswith('/scan comes from /laser_nodelet_manager now')
    assert len(alarms[0]['suspects']) == 1


def test_several_topics_move_and_one_dies(cases, judged, tmp_path: Path) -> None:
    made = cases.robot.standard(142, 100.0)
    made.ev = [each for each in made.ev if each.caller != '/lidar' or each.t < 60.0]
    for each in made.ev:
        if each.caller == '/lidar' or 'depth' in each.topic or each.caller == '/gps':
            each.caller = '/manager'
    alarms = judged(_written(cases.robot, made, tmp_path / 'moved.bag'))
    assert alarms[0]['level'] == 'WARN'
    assert 'from /manager now, in training from' in alarms[0]['reason']
    assert 'not watched' in alarms[0]['reason']
    assert not any(each['kind'] == 'never came' for each in alarms)
    assert alarms[-1]['end_s'] > 99.0


def test_a_second_robot_of_the_same_names_is_told_as_that(cases, judged,
                                                          tmp_path: Path) -> None:
    alarms = judged(str(cases.make('13_second_robot_with_the_same_names', tmp_path) / 'twice.bag'))
    assert {each['kind'] for each in alarms} == {'two senders'}
    assert all(each['busy'] is None and each['culprit'] is None for each in alarms)
    last = alarms[-1]
    assert last['level'] == 'ERROR' and not last['over']
    assert last['reason'] == 'every topic of 9 nodes comes from two senders of one name'
    assert 60.0 < alarms[0]['begin_s'] < 60.0 + SOON_S


@pytest.mark.parametrize('begin', [0.0, 15.0])
def test_one_node_may_be_there_twice(begin: float, cases, judged, tmp_path: Path) -> None:
    made = _doubled(cases.robot, lambda source: source == '/lidar', begin, False)
    alarms = judged(_written(cases.robot, made, tmp_path / 'one.bag'))
    assert alarms[-1]['level'] == 'ERROR' and alarms[-1]['kind'] == 'two senders'
    assert alarms[-1]['reason'] == '/scan of /lidar comes from two senders of one name'


def test_numbers_tell_two_senders_where_the_recorder_made_one_connection(
        cases, judged, tmp_path: Path) -> None:
    made = _doubled(cases.robot, lambda source: True, 15.0, True)
    alarms = judged(_written(cases.robot, made, tmp_path / 'merged.bag'))
    assert all(each['busy'] is None for each in alarms)
    assert alarms[-1]['level'] == 'ERROR' and alarms[-1]['kind'] == 'two senders'
    assert 'nodes come from two senders of one name' in alarms[-1]['reason']


def test_who_plays_on_topics_of_the_robot_is_named_first(cases, judged,
                                                         tmp_path: Path) -> None:
    made, played = cases.robot.standard(31, 40.0), cases.robot.standard(32, 20.0)
    for each in played.ev:
        if each.topic in ('/scan', '/odom', '/fix'):
            made.ev.append(cases.robot.Ev(each.t + 15.0, '/play_1511950934432423423', each.topic,
                                          each.make, each.stamp))
    scans = [each.t + 15.0 for each in played.ev if each.topic == '/scan']
    made.follow(scans, '/amcl', '/amcl_pose', made.pose, .03, .006, every=3)
    alarms = judged(_written(cases.robot, made, tmp_path / 'played.bag'))
    assert alarms[0]['begin_s'] == pytest.approx(15.0, abs=SOON_S)
    for each in alarms:
        assert each['culprit'] == '/play_1511950934432423423'
        assert each['reason'].startswith('/play_1511950934432423423 plays on 3 topics of this '
                                         'robot: /fix, /odom and /scan')
