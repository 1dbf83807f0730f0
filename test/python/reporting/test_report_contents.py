"""What the report says, before anything is drawn, and what it shows an engineer next."""
from __future__ import annotations

import re
import shlex
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from types import SimpleNamespace
from typing import Any, Callable

import numpy as np
import pytest
import rosbag
import rospy
from conftest import jittery_robot, put, write_bag
from judged_recordings import dead, judged, with_graph, without_laser
from rosgraph_msgs.msg import Log

from self_awareness import BagError, EncodingRules, last_log_lines
from self_awareness.commands import convert
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


def log(path: str, topic: str, lines: 'list[tuple[float, str, int, str]]') -> None:
    """Add lines to a bag: stamp [s], node, level, text."""
    with rosbag.Bag(path, 'a') as bag:
        for stamp, node, level, text in lines:
            put(bag, node, topic, Log(level=level, name=node, msg=text), stamp)


@pytest.fixture
def bag(tmp_path: Path) -> str:
    """A laser that dies at 12 s, with its last words."""
    path = write_bag(tmp_path / "laser's.bag", without_laser(3000.0))
    log(path, '/rosout', [(3001.0, '/laser', Log.INFO, 'started'),
                          (3011.9, '/laser', Log.ERROR, 'motor\nstalled \x1b[31m'),
                          (3011.95, '/slam', Log.WARN, 'no scan'),
                          (3029.0, '/laser', Log.INFO, 'much later')])
    log(path, '/rosout_agg', [(3011.9, '/laser', Log.ERROR, 'again')])
    return path


def test_the_last_lines_of_a_node(bag: str) -> None:
    nodes = [('/laser', 3_012_000_000_000), ('/slam', 3_100_000_000_000), ('/nobody', 2**62)]
    laser, slam, nobody = last_log_lines(bag, EncodingRules(), nodes, 12)
    assert [(stamp / 1e9, level) for stamp, level, _ in laser] == [(3001.0, 2), (3011.9, 8)]
    assert laser[1][2] == 'motor stalled \N{REPLACEMENT CHARACTER}[31m'
    assert [text for _, _, text in slam] == ['no scan'] and nobody == []
    assert last_log_lines(bag, EncodingRules(), nodes[:1], 1) == [laser[1:]]


def test_rosout_agg_is_read_where_there_is_no_rosout(tmp_path: Path) -> None:
    path = write_bag(tmp_path / 'b.bag', [(1.0, '/a', '/b')])
    log(path, '/rosout_agg', [(2.0, '/laser_12345', Log.INFO, 'x' * 2000)])
    (stamp, level, text), = last_log_lines(path, EncodingRules(), [('/laser_12345', 2**62)], 9)[0]
    assert (level, len(text)) == (2, 500)


def test_a_message_that_is_no_line_is_passed_over(tmp_path: Path) -> None:
    """Its connection says that it is one; it is shorter than it says."""
    path = str(tmp_path / 'b.bag')
    with rosbag.Bag(path, 'w') as out:
        cut = b'\1\0\0\0' * 3 + b'\xff\xff\xff\xff'
        out.write('/rosout', (Log._type, cut, Log._md5sum, None, Log), rospy.Time(5), raw=True)
    assert last_log_lines(path, EncodingRules(), [('/a', 2**62)], 9) == [[]]
    with pytest.raises(BagError, match='no such file'):
        last_log_lines(str(tmp_path / 'missing.bag'), EncodingRules(), [], 9)


def test_an_incident_has_the_log_and_the_commands(evidence_model: str, bag: str,
                                                  tmp_path: Path) -> None:
    found = section(judged(with_graph(evidence_model, tmp_path / 'm'), bag), 'x')
    steps = found.details[found.incidents[0].key].next
    assert [(level, text.split()[0]) for _, level, text in steps.log] == [
        ('INFO', 'started'), ('ERROR', 'motor')]
    assert steps.log[1][0] == pytest.approx(11.9, abs=0.1)
    assert steps.play is not None and steps.layout is not None
    command = shlex.split(steps.play)
    assert command[:3] == ['rosbag', 'play', '-s'] and command[-1] == bag
    assert float(command[3]) == pytest.approx(7.0, abs=0.1) and command[4] == '-u'
    layout = ElementTree.fromstring(steps.layout)
    info = layout.find('previouslyLoaded_Datafiles/fileInfo')
    assert info is not None and info.get('filename') == bag
    assert '/scan' in info.find('selected_datasources').get('value').split(';')
    assert list(layout.iter('curve')) == []  # strings have no header with a stamp
    tab, = layout.iter('Tab')
    assert tab.get('tab_name') == '/laser: 7 to 27 s'


def test_plotjuggler_takes_the_layout_without_a_question(evidence_model: str,
                                                         tmp_path: Path) -> None:
    """Without this version it asks; settings of bags that are missing here become 0 for good."""
    found = section(dead(evidence_model, tmp_path), 'x')
    layout = ElementTree.fromstring(found.details[found.incidents[0].key].next.layout)
    assert layout.tag == 'root' and layout.get('version') == '2.3.8'
    splitter, = layout.findall('tabbed_widget/Tab/Container/DockSplitter')
    assert int(splitter.get('count')) == len(splitter) == len(splitter.get('sizes').split(';'))
    assert all(area.find('plot').get('mode') == 'TimeSeries' for area in splitter)
    loader, = layout.findall('previouslyLoaded_Datafiles/fileInfo/plugin')
    assert loader.get('ID') == 'DataLoad ROS bags'
    assert {each.tag: each.get('value') for each in loader} == {
        'use_header_stamp': 'false', 'use_renaming_rules': 'true', 'discard_large_arrays': 'true',
        'max_array_size': '100', 'boolean_strings_to_number': 'true',
        'remove_suffix_from_strings': 'true'}


def test_an_event_log_has_no_messages_to_play(evidence_model: str, bag: str,
                                              tmp_path: Path) -> None:
    out = str(tmp_path / 'log.bag')
    assert convert.main([bag, '-o', out]) == 0
    found = section(judged(evidence_model, f'{out}#1'), 'x')
    steps = found.details[found.incidents[0].key].next
    assert (steps.log, steps.play, steps.layout) == ([], None, None)
