"""The program that shows what a monitor has kept of its incidents."""
from __future__ import annotations

import json
from pathlib import Path
from typing import Any, Callable, List

import genpy
import genpy.dynamic
import pytest
import rosbag
from conftest import error_of, printed_by

from self_awareness.commands import incidents
from self_awareness.msg import FileVersion, Incident, Incidents, SelfAwareness
from self_awareness.recovery import history
from self_awareness.stamps import SECOND_NS

HOUR_S = 3600
NOON_S = 1_790_000_000  # 2026-09-21 14:13:20 UTC


def incident(number: int, component: str, opened_s: float, **fields: Any) -> Incident:
    opened = genpy.Time.from_sec(opened_s)
    return Incident(**{**dict(
        id=number, last=number, level=SelfAwareness.ERROR, kind='silent', component=component,
        reason='silent for 2.3 s', opened=opened, grown=opened, over=True, alarms=1,
        ended=opened + genpy.Duration(20)), **fields})


KEPT = [
    incident(1, '/player', NOON_S, alarms=7, near_misses=2, victims=['/slam', '/navigation'],
             others=['/camera', '/microphone'], model='/robot.model',
             recording='/gone/alarm.bag'),
    incident(2, '', NOON_S + HOUR_S, kind='busy machine', reason=''),
    incident(3, '/camera', NOON_S + 2 * HOUR_S, over=False),
    incident(4, '/quiet', NOON_S + 3 * HOUR_S, level=SelfAwareness.WARN, alarms=0, near_misses=5),
]


def write(path: Path, kept: List[Incident]) -> str:
    path.parent.mkdir(parents=True, exist_ok=True)
    version = FileVersion(kind='incidents', format=1, oldest_reader=1, package='0.1.0')
    with rosbag.Bag(str(path), 'w') as bag:
        bag.write('/version', version, genpy.Time(1))
        bag.write('/incidents', Incidents(incidents=kept), genpy.Time(1))
    return str(path)


@pytest.fixture()
def run(tmp_path: Path, capsys: Any) -> Callable[..., str]:
    """Run the program with the file of one monitor."""
    file = write(tmp_path / 'watch.incidents', KEPT)

    def of(*options: str, code: int = 0) -> str:
        assert incidents.main(['--file', file, *options]) == code
        said = capsys.readouterr()
        return said.out if code == 0 else said.err
    return of


def test_one_line_for_an_incident(run: Callable[..., str]) -> None:
    head, columns, player, busy, camera, near = run().splitlines()
    assert head.endswith('watch.incidents: incidents: 3, open: 1')
    assert columns.split()[0] == 'opened'
    assert player.split() == ['2026-09-21', '14:13:20', 'UTC', '20', 's', '/player', 'silent',
                              '7', '2', '/slam,', '/navigation,', '/camera', 'and', '1', 'more',
                              '1']
    assert 'busy machine' in busy and ' open ' in camera
    assert near.strip().startswith('besides, components with near misses only: 1')
    assert '/quiet' in run('--near-misses')
    assert [each['id'] for each in json.loads(run('--json'))] == [1, 2, 3, 4]


def test_one_is_shown_with_its_record_and_the_way_to_its_report(
        run: Callable[..., str], tmp_path: Path, capsys: Any) -> None:
    shown = run('1')
    assert 'silent for 2.3 s' in shown
    assert '7 times, and 2 near misses' in shown
    assert '/slam, /navigation' in shown and '/camera, /microphone' in shown
    assert '/gone/alarm.bag (not there' in shown and '--report' not in shown
    assert 'none were recorded' in run('2')
    recording = tmp_path / 'an alarm.bag'
    recording.touch()
    file = write(tmp_path / 'other.incidents', [incident(
        7, '/player', NOON_S, recording=str(recording), model='/robot.model')])
    assert incidents.main(['--file', file, '7']) == 0
    assert (f"rosrun self_awareness score '{recording}' --model /robot.model "
            '--report incident_7.html') in capsys.readouterr().out


def test_what_was_open_when_its_monitor_ended_is_unknown_since(tmp_path: Path) -> None:
    file = write(tmp_path / 'w.incidents', [incident(7, '/player', NOON_S, unknown=True)])
    said = printed_by(incidents, ['--file', file])
    assert 'open: 0' in said and '  unknown since 2026-09-21 14:13:40 UTC  /player' in said
    assert 'unknown since  2026-09-21 14:13:40' in printed_by(incidents, ['--file', file, '7'])
    assert json.loads(printed_by(incidents, ['--file', file, '--json']))[0]['unknown'] is True


def test_all_monitors_are_found_in_ros_home(tmp_path: Path,
                                            monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv('ROS_HOME', str(tmp_path))
    assert 'no monitor of this machine has had an incident' in error_of(incidents, [])
    for name in ('first', 'second'):
        write(tmp_path / 'self_awareness' / name / f'{name}.incidents', KEPT[:1])
    said = printed_by(incidents, [])
    assert 'first.incidents: incidents: 1' in said and 'second.incidents: incidents: 1' in said


def test_errors_name_what_is_wrong(run: Callable[..., str], tmp_path: Path) -> None:
    assert 'no incident 99 in ' in run('99', code=1)
    damaged = tmp_path / 'damaged.incidents'
    damaged.write_bytes(b'no bag')
    assert f'{damaged}: the incidents in it are damaged' in error_of(incidents, ['--file',
                                                                                 str(damaged)])
    assert 'there is no such file' in error_of(incidents, ['--file', str(tmp_path / 'none')])


def test_what_the_recovery_did_is_shown_with_the_incident(run: Callable[..., str], tmp_path: Path,
                                                          capsys: Any) -> None:
    done = history.History()
    for number, result in ((1, '/player ended by SIGKILL'), (1, '/slam ended'), (99, 'other')):
        done.begin(history.Action(number, '/player', 'silent', 1, 2, 'stop /player',
                                  NOON_S * SECOND_NS, False))
        done.end(True, result)
    done.save(str(tmp_path / 'watch.actions'))
    assert '/player silent (recovery: 2)' in run()
    told = [line for line in run('1').splitlines() if 'recovery' in line]
    assert len(told) == 2
    assert '2026-09-21 14:13:20 UTC, stop /player (step 1 of 2)' in told[0]
    assert told[0].endswith('done: /player ended by SIGKILL')
    first, second = json.loads(run('--json'))[:2]
    assert [each['result'] for each in first['actions']] == ['/player ended by SIGKILL',
                                                             '/slam ended']
    assert second['actions'] == []
    (tmp_path / 'watch.actions').write_text('{}}')
    assert incidents.main(['--file', str(tmp_path / 'watch.incidents')]) == 0
    said = capsys.readouterr()
    assert '/player silent ' in said.out and 'watch.actions: not YAML' in said.err
