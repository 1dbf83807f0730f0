"""Recordings of the simulated robot: rates and errors of the paper, bags, its speed; no master."""
from __future__ import annotations

import os
import time
from collections import Counter
from dataclasses import fields, is_dataclass
from pathlib import Path
from statistics import median
from typing import Any, Dict, Iterator, List, Tuple

import pytest
import rosbag
from simulated_runs import DURATION_S, LEFT_S, ONSET_NS, Run, last, robot, run, times

from self_awareness_follow_me.simulation import START_S, InducedFault, events, simulate
from self_awareness_follow_me.speed import sped_up

KINDS = ('cc1', 'cc2', 'rs', 'ac', 'lat', 'lat:motors', 'crash:camera', 'silence', 'half:player',
         'half:slam', 'double:player', 'double:slam', 'double:face_detection', 'extra', 'order',
         'unknown')


def gaps(stamps: List[float], begin: float, end: float) -> List[float]:
    inside = [begin] + [t for t in stamps if begin <= t < end] + [end]
    return [after - before for before, after in zip(inside, inside[1:])]


def check_goes_on(of: Run, **rates: float) -> None:
    """Topics (with _ for /) still come at these rates [Hz]."""
    for name, rate in rates.items():
        found = len(times(of, '/' + name.replace('_', '/')))
        assert found == pytest.approx(rate * LEFT_S, rel=0.02), name


@pytest.mark.parametrize('seed', [1, 2, 3])
def test_normal_operation_has_the_rates_of_the_paper(seed: int) -> None:
    of = list(events(200.0, seed, scenario=robot()))
    assert len(of) / 200.0 == pytest.approx(163.0, rel=0.03)
    rates = {source: count / 200.0 for source, count in Counter(e.source for e in of).items()}
    assert set(rates) == {'/' + spec.name for spec in robot().components} and len(rates) == 15
    assert min(rates.values()) == pytest.approx(0.5, rel=0.05)
    assert max(rates.values()) == pytest.approx(86.0, rel=0.01)
    types = {(e.source, e.topic, e.datatype,
              e.message.value if e.datatype in robot().type_fields else None) for e in of}
    assert len(types) == 27


def test_seed_decides() -> None:
    assert list(events(DURATION_S, 5, scenario=robot())) == run()
    assert run(seed=6) != run()


@pytest.mark.parametrize('kind', KINDS)
def test_nothing_differs_before_the_onset(kind: str) -> None:
    before, normal = ([event for event in each if event.stamp_ns < ONSET_NS]
                      for each in (run(kind), run()))
    assert before == normal
    assert run(kind) != run()


def test_cc1_silences_the_laser_and_what_depends_on_it() -> None:
    of = run('cc1')
    for topic in ('/scan', '/pose', '/cmd_vel', '/obstacles', '/legs', '/tracks'):
        assert last(of, topic) < 0.5, topic
    assert last(of, '/path') < 2.0
    assert last(of, '/person_hypotheses', 1) < 0.5
    assert 0.0 < last(of, '/person_hypotheses', 9) < 2.0
    assert last(of, '/map_metadata') > 0.0
    check_goes_on(of, odom=86.0, camera_image=7.5)


def test_rs_stretches_gaps_slowly() -> None:
    faces = [(e.stamp_ns - ONSET_NS) / 1e9 for e in run('rs') if e.topic == '/faces']
    normal, growing, worst, still = (median(gaps(faces, begin, begin + 10.0))
                                     for begin in (-10.0, 5.0, 20.0, 35.0))
    assert 1.3 * normal < growing < 0.8 * worst
    assert still == pytest.approx(worst, rel=0.25)
    # At first nearly everything is as ever.
    assert len([t for t in times(run('rs'), '/odom') if t < 2.0]) >= 165


@pytest.mark.parametrize('seed', [1, 2, 3, 4])
def test_ac_drops_the_update_event_in_sporadic_intervals(seed: int) -> None:
    of = run('ac', seed)
    absent = [gap for gap in gaps(times(of, '/person_hypotheses', 1), 0.0, LEFT_S) if gap > 1.0]
    assert len(absent) >= 3
    assert max(absent) > 3.0
    assert sum(absent) < 0.5 * LEFT_S
    # What does not synchronise goes on as ever.
    check_goes_on(of, legs=10.0, camera_image=7.5, pose=5.0)


