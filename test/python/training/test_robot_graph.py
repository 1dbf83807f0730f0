"""Who listens to whom: the file beside a bag, and what all starts had, as event logs say it."""
from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Dict, Tuple

import pytest
import rosbag
from conftest import error_of, printed_by, robot, trained

from self_awareness import EncodingRules, TrainedModel, stable_name
from self_awareness.commands import convert, info, score, simulate, train
from self_awareness.training.robot_graph import RobotGraph, graph_file

Bags = Tuple[str, str]


@pytest.fixture
def bags(robot_bags: Bags, tmp_path: Path) -> Bags:
    """The two recordings, in a folder where files may lie beside them."""
    first, second = (shutil.copy(bag, tmp_path) for bag in robot_bags)
    return first, second


def test_it_lies_beside_the_bag_also_while_that_is_written() -> None:
    assert graph_file('/data/monday.bag') == '/data/monday.graph.yaml'
    assert graph_file('/data/monday.bag.active') == '/data/monday.graph.yaml'
    assert graph_file('monday') == 'monday.graph.yaml'


def test_it_comes_back_as_it_was_saved(tmp_path: Path) -> None:
    graph = RobotGraph({'/scan': {'/laser'}, '/nobody/listens': {'/laser'}},
                       {'/scan': {'/slam', '/log'}, '/nobody/talks': {'/slam'}},
                       {'/laser': 'base', '/log_4242_1600000000000': '10.0.0.2',
                        '/log_4243_1600000000000': '10.0.0.3'})
    path = str(tmp_path / 'g')
    graph.save(path)
    loaded = RobotGraph.load(path)
    assert loaded.edges(EncodingRules()) == graph.edges(EncodingRules()) == {
        ('/laser', '/scan', '/slam'), ('/laser', '/scan', '/log')}
    assert loaded.hosts == graph.hosts
    assert loaded.hosts_of_sources(EncodingRules()) == {'/laser': 'base', stable_name(
        '/log_4242_1600000000000'): ''}
    assert not graph.add(loaded) and not loaded.add(graph)
    assert loaded.add(RobotGraph({}, {'/nobody/listens': {'/slam'}}))
    assert ('/laser', '/nobody/listens', '/slam') in loaded.edges(EncodingRules())
    assert loaded.add(RobotGraph(hosts={'/laser': 'head'})) and loaded.hosts['/laser'] == 'head'
    RobotGraph({'scan': {'laser'}}, {'/scan': {'/slam'}}).save(path)  # as names may be typed
    assert RobotGraph.load(path).edges(EncodingRules()) == {('/laser', '/scan', '/slam')}


def test_a_model_has_the_graphs_of_all_its_bags(bags: Bags, tmp_path: Path) -> None:
    RobotGraph({'/scan': {'/laser'}}, {'/scan': {'/slam_4242_1600000000000'}}).save(
        graph_file(bags[0]))
    RobotGraph({'/scan': {'/laser'}, '/map': {'/slam'}}, {'/map': {'/log'}}).save(
        graph_file(bags[1]))
    both = {('/laser', '/scan', stable_name('/slam_4242_1600000000000')),
            ('/slam', '/map', '/log')}
    for jobs in ('1', '2'):
        assert trained(bags, tmp_path / 'm', '--jobs', jobs).graph == both


def test_what_nobody_subscribes_to_is_known_by_name(bags: Bags, tmp_path: Path, make_bag,
                                                    capsys) -> None:
    """It is listed with those that are not watched, and no suspicion when it is heard later."""
    for bag in bags:
        RobotGraph({'/scan': {'/laser'}, '/debug': {'/planner'}, '/view': {'/rqt_plot'}},
                   {'/scan': {'/slam'}, '/debug': {'/rostopic_1_1600000000000'}}
                   ).save(graph_file(bag))
    model = trained(bags, tmp_path / 'm')
    assert model.unheard == {('/planner', '/debug')}
    line = '/debug on /planner: not watched, nobody subscribed in training'
    path = str(tmp_path / 'm')
    capsys.readouterr()
    assert info.main([path, '--details']) == 0 and line in capsys.readouterr().out
    later = [*robot(5000.0), *((5010.0 + i, '/planner', '/debug') for i in range(15)),
             *((5010.5 + i, '/planner', '/new') for i in range(3))]
    said = printed_by(score, [make_bag('later.bag', sorted(later)), '--model', path, '--details'])
    known = said.split('that nobody subscribed to in training')
    assert '/planner /debug std_msgs/String: 15' in known[1]
    assert '/debug' not in known[0] and '/planner /new std_msgs/String: 3' in known[0]


