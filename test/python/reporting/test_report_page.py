"""The page of a report as a file: whole, bounded, and safe whatever the names are."""
from __future__ import annotations

import json
import os
import re
from pathlib import Path
from typing import Any, Callable, Dict

import numpy as np
import pytest
from conftest import jittery_robot, write_bag
from judged_recordings import judged, with_graph, without_laser

from self_awareness.commands import score, train
from self_awareness.reporting.report import figures
from self_awareness.reporting.report.page import save_page, save_report
from self_awareness.reporting.report.section import section
from self_awareness.reporting.report.timeline import MOST_LANES
from self_awareness.reporting.report.unjudged import MOST_NAMES

FOLDER = Path(figures.__file__).parent
MOST_BYTES = 3_500_000


def data_of(page: str) -> Dict[str, Any]:
    """Return what the page draws."""
    found, = re.findall(r'<script type="application/json" id="data">(.*?)</script>', page)
    return json.loads(found)


def test_score_writes_a_report_of_each_recording(evidence_model: str, make_bag, tmp_path: Path,
                                                 capsys) -> None:
    bags = [make_bag('dead.bag', without_laser(3000.0)),
            make_bag('normal.bag', jittery_robot(7000.0, 30.0, 4))]
    report, model = tmp_path / 'r.html', with_graph(evidence_model, tmp_path / 'm')
    assert score.main([*bags, '--model', model, '--report', str(report)]) == 0
    page = report.read_text()
    assert len(page) < MOST_BYTES
    assert page.count('<section ') == 2
    without_plotly = re.sub(r'<script>.*?</script>', '', page, flags=re.S)
    assert not re.search(r'(src|href)="(?!#|data:)', without_plotly), 'it needs no network'
    assert "default-src 'none'" in page
    assert '/laser (/scan) fell silent at 12.0 s, and came back at 20.0 s.' in page
    assert 'summary quiet' in page and 'Nothing abnormal.' in page
    # The report and the text agree.
    start, end = re.findall(r'^    ([\d.]+) - ([\d.]+) s', capsys.readouterr().out, re.M)[0]
    assert f'{start} s – {end} s' in page
    interval, = [each for each in data_of(page)['sections'][0]['incidents'].values()
                 if [f'{time:.1f}' for time in each['range']] == [start, end]]
    assert len(interval['figures']) >= 2


@pytest.mark.parametrize('detector', ['evidence', 'paper'])
@pytest.mark.parametrize('calibrated', [True, False])
def test_every_figure_is_one_that_plotly_knows(evidence_model: str, model_file: str, make_bag,
                                               tmp_path: Path, detector: str,
                                               calibrated: bool) -> None:
    objects = pytest.importorskip('plotly.graph_objects')
    report, bag = tmp_path / 'r.html', make_bag('dead.bag', without_laser(3000.0))
    model = with_graph(evidence_model if calibrated else model_file, tmp_path / 'm')
    save_report(str(report), [section(judged(model, bag, detector, 0.2 if calibrated else None),
                                      'x')])
    page = report.read_text()
    for part in ('Not judged: the model is not calibrated.', 'summary not judged',
                 '<b>everything</b>: the model has no limits'):
        assert (part in page) != calibrated
    assert ('evidence of each component' in page) == (calibrated and detector == 'evidence')
    shown, = data_of(page)['sections']
    drawn = [shown['overTime'], *(figure for incident in shown['incidents'].values()
                                  for figure in incident['figures'].values())]
    assert len(drawn) >= (2 if calibrated else 1)
    for figure in drawn:
        objects.Figure(figure)  # ValueError if it has something unknown


def test_the_seen_delay_is_marked_in_its_histogram() -> None:
    drawn = figures.histogram([0.04, 0.05, 0.06], [10, 30], 0.5, 'now: 0.5 s', (0.045, 0.055))
    line, = [shape for shape in drawn['layout']['shapes'] if shape['type'] == 'line']
    assert line['x0'] == line['x1'] == 0.5
    assert drawn['data'][0]['y'] == [25.0, 75.0]
    low, high = drawn['layout']['xaxis']['range']
    assert low <= 0.04 and high > 0.5
    assert 'now: 0.5 s' in drawn['layout']['annotations'][0]['text']


@pytest.mark.parametrize('first_edge', [0.0, 0.04])
def test_log_bins_from_0_on_can_be_drawn(first_edge: float) -> None:
    drawn = figures.histogram([first_edge, 0.05, 0.6], [1, 1], None, 'none', None)
    low, high = drawn['layout']['xaxis']['range']
    assert -3 < low < high < 0
    assert all(edge > 0 for edge in drawn['data'][0]['x'])


def test_a_name_cannot_become_a_part_of_the_page(evidence_model: str, tmp_path: Path) -> None:
    """Names come from strangers; those of event types may hold any text (type_fields)."""
    evil = '/a</script><script>alert(1)</script><b>'
    bag = write_bag(tmp_path / 'evil.bag',
                    sorted([*without_laser(3000.0), (3015.0, evil, '/joystick')]))
    report = tmp_path / '<i>.html'
    assert score.main([bag, '--model', evidence_model, '--report', str(report)]) == 0
    page = report.read_text()
    assert '<script>alert' not in page and '&lt;script&gt;alert' in page
    assert all('<script' not in text for text in
               re.findall(r'id="data">(.*?)</script>', page, re.S))


