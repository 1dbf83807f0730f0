"""What the report says, before anything is drawn."""
from __future__ import annotations

from pathlib import Path
from typing import Callable

import numpy as np
import pytest
from conftest import jittery_robot
from judged_recordings import judged, with_graph, without_laser

from self_awareness.reporting.report import columns
from self_awareness.reporting.report.intervals import ALARM
from self_awareness.reporting.report.neighbours import ROOT, VICTIM
from self_awareness.reporting.report.section import (ALARMED, NOT_JUDGED, QUIET, SUSPICIOUS,
                                                     section)
from self_awareness.reporting.report.timeline import overview


def test_the_summary_says_who_when_why_and_since_when(evidence_model: str, make_bag,
                                                      tmp_path: Path) -> None:
    bag = make_bag('dead.bag', without_laser(3000.0))
    found = section(judged(with_graph(evidence_model, tmp_path / 'm'), bag), 'x')
    assert found.summary.state == ALARMED
    assert (found.summary.headline
            == '/laser (/scan) fell silent at 12.0 s, and came back at 20.0 s.')
    answers = dict(found.summary.answers)
    assert answers['When'].startswith('alarm from 12.')
    assert '1970-01-01 00:50:12.' in answers['When']
    assert answers['Who'] == '/laser /scan std_msgs/String'
    assert answers['Why'].startswith('silent for 0.') and 'usually every 0.050 s' in answers['Why']
    assert answers['Since'].startswith('12.0 s, 0.')
    assert 'overdue of /laser /scan std_msgs/String: 1.' in answers['Evidence']
    assert '/slam' in answers['What else']


def test_an_alarm_has_its_suspects_delays_and_graph(evidence_model: str, make_bag,
                                                    tmp_path: Path) -> None:
    bag = make_bag('dead.bag', without_laser(3000.0))
    found = section(judged(with_graph(evidence_model, tmp_path / 'm'), bag), 'x')
    alarm, = [each for each in found.intervals if each.level == ALARM]
    assert 12.0 < alarm.start < 13.0 and alarm.cleared
    first = alarm.suspects[0]
    assert (first.component, first.short) == ('/laser', 'fell silent')
    assert first.histogram.title == 'gaps between two /laser /scan std_msgs/String'
    assert first.histogram.seen == pytest.approx(alarm.start - alarm.began)
    assert first.histogram.seen > first.histogram.edges[-1] > 0.05
    assert first.histogram.edges[0] < 0.05 < first.histogram.usual[1]
    assert sum(first.histogram.counts) == 2399  # gaps of 2400 messages
    roles = {node.name: node.role for node in alarm.graph.nodes}
    assert roles['/laser'] == ROOT and roles['/slam'] == VICTIM and '/planner' in roles
    layers = {node.name: node.layer for node in alarm.graph.nodes}
    assert layers['/laser'] < layers['/slam'] < layers['/planner']


def test_lanes_and_score_agree(evidence_model: str, make_bag) -> None:
    """The report computes no evidence of its own: the largest of a stretch is its score."""
    found = overview(judged(evidence_model, make_bag('dead.bag', without_laser(3000.0))),
                     ['/slam'])
    assert found.lanes.names[0] == '/slam' and found.lanes.left_out == 0
    np.testing.assert_allclose(found.lanes.shares.max(axis=0), -found.timeline.lowest, rtol=1e-6)
    assert set(found.lanes.names) == {'/slam', '/laser', '/battery'}
    laser = found.lanes.shares[found.lanes.names.index('/laser')]
    assert (laser[found.timeline.abnormal] > 1.0).any()
    assert (found.timeline.abnormal == (found.timeline.lowest < -1.0)).all()


