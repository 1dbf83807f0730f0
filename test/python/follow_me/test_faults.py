"""The simulated robot's faults beyond the paper's: names, culprits, effects; no ROS master."""
from __future__ import annotations

import multiprocessing
import os
import time
from collections import Counter
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from typing import Any, Dict, List, NamedTuple, Tuple

import pytest
import rosbag
from simulated_runs import Run, counts, output, robot, run, times

from self_awareness_evaluation.live.processes import becomes_true
from self_awareness_follow_me import induction
from self_awareness_follow_me.component_spec import ComponentSpec, Duration, Task
from self_awareness_follow_me.effects import Change, Starvation
from self_awareness_follow_me.faults import effect_of
from self_awareness_follow_me.simulation import START_S, InducedFault, events, simulate


def typical_delay(of: Run, first: str, second: str) -> float:
    """Median time (s) from a message on `second` back to the newest one before on `first`."""
    firsts = times(of, first)
    return median(t - max(f for f in firsts if f <= t) for t in times(of, second)[2:])


@pytest.mark.parametrize('kind, culprits', [
    ('cc1', ('/player',)), ('cc2', ('/slam',)), ('rs', ()), ('ac', ()), ('silence', ()),
    ('crash:camera', ('/camera',)), ('lat', ('/leg_detection', '/face_detection')),
    ('lat:slam', ('/slam',)), ('half:dialog', ('/dialog',)), ('double:player', ('/player',)),
    ('extra', ('/intruder',)), ('order', ('/slam',)), ('unknown', ('/anchoring',)),
    ('stale:slam', ('/slam',)), ('lossy:camera', ('/camera',)), ('empty:player', ('/player',)),
    ('freeze:camera', ('/camera',)), ('unsubscribed:navigation', ('/navigation',)),
])
def test_culprits(kind: str, culprits: Tuple[str, ...]) -> None:
    assert effect_of(robot(), kind).culprits == culprits