def test_normal_operation_draws_no_walls(evidence_model: str, make_bag) -> None:
    """The evidence of a slow topic grows to nearly its limit between any two of its messages."""
    of = judged(evidence_model, make_bag('n.bag', jittery_robot(7000.0, 60.0, 4)))
    found = section(of, 'x')
    assert np.nanmin(of.verdicts.score) < -0.5
    drawn = figures.over_time(found.timeline, found.incidents)
    score = [trace for trace in drawn['data'] if trace.get('yaxis') == 'y2']
    assert {value for trace in score for value in trace['y']} == {-1.0}


@pytest.mark.parametrize('name, code, told', [
    ('report.pdf', 2, '.html'), ('report', 2, '.html'), ('html', 2, '.html'),
    ('without_plotly.html', 1, 'apt install python3-plotly')])
def test_what_cannot_be_written_is_told_before(
        evidence_model: str, make_bag, tmp_path: Path, name: str, code: int, told: str,
        monkeypatch: pytest.MonkeyPatch, capsys) -> None:
    bag = make_bag('n.bag', jittery_robot(7000.0, 30.0, 4))
    monkeypatch.setattr('importlib.util.find_spec', lambda name: None)
    assert score.main([bag, '--model', evidence_model, '--report', str(tmp_path / name)]) == code
    captured = capsys.readouterr()
    assert told in captured.err and captured.out == '' and os.listdir(tmp_path) == ['n.bag']


def test_any_number_of_event_types_is_a_bounded_page(
        evidence_model: str, tmp_path: Path, make_bag: Callable[..., str]) -> None:
    messages = sorted([*without_laser(3000.0),
                       *((3010.0 + i / 1000.0, f'/n{i}', f'/t{i}') for i in range(20_000))])
    bag, report = make_bag('many.bag', messages), tmp_path / 'r.html'
    assert score.main([bag, '--model', evidence_model, '--report', str(report)]) == 0
    page = report.read_text()
    assert len(page) < MOST_BYTES
    # 4000 are told apart, and one stands for all others.
    assert '4001 event types that training never saw' in page
    assert f'and {4001 - MOST_NAMES} more' in page


def test_a_model_of_many_nodes_has_its_most_unusual_lanes(tmp_path: Path) -> None:
    rng = np.random.default_rng(1)
    nodes = 3 * MOST_LANES
    messages = sorted((1000.0 + tick + 0.5 * node / nodes + rng.exponential(0.002), f'/n{node}',
                       f'/t{node}') for node in range(nodes) for tick in np.arange(0, 120, 0.5))
    model, bag = str(tmp_path / 'm'), write_bag(tmp_path / 'b.bag', messages)
    assert train.main([bag, '-o', model]) == 0
    dead = [m for m in messages if not (m[0] > 1060.0 and m[1] == '/n7')]
    found = section(judged(model, write_bag(tmp_path / 'd.bag', dead)), 'x')
    lanes = found.timeline.lanes
    assert len(lanes.names) == MOST_LANES and lanes.names[0] == '/n7'
    assert lanes.left_out >= nodes - MOST_LANES
    assert lanes.largest_left_out <= lanes.shares[-1].max()
    save_report(str(tmp_path / 'r.html'), [found])
    assert f'{lanes.left_out} more components have evidence' in re.sub(
        r'\s+', ' ', (tmp_path / 'r.html').read_text()[:100_000])


@pytest.mark.parametrize('version, allowed', [('4.14.3', True), ('5.0.0', False),
                                              ('10.1', False)])
def test_eval_is_allowed_to_a_plotly_that_cannot_do_without(version: str, allowed: bool,
                                                            monkeypatch, tmp_path: Path) -> None:
    """Else the page of Debian 11 or Ubuntu 20.04 has no figures."""
    plotly = pytest.importorskip('plotly')
    monkeypatch.setattr(plotly, '__version__', version)
    path = tmp_path / 'page.html'
    save_page(str(path), 'base.html', {'</script><!--': ['&', 1.5]})
    assert data_of(path.read_text(encoding='utf-8')) == {'</script><!--': ['&', 1.5]}
    with pytest.raises(ValueError):
        save_page(str(path), 'base.html', {'value': float('nan')})
    policy, = re.findall(r'content="(default-src .*?)"', path.read_text(encoding='utf-8'))
    assert ('unsafe-eval' in policy) == allowed


def test_no_template_leaves_out_an_else() -> None:
    """Jinja2 before 2.11, that of Ubuntu 20.04, calls what is left out an error."""
    for path in FOLDER.glob('*.html'):
        for expression in re.findall(r'{{.*?}}', path.read_text(encoding='utf-8'), re.DOTALL):
            assert (' if ' in expression) == (' else ' in expression), expression
