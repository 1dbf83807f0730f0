"""What is measured of a system on a record, and what rows come to."""
from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any, List, Optional

import numpy as np
import pytest

from self_awareness import DEFAULT_WINDOW
from self_awareness.calibration import confidence
from self_awareness_evaluation.figures import Found, Quiet, rate_interval
from self_awareness_evaluation.records import (NORMAL, SUSPICION, FaultRecord, Judged, Learning,
                                               SystemAlarm, WindowedEvents)
from self_awareness_evaluation.rows import Row, Subject, fault_row, load, normal_row, save
from self_awareness_evaluation.systems import Evidence

from evaluation_robot import START, robot

SUBJECT = Subject('families', 'timers 1', '2 x 60 s + 1 x 60 s', 'evidence', budget=0.5)


def at(window: int) -> int:
    """Return the end of a window [ns]."""
    return START + (window + 1) * DEFAULT_WINDOW


def judged(alarms: List[SystemAlarm], suspicion: Optional[List[int]] = None,
           suspicions: Optional[List[SystemAlarm]] = None) -> Judged:
    """Return 100 windows, of which 50 settle."""
    start = START + DEFAULT_WINDOW * np.arange(100, dtype=np.int64)
    suspicious = np.zeros(100, dtype=bool)
    suspicious[suspicion or []] = True
    return Judged(start, np.arange(100) < 50, alarms, suspicious, suspicions or [])


def fault_at(window: int, back: Optional[int] = None, culprit: str = '/a') -> FaultRecord:
    recording = WindowedEvents([], np.array([START]), np.array([0]), at(99))
    return FaultRecord('crash', (culprit,) if culprit else (), recording, at(window) - 1, back)


def row(**changed: Any) -> Row:
    return replace(Row(SUBJECT, NORMAL, hours=1.0), **changed)


def test_half_as_many_starts_are_calibrated_on_but_one_at_least() -> None:
    assert [Learning.of(starts, 150.0, 60.0).calibrations for starts in (1, 2, 4, 8)] \
        == [1, 1, 2, 4]
    assert str(Learning.of(4, 150.0, 60.0)) == '4 x 150 s + 2 x 60 s'


def test_normal_operation() -> None:
    found = normal_row(SUBJECT, judged(
        [SystemAlarm(at(60), at(70), True, ['/a'], 'answers')], [80, 81, 90],
        [SystemAlarm(at(80), at(82), True, [], 'new mode')]), 0.4, 3, 4)
    assert found.hours == pytest.approx(5.0 / 3600.0)
    assert found.standing_hours == pytest.approx(1.0 / 3600.0)
    assert (found.alarms, found.warnings, found.evidence) == (1, 3, ('answers',))
    assert (found.expected, found.watched, found.components) == (0.4, 3, 4)


def test_who_is_named_though_a_fault_does_not_reach_him() -> None:
    alarms = judged([SystemAlarm(at(80), at(90), True, ['/a', '/b', '/c'])])
    assert fault_row(SUBJECT, fault_at(70), alarms).bystanders is None
    found = fault_row(SUBJECT, replace(fault_at(70), involved=frozenset(('/a', '/c'))), alarms)
    assert found.bystanders == 1
    assert Found([found, row(bystanders=0), row()]).bystanders == (1, 2)


def test_a_fault() -> None:
    alarms = [SystemAlarm(at(60), at(62), True, ['/a'], 'pairs'),
              SystemAlarm(at(80), at(90), True, ['/b', '/a'])]
    found = fault_row(SUBJECT, fault_at(70), judged(alarms), 1)
    assert found.latency_s == pytest.approx(1.0, abs=1e-6)
    assert (found.first, found.among_three, found.stood_before) == (False, True, False)
    # What was before the onset is normal operation.
    assert found.hours == pytest.approx(2.0 / 3600.0)
    assert (found.alarms, found.evidence, found.watched) == (1, ('pairs',), 1)
    found = fault_row(SUBJECT, fault_at(59), judged(alarms))
    assert (found.latency_s, found.first) == (pytest.approx(0.1, abs=1e-6), True)
    found = fault_row(SUBJECT, fault_at(90), judged(alarms))
    assert (found.latency_s, found.first, found.among_three) == (None, None, None)
    found = fault_row(SUBJECT, fault_at(70, culprit=''), judged(alarms))
    assert found.latency_s is not None and found.first is None


def test_a_suspicion_is_told_too() -> None:
    found = judged([], [72])
    of_fault = fault_row(SUBJECT, fault_at(69), found)
    assert (of_fault.latency_s, of_fault.noticed_s) == (None, pytest.approx(0.3))
    # One that stands at the onset is no finding.
    assert fault_row(SUBJECT, replace(fault_at(72), onset=at(72)), found).noticed_s is None


