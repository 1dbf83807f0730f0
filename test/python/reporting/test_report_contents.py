"""What the report says, before anything is drawn."""
from __future__ import annotations

import re
from pathlib import Path
from types import SimpleNamespace
from typing import Any, Callable

import numpy as np
import pytest
from conftest import jittery_robot
from judged_recordings import dead, judged, without_laser

from self_awareness.reporting.report import timeline
from self_awareness.reporting.report.against import against
from self_awareness.reporting.report.intervals import ALARM
from self_awareness.reporting.report.neighbours import ROOT, VICTIM
from self_awareness.reporting.report.section import ALARMED, SUSPICIOUS, section


def test_the_summary_and_the_details_say_who_when_and_why(evidence_model: str,
                                                          tmp_path: Path) -> None:
    found = section(dead(evidence_model, tmp_path), 'x')
    assert found.summary.state == ALARMED
    assert (found.summary.headline
            == '/laser (/scan) fell silent at 12.0 s, and came back at 20.0 s.')
    answers = dict(found.summary.answers)
    assert answers['When'].startswith('alarm from 12.')
    assert '1970-01-01 00:50:12.' in answers['When']
    assert answers['Who'] == '/laser /scan std_msgs/String'
    assert answers['Why'].startswith('silent for 0.') and 'usually every 0.050 s' in answers['Why']
    assert answers['Since'].startswith('12.0 s, 0.')
    assert answers['Victims'] == '/slam' and 'Also named' not in answers
    assert 'overdue' not in ' '.join(answers.values())

    incident = found.incidents[0]
    alarm, details = incident.main, found.details[incident.key]
    assert incident.level == ALARM and 12.0 < alarm.start < 13.0 and alarm.cleared
    first, histogram = alarm.suspects[0], details.evidence[0]
    assert (first.component, first.short) == ('/laser', 'fell silent')
    assert histogram.caption == ('gaps between two /laser /scan std_msgs/String; '
                                 'shaded: what is usual')
    usual, seen = histogram.figure['layout']['shapes']
    bars, = histogram.figure['data']
    assert seen['x0'] == pytest.approx(alarm.start - alarm.began)
    assert seen['x0'] > bars['x'][-1] > 0.05 and bars['x'][0] < 0.05 < usual['x1']
    assert bars['hovertext'][0].endswith(' of 2399')  # gaps of 2400 messages
    assert re.fullmatch(r'overdue of /laser /scan std_msgs/String: [1-9]\d\d % of its limit',
                        details.decided)
    assert details.graph.roles['/laser'] == ROOT and details.graph.roles['/slam'] == VICTIM
    assert [each.component for each in incident.silent] == ['/laser', '/slam']
    assert incident.silent[0].silence.back == pytest.approx(20.0, abs=0.1)


def test_a_rate_has_counts_and_what_is_usual(evidence_model: str, make_bag) -> None:
    """A histogram of gaps would have the gap that was seen among those of training."""
    messages = [m for i, m in enumerate(jittery_robot(3000.0, 60.0, 3))
                if not (m[1] == '/laser' and 3020.0 < m[0] < 3030.0 and i % 3 == 0)]
    of = judged(evidence_model, make_bag('seldom.bag', messages))
    laser = [kind.source for kind in of.recording.event_types].index('/laser')
    reason = SimpleNamespace(kind='slow', after='', unit='Hz', value=13.0, usual=20.0,
                             usual_shortest=18.0, usual_longest=22.0, lasted=2.0, words='')
    suspect: Any = SimpleNamespace(id=laser, reason=reason)
    alarm: Any = SimpleNamespace(begin=3_021_000_000_000, end=3_032_000_000_000)
    shown = against(of, alarm, suspect)
    assert shown.caption.startswith('/laser /scan')
    counts, = shown.figure['data']
    by_time = dict(zip(counts['x'], counts['y']))
    assert all(36 <= by_time[time] <= 44 for time in (10.0, 18.0, 36.0))
    assert all(count < 36 for time, count in by_time.items() if 22.5 < time < 29.5)
    usual, of_alarm = shown.figure['layout']['shapes']
    assert (usual['y0'], usual['y1']) == (36.0, 44.0)
    assert (of_alarm['x0'], of_alarm['x1']) == pytest.approx((21.0, 32.0), abs=0.1)


def test_lanes_and_score_agree(evidence_model: str, tmp_path: Path) -> None:
    """The report computes no evidence of its own: the largest of a stretch is its score."""
    found = timeline.timeline(dead(evidence_model, tmp_path), ['/slam'])
    assert found.lanes.names[0] == '/slam' and found.lanes.left_out == 0
    np.testing.assert_allclose(found.lanes.shares.max(axis=0), -found.lowest, rtol=1e-6)
    assert set(found.lanes.names) == {'/slam', '/laser', '/battery'}
    laser = found.lanes.shares[found.lanes.names.index('/laser')]
    assert (laser[found.abnormal] > 1.0).any()
    assert (found.abnormal == (found.lowest < -1.0)).all()


def test_long_recordings_are_drawn_in_stretches_that_lose_no_extreme(
        evidence_model: str, make_bag, monkeypatch: pytest.MonkeyPatch) -> None:
    of = judged(evidence_model, make_bag('dead.bag', without_laser(3000.0, 120.0)))
    monkeypatch.setattr(timeline, 'MOST_LONG', 50)
    monkeypatch.setattr(timeline, 'MOST_FINE', 160)
    begins = timeline.cut(of)
    assert len(begins) <= 50 + 160 and begins[0] == 0 and (np.diff(begins) > 0).all()
    drawn = timeline.timeline(of)
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


def test_the_papers_detector_has_suspects_and_no_lanes(evidence_model: str,
                                                       make_bag: Callable[..., str]) -> None:
    bag = make_bag('dead.bag', without_laser(3000.0))
    scores = judged(evidence_model, bag, 'paper').verdicts.score
    threshold = float(np.nanmedian(scores)) / 2
    found = section(judged(evidence_model, bag, 'paper', threshold), 'x')
    assert found.timeline.lanes is None
    assert found.timeline.limit == 1.0 and found.timeline.unit == threshold
    silent, shown = next(
        (suspect, shown) for each in found.incidents
        for suspect, shown in zip(each.main.named, found.details[each.key].evidence)
        if suspect.short == 'fell silent')
    assert silent.component == '/laser' and shown.figure['layout']['shapes'][-1]['x0'] > 0.05
    assert shown.figure['data'][0]['hovertext'][0].endswith(' of 2399')
    assert any('one score for all' in each.why for each in found.unjudged)
