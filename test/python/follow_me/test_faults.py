"""The simulated robot's faults beyond the paper's: names, culprits, effects; no ROS master."""
from __future__ import annotations

import multiprocessing
import os
import random
import time
from collections import Counter
from dataclasses import replace
from pathlib import Path
from statistics import median
from typing import Any, Dict, List, Tuple

import pytest
import rosbag
from simulated_runs import LEFT_S, MS, ONSET_NS, S, Run, counts, last, output, robot, run, times

from self_awareness_evaluation.live.processes import becomes_true
from self_awareness_follow_me import induction
from self_awareness_follow_me.component import Component, Message, Publish, Wake
from self_awareness_follow_me.component_spec import ComponentSpec, Duration, Task
from self_awareness_follow_me.effects import Change, Starvation, doubled, halved
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


def test_latency_beyond_a_period_leaves_the_rate() -> None:
    odom = times(run('lat:motors'), '/odom')
    assert odom[-1] - odom[0] > LEFT_S - 0.2
    assert len(odom) == pytest.approx(len(times(run(), '/odom')), abs=8)


def test_crash_silences_the_component_and_silence_all() -> None:
    assert last(run('crash:camera'), '/camera/image') < 0.1
    assert last(run('crash:camera'), '/scan') > LEFT_S - 0.2
    assert max(e.stamp_ns for e in run('silence')) < ONSET_NS + 50 * MS


@pytest.mark.parametrize('component', ['player', 'slam', 'face_detection'])
@pytest.mark.parametrize('kind, factor', [('half', 0.5), ('double', 2.0)])
def test_component_runs_at_another_rate(component: str, kind: str, factor: float) -> None:
    before, after = counts(run()), counts(run(f'{kind}:{component}'))
    own = [key for key in before if key[0] == '/' + component]
    assert own
    for key in own:
        assert after[key] == pytest.approx(factor * before[key], rel=0.1, abs=2), key


def test_intruder_publishes_besides() -> None:
    after = counts(run('extra'))
    assert after.pop(('/intruder', '/cmd_vel')) == pytest.approx(10 * LEFT_S, abs=2)
    for key, count in counts(run()).items():
        assert after[key] == pytest.approx(count, rel=0.02, abs=2), key


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


def test_order_is_reversed() -> None:
    between = typical_delay(run(), '/pose_hypotheses', '/pose')
    assert 0.0 < between < 0.01
    assert typical_delay(run('order'), '/pose', '/pose_hypotheses') == pytest.approx(between,
                                                                                     rel=0.3)
    assert len(times(run('order'), '/pose')) == pytest.approx(len(times(run(), '/pose')), abs=1)


def test_unknown_message_comes_every_second() -> None:
    assert not [e for e in run() if e.message.value == 5]
    stamps = times(run('unknown'), '/person_hypotheses', 5, '/anchoring')
    assert len(stamps) == pytest.approx(LEFT_S, abs=2)
    assert all(0.9 < b - a < 1.1 for a, b in zip(stamps, stamps[1:]))


def _changing(effect: Change, *tasks: Task) -> Tuple[Component, Dict[str, bool]]:
    """Return a component, and the switch that says whether the fault is there."""
    normal = ComponentSpec('it', 'a', tasks)
    changed = effect.changed(normal)
    switch = {'on': False}
    return Component(normal, random.Random(1),
                     spec_at=lambda now: changed if switch['on'] else normal), switch


def _published(component: Component, requests: List[Any], now: int) -> List[Any]:
    """Finish all work at once and return what was published."""
    published = []
    while requests:
        request = requests.pop(0)
        if isinstance(request, Publish):
            published.append(request)
        elif not isinstance(request, Wake):
            requests += component.work_done(now)
    return published


def test_component_is_right_again_after_the_fault() -> None:
    component, switch = _changing(Change(('it',), {'delay': 0.06}),
                                  Task((output('out'),), upon='in'))
    delays = []
    for now, on in enumerate((False, True, True, False)):
        switch['on'] = on
        said, = _published(component, component.receive(now, Message('in', now)), now)
        delays.append(said.delay)
    assert delays == [0, 60 * MS, 60 * MS, 0]


def test_what_a_fault_adds_ends_with_it_and_does_not_come_twice() -> None:
    component, switch = _changing(
        Change(('it',), more=(Task((output('new'),), every=Duration(1.0)),)),
        Task((output('out'),), upon='in'))
    assert component.start(0) == []

    def wakes(now: int, on: bool) -> List[Wake]:
        switch['on'] = on
        return [r for r in component.receive(now, Message('other', now)) if isinstance(r, Wake)]

    added, = wakes(10 * S, True)
    assert wakes(10 * S + 1, False) == [] and wakes(10 * S + 2, True) == []
    said = _published(component, component.wake(added.at, added.timer), added.at)
    assert [s.message.topic for s in said] == ['new']
    switch['on'] = False
    assert component.wake(added.at + S, added.timer) == []
    assert len(wakes(20 * S, True)) == 1


@pytest.mark.parametrize('each, effect, copies', [
    (1, halved, 3), (2, halved, 1), (1, doubled, 12), (2, doubled, 6), (3, doubled, 4)])
def test_rate_of_what_is_done_upon_a_topic(each: int, effect: Any, copies: int) -> None:
    component, switch = _changing(Change(('it',), other=effect),
                                  Task((output('out'),), upon='in', each=each))
    switch['on'] = True
    said = [p for now in range(6)
            for p in _published(component, component.receive(now, Message('in', now)), now)]
    assert len(said) == copies


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
