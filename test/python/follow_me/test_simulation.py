"""Recordings of the simulated robot: the paper's rates and errors, bags; no ROS master."""
from __future__ import annotations

import os
import time
from collections import Counter
from pathlib import Path
from typing import Any, Dict, List

import pytest
import rosbag

from self_awareness.commands.simulate import main
from self_awareness_follow_me.scenario import Scenario, load_scenario
from self_awareness_follow_me.simulation import START_S, Event, InducedFault, events, simulate

SCENARIO = Path(__file__).resolve().parents[3] / 'config' / 'follow_me.yaml'
KINDS = ('cc1', 'cc2', 'rs', 'ac', 'lat', 'lat:motors', 'crash:camera', 'silence', 'half:player',
         'half:slam', 'double:player', 'double:slam', 'double:face_detection', 'extra', 'order',
         'unknown')
DURATION_S = 100.0
ONSET_S = 50.0


@pytest.fixture(name='scenario', scope='module')
def _scenario() -> Scenario:
    return load_scenario(SCENARIO)


@pytest.fixture(name='runs', scope='module')
def _runs(scenario: Scenario) -> Dict[str, List[Event]]:
    kinds: Dict[str, Any] = {kind: InducedFault(kind, ONSET_S) for kind in KINDS}
    kinds['normal'] = None
    return {kind: list(events(DURATION_S, 5, fault, scenario)) for kind, fault in kinds.items()}


def times(run: List[Event], topic: str, value: Any = None) -> List[float]:
    """Seconds since the start of the recording at which a topic (with a value) was seen."""
    return [event.stamp_ns / 1e9 - START_S for event in run
            if event.topic == topic and (value is None or event.value == value)]


def gaps(stamps: List[float], begin: float, end: float) -> List[float]:
    inside = [begin] + [t for t in stamps if begin <= t < end] + [end]
    return [after - before for before, after in zip(inside, inside[1:])]


@pytest.mark.parametrize('seed', [1, 2, 3])
def test_normal_operation_has_the_rates_of_the_paper(scenario: Scenario,
                                                     seed: int) -> None:
    run = list(events(200.0, seed, scenario=scenario))
    assert len(run) / 200.0 == pytest.approx(163.0, rel=0.03)
    rates = {source: count / 200.0 for source, count in Counter(e.source for e in run).items()}
    assert set(rates) == {'/' + spec.name for spec in scenario.components}
    assert min(rates.values()) == pytest.approx(0.5, rel=0.05)
    assert max(rates.values()) == pytest.approx(86.0, rel=0.01)
    types = {(e.source, e.topic, e.datatype,
              e.value if e.datatype in scenario.type_fields else None) for e in run}
    assert len(types) == 27


def test_recording_is_sorted_and_within_its_time(runs: Dict[str, List[Event]]) -> None:
    stamps = [event.stamp_ns for event in runs['rs']]
    assert stamps == sorted(stamps)
    assert START_S * 1e9 <= stamps[0] and stamps[-1] < (START_S + DURATION_S) * 1e9


def test_seed_decides(scenario: Scenario, runs: Dict[str, List[Event]]) -> None:
    assert list(events(DURATION_S, 5, scenario=scenario)) == runs['normal']
    assert list(events(DURATION_S, 6, scenario=scenario)) != runs['normal']


@pytest.mark.parametrize('kind', KINDS)
def test_nothing_differs_before_the_onset(runs: Dict[str, List[Event]], kind: str) -> None:
    onset = (START_S + ONSET_S) * 1e9
    before = [event for event in runs[kind] if event.stamp_ns < onset]
    assert before == [event for event in runs['normal'] if event.stamp_ns < onset]
    assert runs[kind] != runs['normal']


