"""The simulated robot's faults beyond the paper's: names, culprits, effects; no ROS master."""
from __future__ import annotations

import copy
import random
from collections import Counter
from pathlib import Path
from statistics import median
from typing import Any, Callable, Dict, List, Tuple

import pytest
import rosbag

from self_awareness_follow_me.component import Component, Message, Publish, Wake
from self_awareness_follow_me.component_spec import ComponentSpec, Duration, Output, Task
from self_awareness_follow_me.effects import (Change, Novelty, OtherTasks, Setting, doubled,
                                              halved)
from self_awareness_follow_me.faults import effect_of
from self_awareness_follow_me.scenario import Scenario, load_scenario
from self_awareness_follow_me.simulation import START_S, Event, InducedFault, events, simulate

SCENARIO = Path(__file__).resolve().parents[3] / 'config' / 'follow_me.yaml'
DURATION_S = 60.0
ONSET_S = 20.0
MS = 1_000_000
S = 1000 * MS

Run = List[Event]


@pytest.fixture(name='scenario', scope='module')
def _scenario() -> Scenario:
    return load_scenario(SCENARIO)


@pytest.fixture(name='normal', scope='module')
def _normal(scenario: Scenario) -> Run:
    return list(events(DURATION_S, 7, scenario=scenario))


@pytest.fixture(name='run_with', scope='module')
def _run_with(scenario: Scenario) -> Callable[[str], Run]:
    return lambda kind: list(events(DURATION_S, 7, InducedFault(kind, ONSET_S), scenario))


def times(run: Run, topic: str, source: str = '') -> List[float]:
    """Seconds since the onset at which a topic (of a source) was seen after it."""
    seen = [e.stamp_ns / 1e9 - START_S - ONSET_S for e in run
            if e.topic == topic and source in ('', e.source)]
    return [t for t in seen if t >= 0.0]


def counts(run: Run) -> Counter:
    """How many messages of each source came on each topic after the onset."""
    return Counter((e.source, e.topic) for e in run if e.stamp_ns >= (START_S + ONSET_S) * 1e9)


def typical_delay(run: Run, first: str, second: str) -> float:
    """Median time (s) from a message on `second` back to the newest one before on `first`."""
    firsts = times(run, first)
    return median(t - max(f for f in firsts if f <= t) for t in times(run, second)[2:])


@pytest.mark.parametrize('kind, culprits', [
    ('cc1', ('/player',)), ('cc2', ('/slam',)), ('rs', ()), ('ac', ()), ('silence', ()),
    ('crash:camera', ('/camera',)), ('lat', ('/leg_detection', '/face_detection')),
    ('lat:slam', ('/slam',)), ('half:dialog', ('/dialog',)), ('double:player', ('/player',)),
    ('extra', ('/intruder',)), ('order', ('/slam',)), ('unknown', ('/anchoring',)),
    ('stale:slam', ('/slam',)), ('lossy:camera', ('/camera',)), ('empty:player', ('/player',)),
    ('freeze:camera', ('/camera',)), ('unsubscribed:navigation', ('/navigation',)),
])
def test_culprits(scenario: Scenario, kind: str, culprits: Tuple[str, ...]) -> None:
    assert effect_of(scenario, kind).culprits == culprits
    assert InducedFault(kind, 1.0).culprits == culprits


