"""The part of the graph that the report draws, and how."""
from __future__ import annotations

import re
import xml.etree.ElementTree as ElementTree

import pytest

from self_awareness.reporting.report.neighbours import (MOST_NODES, OTHER, ROOT, VICTIM, draw,
                                                        neighbourhood)
from self_awareness.reporting.report.page import check_installed


def test_the_root_has_its_publishers_and_subscribers() -> None:
    found = neighbourhood([('/a', '/x', '/b'), ('/b', '/y', '/c'), ('/a', '/x', '/c'),
                           ('/a', '/z', '/c'), ('/c', '/w', '/far'), ('/a', '/self', '/a')],
                          ['/b', '/c'])
    assert found.roles == {'/a': OTHER, '/b': ROOT, '/c': VICTIM}
    assert found.topics['/a', '/c'] == ['/x', '/z'] and ('/a', '/a') not in found.topics
    assert found.left_out == 1


def test_who_hears_nearly_everybody_is_left_out() -> None:
    """Recorders and /rosout put all nodes within two steps of each other."""
    edges = [(f'/n{i}', f'/t{i}', f'/n{i + 1}') for i in range(9)]
    edges += [(publisher, topic, '/recorder') for publisher, topic, _ in edges]
    edges += [(publisher, '/rosout', '/rosout') for publisher, _, _ in edges]
    found = neighbourhood(edges, ['/n4', '/n5'])
    assert set(found.roles) == {'/n3', '/n4', '/n5'}
    assert found.listeners == ['/recorder']
    assert '/recorder' in neighbourhood(edges, ['/recorder']).roles  # unless it is a suspect
    assert neighbourhood([('/a', '/x', '/b'), ('/c', '/y', '/b')], ['/a']).listeners == []


def test_suspects_farther_away_come_with_the_way_to_them() -> None:
    edges = [(f'/n{i}', f'/t{i}', f'/n{i + 1}') for i in range(9)]
    found = neighbourhood(edges, ['/n2', '/n5'])
    assert list(found.roles)[0] == '/n2' and found.roles['/n5'] == VICTIM
    assert set(found.roles) == {'/n1', '/n2', '/n3', '/n4', '/n5'}


def test_a_large_graph_is_drawn_near_the_suspects_only() -> None:
    edges = [(f'/n{i}', f'/t{i}', f'/n{i + 1}') for i in range(500)]
    edges += [('/n250', '/many', f'/m{i}') for i in range(500)]
    found = neighbourhood(edges, ['/n250', '/n252', '/n400', '/nobody'])
    assert len(found.roles) == MOST_NODES and {'/n249', '/n251', '/n252'} <= set(found.roles)
    assert found.left_out == 1001 - MOST_NODES


def test_suspects_that_are_not_in_the_graph_are_left_out() -> None:
    assert neighbourhood([('/a', '/x', '/b')], ['/c']).roles == {}
    found = neighbourhood([('/a', '/x', '/b')], ['/c', '/b'])
    assert found.roles == {'/b': VICTIM, '/a': OTHER}


def test_names_are_shown_as_they_are() -> None:
    """Names come from strangers; dot has escapes and entities of its own."""
    evil = r'</svg><script>"\N\l&amp;'
    drawn = draw(neighbourhood([(evil, '/x', '/a/very/long/name/of/a/node')], [evil]))
    texts = [element.text for element in ElementTree.fromstring(drawn).iter()
             if element.tag.endswith('}text')]
    assert ''.join(texts[:texts.index('/a/very/long')]).replace('/x', '') == evil
    assert {'/x', '/a/very/long', '/name/of/a/node'} <= set(texts)
    assert '<script' not in drawn and ' id=' not in drawn
    assert 'class="node root"' in drawn and 'class="node other"' in drawn


@pytest.mark.parametrize('edges', [
    [(f'/n{i}', f'/topic_{i}', f'/n{i + 1}') for i in range(MOST_NODES - 1)],
    [('/n0', '/topic', f'/n{i + 1}') for i in range(MOST_NODES - 1)]], ids=['a chain', 'a star'])
def test_a_phone_shows_it_whole(edges: 'list[tuple[str, str, str]]') -> None:
    """A chain goes down, and who has many listeners has them below each other."""
    shown = neighbourhood(edges, [edges[0][0], edges[-1][2]])
    assert len(shown.roles) == MOST_NODES
    width = re.search(r'<svg width="(\d+)pt"', draw(shown))
    assert width is not None and 4 / 3 * int(width[1]) < 360  # pixels


def test_without_dot_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv('PATH', '/nowhere')
    with pytest.raises(ValueError, match='apt install graphviz'):
        check_installed(graphs=True)