def test_bag_is_like_a_recorded_one(tmp_path: Path) -> None:
    path = tmp_path / 'run.bag'
    seconds: List[int] = []
    begin = time.monotonic()
    simulate(path, DURATION_S, 5, scenario=robot(), progress=seconds.append)
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
    assert stamps == [event.stamp_ns for event in run()]
    for spec in robot().components:
        for topic, output in spec.outputs().items():
            header = connections['/' + topic]
            assert header['callerid'] == f'/{spec.name}'.encode()
            assert header['latching'] == (b'1' if output.latch else b'0')
            assert header['type'] == output.datatype.encode()
            assert {'md5sum', 'message_definition', 'topic'} <= set(header)


def test_clock_drift_shows_in_the_stamps_of_one_host(tmp_path: Path) -> None:
    path = tmp_path / 'ac.bag'
    simulate(path, 30.0, 5, InducedFault('ac', 10.0), robot())
    late: Dict[str, List[float]] = {'/scan': [], '/camera/image': []}
    with rosbag.Bag(str(path)) as bag:
        for topic, message, stamp in bag.read_messages(topics=list(late)):
            late[topic].append((stamp - message.header.stamp).to_sec())
    assert 0.0 < min(late['/scan']) and max(late['/scan']) < 0.05
    assert min(late['/camera/image']) < -0.1 and max(late['/camera/image']) > 0.1


def test_latched_message_from_before_is_recorded_first() -> None:
    first = run()[0]
    assert (first.topic, first.stamp_ns) == ('/map_metadata', int(START_S * 1e9))


def test_failure_leaves_nothing_behind(tmp_path: Path) -> None:
    def interrupt(_: int) -> None:
        raise KeyboardInterrupt
    with pytest.raises(KeyboardInterrupt):
        simulate(tmp_path / 'run.bag', 5.0, 1, scenario=robot(), progress=interrupt)
    assert not os.listdir(str(tmp_path))


@pytest.mark.parametrize('arguments, message', [
    ({'duration_s': 0.0}, 'duration'),
    ({'duration_s': float('nan')}, 'duration'),
    ({'duration_s': float('inf')}, 'duration'),
    ({'duration_s': 1.0, 'start_s': 0.0}, 'start'),
    ({'duration_s': 1.0, 'start_s': 5e9}, 'start'),
])
def test_arguments_out_of_range(arguments: Dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        events(seed=1, scenario=robot(), **arguments)


def numbers(part: Any, name: str = '', owner: str = '') -> Iterator[Tuple[str, float]]:
    """Yield all floats of a part of a scenario but 0, each with the names that lead to it last."""
    if is_dataclass(part):
        part = {field.name: getattr(part, field.name) for field in fields(part)}
    if isinstance(part, dict):
        for key, each in part.items():
            yield from numbers(each, key, name)
    elif isinstance(part, tuple):
        for each in part:
            yield from numbers(each, name, owner)
    elif isinstance(part, float) and part != 0.0:
        yield f'{owner}.{name}', part


def test_no_time_of_it_is_forgotten() -> None:
    usual = robot()
    assert sped_up(usual, 1.0) == usual
    ratios = {(name, slow / number) for (name, number), (_, slow) in zip(
        numbers(usual), numbers(sped_up(usual, 0.5)))}
    assert {ratio for _, ratio in ratios} == {1.0, 2.0}
    # The machine stays as it is, and so does what is no time.
    as_ever = {name for name, ratio in ratios if ratio == 1.0}
    no_time = ('.sigma', '.rare', '.factor', '.probability')
    assert {name for name in as_ever if not name.endswith(no_time)} == {
        '.cpu_share', 'transport.median', 'lateness.median', 'rs.slowdown', 'settings.lost'}
    assert not as_ever & {name for name, ratio in ratios if ratio == 2.0}
