"""Names of topics and nodes are whole, however `rosbag record` was told them."""
from __future__ import annotations

from pathlib import Path
from typing import Callable, Iterable, List

import pytest
from conftest import Message, jittery_robot, trained, write_bag

from self_awareness import EncodingRules, TrainedModel, load, recorded_types
from self_awareness.commands import convert
from self_awareness.training.robot_graph import RobotGraph, graph_file

LENGTH_S = 40.0
Typed = Callable[[str], str]
AS_IT_IS: Typed = str
TYPED: List[Typed] = [lambda name: name[1:], lambda name: '/' + name, lambda name: name + '/']


def some(name: str) -> str:
    """One topic of the robot is typed without its first slash."""
    return name[1:] if name == '/scan' else name


def typed_robot(start: float, topic: Typed, node: Typed = AS_IT_IS,
                until: float = LENGTH_S) -> Iterable[Message]:
    """The robot by names as they were typed, whose laser dies at a time."""
    return [(stamp, node(source), topic(name))
            for stamp, source, name in jittery_robot(start, LENGTH_S, int(start))
            if source != '/laser' or stamp < start + until]


@pytest.fixture(scope='module', name='model')
def _model(tmp_path_factory: pytest.TempPathFactory) -> str:
    """A model of bags without first slashes, and one in which only some topics lack it."""
    folder = tmp_path_factory.mktemp('typed')
    bags = [write_bag(folder / f'{place}.bag', typed_robot(1000.0 * place, topic, node))
            for place, (topic, node) in enumerate([
                (TYPED[0], AS_IT_IS), (TYPED[0], TYPED[0]), (TYPED[1], TYPED[1]),
                (some, AS_IT_IS)], 1)]
    path = str(folder / 'm')
    trained(bags, Path(path))
    return path


def test_the_model_knows_whole_names(model: str) -> None:
    assert {(kind.source, kind.scope) for kind in TrainedModel.load(model).event_types} == {
        ('/laser', '/scan'), ('/slam', '/map'), ('/battery', '/charge')}


@pytest.mark.parametrize('topic', [AS_IT_IS, *TYPED])
def test_a_death_is_found_in_bags_of_any_names(model: str, tmp_path: Path, topic: Typed) -> None:
    normal, crash = (write_bag(tmp_path / f'{until:g}.bag',
                               typed_robot(9000.0, topic, until=until)) for until in (40.0, 20.0))
    judge = load(model).judge
    assert not [alarm for alarm in judge(normal) if alarm.level == 'ERROR']
    assert ('silent', '/laser') in {(alarm.kind, alarm.culprit) for alarm in judge(crash)}


def test_logs_and_graphs_have_whole_names(tmp_path: Path) -> None:
    bag = write_bag(tmp_path / 'a.bag', typed_robot(1000.0, TYPED[0]))
    RobotGraph({'scan': {'laser'}}, {'/scan': {'/slam'}}).save(graph_file(bag))
    graph = RobotGraph.load(graph_file(bag))
    assert graph.edges(EncodingRules()) == {('/laser', '/scan', '/slam')}
    log = str(tmp_path / 'log.bag')
    assert convert.main([bag, '-o', log]) == 0
    rules = EncodingRules.defaults()
    assert recorded_types(log, rules, 0) == recorded_types(bag, rules)
    assert sorted((kind.source, kind.scope) for kind in recorded_types(bag, rules)) == [
        ('/battery', '/charge'), ('/laser', '/scan'), ('/slam', '/map')]
