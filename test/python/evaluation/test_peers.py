"""The peers of the evaluation: what each sees, and what its bounds are."""
from __future__ import annotations

import numpy as np
import pytest

from self_awareness import EventType
from self_awareness.stamps import SECOND_NS
from self_awareness_evaluation.records import WindowedEvents
from self_awareness_evaluation.systems import FrequencyMonitor, GapBounds, GapMonitor
from self_awareness_evaluation.variants import SYSTEMS, Variant

from evaluation_robot import START, robot


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


def test_gaps_may_last_a_quarter_longer_than_ever_seen() -> None:
    monitor = GapMonitor()
    monitor.train([steady(30.0, 10.0)])
    bounds, = monitor.bounds.values()
    assert bounds == (0.1 * SECOND_NS, 50, 50)
    ages = np.array([np.nan, 0.124, 0.125, 0.25]) * SECOND_NS
    assert bounds.deviation(ages, np.full(4, 50.0)).tolist() == pytest.approx([0.0, 0.0, 0.0, 1.0])


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
