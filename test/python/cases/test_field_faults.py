"""What people in the field look at first, by the cases of ../shared/cases."""
from __future__ import annotations

from pathlib import Path


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