@pytest.mark.parametrize('kind, message', [
    ('', 'choose one of cc1, cc2'),
    ('crsh:slam', r"'crsh:slam': choose one of .*crash:COMPONENT.*lat\[:COMPONENT\]"),
    ('crash', "'crash': expected crash:COMPONENT"),
    ('crash:', "'crash:': expected crash:COMPONENT"),
    ('cc1:player', "'cc1:player': expected cc1"),
    ('lat:', r"'lat:': expected lat\[:COMPONENT\]"),
])
def test_name_of_another_form(kind: str, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        InducedFault(kind, 1.0)


@pytest.mark.parametrize('kind', ['crash:plaer', 'lat:plaer', 'half:plaer', 'double:intruder'])
def test_fault_of_a_component_there_is_not(scenario: Scenario, kind: str) -> None:
    with pytest.raises(ValueError, match=f'fault {kind}: no component .*motors, player'):
        events(1.0, 1, InducedFault(kind, 0.5), scenario)


def test_busy_component_cannot_be_doubled(scenario: Scenario) -> None:
    busy = ComponentSpec('busy', 'a', (Task((_output('odom', 0.06),), every=Duration(0.1)),))
    robot = copy.copy(scenario)
    object.__setattr__(robot, 'components', (busy,))
    with pytest.raises(ValueError, match='double:busy: .* 0.06 s every 0.1 s and cannot'):
        effect_of(robot, 'double:busy')


def test_latency_is_added_and_rates_stay(normal: Run, run_with: Callable[[str], Run]) -> None:
    late = run_with('lat')
    for first, second in (('/scan', '/legs'), ('/camera/image', '/faces')):
        added = typical_delay(late, first, second) - typical_delay(normal, first, second)
        assert added == pytest.approx(0.06, abs=0.01), second
    before, after = counts(normal), counts(late)
    assert set(before) == set(after)
    for key, count in before.items():
        assert after[key] == pytest.approx(count, rel=0.02, abs=2), key


def test_latency_beyond_a_period_leaves_the_rate(normal: Run,
                                                 run_with: Callable[[str], Run]) -> None:
    odom = times(run_with('lat:motors'), '/odom')
    assert odom[-1] - odom[0] > DURATION_S - ONSET_S - 0.2
    assert len(odom) == pytest.approx(len(times(normal, '/odom')), abs=8)


def test_crash_silences_the_component(run_with: Callable[[str], Run]) -> None:
    run = run_with('crash:camera')
    assert max(times(run, '/camera/image'), default=0.0) < 0.1
    assert times(run, '/scan')[-1] > DURATION_S - ONSET_S - 0.2


def test_silence_is_total(run_with: Callable[[str], Run]) -> None:
    assert max(e.stamp_ns for e in run_with('silence')) < (START_S + ONSET_S) * 1e9 + 50 * MS


@pytest.mark.parametrize('component', ['motors', 'slam', 'navigation', 'person_tracking',
                                       'task_control', 'camera', 'face_detection'])
@pytest.mark.parametrize('kind, factor', [('half', 0.5), ('double', 2.0)])
def test_component_runs_at_another_rate(normal: Run, run_with: Callable[[str], Run],
                                        component: str, kind: str, factor: float) -> None:
    before, after = counts(normal), counts(run_with(f'{kind}:{component}'))
    own = [key for key in before if key[0] == '/' + component]
    assert own
    for key in own:
        assert after[key] == pytest.approx(factor * before[key], rel=0.1, abs=2), key


def test_intruder_publishes_besides(normal: Run, run_with: Callable[[str], Run]) -> None:
    run = run_with('extra')
    assert len(times(run, '/cmd_vel', '/intruder')) == pytest.approx(400, abs=2)
    after = counts(run)
    del after['/intruder', '/cmd_vel']
    for key, count in counts(normal).items():
        assert after[key] == pytest.approx(count, rel=0.02, abs=2), key


def test_intruder_is_a_connection_of_its_own_in_a_bag(scenario: Scenario, tmp_path: Path) -> None:
    path = tmp_path / 'extra.bag'
    simulate(path, 4.0, 7, InducedFault('extra', 2.0), scenario)
    with rosbag.Bag(str(path)) as bag:
        found = [(m.connection_header['callerid'].decode(), m.timestamp.to_sec() - START_S)
                 for m in bag.read_messages(topics=['/cmd_vel'], return_connection_header=True)]
    assert {source for source, t in found if t < 2.0} == {'/navigation'}
    assert Counter(source for source, t in found if t > 2.0) == pytest.approx(
        {'/navigation': 10, '/intruder': 20}, abs=1)
    written = [e.source for e in events(4.0, 7, InducedFault('extra', 2.0), scenario)
               if e.topic == '/cmd_vel']
    assert [source for source, _ in found] == written


def test_order_is_reversed(normal: Run, run_with: Callable[[str], Run]) -> None:
    run = run_with('order')
    between = typical_delay(normal, '/pose_hypotheses', '/pose')
    assert 0.0 < between < 0.01
    assert typical_delay(run, '/pose', '/pose_hypotheses') == pytest.approx(between, rel=0.3)
    assert counts(run)['/slam', '/pose'] == pytest.approx(counts(normal)['/slam', '/pose'], abs=1)


def test_unknown_message_comes_every_second(normal: Run, run_with: Callable[[str], Run]) -> None:
    assert not [e for e in normal if e.value == 5]
    stamps = [e.stamp_ns / 1e9 - START_S for e in run_with('unknown')
              if (e.source, e.topic, e.value) == ('/anchoring', '/person_hypotheses', 5)]
    assert len(stamps) == pytest.approx(DURATION_S - ONSET_S, abs=2)
    assert all(0.9 < b - a < 1.1 for a, b in zip(stamps, stamps[1:]))


def _output(topic: str, takes_s: float = 0.0, **options: Any) -> Output:
    return Output(topic, 'std_msgs/String', Duration(takes_s), Duration(0.0), **options)


def _changing(effect: Any, *tasks: Task) -> Tuple[Component, Dict[str, bool]]:
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
    component, switch = _changing(Setting(('it',), 'delay', 0.06),
                                  Task((_output('out'),), upon='in'))
    delays = []
    for now, on in enumerate((False, True, True, False)):
        switch['on'] = on
        said, = _published(component, component.receive(now, Message('in', now)), now)
        delays.append(said.delay)
    assert delays == [0, 60 * MS, 60 * MS, 0]


def test_what_a_fault_adds_ends_with_it_and_does_not_come_twice() -> None:
    component, switch = _changing(
        Novelty(('it',), Task((_output('new'),), every=Duration(1.0))),
        Task((_output('out'),), upon='in'))
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
    component, switch = _changing(OtherTasks(('it',), effect),
                                  Task((_output('out'),), upon='in', each=each))
    switch['on'] = True
    said = [p for now in range(6)
            for p in _published(component, component.receive(now, Message('in', now)), now)]
    assert len(said) == copies


def test_other_components_are_left_alone(scenario: Scenario) -> None:
    effect = effect_of(scenario, 'lat')
    assert isinstance(effect, Change)
    changed = [spec.name for spec in scenario.components if effect.changed(spec) is not spec]
    assert changed == ['leg_detection', 'face_detection']
