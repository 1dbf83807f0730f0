"""Whom an alarm names, when it ends, and the sentence for it, by the cases of ../shared/cases."""
from __future__ import annotations

import re
from pathlib import Path


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
