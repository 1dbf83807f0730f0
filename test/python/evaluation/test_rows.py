"""What is measured of a system on a record, what rows come to, and what the peers see."""
from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any, List, Optional

import numpy as np
import pytest
from evaluation_robot import BATTERY, LASER, START, robot

from self_awareness import DEFAULT_WINDOW, DetectorParameters, EventType, Learner, PaperModel
from self_awareness.calibration import confidence
from self_awareness.stamps import SECOND_NS
from self_awareness_evaluation.figures import Found, Quiet, rate_interval
from self_awareness_evaluation.records import (NORMAL, SUSPICION, FaultRecord, Judged, Learning,
                                               SystemAlarm, WindowedEvents, persistent, settling)
from self_awareness_evaluation.rows import Row, Subject, fault_row, load, normal_row, save
from self_awareness_evaluation.simulated import normal_record
from self_awareness_evaluation.systems import (Evidence, FrequencyMonitor, GapBounds, GapMonitor,
                                               Paper)
from self_awareness_evaluation.variants import SYSTEMS, Variant
from self_awareness_follow_me.scenario import load_scenario

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
    stands = SystemAlarm(at(74), at(99), False, ['/b', '/a'], '', culprit='/a', kind='silent')
    found = fault_row(SUBJECT, fault_at(70), judged([stands], suspicions=[suspected]))
    assert (found.first, found.right_at_end) == (False, True)
    assert (found.level, found.culprit, found.kind) == ('ERROR', '/a', 'silent')
    # By then it is over, and somebody else is only suspected.
    over = replace(stands, end=at(80), cleared=True)
    later = replace(suspected, start=at(90), end=at(99), cleared=False)
    found = fault_row(SUBJECT, fault_at(70), judged([over], suspicions=[later]))
    assert (found.level, found.culprit, found.right_at_end) == (SUSPICION, '/b', False)
    found = fault_row(SUBJECT, fault_at(70), judged([over]))
    assert (found.level, found.right_at_end) == ('', None)
    nobody = replace(stands, culprit='', kind='busy machine')
    assert fault_row(SUBJECT, fault_at(70), judged([nobody])).right_at_end is False


def test_who_dies_is_to_blame_until_the_end() -> None:
    system = Evidence(set())
    system.train([robot(60.0, 1), robot(60.0, 2)])
    system.calibrate([robot(60.0, 3)])
    onset = START + 20_000_000_000
    record = FaultRecord('crash', ('/player',), robot(40.0, 4, silent=((20.0, 40.0),)), onset)
    found = fault_row(SUBJECT, record, system.judge(record.recording), 1)
    assert (found.first, found.right_at_end, found.kind) == (True, True, 'silent')
    assert found.latency_s is not None and 0.0 < found.latency_s < 1.0


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


def test_windows_and_counts_are_those_of_the_detector() -> None:
    recording = robot(20.0, 1, silent=((8.0, 12.0),))
    learner = Learner(paper=True)
    learner.count(recording.events)
    trained = learner.model()
    verdicts = PaperModel(trained).judge(DEFAULT_WINDOW, None, DetectorParameters(),
                                         recording.encoded(trained.event_types).events)
    assert np.array_equal(recording.starts(), verdicts.start)
    assert len(verdicts.start) == 200
    assert np.array_equal(settling(recording), verdicts.settling)
    assert settling(recording).sum() == 51  # the first event comes after the window begins


def test_an_unknown_source_is_blamed() -> None:
    system = Paper()
    system.train([robot(60.0, 1), robot(60.0, 2)])
    system.calibrate([robot(60.0, 3)])
    recording = robot(60.0, 4)
    flood = START + np.arange(30 * 200, dtype=np.int64) * 5_000_000 + 30 * SECOND_NS
    stamps = np.concatenate([recording.stamps, flood])
    ids = np.concatenate([recording.ids, np.full(len(flood), 2, dtype=np.uint32)])
    order = np.argsort(stamps, kind='stable')
    intruder = EventType('/intruder', '/flood', 'std_msgs/String')
    result = system.judge(WindowedEvents([LASER, BATTERY, intruder], stamps[order], ids[order],
                                         recording.end))
    assert result.alarms[0].suspects[0] == '/intruder'


def test_alarms_of_peers_are_those_that_the_detector_raises() -> None:
    system = Paper()
    system.train([robot(60.0, 1), robot(60.0, 2)])
    system.calibrate([robot(60.0, 3)])
    # The first silence ends, so that its alarm clears; the second lasts to the end.
    recording = robot(60.0, 4, silent=((1.0, 2.0), (20.0, 24.0), (50.0, 60.0)))
    found = system.judge(recording).alarms
    assert [alarm.cleared for alarm in found] == [True, False]
    said = system.verdicts(recording)
    assert said.abnormal[said.settling].any()
    alarms = persistent(said.start, said.abnormal & ~said.settling)
    assert ([(each.start, each.end, each.cleared) for each in alarms]
            == [(each.start, each.end, each.cleared) for each in found])


