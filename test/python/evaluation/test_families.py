"""The robots of the families: what is random in them, what is not, and which faults they have.

What a fault does, message by message, is kept by test_method_version.py.
"""
from __future__ import annotations

from typing import Dict

import numpy as np
import pytest

from self_awareness.stamps import SECOND_NS
from self_awareness_evaluation.families.emissions import Answer, Timer
from self_awareness_evaluation.families.kinds import FAMILIES
from self_awareness_evaluation.families.protocol import (DEATH, NEVER, RESTARTS_IN_S, UNHEARD,
                                                         Records)
from self_awareness_evaluation.families.robot import Output, Robot
from self_awareness_evaluation.families.scene import (CRASH, HALF_RATE, LATE, MISSES, RESTART,
                                                      SILENT, STARVED, Conditions, Fault)
from self_awareness_evaluation.records import Learning, WindowedEvents

POINTS = 'sensor_msgs/PointCloud2'


def draw(family: str, seed: int) -> Robot:
    """Return a robot of a family."""
    return FAMILIES[family].robot(seed)


def small(jitter_s: float = 0.0003, ppm: float = 0.0) -> Robot:
    """Return a robot of a timer at 10 Hz, what answers to it, what to that, and a slow timer."""
    return Robot(7, (
        Output('/driver', '/scan', POINTS, Timer(0.1, jitter_s, ppm=ppm)),
        Output('/driver', '/info', POINTS, Answer(0, 0.0005)),
        Output('/filter', '/map', POINTS, Answer(0, 0.02)),
        Output('/planner', '/path', POINTS, Answer(2, 0.01)),
        Output('/battery', '/charge', POINTS, Timer(1.0)),
    ), subscriptions=frozenset({('/battery', '/planner')}))


