"""What `score` says of the cases of ../shared/cases: whom it names, when, in which words."""
from __future__ import annotations

import re
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


def test_old_stamps_of_transforms_are_found(cases, scored, tmp_path: Path) -> None:
    recording, = scored(str(cases.make('07_tf_stamps_old', tmp_path) / 'crash.bag'))
    incident, = recording['incidents']
    assert incident['kind'] == 'stale'
    alarm, = (each for each in recording['alarms'] if each['level'] == 'ERROR')
    assert {suspect['event_type'] for suspect in alarm['suspects']} == {
        '/ekf /tf tf2_msgs/TFMessage', '/robot_state_publisher /tf tf2_msgs/TFMessage'}
    assert 50.0 < alarm['begin_s'] < 52.0


def test_a_transform_or_joint_that_is_missing_and_a_first_error_are_told(
        of_its_own_robot) -> None:
    """Of 1, "lacks one of its eight transforms"; of 3, the first ERROR on /diagnostics."""
    make = Path(__file__).parent / 'robot_that_lists.py'
    lacking, jointless, failing = of_its_own_robot(make, 'lacking.bag', 'jointless.bag',
                                                   'failing.bag')
    for recording, cause, said in (
            (lacking, '/robot_state_publisher',
             '/tf without laser (transforms.child_frame_id)'),
            (jointless, '/base_driver', '/joint_states without r (name)'),
            (failing, '/gps', '/diagnostics with status.level=2')):
        incident, = recording['incidents']
        assert (incident['cause'], incident['level']) == (cause, 'WARN'), 'its messages come'
        assert incident['headline'].startswith(f'{cause} sends {said}, as never in training')
        assert incident['headline'].endswith('to the end of the recording.')
        alarm, = recording['alarms']
        assert 50 < alarm['begin_s'] < 52


def test_a_flood_of_log_lines_is_found(of_its_own_robot) -> None:
    recording, = of_its_own_robot('21_log_flood', 'flood.bag')
    incident, = recording['incidents']
    assert (incident['cause'], incident['kind']) == ('/move_base', 'fast')
    assert incident['headline'].startswith(
        '/move_base (/rosout with level=4) sends too often from 50.0 s')
    alarm, = (each for each in recording['alarms'] if each['level'] == 'ERROR')
    assert alarm['begin_s'] < 55.0


def test_while_a_simulation_stands_still_nobody_is_fast(of_its_own_robot) -> None:
    recording, = of_its_own_robot('24_simulation_paused', 'paused.bag')
    assert recording['alarms'] == []


def test_a_simulation_that_runs_slower_blames_nobody(of_its_own_robot) -> None:
    recording, = of_its_own_robot(Path(__file__).parent / 'slower_simulation.py', 'slower.bag')
    incident, = recording['incidents']
    assert (incident['cause'], incident['kind'], incident['level']) == (
        None, 'slower clock', 'WARN')
    assert incident['headline'].startswith(
        'The simulation may run slower: 2 nodes send 2.5 times as often by its clock, from 50.')


def test_goals_that_never_failed_before_are_told(of_its_own_robot) -> None:
    recording, = of_its_own_robot('34_goals_aborted', 'abort.bag')
    incident, = recording['incidents']
    assert (incident['cause'], incident['level']) == ('/navigator', 'WARN'), 'results go on'
    alarm, = recording['alarms']
    assert [suspect['event_type'] for suspect in alarm['suspects']] == [
        '/navigator /navigator/result nav_demo/GoResult[status.status=4]']
    assert incident['headline'].startswith(
        '/navigator sends /navigator/result with status.status=4, as never in training, since 6')


def test_what_was_always_latched_and_is_not_there_is_told(of_its_own_robot) -> None:
    recording, = of_its_own_robot('19_map_never_came', 'no_map.bag')
    incident, = recording['incidents']
    assert (incident['cause'], incident['kind'], incident['level']) == (
        '/map_server', 'never came', 'WARN')
    alarm, = recording['alarms']
    assert alarm['suspects'][0]['event_type'].startswith('/map_server /map ')


def test_who_has_a_request_outstanding_is_no_suspect(cases, scored, tmp_path: Path) -> None:
    recording, = scored(str(cases.make('03_healthy_nodes_said_to_have_died', tmp_path)
                            / 'crash.bag'))
    assert recording['alarms']
    assert {suspect['component'] for alarm in recording['alarms']
            for suspect in alarm['suspects']} == {'/camera/manager'}


def test_an_alarm_of_losses_ends_with_them(cases, scored, tmp_path: Path) -> None:
    recording, = scored(str(cases.make('11_loss_alarm_outlives_the_loss', tmp_path) / 'loss.bag'))
    incident, = recording['incidents']
    assert (incident['cause'], incident['kind']) == ('/lidar', 'lossy')
    assert incident['headline'].startswith('/lidar (/scan) loses messages from 5')
    alarms = [each for each in recording['alarms'] if each['level'] == 'ERROR']
    assert 50.0 < alarms[0]['begin_s'] < 54.0
    assert 70.0 < alarms[-1]['end_s'] < 80.0


def test_a_node_that_is_started_again_and_again_is_one_incident(cases, scored, capsys,
                                                                tmp_path: Path) -> None:
    capsys.readouterr()
    recording, = scored(str(cases.make('30_text_of_a_respawn_loop', tmp_path) / 'loop.bag'))
    said = [line for line in capsys.readouterr().out.splitlines() if not line.startswith(' ')
            or line.startswith('  /')]
    assert len(recording['incidents']) == 1
    assert recording['incidents'][0]['headline'] == (
        '/gps (/fix) fell silent 16 times, the longest at 39.9 s, and came back at 43.1 s.')
    assert said[-2] == f"  {recording['incidents'][0]['headline']}"


def test_nodes_that_fall_silent_at_once_are_not_late(of_its_own_robot) -> None:
    """One robot of two loses its link; the other one, and the station, go on."""
    recording, = of_its_own_robot('15_one_robot_of_two_loses_its_link', 'lost.bag')
    assert re.fullmatch(r'7 nodes at once \((/r1/\w+, ){2}/r1/\w+ and others\) fell silent at '
                        r'60\.0 s, and came back at 80\.6 s\.',
                        recording['incidents'][0]['headline'])
    assert [alarm['busy'] for alarm in recording['alarms']] == [None] * len(recording['alarms'])


def test_two_thirds_of_the_rate_are_found_in_clumps(of_its_own_robot) -> None:
    recording, = of_its_own_robot('31_two_thirds_of_the_rate_over_a_weak_link', 'slow.bag',
                                  training=8, normal=12)
    incident, = recording['incidents']
    assert (incident['cause'], incident['kind']) == ('/laser', 'slow')
    assert recording['alarms'][0]['begin_s'] < 20.0
