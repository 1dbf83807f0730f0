"""The evaluation beside packaged nodes, without a master: the lists, counting, and the page."""
from __future__ import annotations

import math
import re
import shlex
from dataclasses import replace
from pathlib import Path
from typing import Any, Dict, List, Tuple

import pytest
import rosbag

from self_awareness_evaluation import evaluate
from self_awareness_evaluation.live.samples import ERROR, WARN, Status, Stretch
from self_awareness_evaluation.nodes import drivers, report
from self_awareness_evaluation.nodes.measures import (BURSTS, UNDISTURBED, Promised, Row,
                                                      of_fault, of_quiet)
from self_awareness_evaluation.nodes.session import SessionPlan
from self_awareness_evaluation.nodes.system import (CAMERAS_HZ, FAULTS, HALF_RATE, KILL, LATE,
                                                    NODES, Fault)
from self_awareness_evaluation.pages import written_by

PAGES = Path(__file__).resolve().parents[3] / 'docs' / 'evaluation'
ONSET = 1000.0
PROMISED = Promised(0.4, 33, 34)
QUIET = Stretch(1, UNDISTURBED, ONSET, ONSET + 10.0, load=1.5)
KILLED = Fault(KILL, 'lidar', 5.0)
BROKEN = Stretch(1, KILL, ONSET, ONSET + 5.0, KILLED.culprits)


def statuses(*levels: Tuple[float, int], settled_after_s: float = -2.0) -> List[Status]:
    """Return ten statuses a second, from 2 s before the onset to 12 s after it.

    Args:
        levels: from when on after the onset [s], and which.
        settled_after_s: until then the monitor settles.
    """
    found = []
    for number in range(1, 141):
        after_s = round(0.1 * number - 2.0, 1)
        level = ([0] + [level for begin_s, level in levels if begin_s <= after_s])[-1]
        found.append(Status(ONSET + after_s, ONSET + after_s, level, after_s <= settled_after_s,
                            'overdue', ('/lidar', '/base') if level else (),
                            f'level {level} at {after_s:g}' if level else '',
                            '/lidar' if level else ''))
    return found


def test_names_are_unique_and_faults_are_of_nodes() -> None:
    names = [node.name for node in NODES]
    assert len(set(names)) == len(names)
    assert {node.manager for node in NODES if node.manager} <= set(names)
    by_name = {node.name: node for node in NODES}
    for fault in FAULTS:
        assert not fault.node or fault.node in names
        if fault.kind == HALF_RATE:
            assert fault.node in CAMERAS_HZ, 'others have no rate that can be set'
        if fault.kind == LATE:
            assert by_name[fault.node].program == 'late_relay'


def test_what_drivers_replay_is_made(tmp_path: Path) -> None:
    drivers.write(tmp_path)
    for node in NODES:
        assert not node.file or (tmp_path / node.file).exists()
        if node.package == 'rosbag':
            with rosbag.Bag(str(tmp_path / node.file)) as bag:
                assert set(bag.get_type_and_topic_info().topics) == set(node.topics)


def test_alarms_and_suspicions_of_normal_operation() -> None:
    row = of_quiet(QUIET, PROMISED, statuses((1.0, WARN), (2.0, 0), (4.0, WARN), (5.0, ERROR),
                                             (7.0, WARN), (8.0, 0), (9.0, ERROR), (9.5, 0)))
    assert (row.alarms, row.suspicions) == (2, 1)
    assert (row.expected, row.watched, row.components) == (0.4, 33, 34)
    assert row.standing_s == pytest.approx(2.5)
    assert row.said == ('WARN: level 1 at 1; ERROR, a node is named: level 2 at 5; '
                        'ERROR, a node is named: level 2 at 9')
    assert row.named == 2
    assert (row.lasted_s, row.load) == (pytest.approx(10.0), 1.5)


def test_what_began_earlier_is_not_counted_again() -> None:
    row = of_quiet(QUIET, PROMISED, statuses((-1.0, ERROR), (2.0, WARN), (3.0, 0)))
    assert (row.alarms, row.suspicions, row.said) == (0, 0, '')
    assert row.standing_s == pytest.approx(1.9)
    row = of_quiet(QUIET, PROMISED, statuses((-1.0, WARN), (2.0, ERROR), (3.0, 0)))
    assert (row.alarms, row.suspicions) == (1, 0)


def test_a_suspicion_between_two_alarms_is_none_of_its_own() -> None:
    row = of_quiet(QUIET, PROMISED, statuses((1.0, WARN), (1.5, ERROR), (3.0, WARN), (4.0, ERROR),
                                             (5.0, WARN), (6.0, 0), (7.0, WARN)))
    assert (row.alarms, row.suspicions) == (2, 1)
    assert [text.split(':')[0] for text in row.said.split('; ')] == [
        'ERROR, a node is named', 'ERROR, a node is named', 'WARN']


def test_time_in_which_the_monitor_settles_is_not_judged() -> None:
    assert of_quiet(QUIET, PROMISED, statuses(settled_after_s=4.0)).lasted_s == pytest.approx(6.0)


def test_a_fault_that_is_found_and_clears() -> None:
    row = of_fault(KILLED, BROKEN, ONSET + 6.0,
                   statuses((0.2, WARN), (0.4, ERROR), (8.0, WARN), (9.0, 0)))
    assert row.suspicion_s == pytest.approx(0.2)
    assert row.latency_s == pytest.approx(0.4)
    assert (row.first, row.among_three, row.said) == (True, True, 'level 2 at 0.4')
    assert row.cleared_s == pytest.approx(1.9)


