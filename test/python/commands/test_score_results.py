"""`score --result-bag`: what the monitor would have published, with the times of the recording."""
from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any, Callable, Dict, List, Tuple

import pytest
import rosbag
from conftest import error_of, jittery_robot

from self_awareness import ResultBag
from self_awareness.commands import score

STATUS, ALARM, DIAGNOSTICS = '/self_awareness/status', '/self_awareness/alarm', '/diagnostics'
VERSION = '/version'
OK, WARN, ERROR = 0, 1, 2


@pytest.fixture
def dead_laser(make_bag: Callable[..., str]) -> str:
    """Its laser falls silent from 12 s to 20 s, and a stranger speaks at 5.5 s."""
    return make_bag('dead.bag', sorted(
        [m for m in jittery_robot(3000.0, 30.0, 3)
         if not (3012.0 <= m[0] < 3020.0 and m[1] == '/laser')] + [(3005.52, '/new', '/a')]))


@pytest.fixture
def results(evidence_model: str, dead_laser: str, tmp_path: Path) -> Tuple[str, Dict[str, Any]]:
    """The result bag of it, and what was said of it as JSON."""
    path, values = str(tmp_path / 'out.bag'), tmp_path / 'out.json'
    assert score.main([dead_laser, '--model', evidence_model, '--result-bag', path,
                       '--json', str(values)]) == 0
    return path, json.loads(values.read_text())['recordings'][0]


def read(path: str, topic: str) -> List[Tuple[Any, Any]]:
    """Return message and time [s] of a topic."""
    with rosbag.Bag(path) as bag:
        return [(message, stamp.to_sec()) for _, message, stamp in bag.read_messages(topic)]


def test_programs_need_not_parse_words(results: Tuple[str, Dict[str, Any]],
                                       dead_laser: str) -> None:
    """The monitor's messages and score --json tell the same, in fields."""
    path, recording = results
    assert recording['bag'] == dead_laser
    told = [message for message, _ in read(path, ALARM)]
    begun = {}
    for message in told:
        if message.level != OK:
            begun.setdefault(message.alarm, message)
    assert [alarm['id'] for alarm in recording['alarms']] == list(begun)
    assert {alarm['level'] for alarm in recording['alarms']} == {'WARN', 'ERROR'}
    for alarm, message in zip(recording['alarms'], begun.values()):
        assert (alarm['kind'], alarm['culprit']) == (message.kind, message.component)
        assert alarm['reason'] == message.reason
        assert alarm['level'] == {WARN: 'WARN', ERROR: 'ERROR'}[message.level]
        assert alarm['begin_ns'] == message.header.stamp.to_nsec() <= alarm['end_ns']
        for said, suspect in zip(alarm['suspects'], message.suspects):
            assert said['reason'] == suspect.reason
            assert (said['component'], said['kind']) == (suspect.component, suspect.kind)
            assert said['event_type'].split()[:2] == [suspect.source, suspect.scope]
            assert (said['value'], said['unit']) == (suspect.value, suspect.unit)
    times = {key: {alarm[key] for alarm in recording['alarms']} for key in ('begin_ns', 'end_ns')}
    assert {message.header.stamp.to_nsec() for message in told if message.level == OK} == (
        times['end_ns'] - times['begin_ns'])
    died = next(alarm for alarm in recording['alarms'] if alarm['level'] == 'ERROR')
    assert (died['kind'], died['culprit']) == ('silent', '/laser')
    assert 12.0 < died['begin_s'] < 13.0 and died['end_s'] > 20.0 and died['over']
    first = died['suspects'][0]
    assert first['unit'] == 's' and first['value'] == pytest.approx(died['begin_s'] - 12, abs=0.2)
    assert first['usual'] < first['value'] and first['after'] is None


