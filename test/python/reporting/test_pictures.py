"""What reports draw of the graph and of scores, and numbers as people read them."""
from __future__ import annotations

import math
import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from types import SimpleNamespace
from typing import Any, Optional

import numpy as np
import pytest

from self_awareness import Roc
from self_awareness.reporting.plots import save_roc, save_scores
from self_awareness.reporting.report.judged import Judged
from self_awareness.reporting.report.neighbours import (MOST_NODES, OTHER, ROOT, VICTIM, draw,
                                                        neighbourhood)
from self_awareness.reporting.report.page import check_installed
from self_awareness.reporting.text import of_limit, rounded


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


STARTS = {'png': b'\x89PNG', 'pdf': b'%PDF', 'svg': b'<?xml'}


def scores(windows: int, lowest: float = -2.0, threshold: Optional[float] = -1.0,
           name: str = 'robot.bag') -> Judged:
    values = np.full(windows, -0.3)
    values[windows // 2] = lowest
    values[:3] = np.nan
    alarm = SimpleNamespace(begin=windows * 5 * 10 ** 6, end=windows * 6 * 10 ** 6,
                            culprit='/player')
    verdicts: Any = SimpleNamespace(start=np.arange(windows) * 10 ** 8, score=values,
                                    abnormal=values < -1.0, settling=np.arange(windows) < 50,
                                    alarms=[alarm], suspicions=[])
    by: Any = SimpleNamespace(threshold=threshold, evidence='of it',
                              trained=SimpleNamespace(window=10 ** 8))
    recording: Any = SimpleNamespace(origin=0, part=name)
    return Judged(by, recording, verdicts)


@pytest.mark.parametrize('ending', sorted(STARTS))
def test_the_ending_says_the_format(ending: str, tmp_path: Path) -> None:
    roc = Roc([-0.1, -0.2, -0.3], [-2.0, -0.15])
    curves = [(f'crash:/n{number}', roc) for number in range(9)] + [('all together', roc)]
    paths = [tmp_path / f'{name}.{ending}' for name in ('scores', 'roc')]
    save_scores(str(paths[0]), [scores(600), scores(20, threshold=None)])
    save_roc(str(paths[1]), 'ROC', curves, roc.at(-1.0))
    for path in paths:
        assert path.read_bytes().startswith(STARTS[ending])
    assert sorted(tmp_path.iterdir()) == sorted(paths)


def test_a_plot_names_the_alarm_and_the_few_worst_faults(tmp_path: Path) -> None:
    from matplotlib import rc_context
    rocs = [Roc([-0.1, -0.2, -0.3], [-0.25 - 0.02 * number, -0.15]) for number in range(9)]
    curves = [(f'fault$x^{{{number}', roc) for number, roc in enumerate(rocs)]
    title = r'$HOME/a_$x^{robot.bag'  # with dollars, and no formula
    with rc_context({'svg.fonttype': 'none'}):  # text as text
        save_scores(str(tmp_path / 's.svg'), [scores(600, name=title)])
        save_roc(str(tmp_path / 'r.svg'), title, [*curves, ('all together', rocs[4])],
                 rocs[4].at(-1.0))
    plot, legend = ((tmp_path / name).read_text(encoding='utf-8') for name in ('s.svg', 'r.svg'))
    assert '/player' in plot and title in plot and title in legend
    named = [name for name, _ in curves if f'{name}: AUC' in legend]
    worst = sorted(curves, key=lambda curve: curve[1].auc)[:3]
    assert named == sorted(name for name, _ in worst)
    assert '6 others: AUC' in legend and 'all together: AUC' in legend


def test_an_abnormal_window_of_a_long_recording_is_seen(tmp_path: Path) -> None:
    """Two days of windows of 0.1 s: one in 1.7 million is abnormal."""
    from matplotlib.image import imread
    seen = []
    for lowest in (-0.3, -3.0):
        path = tmp_path / 'p.png'
        save_scores(str(path), [scores(1_728_000, lowest)])
        pixels = imread(str(path))[:, :, :3]
        in_plot = pixels[330:448, 100:1150]  # below the line of the threshold
        seen.append(int((np.abs(in_plot - (0.776, 0.184, 0.208)).max(axis=2) < 0.1).sum()))
    assert seen[0] == 0 and seen[1] > 0


@pytest.mark.parametrize('value, digits, text', [
    (1234.0, 2, '1200'), (0.0116, 2, '0.012'), (18.2, 2, '18'), (0.0, 2, '0'), (997.0, 2, '1000'),
    (86.4, 3, '86.4'), (12345.0, 3, '12300'), (999_999.0, 2, '1e+06')])
def test_a_number_has_no_exponent_that_nobody_needs(value: float, digits: int, text: str) -> None:
    assert rounded(value, digits) == text


@pytest.mark.parametrize('score, threshold, text', [
    (-1.104, -1.0, '110 % of the limit'), (-0.0, -1.0, '0 % of the limit'),
    (0.0, -1.0, '0 % of the limit'), (-95.16, -1.0, '9516 % of the limit'),
    (0.25, 0.5, 'lowest score 0.25, threshold 0.5'), (0.25, None, 'lowest score 0.25'),
    (math.nan, 0.5, 'lowest score none, threshold 0.5')])
def test_only_the_evidence_detector_has_a_percentage_of_its_limit(
        score: float, threshold: Optional[float], text: str) -> None:
    assert of_limit(score, threshold) == text