@pytest.mark.parametrize('text, told', [
    ('{', 'not YAML'),
    ('- /scan', 'expected keys'),
    ('/scan: [/laser]', '/scan: expected keys'),
    ('/scan: {publishers: [/laser]}', '/scan.subscribers: missing'),
    ('/scan: {publishers: [1], subscribers: []}', '/scan.publishers: expected texts'),
])
def test_a_bad_file_is_named(bags: Bags, tmp_path: Path, text: str, told: str) -> None:
    path = graph_file(bags[0])
    Path(path).write_text(text)
    error = error_of(train, [*bags, '-o', str(tmp_path / 'm')])
    assert path in error and told in error
    assert len(trained(bags, tmp_path / 'm', '--skip-bad').recordings) == 1


MISSING = ('/navigation', '/pose_hypotheses')


def as_heard_live(log: str) -> None:
    """Make an event log of a bag one that was heard live: its graph is all that there was."""
    with rosbag.Bag(log) as bag:
        messages = list(bag.read_messages(return_connection_header=True))
    with rosbag.Bag(log, 'w') as bag:
        for topic, message, stamp, header in messages:
            if topic == '/event_log/start':
                message.bag = ''
            bag.write(topic, message, stamp, connection_header=header)


@pytest.fixture(name='logs', scope='module')
def _logs(tmp_path_factory: pytest.TempPathFactory) -> Dict[str, str]:
    folder = tmp_path_factory.mktemp('connections')
    logs = {}
    for name, seed, fault in (('1', 1, None), ('2', 2, None), ('fine', 3, None),
                              ('deaf', 3, 'unsubscribed:navigation')):
        bag, log = str(folder / f'{name}.bag'), str(folder / f'{name}.events.bag')
        options = [] if fault is None else ['--fault', fault]
        assert simulate.main(['-o', bag, '--duration', '100', '--seed', str(seed), *options]) == 0
        assert convert.main([bag, '-o', log]) == 0
        logs[f'{name} bag'] = bag
        logs[f'{name} of a bag'] = str(folder / f'{name}.of_bag.bag')
        Path(logs[f'{name} of a bag']).write_bytes(Path(log).read_bytes())
        as_heard_live(log)
        logs[name] = log
    return logs


@pytest.fixture(name='model', scope='module')
def _model(logs: Dict[str, str]) -> str:
    path = Path(logs['1']).parent / 'robot.model'
    trained([logs['1'], logs['2']], path)
    return str(path)


def test_what_every_start_had_is_learned(logs: Dict[str, str], model: str) -> None:
    known = TrainedModel.load(model)
    assert MISSING in known.subscriptions and len(known.subscriptions) > 25
    assert {node for node, _ in known.subscriptions} <= {
        kind.source for kind in known.event_types}
    said = json.loads(printed_by(info, [model, '--json']))
    assert dict(zip(('node', 'topic'), MISSING)) in said['subscriptions']


@pytest.mark.parametrize('names', [
    ('1',), ('1 bag', '2 bag'), ('1 of a bag', '2 of a bag'), ('1', '2', '3 of no graph'),
    ('1', '2', 'deaf')])
def test_what_not_every_start_is_known_to_have_is_not_expected(
        logs: Dict[str, str], tmp_path: Path, names: Tuple[str, ...]) -> None:
    bags = [logs['fine of a bag' if name == '3 of no graph' else name] for name in names]
    expected = trained(bags, tmp_path / 'robot.model').subscriptions
    assert MISSING not in expected
    assert bool(expected) == (names == ('1', '2', 'deaf'))


def test_the_running_robots_graph_is_added(bags: Bags, tmp_path: Path, monkeypatch) -> None:
    RobotGraph({'/scan': {'/laser'}}, {'/scan': {'/slam'}}).save(graph_file(bags[0]))
    monkeypatch.setattr('self_awareness.training.robot_graph.fetch',
                        lambda: RobotGraph({'/map': {'/slam'}}, {'/map': {'/log'}}))
    assert trained(bags, tmp_path / 'm', '--graph').graph == {('/laser', '/scan', '/slam'),
                                                              ('/slam', '/map', '/log')}