def test_times_are_those_of_the_recording_and_diagnostics_tell_of_all(
        results: Tuple[str, Dict[str, Any]], dead_laser: str) -> None:
    """All else of it: test/ros/verdict/replayed_monitor_test.cpp."""
    path, _ = results
    with rosbag.Bag(path) as bag, rosbag.Bag(dead_laser) as recording:
        assert bag.get_compression_info().compression == 'lz4'
        assert set(bag.get_type_and_topic_info().topics) == {VERSION, STATUS, ALARM, DIAGNOSTICS}
        assert next(bag.read_messages()).topic == VERSION
        stamps = [stamp for _, _, stamp in bag.read_messages([STATUS, ALARM, DIAGNOSTICS])]
        assert recording.get_start_time() < stamps[0].to_sec()
        assert stamps[-1].to_sec() == pytest.approx(recording.get_end_time(), abs=0.11)
        assert {connection.topic: connection.header['latching']
                for connection in bag._get_connections()} == {
                    VERSION: b'0', STATUS: b'0', ALARM: b'1', DIAGNOSTICS: b'0'}
    alarm, at = next((message, stamp) for message, stamp in read(path, ALARM)
                     if message.level == ERROR)
    status = next(array.status for array, stamp in read(path, DIAGNOSTICS) if stamp == at)
    by_name = {each.name.split(': ')[1]: (each.level, each.message) for each in status}
    assert list(by_name) == ['communication', '/battery', '/laser', '/slam']
    assert by_name['communication'] == (ERROR, alarm.message)
    assert by_name['/laser'][0] == ERROR and by_name['/laser'][1].startswith('/scan: silent for ')
    assert by_name['/battery'][1] == 'heard'


def test_several_recordings_are_in_one_bag_in_the_order_of_time(
        evidence_model: str, make_bag: Callable[..., str], tmp_path: Path) -> None:
    later = make_bag('later.bag', jittery_robot(7000.0, 12.0, 4))
    earlier = make_bag('earlier.bag', jittery_robot(3000.0, 12.0, 3))
    both, alone = str(tmp_path / 'both.bag'), str(tmp_path / 'alone.bag')
    assert score.main([later, earlier, '--model', evidence_model, '--result-bag', both]) == 0
    assert score.main([later, '--model', evidence_model, '--result-bag', alone]) == 0
    windows = [message.window_start.to_nsec() for message, _ in read(both, STATUS)]
    assert windows == sorted(windows)
    assert windows[0] < 3100 * 10**9 and windows[-1] > 7000 * 10**9
    assert [message for message, _ in read(both, STATUS)
            if message.window_start.to_sec() > 6000] == [m for m, _ in read(alone, STATUS)]


def test_recordings_that_overlap_are_refused(
        evidence_model: str, make_bag: Callable[..., str], tmp_path: Path) -> None:
    bag, path = make_bag('a.bag', jittery_robot(3000.0, 20.0, 3)), str(tmp_path / 'out.bag')
    assert 'overlap in time' in error_of(score, [f'{bag}@0-12', f'{bag}@8', '--model',
                                                 evidence_model, '--result-bag', path])
    assert not os.path.exists(path)
    assert score.main([f'{bag}@0-10', f'{bag}@10', '--model', evidence_model,
                       '--result-bag', path]) == 0


def test_a_recording_that_cannot_be_judged_keeps_no_other_from_it(evidence_model: str,
                                                                  dead_laser: str,
                                                                  make_bag: Callable[..., str],
                                                                  tmp_path: Path) -> None:
    other = make_bag('other.bag', [(9000.0 + i, '/a', '/b') for i in range(9)])
    before = sorted(tmp_path.iterdir())
    results = tmp_path / 'out.bag'
    assert score.main([other, '--model', evidence_model, '--result-bag', str(results)]) == 1
    assert sorted(tmp_path.iterdir()) == before
    assert 'the model knows none of' in error_of(score, [other, dead_laser, '--model',
                                                         evidence_model, '--result-bag',
                                                         str(results)])
    assert ResultBag.is_one(str(results))
