"""The simulated robot's scenario file and the behaviour of a component; no ROS master needed."""
from __future__ import annotations

import random
from pathlib import Path
from typing import Any, Callable, List

import pytest
import yaml
from simulated_runs import MS, SCENARIO, output, robot

from self_awareness.yaml_section import SectionError
from self_awareness_follow_me.component import Component, Message, Publish, Work
from self_awareness_follow_me.component_spec import ComponentSpec, Task
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


def test_busy_worker_takes_the_newest_message_next() -> None:
    spec = ComponentSpec('it', 'a', (Task((output('out'),), upon='in'),))
    component = Component(spec, random.Random(1), lambda now: now)
    assert component.receive(0, Message('in', 1)) == [Work(10 * MS, 0)]
    assert component.receive(1, Message('in', 2)) == []
    assert component.receive(2, Message('in', 3)) == []
    assert component.work_done(3) == [Publish(Message('out', 1, content=3)), Work(10 * MS, 0)]
    assert component.work_done(4) == [Publish(Message('out', 3, content=4))]
