"""The robot in quick motion: the same messages in less time."""
from __future__ import annotations

from collections import Counter

import pytest
from simulated_runs import robot

from self_awareness_follow_me import simulation
from self_awareness_follow_me.speed import sped_up


def test_ten_times_as_fast_it_sends_as_much_in_a_tenth_of_the_time() -> None:
    usual = Counter(event.topic for event in simulation.events(200.0, 1, None, robot()))
    fast = Counter(event.topic for event in simulation.events(20.0, 1, None,
                                                              sped_up(robot(), 10.0)))
    assert set(fast) == set(usual)
    assert sum(fast.values()) == pytest.approx(sum(usual.values()), rel=0.02)
    for topic in ('/odom', '/scan', '/battery', '/pose', '/faces'):
        assert fast[topic] == pytest.approx(usual[topic], rel=0.1), topic


def test_no_time_of_it_is_forgotten() -> None:
    usual = robot()
    assert sped_up(usual, 1.0) == usual
    slow = sped_up(usual, 0.5)
    for spec, twice in zip(usual.components, slow.components):
        for task, longer in zip(spec.tasks, twice.tasks):
            assert longer.jitter == 2.0 * task.jitter
            assert longer.every == (task.every and task.every.times(2.0))
            assert longer.in_view == task.in_view or longer.in_view.stays.median == (
                2.0 * task.in_view.stays.median)
            assert longer.hypothesis == task.hypothesis or longer.hypothesis.discard_after == (
                2.0 * task.hypothesis.discard_after)
            for need, later in zip(task.needs, longer.needs):
                assert later.within == (need.within and 2.0 * need.within)
                assert later.stamps_within == (need.stamps_within and 2.0 * need.stamps_within)
            for output, slower in zip(task.publish + task.otherwise,
                                      longer.publish + longer.otherwise):
                assert slower.takes == output.takes.times(2.0)
                assert slower.waits == output.waits.times(2.0)
    faults, longer_faults = usual.faults, slow.faults
    assert longer_faults.lat.settings == {'delay': 2.0 * faults.lat.settings['delay']}
    assert longer_faults.rs.ramp == 2.0 * faults.rs.ramp
    assert longer_faults.ac.periods == tuple(2.0 * period for period in faults.ac.periods)
    assert longer_faults.ac.offset_ns(2 * 10 ** 9) == pytest.approx(
        2 * faults.ac.offset_ns(10 ** 9), abs=2)
    assert longer_faults.extra.spec.tasks[0].period() == faults.extra.spec.tasks[0].period().times(
        2.0)
    # The machine stays as it is.
    assert (slow.transport, slow.lateness, slow.cpu_share) == (
        usual.transport, usual.lateness, usual.cpu_share)
