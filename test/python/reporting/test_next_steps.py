"""What the report shows an engineer next: the node's log, and the recording at that time."""
from __future__ import annotations

import shlex
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest
import rosbag
import rospy
from conftest import put, write_bag
from judged_recordings import dead, judged, with_graph, without_laser
from rosgraph_msgs.msg import Log

from self_awareness import BagError, EncodingRules, last_log_lines
from self_awareness.commands import convert
from self_awareness.reporting.report.section import section


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
