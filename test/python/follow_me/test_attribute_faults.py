"""Faults of the simulated robot that only the messages, or the graph, tell; no ROS master."""
from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any, Callable, Dict, List, NamedTuple, Optional, Set

import pytest
import rosbag

from self_awareness.commands import simulate as simulate_program
from self_awareness.training.robot_graph import RobotGraph
from self_awareness_follow_me.effects import Setting
from self_awareness_follow_me.faults import effect_of
from self_awareness_follow_me.scenario import Scenario, load_scenario
from self_awareness_follow_me.simulation import START_S, InducedFault, events, simulate

SCENARIO = Path(__file__).resolve().parents[3] / 'config' / 'follow_me.yaml'
DURATION_S = 20.0
ONSET_S = 10.0


class Recorded(NamedTuple):
    """A message in a bag: times since its start (s), the header's number, the rest."""

    at: float
    stamp: float
    number: int
    message: Any


Bag = Dict[str, List[Recorded]]


@pytest.fixture(name='scenario', scope='module')
def _scenario() -> Scenario:
    return load_scenario(SCENARIO)


@pytest.fixture(name='bag_with', scope='module')
def _bag_with(scenario: Scenario, tmp_path_factory: pytest.TempPathFactory
              ) -> Callable[[Optional[str]], Bag]:
    """Return what makes a bag with a fault, and reads what has a header in it."""
    def make(kind: Optional[str], robot: Scenario = scenario) -> Bag:
        path = tmp_path_factory.mktemp('bags') / 'it.bag'
        fault = None if kind is None else InducedFault(kind, ONSET_S)
        simulate(path, DURATION_S, 7, fault, robot)
        found: Bag = {}
        with rosbag.Bag(str(path)) as bag:
            for topic, message, stamp in bag.read_messages():
                if message._has_header:
                    header = message.header
                    found.setdefault(topic, []).append(
                        Recorded(stamp.to_sec() - START_S, header.stamp.to_sec() - START_S,
                                 header.seq, message))
        return found
    return make


@pytest.fixture(name='normal', scope='module')
def _normal(bag_with: Callable[[Optional[str]], Bag]) -> Bag:
    return bag_with(None)


def after(recorded: List[Recorded]) -> List[Recorded]:
    return [each for each in recorded if each.at > ONSET_S + 0.05]


def before(recorded: List[Recorded]) -> List[Recorded]:
    return [each for each in recorded if each.at < ONSET_S]


def times(bag: Bag) -> Dict[str, List[float]]:
    return {topic: [each.at for each in recorded] for topic, recorded in bag.items()}


def test_messages_are_those_of_a_real_robot(normal: Bag) -> None:
    images = [bytes(each.message.data) for each in normal['/camera/image']]
    assert len(set(images)) == len(images) > 100
    assert len({len(image) for image in images}) > 10
    for topic, field in (('/scan', 'ranges'), ('/odom', 'pose'), ('/pose', 'pose')):
        said = {str(getattr(each.message, field)) for each in normal[topic]}
        assert len(said) == len(normal[topic]), topic


def test_starts_say_different_things(scenario: Scenario, tmp_path: Path) -> None:
    said: Set[bytes] = set()
    for seed in (1, 2):
        path = tmp_path / f'{seed}.bag'
        simulate(path, 2.0, seed, None, scenario, START_S + seed)
        with rosbag.Bag(str(path)) as bag:
            said |= {bytes(message.data) for _, message, _ in bag.read_messages('/camera/image')}
    assert len(said) == 30


def test_stale_stamp(bag_with: Callable[[str], Bag], normal: Bag) -> None:
    bag = bag_with('stale:slam')
    assert times(bag) == times(normal)
    for topic in ('/pose', '/pose_hypotheses'):
        assert len({each.stamp for each in after(bag[topic])}) == 1, topic
        assert len({each.stamp for each in before(bag[topic])}) == len(before(bag[topic])), topic
        assert bag[topic][-1].at - bag[topic][-1].stamp > 9.0
        assert [each.number for each in bag[topic]] == [each.number for each in normal[topic]]
    assert len({str(each.message.pose) for each in bag['/pose']}) == len(bag['/pose'])


def test_lost_messages_are_counted(bag_with: Callable[..., Bag], scenario: Scenario,
                                   normal: Bag) -> None:
    robot = replace(scenario, faults=replace(scenario.faults, lossy=Setting((), 'lost', 0.1)))
    bag = bag_with('lossy:motors', robot)
    numbers = [each.number for each in bag['/odom']]
    gaps = [b - a - 1 for a, b in zip(numbers, numbers[1:])]
    begin = len(before(bag['/odom'])) - 1
    assert not any(gaps[:begin])
    assert sum(gaps) == pytest.approx(0.1 * len(after(normal['/odom'])), rel=0.3)
    assert len(bag['/odom']) + sum(gaps) == pytest.approx(len(normal['/odom']), abs=2)
    assert len(bag['/scan']) == pytest.approx(len(normal['/scan']), abs=1)


def test_one_in_a_hundred_is_lost_by_default(scenario: Scenario) -> None:
    effect = effect_of(scenario, 'lossy:camera')
    assert effect == Setting(('camera',), 'lost', 0.01)


def test_empty_messages(bag_with: Callable[[str], Bag], normal: Bag) -> None:
    bag = bag_with('empty:player')
    assert times(bag) == times(normal)
    assert {len(each.message.ranges) for each in before(bag['/scan'])} == {180}
    assert {len(each.message.ranges) for each in after(bag['/scan'])} == {0}
    assert [each.stamp for each in bag['/scan']] == [each.stamp for each in normal['/scan']]


def test_frozen_image(bag_with: Callable[[str], Bag], normal: Bag) -> None:
    bag = bag_with('freeze:camera')
    assert times(bag) == times(normal)
    images = [bytes(each.message.data) for each in after(bag['/camera/image'])]
    assert len(images) > 60 and len(set(images)) == 1
    stamps = [each.stamp for each in bag['/camera/image']]
    assert stamps == [each.stamp for each in normal['/camera/image']]


def test_missing_subscriber_is_in_the_graph_only(scenario: Scenario, tmp_path: Path) -> None:
    kinds: Dict[str, List[str]] = {'normal': [], 'deaf': ['--fault', 'unsubscribed:navigation@1']}
    graphs = {}
    for name, options in kinds.items():
        bag = tmp_path / f'{name}.bag'
        assert simulate_program.main(['-o', str(bag), '--duration', '2', '--scenario',
                                      str(SCENARIO), *options]) == 0
        graphs[name] = RobotGraph.load(str(bag.with_suffix('.graph.yaml')))
    missing = {(topic, node) for topic, nodes in graphs['normal'].subscribers.items()
               for node in nodes - graphs['deaf'].subscribers.get(topic, set())}
    assert missing == {('/pose_hypotheses', '/navigation')}
    assert graphs['deaf'].publishers == graphs['normal'].publishers
    fault = InducedFault('unsubscribed:navigation', ONSET_S)
    assert (list(events(DURATION_S, 7, fault, scenario))
            == list(events(DURATION_S, 7, scenario=scenario)))


@pytest.mark.parametrize('kind, message', [
    ('stale:dialog', "no message of 'dialog' has a stamp"),
    ('empty:motors', "no message of 'motors' has a list that can be empty"),
    ('unsubscribed:player', "'player' hears nothing that it could miss"),
])
def test_component_that_cannot_have_the_fault(scenario: Scenario, kind: str,
                                              message: str) -> None:
    with pytest.raises(ValueError, match=f'fault {kind}: {message}.*choose another component'):
        effect_of(scenario, kind)
