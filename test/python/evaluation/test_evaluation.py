"""The evaluation: the same windows, alarms and records for all systems, and what its peers see."""
from __future__ import annotations

import numpy as np
import pytest

from self_awareness import DEFAULT_WINDOW, DetectorParameters, EventType, Learner, PaperModel
from self_awareness.stamps import SECOND_NS
from self_awareness_evaluation.records import WindowedEvents, persistent, settling
from self_awareness_evaluation.simulated import normal_record
from self_awareness_evaluation.systems import FrequencyMonitor, GapBounds, GapMonitor, Paper
from self_awareness_evaluation.variants import SYSTEMS, Variant
from self_awareness_follow_me.scenario import load_scenario

from evaluation_robot import BATTERY, LASER, START, robot


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