def test_where_this_machine_keeps_its_files_is_not_told() -> None:
    said = [replace(status, message=status.message and f'{status.message}; events in /tmp/a.bag')
            for status in statuses((0.4, ERROR), (3.0, 0))]
    assert of_fault(KILLED, BROKEN, ONSET + 6.0, said).said == 'level 2 at 0.4'
    assert of_quiet(QUIET, PROMISED, said).said == 'ERROR, a node is named: level 2 at 0.4'


def test_a_fault_that_is_not_found_or_does_not_clear() -> None:
    row = of_fault(KILLED, BROKEN, ONSET + 6.0, statuses((0.2, WARN), (3.0, 0)))
    assert (row.latency_s, row.first, row.cleared_s) == (None, None, 0.0)
    row = of_fault(KILLED, BROKEN, ONSET + 6.0, statuses((5.5, ERROR)))
    assert (row.latency_s, row.said, row.cleared_s) == (None, '', math.inf)


def test_a_fault_under_a_standing_alarm_does_not_count() -> None:
    row = of_fault(KILLED, BROKEN, ONSET + 6.0, statuses((-1.0, ERROR)))
    assert 'stood' in row.void and row.latency_s is None and row.said == ''


def test_an_alarm_of_the_machine_names_no_node() -> None:
    said = [replace(status, component='') for status in statuses((1.0, ERROR), (2.0, 0))]
    row = of_quiet(replace(QUIET, kind=BURSTS), PROMISED, said)
    assert (row.fault, row.alarms, row.named) == (BURSTS, 1, 0)
    assert row.said == 'ERROR, no node is named: level 2 at 1'


PLAN = SessionPlan(3, 150.0, 1, 250.0, 60.0, 20.0)
ROWS = [
    Row(UNDISTURBED, '', 1800.0, 1, 2, 9.0, 0.5,
        said='ERROR: this: 1 s; WARN: that: 2 s; ERROR: this: 3 s', load=2.0),
    Row(UNDISTURBED, '', 1800.0, 0, 1, 0.0, 0.5, load=4.0),
    Row(KILL, 'lidar', 10.0, suspicion_s=0.2, latency_s=0.3, first=True, among_three=True,
        cleared_s=2.5, said='silent', suspects='/lidar'),
    Row(LATE, 'late_relay', 20.0, suspicion_s=0.4, note='twice'),
    Row(HALF_RATE, 'rear', 20.0, latency_s=1.0, first=False, among_three=False,
        cleared_s=math.inf, said='a|b'),
    Row(KILL, 'base', 10.0, void='the alarm stood at the onset')]


def test_page_has_a_line_for_normal_operation_and_one_for_each_fault(tmp_path: Path) -> None:
    paths = report.write(tmp_path, PLAN, ROWS, 'the command')
    assert [path.name for path in paths] == ['nodes.csv', 'nodes.md']
    text = paths[1].read_text(encoding='utf-8')
    assert 'the command' in text and 'load average was 0.0 to 4.0' in text
    assert ('| **undisturbed** | 60 min | 3 (3.0 an hour) | 1 (95 %: 0.2 to 5.7 an hour; expected '
            'by calibrate: 0.5) | – | an alarm stood for 9 s (0.25 % of the time) | '
            'ERROR: this (2x); WARN: that (1x) |') in text
    assert '| `lidar` killed (kill -9) | 10 s | 0.20 s | 0.30 s | yes | 2.5 s | silent |' in text
    assert '| `late_relay` relays 60 ms late | 20 s | 0.40 s | none | – | – | – |' in text
    assert '| none | 1.00 s | no | did not clear | a/b |' in text
    assert 'void: the alarm stood' in text and '- `late_relay` relays 60 ms late: twice' in text
    assert 'nan' not in text and 'inf' not in text.split('|')[2]


def test_the_page_tells_which_alarms_named_a_node(tmp_path: Path) -> None:
    quiet = [Row(UNDISTURBED, '', 3600.0, 2, 0, 0.0, 0.5, 33, 34, named=1), ROWS[2],
             Row(BURSTS, '', 1200.0, 1, 3, 0.0, 0.5, named=0)]
    text = report.write(tmp_path, PLAN, quiet, 'the command')[1].read_text(encoding='utf-8')
    assert 'expected by calibrate: 0.5); 1 name a node |' in text
    assert f'| **{BURSTS}** | 20 min |' in text and '); 0 name a node |' in text
    assert 'The model watches 33 of 34 components.' in text
    assert 'rosbag record -a' in text and 'rostopic echo /diagnostics' in text


def test_rows_are_read_as_they_were_written(tmp_path: Path) -> None:
    report.save_csv(tmp_path / 'nodes.csv', ROWS)
    read = report.load_csv(tmp_path / 'nodes.csv')
    assert [repr(row) for row in read] == [repr(_with_floats(row)) for row in ROWS]


def _with_floats(row: Row) -> Row:
    """Return a row whose counts are floats, as they are read."""
    values: Dict[str, Any] = {name: float(value) if type(value) is int else value
                              for name, value in vars(row).items()}
    return Row(**values)


def test_the_page_in_the_repository_is_that_of_its_rows() -> None:
    text = (PAGES / 'nodes.md').read_text(encoding='utf-8')
    command = re.search('`(rosrun self_awareness evaluate (nodes.*))`', text)
    assert command is not None
    plan = evaluate.nodes_plan(evaluate.parser().parse_args(shlex.split(command[2])))
    page = report.page(plan, report.load_csv(PAGES / 'nodes.csv'), command[1])
    # The page alone knows with which version of the method its rows were measured.
    measured, = re.findall('^Written by .*$', text, re.MULTILINE)
    assert text == page.replace(written_by(command[1]), measured)