def test_cc1_silences_the_laser_and_what_depends_on_it(runs: Dict[str, List[Event]]) -> None:
    run = runs['cc1']
    for topic in ('/scan', '/pose', '/cmd_vel', '/obstacles', '/legs', '/tracks'):
        assert max(times(run, topic)) < ONSET_S + 0.5, topic
    assert max(times(run, '/path')) < ONSET_S + 2.0
    assert max(times(run, '/person_hypotheses', 1)) < ONSET_S + 0.5
    assert ONSET_S < max(times(run, '/person_hypotheses', 9)) < ONSET_S + 2.0
    assert max(times(run, '/map_metadata')) > ONSET_S
    for topic, rate in (('/odom', 86.0), ('/camera/image', 7.5)):
        assert len([t for t in times(run, topic) if t > ONSET_S]) == pytest.approx(
            rate * (DURATION_S - ONSET_S), rel=0.02)


def test_cc2_silences_slam_and_navigation_only(runs: Dict[str, List[Event]]) -> None:
    run = runs['cc2']
    assert max(times(run, '/pose')) < ONSET_S + 0.01
    assert max(times(run, '/cmd_vel')) < ONSET_S + 0.1
    assert max(e.stamp_ns for e in run if e.source == '/slam') < (START_S + ONSET_S + 0.01) * 1e9
    for topic, rate in (('/scan', 10.0), ('/legs', 10.0), ('/obstacles', 5.0)):
        assert len([t for t in times(run, topic) if t > ONSET_S]) == pytest.approx(
            rate * (DURATION_S - ONSET_S), rel=0.02)


