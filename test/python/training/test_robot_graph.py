"""The file beside a bag that says who listens to whom: what train makes of it, and bad ones."""
from __future__ import annotations

import shutil
from pathlib import Path
from typing import Tuple

import pytest
from conftest import error_of, robot, trained

from self_awareness import EncodingRules, stable_name
from self_awareness.commands import info, score, train
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
    assert score.main([make_bag('later.bag', sorted(later)), '--model', path,
                       '--details']) == 0
    said = capsys.readouterr().out
    known = said.split('that nobody subscribed to in training')
    assert '/planner /debug std_msgs/String: 15' in known[1]
    assert '/debug' not in known[0] and '/planner /new std_msgs/String: 3' in known[0]


def test_the_running_robots_graph_is_added(bags: Bags, tmp_path: Path, monkeypatch) -> None:
    RobotGraph({'/scan': {'/laser'}}, {'/scan': {'/slam'}}).save(graph_file(bags[0]))
    monkeypatch.setattr('self_awareness.training.live_graph.fetch',
                        lambda: RobotGraph({'/map': {'/slam'}}, {'/map': {'/log'}}))
    assert trained(bags, tmp_path / 'm', '--graph').graph == {('/laser', '/scan', '/slam'),
                                                              ('/slam', '/map', '/log')}


def test_without_a_file_there_is_no_graph(bags: Bags, tmp_path: Path, capsys) -> None:
    assert trained(bags, tmp_path / 'm', '--details').graph == set()
    assert 'graph        none: ' in capsys.readouterr().out


@pytest.mark.parametrize('text, told', [
    ('{', 'not YAML'),
    ('- /scan', 'expected keys'),
    ('/scan: [/laser]', '/scan: expected keys'),
    ('/scan: {publishers: [/laser]}', '/scan.subscribers: missing'),
    ('/scan: {publishers: [1], subscribers: []}', '/scan.publishers: expected texts'),
])
def test_a_bad_file_is_named(bags: Bags, tmp_path: Path, capsys, text: str, told: str) -> None:
    path = graph_file(bags[0])
    Path(path).write_text(text)
    error = error_of(train, [*bags, '-o', str(tmp_path / 'm')], capsys)
    assert path in error and told in error
    assert len(trained(bags, tmp_path / 'm', '--skip-bad').recordings) == 1