def stamps(recording: WindowedEvents) -> Dict[str, np.ndarray]:
    """Return the seconds of the events since the full hour before, by topic."""
    seconds = (recording.stamps - recording.stamps[0] // (3600 * SECOND_NS) * 3600 * SECOND_NS) \
        / SECOND_NS
    return {kind.scope: seconds[recording.ids == id_]
            for id_, kind in enumerate(recording.event_types)}


def same(first: WindowedEvents, second: WindowedEvents) -> bool:
    """Return whether two recordings are the same."""
    return (first.event_types == second.event_types and first.end == second.end
            and np.array_equal(first.stamps, second.stamps)
            and np.array_equal(first.ids, second.ids))


@pytest.mark.parametrize('name', FAMILIES)
def test_every_family_can_be_repeated_and_is_recorded_in_order(name: str) -> None:
    robot = draw(name, 3)
    recording = robot.start(5, 60.0, begin_s=100.0)
    assert same(recording, draw(name, 3).start(5, 60.0, begin_s=100.0))
    assert not same(recording, draw(name, 4).start(5, 60.0, begin_s=100.0))
    other = robot.start(6, 60.0)
    # Starts are apart in time, by more than how long they may last.
    assert other.stamps[0] > recording.end
    assert not np.array_equal(other.stamps - other.end, recording.stamps - recording.end)
    assert (np.diff(recording.stamps) >= 0).all()
    assert recording.end - 60 * SECOND_NS <= recording.stamps[0] <= recording.stamps[-1] \
        < recording.end
    first = [int(np.flatnonzero(recording.ids == id_)[0])
             for id_ in range(len(recording.event_types))]
    assert first == sorted(first)
    assert recording.ids.max() == len(recording.event_types) - 1
    topics = {(output.source, output.topic) for output in robot.outputs}
    for publisher, topic, subscriber in robot.graph:
        assert (publisher, topic) in topics and subscriber in robot.sources - {publisher}
    assert {*robot.regular, *robot.answering} <= robot.sources


def test_families_are_as_large_and_as_fast_as_they_say() -> None:
    large = draw('large', 1)
    assert len({output.source for output in large.outputs}) == 60
    assert len(large.outputs) == 250
    assert 1200.0 < len(large.start(1, 20.0).stamps) / 20.0 < 2800.0
    assert len(draw('events_only', 1).start(1, 600.0).stamps) / 600.0 < 5.0
    assert all(15 <= len({output.source for output in draw('bursty', seed).outputs}) <= 40
               for seed in range(1, 21))
    names = {output.source.split('/')[1] for output in draw('two_robots', 1).outputs}
    assert names == {'robot1', 'robot2'}


def test_a_clock_that_drifts_changes_the_phase() -> None:
    scan = stamps(small(ppm=50.0).start(1, 3600.0))['/scan']
    assert scan[-1] - scan[0] == pytest.approx((len(scan) - 1) * 0.1 * (1 + 50e-6), abs=0.01)


def test_rates_wander_within_bounds() -> None:
    robot = Robot(7, (Output('/driver', '/scan', POINTS, Timer(0.1, wander=0.05)),))
    scan = stamps(robot.start(1, 7200.0))['/scan']
    rates = [np.sum((scan >= begin) & (scan < begin + 60.0)) / 60.0
             for begin in np.arange(scan[0], scan[-1] - 60.0, 60.0)]
    assert 9.4 < min(rates) < 9.9 and 10.1 < max(rates) < 10.6
    assert max(rates) - min(rates) > 0.3
    assert np.abs(np.diff(rates)).max() < 0.1


def test_periods_vary_without_a_grid() -> None:
    robot = Robot(7, (Output('/driver', '/scan', POINTS, Timer(0.1, variation=0.02)),))
    gaps = np.diff(stamps(robot.start(1, 600.0))['/scan'])
    assert gaps.mean() == pytest.approx(0.1, rel=0.002)
    assert gaps.std() == pytest.approx(0.002, rel=0.2)


def test_the_graph_and_who_can_break() -> None:
    robot = small()
    assert robot.graph == {('/driver', '/scan', '/filter'), ('/filter', '/map', '/planner'),
                           ('/battery', '/charge', '/planner')}
    assert robot.regular == ['/driver', '/filter', '/planner', '/battery']
    assert robot.answering == ['/filter', '/planner']
    events = draw('events_only', 1)
    assert all('watchdog' in source for source in events.regular)
    assert len(events.answering) == 9
    assert set(draw('servers', 1).answering) == {'/server0', '/server1'}  # clients ask themselves
    driving = draw('driving_docked', 1).regular
    assert '/motion0' not in driving and '/planner0' in driving


@pytest.mark.parametrize('kind', [CRASH, HALF_RATE, LATE, MISSES, STARVED, SILENT])
@pytest.mark.parametrize('name', ['timers', 'stalled_loops', 'wireless', 'bursty', 'rate_modes',
                                  'servers'])
def test_nothing_changes_before_the_onset(name: str, kind: str) -> None:
    robot = draw(name, 2)
    source = '' if kind in (STARVED, SILENT) else robot.answering[0]
    normal = robot.start(1, 60.0)
    faulty = robot.start(1, 60.0, Fault(kind, source, 30.0))
    before = normal.stamps < normal.end - 30 * SECOND_NS
    number = int(before.sum())
    assert np.array_equal(normal.stamps[before], faulty.stamps[:number])
    assert faulty.end == normal.end
    # What was sent just before it may come after it.
    assert (len(faulty.stamps) < number + 5) == (kind == SILENT)


def test_who_is_hit_later_needs_nobody_who_was_hit() -> None:
    assert small().strangers_of('/battery', 3) == ('/driver',)
    assert small().strangers_of('/filter', 3) == ('/battery',)
    assert small().strangers_of('/planner', 3) == ()


def test_who_is_started_again_is_watched_for_long() -> None:
    records = Records('timers', 1)
    found = list(records.faults((RESTART,)))
    assert [fault.source for fault in found] == records.robot.regular
    for fault in found[:3]:
        assert fault.back is not None
        times = fault.recording.stamps_of(fault.source)
        assert fault.back == fault.onset + int(RESTARTS_IN_S) * SECOND_NS
        assert not ((times > fault.onset) & (times < fault.back)).any()
        assert (times > fault.back).any()
        assert fault.recording.end - fault.back == 180 * SECOND_NS


def test_what_is_latched_comes_at_every_start_but_that_with_the_fault() -> None:
    records = Records('everyday', 1)
    assert records.robot.latching == ['/map_server'] and '/map_server' not in records.robot.seldom
    for recording in records.training(Learning(2, 60.0, 1, 60.0)):
        assert len(recording.stamps_of('/map_server')) == 1
    absent = next(records.faults((NEVER,)))
    assert not len(absent.recording.stamps_of(absent.source))
    assert absent.onset <= absent.recording.stamps[0] < absent.onset + SECOND_NS


def test_one_recording_to_train_on_has_a_hole() -> None:
    records = Records('hole', 1)
    recordings = records.training(Learning(2, 60.0, 1, 60.0))
    guilty, other = ([np.diff(stamps(recording)[f'{source}/data']).max()
                      for recording in recordings]
                     for source in (records.robot.regular[0], '/driver4'))
    assert guilty[0] > 5.9 > 2.5 > guilty[1]
    assert max(other) < 1.0


def test_a_link_has_a_heavy_tail_and_nothing_overtakes() -> None:
    sent = np.arange(20_000) * 0.1
    conditions = Conditions(heavy=0.01)
    delays, near = (conditions.transport(sent, over_link, np.random.default_rng(1)) - sent
                    for over_link in (True, False))
    assert np.median(near) < 0.0003 and 0.003 < np.median(delays) < 0.006
    assert (delays > 5.0 * np.median(delays)).mean() == pytest.approx(0.01, abs=0.003)
    fast = conditions.transport(np.arange(20_000) * 0.001, True, np.random.default_rng(1))
    assert (np.diff(fast) >= 0.0).all()


def test_a_load_makes_work_take_longer_and_shorter_again() -> None:
    robot = Robot(7, small().outputs, Conditions(load_period_s=3600.0, most_load=3.0))
    recorded = stamps(robot.start(1, 3600.0))
    number = np.searchsorted(recorded['/scan'], recorded['/map'][1:]) - 1
    delays = recorded['/map'][1:] - recorded['/scan'][number]
    by_minute = [np.median(part) for part in np.array_split(delays, 60)]
    assert min(by_minute) == pytest.approx(0.02, abs=0.001)
    assert max(by_minute) == pytest.approx(0.06, abs=0.002)


def test_the_recorder_stalls_with_its_host() -> None:
    robot = draw('second_stalls', 3)
    recording = robot.start(5, 3600.0)
    stalls = [each for each in recording.waiting if each[2]]
    assert stalls and len(recording.waiting) == 2 * len(stalls)
    for begin, end, waited in stalls:
        assert 0.8 <= waited / SECOND_NS <= 1.5
        assert not ((recording.stamps > begin) & (recording.stamps < end)).any()
        assert ((recording.stamps >= end) & (recording.stamps < end + SECOND_NS // 100)).any()
    edges = [edge for begin, end, _ in recording.waiting for edge in (begin, end)]
    assert edges == sorted(edges)
    assert not draw('timers', 3).start(5, 60.0).waiting


def test_wrong_times_are_refused() -> None:
    robot = small()
    with pytest.raises(ValueError, match='not in a start'):
        robot.start(1, 60.0, begin_s=90_000.0)
    with pytest.raises(ValueError, match='nothing happens'):
        Robot(1, small().outputs[4:]).start(1, 0.001)


def test_robots_of_one_make_are_the_same_but_for_a_node_of_their_own() -> None:
    records = Records('one_make', 3)
    learning = Learning(2, 60.0, 1, 60.0)
    learned = [*records.training(learning), *records.calibration(learning)]
    watched = [*records.watched(60.0 / 3600.0),
               *(fault.recording for fault in records.faults((CRASH,), most=1))]
    own = [{kind.source for kind in recording.event_types} - records.robot.sources
           for recording in [*learned, *watched]]
    assert all(len(nodes) == 1 for nodes in own)
    assert len(set().union(*own[:3])) == 3, 'each is another robot'
    assert own[3] == own[4] and not own[3] & set().union(*own[:3])
    assert {kind.source for kind in learned[0].event_types} >= set(records.robot.regular)


@pytest.mark.parametrize('family,learned_in,watched_in',
                         [('timers', 4, 4), ('timers_one_start', 1, 4), ('stalls', 1, 1)])
def test_recordings_are_of_as_many_starts_as_the_family_says(family: str, learned_in: int,
                                                             watched_in: int) -> None:
    records = Records(family, 1)
    learning = Learning.of(3, 20.0, 20.0)
    learned, watched = ([recording.stamps[0] / SECOND_NS for recording in recordings]
                        for recordings in ([*records.training(learning),
                                            *records.calibration(learning)],
                                           list(records.watched(0.51))))
    assert len(learned) == 4 and len(watched) == 2
    # Starts lie more than a day apart, recordings of one start do not overlap.
    assert 1 + (np.diff(learned) > 86_400.0).sum() == learned_in
    assert 1 + (np.diff([learned[0], *watched]) > 86_400.0).sum() == (
        3 if watched_in == 4 else watched_in)
    assert min(np.diff(learned)) > 20.0


def test_watched_hours_are_those_that_were_asked_for() -> None:
    lengths = [(recording.end - recording.stamps[0]) / SECOND_NS
               for recording in Records('events_only', 1).watched(1.25)]
    assert lengths == pytest.approx([1800.0, 1800.0, 900.0], abs=5.0)


def test_every_component_has_its_faults() -> None:
    records = Records('bursty', 2)
    robot = records.robot
    found = [(fault.kind, fault.source) for fault in records.faults((CRASH, HALF_RATE, LATE))]
    assert found == [
        *((kind, source) for kind in (CRASH, HALF_RATE) for source in robot.regular),
        *((LATE, source) for source in robot.regular if source in robot.answering)]
    # Which faults are left out does not change the others, and those that are left are spread.
    late = next(records.faults((LATE,))).recording
    assert same(late, next(fault.recording for fault in records.faults((CRASH, LATE))
                           if fault.kind == LATE))
    some = [fault.source for fault in records.faults((CRASH,), 3)]
    count = len(robot.regular)
    assert some == [robot.regular[index] for index in (0, count // 3, 2 * count // 3)]


def test_a_death_counts_from_the_first_message_that_is_missing() -> None:
    deaths = list(Records('events_only', 1).faults((DEATH, UNHEARD)))
    assert 8 <= len(deaths) <= 16
    for death in deaths:
        heard = death.recording.stamps_of(death.source)
        assert (heard < death.onset).all()
        assert (len(heard) == 0) == (death.kind == UNHEARD)
        assert death.onset < death.recording.end - 60 * SECOND_NS


@pytest.mark.parametrize('gap_s, however_slow, lost', [(0.1, 0.0, 0.1), (0.2, 0.0, 0.0),
                                                       (0.1, 0.2, 0.1), (2.0, 0.2, 0.2)])
def test_queues_lose_what_comes_soon_after_another_and_links_lose_however_slow(
        gap_s: float, however_slow: float, lost: float) -> None:
    received = Conditions(lost=0.1, lost_however_slow=however_slow).received(
        np.arange(5000) * gap_s, np.random.default_rng(1))
    assert 1.0 - received.mean() == pytest.approx(lost, abs=0.02)
