"""Faults of the simulated robot that only the messages, or the graph, tell; no ROS master."""
from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Dict, List, NamedTuple

import pytest
import rosbag
from simulated_runs import SCENARIO, robot

from self_awareness.commands import simulate as simulate_program
from self_awareness.training.robot_graph import RobotGraph
from self_awareness_follow_me.effects import Change
from self_awareness_follow_me.faults import effect_of
from self_awareness_follow_me.simulation import START_S, InducedFault, events, simulate

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


def times(bag: Bag) -> Dict[str, List[float]]:
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


def test_stale_stamp() -> None:
    bag, normal = bag_with('stale:slam'), bag_with()
    assert times(bag) == times(normal)
    for topic in ('/pose', '/pose_hypotheses'):
        assert len({each.stamp for each in after(bag[topic])}) == 1, topic
        assert len({each.stamp for each in before(bag[topic])}) == len(before(bag[topic])), topic
        assert bag[topic][-1].at - bag[topic][-1].stamp > 9.0
        assert [each.number for each in bag[topic]] == [each.number for each in normal[topic]]
    assert len({str(each.message.pose) for each in bag['/pose']}) == len(bag['/pose'])


def test_lost_messages_are_counted() -> None:
    bag, normal = bag_with('lossy:motors', 0.1), bag_with()
    numbers = [each.number for each in bag['/odom']]
    gaps = [b - a - 1 for a, b in zip(numbers, numbers[1:])]
    begin = len(before(bag['/odom'])) - 1
    assert not any(gaps[:begin])
    assert sum(gaps) == pytest.approx(0.1 * len(after(normal['/odom'])), rel=0.3)
    assert len(bag['/odom']) + sum(gaps) == pytest.approx(len(normal['/odom']), abs=2)
    assert len(bag['/scan']) == pytest.approx(len(normal['/scan']), abs=1)


def test_one_in_a_hundred_is_lost_by_default() -> None:
    assert effect_of(robot(), 'lossy:camera') == Change(('camera',), {'lost': 0.01})


def test_empty_and_frozen_messages() -> None:
    empty, frozen, normal = bag_with('empty:player'), bag_with('freeze:camera'), bag_with()
    assert {len(each.message.ranges) for each in before(empty['/scan'])} == {180}
    assert {len(each.message.ranges) for each in after(empty['/scan'])} == {0}
    still = images({'/camera/image': after(frozen['/camera/image'])})
    assert len(still) > 60 and len(set(still)) == 1
    for bag, topic in ((empty, '/scan'), (frozen, '/camera/image')):
        assert times(bag) == times(normal)
        assert [each.stamp for each in bag[topic]] == [each.stamp for each in normal[topic]]


def test_missing_subscriber_is_in_the_graph_only(tmp_path: Path) -> None:
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
    assert (list(events(DURATION_S, 7, fault, robot()))
            == list(events(DURATION_S, 7, scenario=robot())))