def test_long_recordings_are_drawn_in_stretches_that_lose_no_extreme(
        evidence_model: str, make_bag, monkeypatch: pytest.MonkeyPatch) -> None:
    of = judged(evidence_model, make_bag('dead.bag', without_laser(3000.0, 120.0)))
    monkeypatch.setattr(columns, 'MOST_LONG', 50)
    monkeypatch.setattr(columns, 'MOST_FINE', 160)
    begins = columns.cut(of.verdicts, 3)
    assert len(begins) <= 50 + 160 and begins[0] == 0 and (np.diff(begins) > 0).all()
    drawn = overview(of, []).timeline
    assert len(drawn.lowest) == len(begins) < len(of.verdicts.start) / 3
    alarm, = of.verdicts.alarms
    near = (of.verdicts.start[begins] >= alarm.begin - 3 * 10**9) & (
        of.verdicts.start[begins] < alarm.begin)
    assert near.sum() == 30  # each window of 0.1 s
    assert drawn.lowest.min() == of.verdicts.score.min()
    assert drawn.highest.max() == of.verdicts.score.max()
    for index, (begin, end) in enumerate(zip(begins, [*begins[1:], len(of.verdicts.start)])):
        assert drawn.lowest[index] == of.verdicts.score[begin:end].min()
        assert drawn.abnormal[index] == of.verdicts.abnormal[begin:end].any()


def test_with_many_components_there_are_fewer_stretches(evidence_model: str, make_bag,
                                                        monkeypatch) -> None:
    of = judged(evidence_model, make_bag('dead.bag', without_laser(3000.0)))
    monkeypatch.setattr(columns, 'MOST_CELLS', 1000)
    assert len(columns.cut(of.verdicts, 20)) <= 52
    assert len(columns.cut(of.verdicts, 10_000)) >= 1


def test_what_was_not_judged_is_told(evidence_model: str, make_bag) -> None:
    messages = sorted([m for m in jittery_robot(3000.0, 30.0, 5) if m[1] != '/battery']
                      + [(3010.02, '/new', '/a'), (3011.02, '/new', '/a')])
    found = section(judged(evidence_model, make_bag('new.bag', messages)), 'x')
    assert found.summary.state == SUSPICIOUS
    assert found.summary.headline == '/battery (/charge) was not heard since the start.'
    texts = {each.what: each for each in found.unjudged}
    assert texts['1 event type that training never saw'].names == ['/new /a std_msgs/String: 2']
    assert texts['1 event type of the model without any event'].names == [
        '/battery /charge std_msgs/String']
    assert any('of settling' in what for what in texts)
    assert 'who hears whom' in texts


def test_normal_operation_is_called_so(evidence_model: str, make_bag) -> None:
    found = section(judged(evidence_model, make_bag('n.bag', jittery_robot(7000.0, 30.0, 4))), 'x')
    assert (found.summary.state, found.summary.headline) == (QUIET, 'Nothing abnormal.')
    assert found.intervals == [] and found.overview.lanes.names


def test_without_limits_nothing_is_judged(model_file: str, make_bag) -> None:
    found = section(judged(model_file, make_bag('dead.bag', without_laser(3000.0))), 'x')
    assert found.summary.state == NOT_JUDGED and 'not calibrated' in found.summary.headline
    assert found.overview.lanes is None and found.unjudged[0].what == 'everything'


def test_the_papers_detector_has_suspects_and_no_lanes(evidence_model: str,
                                                       make_bag: Callable[..., str]) -> None:
    bag = make_bag('dead.bag', without_laser(3000.0))
    scores = judged(evidence_model, bag, 'paper').verdicts.score
    threshold = float(np.nanmedian(scores)) / 2
    found = section(judged(evidence_model, bag, 'paper', threshold), 'x')
    assert found.overview.lanes is None
    assert found.overview.timeline.limit == 1.0 and found.overview.timeline.unit == threshold
    suspects = [suspect for each in found.intervals for suspect in each.suspects]
    silent = next(suspect for suspect in suspects if suspect.short == 'fell silent')
    assert silent.component == '/laser' and silent.histogram.seen > 0.05
    assert sum(silent.histogram.counts) == 2399
    assert any('one score for all' in each.why for each in found.unjudged)
