"""What `score` says of the cases of ../shared/cases, by one model of their robot."""
from __future__ import annotations

from pathlib import Path


def test_a_stall_takes_no_death_away(cases, scored, tmp_path: Path) -> None:
    """What began before an excuse stays what it was."""
    recording, = scored(str(cases.make('01_stall_hides_a_death', tmp_path) / 'crash.bag'))
    assert recording['incidents'][0]['headline'] == '/lidar and /amcl stopped sending at 50.0 s.'
    alarm, = [each for each in recording['alarms'] if each['level'] == 'ERROR']
    assert (alarm['kind'], alarm['culprit'], alarm['over']) == ('silent', '/lidar', False)


def test_a_topic_that_comes_from_another_node_is_one_suspicion(cases, scored,
                                                               tmp_path: Path) -> None:
    recording, = scored(str(cases.make('26_topic_comes_from_another_node', tmp_path)
                            / 'renamed.bag'))
    alarm, = recording['alarms']
    assert (alarm['level'], alarm['culprit']) == ('WARN', '/laser_nodelet_manager')
    assert alarm['reason'] == (
        '/scan comes from /laser_nodelet_manager now, in training from /lidar; not watched until '
        'you train again with --rename /laser_nodelet_manager /lidar; to accept it: ~accept '
        '"{component: /laser_nodelet_manager, kind: stranger}"')
    assert not alarm['over'] and len(alarm['suspects']) == 1
    assert recording['incidents'][0]['headline'].startswith(
        '/scan comes from /laser_nodelet_manager now')


def test_a_second_robot_of_the_same_names_is_told_as_that(cases, scored, tmp_path: Path) -> None:
    recording, = scored(str(cases.make('13_second_robot_with_the_same_names', tmp_path)
                            / 'twice.bag'))
    alarms = recording['alarms']
    assert {each['kind'] for each in alarms} == {'two senders'}
    assert all(each['busy'] is None and each['culprit'] is None for each in alarms)
    last = alarms[-1]
    assert last['level'] == 'ERROR' and not last['over']
    assert last['reason'] == 'every topic of 9 nodes comes from two senders of one name'
    assert 60.0 < alarms[0]['begin_s'] < 62.0, 'soon'
