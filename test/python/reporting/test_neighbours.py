"""The part of the graph that the report draws, and where."""
from __future__ import annotations

from self_awareness.reporting.report.neighbours import (MOST_NODES, OTHER, ROOT, VICTIM,
                                                        neighbourhood)


def test_publishers_stand_before_their_subscribers() -> None:
    found = neighbourhood([('/a', '/x', '/b'), ('/b', '/y', '/c'), ('/a', '/x', '/c'),
                           ('/a', '/z', '/c')], ['/b', '/c'])
    assert {node.name: (node.role, node.layer) for node in found.nodes} == {
        '/a': (OTHER, 0), '/b': (ROOT, 1), '/c': (VICTIM, 2)}
    topics = {(link.publisher, link.subscriber): link.topics for link in found.connections}
    assert topics['/a', '/c'] == ['/x', '/z']
    assert found.left_out == 0


def test_a_loop_goes_back() -> None:
    found = neighbourhood([('/a', '/x', '/b'), ('/b', '/y', '/a'), ('/a', '/self', '/a')], ['/a'])
    assert {node.name: node.layer for node in found.nodes} == {'/a': 0, '/b': 1}
    assert len(found.connections) == 2


def test_no_two_nodes_stand_at_one_place() -> None:
    edges = [('/hub', '/x', f'/n{i}') for i in range(9)]
    edges += [(f'/n{i}', '/y', '/end') for i in range(9)]
    found = neighbourhood(edges, ['/hub'])
    assert len({(node.layer, node.place) for node in found.nodes}) == 11


def test_a_large_graph_is_drawn_near_the_suspects_only() -> None:
    edges = [(f'/n{i}', f'/t{i}', f'/n{i + 1}') for i in range(500)]
    edges += [('/n250', '/many', f'/m{i}') for i in range(500)]
    found = neighbourhood(edges, ['/n250', '/n300', '/nobody'])
    names = {node.name for node in found.nodes}
    assert len(names) == MOST_NODES and {'/n249', '/n250', '/n299', '/n300'} <= names
    assert found.left_out == 1001 - MOST_NODES


def test_suspects_that_are_not_in_the_graph_are_left_out() -> None:
    assert neighbourhood([('/a', '/x', '/b')], ['/c']).nodes == []
    found = neighbourhood([('/a', '/x', '/b')], ['/c', '/b'])
    assert {node.name: node.role for node in found.nodes} == {'/a': OTHER, '/b': VICTIM}
