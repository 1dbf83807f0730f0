"""What `score` says of the cases of ../shared/cases: whom it names, when, in which words."""
from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any, NamedTuple

import pytest
from conftest import printed_by

from self_awareness import TrainedModel
from self_awareness.commands import calibrate, score, train


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


def test_goals_that_never_failed_before_are_told(of_its_own_robot) -> None:
    recording = of_its_own_robot('34_goals_aborted', 'abort.bag')
    incident, = recording['incidents']
    assert (incident['cause'], incident['level']) == ('/navigator', 'WARN'), 'results go on'
    alarm, = recording['alarms']
    assert [suspect['event_type'] for suspect in alarm['suspects']] == [
        '/navigator /navigator/result nav_demo/GoResult[status.status=4]']
    assert incident['headline'].startswith(
        '/navigator sends /navigator/result with status.status=4, as never in training, since 6')


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
    recording = of_its_own_robot('15_one_robot_of_two_loses_its_link', 'lost.bag')
    assert re.fullmatch(r'7 nodes at once \((/r1/\w+, ){2}/r1/\w+ and others\) fell silent at '
                        r'60\.0 s, and came back at 80\.6 s\.',
                        recording['incidents'][0]['headline'])
    assert [alarm['busy'] for alarm in recording['alarms']] == [None] * len(recording['alarms'])


class Learned(NamedTuple):
    """A model, the folder that it is in with the bags of the case, and what the programs said."""

    folder: Path
    model: str
    trained: str
    calibrated: str


@pytest.fixture(scope='module', name='learned')
def _learned(cases: Any, tmp_path_factory: pytest.TempPathFactory) -> Learned:
    folder = cases.make('37_node_stopped_before_the_recorder', tmp_path_factory.mktemp('early'))
    model = str(folder / 'robot.model')
    trained = printed_by(train, [*(str(folder / f'n{k}.bag') for k in range(1, 5)), '-o', model,
                                 '--details'])
    calibrated = printed_by(calibrate, [
        '--model', model, '--normal', str(folder / 'n5.bag'), str(folder / 'n6.bag'), '-o', model,
        '--inject', 'crash:/move_base', '--details'])
    return Learned(folder, model, trained, calibrated)


def test_who_ends_before_recordings_is_told_and_counts_in_no_promise(learned: Learned) -> None:
    line = re.search(r'/move_base ends before the recording does in 3 of 4: .*', learned.trained)
    assert line and f'{learned.folder}/n4.bag by 14.' in line[0] and '--end' in line[0]
    assert '/move_base ends before the recording does in 1 of 2' in learned.calibrated
    assert learned.trained.count('before the recording does') == 1
    found = {each.component: each.death_found_after
             for each in TrainedModel.load(learned.model).coverage()}
    assert found['/move_base'] < 1.5, 'its longest gap is 0.2 s'
    assert ': 0, and 1 of what stopped before a recording ended\n' in learned.calibrated
    assert 'found 2 of 2' in learned.calibrated


@pytest.mark.parametrize('name, headline', [
    ('crash', r'/move_base \(/cmd_vel\) stopped sending at (59.9|60.0) s\.'),
    ('pause10', r'/move_base \(/cmd_vel\) fell silent at \S+ s, and came back at 70.\d s\.'),
    ('n6', r'/move_base \(/cmd_vel\) stopped sending at 10[89].\d s, 11.\d s before the '
           r'recording ended\.')])
def test_deaths_and_pauses_are_found(learned: Learned, name: str, headline: str,
                                     tmp_path: Path) -> None:
    values = tmp_path / 'said.json'
    text = printed_by(score, [str(learned.folder / f'{name}.bag'), '--model', learned.model,
                              '--json', str(values)])
    incident, = json.loads(values.read_text())['recordings'][0]['incidents']
    assert re.fullmatch(headline, incident['headline']), incident['headline']
    assert ('before the recording ended' in text) == (name == 'n6')