def test_what_is_said_when_the_fault_ends() -> None:
    suspected = SystemAlarm(at(72), at(74), True, ['/b'], '', SUSPICION, '/b', 'late')
    stands = SystemAlarm(at(74), at(99), False, ['/b', '/a'], '', culprit='/a', kind='silent',
                         incident=(at(72), at(99), False))
    found = fault_row(SUBJECT, fault_at(70), judged([stands], suspicions=[suspected]))
    assert (found.first, found.right_at_end) == (False, True)
    assert (found.level, found.culprit, found.kind) == ('ERROR', '/a', 'silent')
    assert (found.opened_s, found.closed_s) == (pytest.approx(0.2, abs=1e-6), None)
    # By then it is over, and somebody else is only suspected.
    over = replace(stands, end=at(80), cleared=True, incident=None)
    later = replace(suspected, start=at(90), end=at(99), cleared=False)
    found = fault_row(SUBJECT, fault_at(70), judged([over], suspicions=[later]))
    assert (found.level, found.culprit, found.right_at_end) == (SUSPICION, '/b', False)
    found = fault_row(SUBJECT, fault_at(70), judged([over]))
    assert (found.level, found.right_at_end) == ('', None)
    assert (found.opened_s, found.closed_s) == (pytest.approx(0.4, abs=1e-6),
                                                pytest.approx(1.0, abs=1e-6))
    nobody = replace(stands, culprit='', kind='busy machine')
    found = fault_row(SUBJECT, fault_at(70), judged([nobody]))
    assert (found.right_at_end, found.excused) == (False, True)


def test_an_incident_begins_with_its_first_suspicion() -> None:
    system = Evidence(set())
    system.train([robot(60.0, 1), robot(60.0, 2)])
    system.calibrate([robot(60.0, 3)])
    onset = START + 20_000_000_000
    record = FaultRecord('crash', ('/player',), robot(40.0, 4, silent=((20.0, 40.0),)), onset)
    found = fault_row(SUBJECT, record, system.judge(record.recording), 1)
    assert (found.first, found.right_at_end, found.kind) == (True, True, 'silent')
    assert found.opened_s is not None and found.latency_s is not None
    assert 0.0 < found.opened_s <= found.latency_s < 1.0 and found.closed_s is None


def test_alarms_for_who_is_back_are_counted_apart() -> None:
    alarms = [SystemAlarm(at(71), at(90), True, ['/a']), SystemAlarm(at(121), at(125), True, []),
              SystemAlarm(at(131), at(140), True, ['/a'])]
    record = fault_at(70, at(80))  # windows of 0.1 s, so 5 s are fifty
    found = fault_row(SUBJECT, record, judged(alarms))
    assert found.latency_s == pytest.approx(0.1, abs=1e-6) and found.after == 1
    found = fault_row(SUBJECT, record, judged(alarms[2:]))
    assert (found.latency_s, found.first, found.after) == (None, None, 1)
    assert fault_row(SUBJECT, fault_at(70), judged(alarms)).after is None


def test_a_false_alarm_that_stands_at_the_onset_is_told() -> None:
    for alarm, stood in ((SystemAlarm(at(60), at(69), True, []), False),
                         (SystemAlarm(at(60), at(71), True, []), True),
                         (SystemAlarm(at(60), at(99), False, []), True),
                         (SystemAlarm(at(71), at(99), False, []), False)):
        assert fault_row(SUBJECT, fault_at(70), judged([alarm])).stood_before == stood


def test_rows_are_read_as_they_were_written(tmp_path: Path) -> None:
    path = tmp_path / 'rows.csv'
    rows = [row(alarms=2, evidence=('a', 'b'), expected=0.25),
            row(fault='crash', source='/a', first=True, latency_s=0.5, level='ERROR'),
            row(refused='too short, or so')]
    save(path, rows, Row)
    assert load(path, Row) == rows
    for text, why in (('part,robot\na,b\n', 'there is no learning'),
                      ('part,robot,learning,system,fault,alarms\na,b,c,d,e,many\n',
                       "alarms is 'many', no number")):
        path.write_text(text, encoding='utf-8')
        with pytest.raises(ValueError, match=f'rows.csv, line 2: {why}'):
            load(path, Row)


def test_robots_that_differ_widen_the_interval() -> None:
    assert rate_interval([(5, 10.0), (5, 10.0)]) == confidence.poisson_rate(10, 20.0)
    # Chi-square is 25 / 5 + 25 / 5 = 10 at one degree of freedom.
    assert rate_interval([(10, 10.0), (0, 10.0)]) == pytest.approx(confidence.poisson_rate(1, 2.0))
    assert rate_interval([(0, 10.0), (0, 10.0)]) == confidence.poisson_rate(0, 20.0)


def test_figures_of_nothing_and_of_what_was_never_found() -> None:
    nothing, none = Quiet([]), Found([])
    assert math.isnan(nothing.per_hour) and math.isnan(nothing.interval[0])
    assert none.records == 0 and math.isnan(none.share()) and math.isnan(none.median_s)
    found = Found([row(stood_before=True), row(), row(latency_s=1.0)])
    assert (found.stood_before, found.within(0.9), found.within(1.0)) == (1, 0, 1)
    assert found.median_s == math.inf, 'what was not found took for ever'
