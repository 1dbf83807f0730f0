"""The simulated robot's scenario file and the behaviour of a component; no ROS master needed."""
from __future__ import annotations

import random
from pathlib import Path
from typing import Any, Callable, List

import pytest
import yaml
from simulated_runs import MS, SCENARIO, S, output, robot

from self_awareness.yaml_section import SectionError
from self_awareness_follow_me.component import Component, Message, Publish, Work
from self_awareness_follow_me.component_spec import (ComponentSpec, Duration, Hypothesis, Need,
                                                     Task)
from self_awareness_follow_me.scenario import load_scenario


def test_somebody_listens_to_every_topic() -> None:
    # A monitor that only listens where somebody else does would miss the others.
    heard = {topic for spec in robot().components for topic in spec.inputs()}
    assert heard == set(robot().datatypes)


def _remove(key: str) -> Callable[[Any], None]:
    return lambda section: section.pop(key)


def _set(key: str, value: Any) -> Callable[[Any], None]:
    return lambda section: section.update({key: value})


@pytest.mark.parametrize('where, change, message', [
    ([], _remove('components'), 'components: missing'),
    ([], _set('rate', 3), 'rate: unknown key; allowed are: .*components'),
    (['components', 1], _remove('name'), r'components\[1\]\.name: missing'),
    (['components', 1], _set('name', 'Player'), r'components\[1\]\.name: expected a text'),
    (['components', 1], _set('name', 'slam'), "components: the name 'slam' is given twice"),
    (['components', 1, 'tasks', 0], _remove('every'), r'tasks\[0\]\.upon: missing; a task needs'),
    (['components', 1, 'tasks', 0], _set('jitter', 0.09), r'jitter: expected .* from 0 to 0\.025'),
    (['components', 1, 'tasks', 0], _set('upon', 'scn'), "'player' listens to 'scn', which no"),
    (['components', 1, 'tasks', 0], _set('needs', [{'topic': 'odom'}]),
     r'needs\[0\]\.within: give exactly one'),
    (['components', 1, 'tasks', 0, 'publish', 0], _set('topic', '/scan'), r'publish\[0\]\.topic'),
    (['components', 1, 'tasks', 0, 'publish', 0], _set('topic', 'odom'),
     "'odom' is published by both 'motors' and 'player'"),
    (['components', 2, 'tasks', 0, 'publish', 1], _set('topic', 'pose_hypotheses'),
     "'pose_hypotheses' has two types"),
    (['components', 7, 'tasks', 0, 'hypothesis'], _set('update', 0), 'insert: .*different values'),
    (['faults', 'cc1'], _set('crash', 'plaer'), r"faults\.cc1\.crash: no component 'plaer'"),
    (['faults', 'extra'], _set('name', 'slam'), r"extra\.name: 'slam' is a component"),
    (['faults', 'extra', 'tasks', 0], _set('upon', 'joy'), "no component publishes 'joy'"),
    (['faults', 'order'], _set('component', 'player'), "'player' never publishes two"),
    (['faults', 'unknown', 'task', 'publish', 0], _set('type', 'std_msgs/String'),
     'as std_msgs/String'),
    (['faults', 'unknown'], _set('component', 'slam'),
     "'slam' does not publish 'person_hypotheses' otherwise"),
    (['live'], _set('cpu_share', 0), r'live\.cpu_share: expected a finite number from'),
])
def test_error_names_file_and_key(tmp_path: Path, where: List[Any],
                                  change: Callable[[Any], None], message: str) -> None:
    changed = section = yaml.safe_load(SCENARIO.read_text(encoding='utf-8'))
    for key in where:
        section = section[key]
    change(section)
    path = tmp_path / 'robot.yaml'
    path.write_text(yaml.safe_dump(changed), encoding='utf-8')
    with pytest.raises(SectionError, match=rf'robot\.yaml: .*{message}'):
        load_scenario(path)


def _component(*tasks: Task) -> Component:
    return Component(ComponentSpec('it', 'a', tasks), random.Random(1))


def test_busy_worker_takes_the_newest_message_next() -> None:
    component = _component(Task((output('out'),), upon='in'))
    assert component.receive(0, Message('in', 1)) == [Work(10 * MS, 0)]
    assert component.receive(1, Message('in', 2)) == []
    assert component.receive(2, Message('in', 3)) == []
    assert component.work_done(3) == [Publish(Message('out', 1, content=3)), Work(10 * MS, 0)]
    assert component.work_done(4) == [Publish(Message('out', 3, content=4))]


@pytest.mark.parametrize('need, at, holds', [
    (Need('other', within=1.0), 11 * S, True),
    (Need('other', within=1.0), 11 * S + 1, False),
    (Need('other', stamps_within=0.5), 20 * S, True),
    (Need('other', stamps_within=0.4), 10 * S, False),
    (Need('other', one_of=('yes', 'no')), 20 * S, True),
    (Need('other', one_of=('no',)), 20 * S, False),
    (Need('silent', within=1.0), 10 * S, False),
])
def test_needs(need: Need, at: int, holds: bool) -> None:
    component = _component(Task((output('out'),), upon='in', needs=(need,)))
    component.receive(10 * S, Message('other', 9 * S, 'yes'))
    assert bool(component.receive(at, Message('in', 9 * S - 500 * MS))) is holds


def test_hypothesis_is_inserted_updated_and_deleted() -> None:
    life = Hypothesis(confirm=3, discard_after=1.0, insert=0, update=1, delete=9)
    component = _component(Task((output('out', 0.0),), upon='in', every=Duration(0.25),
                                hypothesis=life))
    component.start(0)

    def told(requests: List[Any], now: int) -> Any:
        if not any(isinstance(request, Work) for request in requests):
            return None
        return component.work_done(now)[0].message.value

    def track(now: int) -> Any:
        return told(component.receive(now, Message('in', now)), now)

    def check(now: int) -> Any:
        return told(component.wake(now, 0), now)

    assert [track(t * 200 * MS) for t in range(5)] == [None, None, 0, 1, 1]
    assert check(1800 * MS) is None and check(1801 * MS) == 9 and check(3 * S) is None
    assert [track(4 * S + t * 200 * MS) for t in range(4)] == [None, None, 0, 1]
