"""What is measured of a stretch of a live session, from statuses to rows; no ROS here."""
from __future__ import annotations

import math
from dataclasses import replace
from typing import List, Tuple

import pytest

from self_awareness_evaluation.live.rows import ERROR, WARN, Incident, Row, Status, measure

ONSET = 1000.0
QUIET = Row('undisturbed', '', onset=ONSET, lasted_s=10.0, load=1.5, alarms=0)
KILLED = Row('killed', 'lidar', onset=ONSET, lasted_s=5.0, recovered_s=6.0)


def said(*levels: Tuple[float, int], settled_after_s: float = -2.0) -> List[Status]:
    """Return ten statuses a second, from 2 s before the onset to 12 s after it.

    Args:
        levels: from when on after the onset [s], and which.
        settled_after_s: until then the monitor settles.
    """
    found = []
    for number in range(1, 141):
        after_s = round(0.1 * number - 2.0, 1)
        level = ([0] + [level for begin_s, level in levels if begin_s <= after_s])[-1]
        name = '/lidar' if level else ''
        found.append(Status(ONSET + after_s, level, after_s <= settled_after_s,
                            ('/base', name) if level else (),
                            f'level {level} at {after_s:g}; events in /tmp/a.bag',
                            name, 'silent' if level else '', 7 if level else 0, events=16))
    return found


def test_a_fault_that_is_found_and_clears() -> None:
    row = measure(KILLED, said((0.2, WARN), (0.4, ERROR), (8.0, WARN), (9.0, 0)),
                  [Incident(1, 3, 0.0, 1.0), Incident(5, 9, ONSET - 60.0, ONSET + 7.5)])
    assert (row.suspicion_s, row.latency_s) == (pytest.approx(0.2), pytest.approx(0.4))
    assert (row.blamed_s, row.first) == (pytest.approx(0.4), False)
    assert row.cleared_s == pytest.approx(1.9)
    assert (row.end_level, row.end_kind, row.end_component) == (ERROR, 'silent', '/lidar')
    assert (row.incident_began_s, row.incident_ended_s) == (-60.0, 7.5)
    assert (row.void, row.events) == ('', 50 * 16)
    assert row.said == 'level 2 at 0.4', 'files of this machine are not told'


def test_a_fault_that_is_not_found_or_does_not_clear() -> None:
    row = measure(KILLED, said((0.2, WARN), (3.0, 0)))
    assert (row.latency_s, row.first, row.said, row.cleared_s) == (None, None, '', 0.0)
    assert (row.suspicion_s, row.end_level) == (pytest.approx(0.2), 0)
    row = measure(KILLED, said((5.5, ERROR)))
    assert (row.latency_s, row.said, row.cleared_s) == (None, '', math.inf)
    assert measure(replace(KILLED, recovered_s=None), said()).cleared_s is None


def test_an_alarm_that_blames_another_node_first() -> None:
    other = [replace(status, component='/base' if status.stamp < ONSET + 2.0 else '/lidar')
             for status in said((1.0, ERROR))]
    row = measure(KILLED, other)
    assert (row.latency_s, row.blamed_s) == (pytest.approx(1.0), pytest.approx(2.0))
    assert measure(replace(KILLED, node='base'), other).first
    assert measure(replace(KILLED, node=''), other).first is None, 'nobody is guilty'


@pytest.mark.parametrize('row, statuses, why', [
    (KILLED, said((-1.0, ERROR), (1.0, 0), (2.0, ERROR)), 'stood'),
    (KILLED, said((1.0, ERROR), settled_after_s=0.0), 'settled'),
    (KILLED, [], 'nothing was said'),
    (replace(KILLED, void='the clock was set'), said((1.0, ERROR)), 'clock')])
def test_faults_that_do_not_count(row: Row, statuses: List[Status], why: str) -> None:
    measured = measure(row, statuses)
    assert why in measured.void and measured.latency_s is None and measured.said == ''


@pytest.mark.parametrize('levels, alarms, suspicions, told', [
    ([(1.0, WARN), (2.0, 0), (4.0, WARN), (5.0, ERROR), (7.0, WARN), (8.0, 0), (9.0, ERROR)], 2, 1,
     'WARN: level 1 at 1; ERROR: level 2 at 5; ERROR: level 2 at 9'),
    # What began earlier is not counted again.
    ([(-1.0, ERROR), (2.0, WARN), (3.0, 0)], 0, 0, ''),
    ([(-1.0, WARN), (2.0, ERROR), (3.0, 0)], 1, 0, 'ERROR: level 2 at 2'),
    # A suspicion between two alarms is none of its own.
    ([(1.0, WARN), (1.5, ERROR), (3.0, WARN), (4.0, ERROR), (5.0, WARN), (6.0, 0), (7.0, WARN)],
     2, 1, 'ERROR: level 2 at 1.5; ERROR: level 2 at 4; WARN: level 1 at 7')])
def test_alarms_and_suspicions_of_normal_operation(levels: List[Tuple[float, int]], alarms: int,
                                                   suspicions: int, told: str) -> None:
    row = measure(QUIET, said(*levels))
    assert (row.alarms, row.suspicions, row.said) == (alarms, suspicions, told)
    assert (row.lasted_s, row.load) == (pytest.approx(10.0), 1.5)


def test_time_in_which_the_monitor_settles_is_not_judged() -> None:
    assert measure(QUIET, said(settled_after_s=4.0)).lasted_s == pytest.approx(6.0)