@pytest.mark.parametrize('kind, onset_s, message', [
    ('', 1.0, 'choose one of cc1, cc2'),
    ('crsh:slam', 1.0, r"'crsh:slam': choose one of .*crash:COMPONENT.*lat\[:COMPONENT\]"),
    ('crash', 1.0, "'crash': expected crash:COMPONENT"),
    ('crash:', 1.0, "'crash:': expected crash:COMPONENT"),
    ('cc1:player', 1.0, "'cc1:player': expected cc1"),
    ('lat:', 1.0, r"'lat:': expected lat\[:COMPONENT\]"),
    ('cc1', -1.0, 'cc1: the onset'), ('rs', float('nan'), 'rs: the onset'),
])
def test_no_such_fault(kind: str, onset_s: float, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        InducedFault(kind, onset_s)


@pytest.mark.parametrize('kind, message', [
    ('crash:plaer', "no component 'plaer'.*motors, player"),
    ('double:intruder', 'no component .*motors, player'),
    ('double:busy', r"'busy' is busy for 0.06 s every 0.1 s and cannot .*choose another comp"),
    ('stale:dialog', "no message of 'dialog' has a stamp; choose another component"),
    ('empty:motors', "no message of 'motors' has a list that can be empty; choose another"),
    ('unsubscribed:player', "'player' hears nothing that it could miss.*choose another component"),
])
def test_component_that_cannot_have_the_fault(kind: str, message: str) -> None:
    busy = ComponentSpec('busy', 'a', (Task((output('odom', 0.06),), every=Duration(0.1)),))
    with_busy = replace(robot(), components=(*robot().components, busy))
    with pytest.raises(ValueError, match=f'fault {kind}: {message}'):
        events(1.0, 1, InducedFault(kind, 0.5), with_busy)


def test_latency_is_added_and_rates_stay() -> None:
    normal, late = run(), run('lat')
    for first, second in (('/scan', '/legs'), ('/camera/image', '/faces')):
        added = typical_delay(late, first, second) - typical_delay(normal, first, second)
        assert added == pytest.approx(0.06, abs=0.01), second
    before, after = counts(normal), counts(late)
    assert set(before) == set(after)
    for key, count in before.items():
        assert after[key] == pytest.approx(count, rel=0.02, abs=2), key


@pytest.mark.parametrize('component', ['player', 'slam', 'face_detection'])
@pytest.mark.parametrize('kind, factor', [('half', 0.5), ('double', 2.0)])
def test_component_runs_at_another_rate(component: str, kind: str, factor: float) -> None:
    before, after = counts(run()), counts(run(f'{kind}:{component}'))
    own = [key for key in before if key[0] == '/' + component]
    assert own
    for key in own:
        assert after[key] == pytest.approx(factor * before[key], rel=0.1, abs=2), key


def test_intruder_is_a_connection_of_its_own_in_a_bag(tmp_path: Path) -> None:
    path = tmp_path / 'extra.bag'
    simulate(path, 4.0, 7, InducedFault('extra', 2.0), robot())
    with rosbag.Bag(str(path)) as bag:
        found = [(m.connection_header['callerid'].decode(), m.timestamp.to_sec() - START_S)
                 for m in bag.read_messages(topics=['/cmd_vel'], return_connection_header=True)]
    assert {source for source, t in found if t < 2.0} == {'/navigation'}
    assert Counter(source for source, t in found if t > 2.0) == pytest.approx(
        {'/navigation': 10, '/intruder': 20}, abs=1)
    written = [e.source for e in events(4.0, 7, InducedFault('extra', 2.0), robot())
               if e.topic == '/cmd_vel']
    assert [source for source, _ in found] == written


TAKES_S = 0.2  # so long, in the test, it takes to start a worker
BUSY_WITHIN_S = 60.0


def busy_s(pid: int) -> float:
    """Return how long a process has taken the CPU [s]."""
    fields = Path(f'/proc/{pid}/stat').read_text(encoding='ascii').rpartition(')')[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf('SC_CLK_TCK')


def test_no_worker_is_busy_before_all_have_started(monkeypatch: pytest.MonkeyPatch) -> None:
    start = multiprocessing.Process.start
    workers: List[multiprocessing.Process] = []

    def start_slowly(worker: multiprocessing.Process) -> None:
        start(worker)
        workers.append(worker)
        time.sleep(TAKES_S)

    def busy() -> List[float]:
        return [busy_s(int(worker.pid or 0)) for worker in workers]

    monkeypatch.setattr(multiprocessing.Process, 'start', start_slowly)
    with induction.starved(Starvation(ramp=0.0, slowdown=1.0, workers_per_core=4)):
        at_first = busy()
        assert becomes_true(lambda: min(busy()) >= 2 * TAKES_S, BUSY_WITHIN_S), 'all are busy'
    assert len(workers) == 4 * len(os.sched_getaffinity(0))
    assert max(at_first) < TAKES_S
    assert not any(worker.is_alive() for worker in workers), 'they end with the fault'


DURATION_S = 20.0
ONSET_S = 10.0


class Recorded(NamedTuple):
    """A message in a bag: times since its start (s), the header's number, the rest."""

    at: float
    stamp: float
    number: int
    message: Any


Bag = Dict[str, List[Recorded]]


@lru_cache(maxsize=None)
def bag_with(kind: str = '', lost: float = 0.01, seed: int = 7) -> Bag:
    """Make a bag with a fault, or without one, and read what has a header in it."""
    of = replace(robot(), faults=replace(robot().faults, lossy=Change((), {'lost': lost})))
    found: Bag = {}
    with TemporaryDirectory() as folder:
        path = f'{folder}/it.bag'
        simulate(path, DURATION_S, seed, InducedFault(kind, ONSET_S) if kind else None, of)
        with rosbag.Bag(path) as bag:
            for topic, message, stamp in bag.read_messages():
                if message._has_header:
                    header = message.header
                    found.setdefault(topic, []).append(
                        Recorded(stamp.to_sec() - START_S, header.stamp.to_sec() - START_S,
                                 header.seq, message))
    return found


def after(recorded: List[Recorded]) -> List[Recorded]:
    return [each for each in recorded if each.at > ONSET_S + 0.05]


def before(recorded: List[Recorded]) -> List[Recorded]:
    return [each for each in recorded if each.at < ONSET_S]


def at_times(bag: Bag) -> Dict[str, List[float]]:
    return {topic: [each.at for each in recorded] for topic, recorded in bag.items()}


def images(bag: Bag) -> List[bytes]:
    return [bytes(each.message.data) for each in bag['/camera/image']]


def test_messages_are_those_of_a_real_robot() -> None:
    normal, of = bag_with(), images(bag_with())
    assert len(set(of)) == len(of) > 100
    assert len({len(image) for image in of}) > 10
    assert not set(of) & set(images(bag_with(seed=8))), 'starts say different things'
    for topic, field in (('/scan', 'ranges'), ('/odom', 'pose'), ('/pose', 'pose')):
        said = {str(getattr(each.message, field)) for each in normal[topic]}
        assert len(said) == len(normal[topic]), topic


def test_lost_messages_are_counted() -> None:
    assert effect_of(robot(), 'lossy:camera') == Change(('camera',), {'lost': 0.01})
    bag, normal = bag_with('lossy:motors', 0.1), bag_with()
    numbers = [each.number for each in bag['/odom']]
    gaps = [b - a - 1 for a, b in zip(numbers, numbers[1:])]
    begin = len(before(bag['/odom'])) - 1
    assert not any(gaps[:begin])
    assert sum(gaps) == pytest.approx(0.1 * len(after(normal['/odom'])), rel=0.3)
    assert len(bag['/odom']) + sum(gaps) == pytest.approx(len(normal['/odom']), abs=2)
    assert len(bag['/scan']) == pytest.approx(len(normal['/scan']), abs=1)


def test_empty_and_frozen_messages() -> None:
    empty, frozen, normal = bag_with('empty:player'), bag_with('freeze:camera'), bag_with()
    assert {len(each.message.ranges) for each in before(empty['/scan'])} == {180}
    assert {len(each.message.ranges) for each in after(empty['/scan'])} == {0}
    still = images({'/camera/image': after(frozen['/camera/image'])})
    assert len(still) > 60 and len(set(still)) == 1
    for bag, topic in ((empty, '/scan'), (frozen, '/camera/image')):
        assert at_times(bag) == at_times(normal)
        assert [each.stamp for each in bag[topic]] == [each.stamp for each in normal[topic]]