def test_every_record_differs_and_can_be_repeated() -> None:
    scenario = load_scenario()
    first = normal_record(scenario, 1, 'training 1', 5.0)
    again = normal_record(scenario, 1, 'training 1', 5.0)
    assert np.array_equal(first.stamps, again.stamps)
    assert all(kind.is_message for kind in first.event_types), 'what is held ready is none'
    for seed, name in ((1, 'training 2'), (2, 'training 1')):
        other = normal_record(scenario, seed, name, 5.0)
        assert not np.array_equal(first.stamps, other.stamps)
        # Each is a start of the robot of its own.
        assert abs(int(first.stamps[0]) - int(other.stamps[0])) > 3000 * SECOND_NS


def steady(seconds: float, rate: float) -> WindowedEvents:
    """Return a recording of one topic without any jitter, from half a period on."""
    stamps = START + np.round((np.arange(seconds * rate) + 0.5) / rate * SECOND_NS)
    return WindowedEvents([EventType('/camera', '/image', 'sensor_msgs/Image')],
                          stamps.astype(np.int64), np.zeros(len(stamps), dtype=np.uint32),
                          START + round(seconds * SECOND_NS))


@pytest.mark.parametrize('name', SYSTEMS)
def test_the_crash_of_the_only_fast_topic_is_seen_and_normal_operation_is_quiet(name: str) -> None:
    system = Variant(name).make(set())
    system.train([robot(100.0, 1), robot(100.0, 2)])
    system.calibrate([robot(200.0, 3)])
    alarm, = system.judge(robot(60.0, 4, silent=((30.0, 60.0),))).alarms
    assert 0.0 < (alarm.start - START) / SECOND_NS - 30.0 < 2.0
    assert alarm.suspects is not None and alarm.suspects[0] == '/player'
    assert not alarm.cleared
    assert system.judge(robot(100.0, 5)).alarms == []


def test_the_frequency_monitor_takes_its_limits_from_the_recordings() -> None:
    monitor = FrequencyMonitor()
    monitor.train([steady(30.0, 10.0), steady(30.0, 11.0)])
    assert monitor.bounds['/image'] == (49, 56)
    assert monitor.scores(steady(30.0, 9.0))[-1] == pytest.approx(-(49 - 45) / 49)
    assert monitor.scores(steady(30.0, 12.6))[-1] == pytest.approx(-(63 - 56) / 56)
    slow = FrequencyMonitor()
    slow.train([steady(60.0, 1.0)])
    assert slow.bounds['/image'] == (4, 6)


def test_irregular_topics_have_no_frequency() -> None:
    gaps = np.resize([0.05, 0.3], 200)
    stamps = START + np.round(np.cumsum(gaps) * SECOND_NS).astype(np.int64)
    recording = WindowedEvents([EventType('/human', '/speech', 'std_msgs/String')], stamps,
                               np.zeros(200, dtype=np.uint32), int(stamps[-1]) + 1)
    monitor = FrequencyMonitor()
    monitor.train([recording])
    assert monitor.bounds == {}


def test_rates_may_leave_what_was_seen_by_a_quarter() -> None:
    bounds = GapBounds(1e9, 40.0, 60.0)
    counts = np.array([np.nan, 29.0, 30.0, 75.0, 90.0])
    assert bounds.deviation(np.zeros(5), counts).tolist() == pytest.approx(
        [0.0, 1.0 / 30.0, 0.0, 0.0, 0.2])
    # Where a quarter is less than one event, it takes more than one event.
    slow = GapBounds(1e9, 2.0, 3.0)
    assert slow.deviation(np.zeros(4), np.array([0.0, 1.0, 4.0, 5.0])).tolist() \
        == pytest.approx([1.0, 0.0, 0.0, 0.25])
    # A recording shorter than the span says nothing about the rate.
    short = GapBounds(1e9, np.inf, 0.0)
    assert short.deviation(np.array([0.0, 2.5e9]), np.array([3.0, 0.0])).tolist() == [0.0, 1.0]


def test_the_gap_monitor_learns_from_the_calibration_too() -> None:
    monitor = GapMonitor()
    monitor.train([steady(30.0, 10.0)])
    slow = steady(30.0, 7.0)
    assert monitor.abnormal(slow).mean() > 0.5
    monitor.calibrate([slow])
    assert not monitor.abnormal(slow).any()
    assert not monitor.abnormal(steady(30.0, 10.0)).any()