def test_rs_stretches_gaps_slowly(runs: Dict[str, List[Event]]) -> None:
    faces = times(runs['rs'], '/faces')

    def typical(begin: float) -> float:
        found = sorted(gaps(faces, begin, begin + 10.0))
        return found[len(found) // 2]

    normal, growing, worst, last = (typical(t) for t in (40.0, 55.0, 70.0, 85.0))
    assert 1.3 * normal < growing < 0.8 * worst
    assert last == pytest.approx(worst, rel=0.25)
    # At first nearly everything is as ever.
    assert len([t for t in times(runs['rs'], '/odom') if 50.0 < t < 52.0]) >= 165


@pytest.mark.parametrize('seed', [1, 2, 3, 4])
def test_ac_drops_the_update_event_in_sporadic_intervals(scenario: Scenario,
                                                         seed: int) -> None:
    run = list(events(DURATION_S, seed, InducedFault('ac', ONSET_S), scenario))
    absent = [gap for gap in gaps(times(run, '/person_hypotheses', 1), ONSET_S, DURATION_S)
              if gap > 1.0]
    assert len(absent) >= 3
    assert max(absent) > 3.0
    assert sum(absent) < 0.5 * (DURATION_S - ONSET_S)
    # What does not synchronise goes on as ever.
    for topic, rate in (('/legs', 10.0), ('/camera/image', 7.5), ('/pose', 5.0)):
        assert len([t for t in times(run, topic) if t > ONSET_S]) == pytest.approx(
            rate * (DURATION_S - ONSET_S), rel=0.02)


def test_bag_is_like_a_recorded_one(scenario: Scenario, tmp_path: Path,
                                    runs: Dict[str, List[Event]]) -> None:
    path = tmp_path / 'run.bag'
    seconds: List[int] = []
    begin = time.monotonic()
    simulate(path, DURATION_S, 5, scenario=scenario, progress=seconds.append)
    assert time.monotonic() - begin < 20.0
    assert sum(seconds) == DURATION_S
    assert os.listdir(str(tmp_path)) == ['run.bag']
    stamps: List[int] = []
    sequences: Counter = Counter()
    with rosbag.Bag(str(path)) as bag:
        connections = {info.topic: info.header for info in bag._get_connections()}
        for topic, message, stamp in bag.read_messages():
            stamps.append(stamp.to_nsec())
            header = getattr(message, 'header', None)
            if header is not None:
                assert 0 <= stamp.to_nsec() - header.stamp.to_nsec() < 1_000_000_000, topic
                assert sequences[topic] in (0, header.seq - 1), topic
                sequences[topic] = header.seq
    assert stamps == [event.stamp_ns for event in runs['normal']]
    for spec in scenario.components:
        for topic, output in spec.outputs().items():
            header = connections['/' + topic]
            assert header['callerid'] == f'/{spec.name}'.encode()
            assert header['latching'] == (b'1' if output.latch else b'0')
            assert header['type'] == output.datatype.encode()
            assert {'md5sum', 'message_definition', 'topic'} <= set(header)


def test_clock_drift_shows_in_the_stamps_of_one_host(scenario: Scenario,
                                                     tmp_path: Path) -> None:
    path = tmp_path / 'ac.bag'
    simulate(path, 30.0, 5, InducedFault('ac', 10.0), scenario)
    late: Dict[str, List[float]] = {'/scan': [], '/camera/image': []}
    with rosbag.Bag(str(path)) as bag:
        for topic, message, stamp in bag.read_messages(topics=list(late)):
            late[topic].append((stamp - message.header.stamp).to_sec())
    assert 0.0 < min(late['/scan']) and max(late['/scan']) < 0.05
    assert min(late['/camera/image']) < -0.1 and max(late['/camera/image']) > 0.1


def test_latched_message_from_before_is_recorded_first(scenario: Scenario) -> None:
    first = next(events(1.0, 1, scenario=scenario))
    assert (first.topic, first.stamp_ns) == ('/map_metadata', int(START_S * 1e9))


def test_failure_leaves_nothing_behind(scenario: Scenario, tmp_path: Path) -> None:
    def interrupt(_: int) -> None:
        raise KeyboardInterrupt
    with pytest.raises(KeyboardInterrupt):
        simulate(tmp_path / 'run.bag', 5.0, 1, scenario=scenario, progress=interrupt)
    assert not os.listdir(str(tmp_path))


@pytest.mark.parametrize('arguments, message', [
    ({'duration_s': 0.0}, 'duration'),
    ({'duration_s': float('nan')}, 'duration'),
    ({'duration_s': float('inf')}, 'duration'),
    ({'duration_s': 1.0, 'start_s': 0.0}, 'start'),
    ({'duration_s': 1.0, 'start_s': 5e9}, 'start'),
])
def test_arguments_out_of_range(scenario: Scenario, arguments: Dict[str, Any],
                                message: str) -> None:
    with pytest.raises(ValueError, match=message):
        events(seed=1, scenario=scenario, **arguments)


@pytest.mark.parametrize('kind, onset_s', [('cc3', 1.0), ('cc1', -1.0), ('rs', float('nan'))])
def test_no_such_fault(kind: str, onset_s: float) -> None:
    with pytest.raises(ValueError, match=kind):
        InducedFault(kind, onset_s)


def test_program_writes_numbered_bags(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    common = ['--scenario', str(SCENARIO), '--duration', '2']
    folder = tmp_path / 'bags'
    assert main(['-o', str(folder), '--runs', '2', '--seed', '3', *common]) == 0
    assert main(['-o', str(folder), '--fault', 'cc1@1', *common]) == 0
    runs = ('cc1_1', 'normal_3', 'normal_4')
    assert (sorted(os.listdir(str(folder)))
            == sorted(run + end for run in runs for end in ('.bag', '.graph.yaml')))
    assert str(folder / 'normal_3.bag') in capsys.readouterr().out


@pytest.mark.parametrize('arguments, message', [
    (['--fault', 'cc1@2'], 'beyond'),
    (['--fault', 'cc1@x'], '--fault cc1@x'),
    (['--fault', 'cc9'], 'choose one of cc1, cc2, rs, ac'),
    (['--runs', '2'], 'need a folder'),
    (['--runs', '0'], 'at least 1'),
    (['--scenario', 'nowhere.yaml'], 'nowhere.yaml: cannot be read'),
])
def test_program_says_what_is_wrong(tmp_path: Path, capsys: pytest.CaptureFixture,
                                    arguments: List[str], message: str) -> None:
    path = tmp_path / 'run.bag'
    assert main(['-o', str(path), '--scenario', str(SCENARIO), '--duration', '2', *arguments]) == 1
    assert message in capsys.readouterr().err
    assert not path.exists()


def test_program_overwrites_nothing(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    path = tmp_path / 'run.bag'
    path.write_text('precious', encoding='utf-8')
    assert main(['-o', str(path), '--scenario', str(SCENARIO), '--duration', '2']) == 1
    assert 'exists already' in capsys.readouterr().err
    assert path.read_text(encoding='utf-8') == 'precious'
