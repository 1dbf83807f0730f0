"""The robots of the families: what is random in them, what is not, and what a fault does."""
from __future__ import annotations

from typing import Dict

import numpy as np
import pytest

from self_awareness.stamps import SECOND_NS
from self_awareness_evaluation.families.emissions import Answer, Feedback, Sporadic, Timer
from self_awareness_evaluation.families.kinds import FAMILIES
from self_awareness_evaluation.families.protocol import (DEATH, NEVER, RESTARTS_IN_S, SELDOM,
                                                         UNHEARD, Records)
from self_awareness_evaluation.families.robot import WARNING, Output, Robot
from self_awareness_evaluation.families.scene import (CRASH, FAILS, FLOOD, HALF_RATE, LATE, LOAD,
                                                      LOSSES, MISSES, NOTHING, OLD, OTHER, RESTART,
                                                      SILENT, SLOWER, STALL, STARVED, STOP,
                                                      Conditions, Fault)
from self_awareness_evaluation.records import FaultRecord, Learning, WindowedEvents

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


def test_a_phase_holds_for_a_start() -> None:
    phases = [stamps(small().start(start, 60.0, begin_s=begin))['/scan'] % 0.1
              for start, begin in ((1, 0.0), (1, 600.0), (2, 0.0))]
    assert abs(np.median(phases[0]) - np.median(phases[1])) < 0.0002
    assert abs(np.median(phases[0]) - np.median(phases[2])) > 0.002
    # But what is random is so again.
    assert not np.array_equal(phases[0][:100], phases[1][:100])


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


def test_answers_follow_what_they_answer_to() -> None:
    recorded = stamps(small().start(1, 60.0))
    delays = recorded['/map'][1:500] - recorded['/scan'][np.searchsorted(
        recorded['/scan'], recorded['/map'][1:500]) - 1]
    assert np.median(delays) == pytest.approx(0.02, abs=0.002)
    assert 0.0005 < delays.std() < 0.005


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


def of_fault(kind: str, source: str) -> Dict[str, np.ndarray]:
    """Return how many messages come in 20 s before the onset, in the fault, and after it."""
    recording = stamps(small().start(1, 60.0, Fault(kind, source, 20.0, 40.0)))
    begin = np.floor(recording['/scan'][0])
    return {topic: np.histogram(times - begin, [0.0, 20.0, 40.0, 60.0])[0]
            for topic, times in recording.items()}


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


@pytest.mark.parametrize('kind, left', [(CRASH, 0), (HALF_RATE, 100), (SLOWER, 140)])
def test_a_crash_or_a_lower_rate_is_that_of_who_answers_too(kind: str, left: int) -> None:
    counts = of_fault(kind, '/driver')
    for topic in ('/scan', '/info', '/map', '/path'):
        assert counts[topic].tolist() == pytest.approx([200, left, 200], abs=left and 1), topic
    assert counts['/charge'].tolist() == [20, 20, 20]
    counts = of_fault(kind, '/filter')
    assert counts['/scan'].tolist() == [200, 200, 200]
    assert counts['/path'].tolist() == pytest.approx([200, left, 200], abs=left and 1)


def test_who_misses_inputs_answers_nothing_for_a_second_now_and_then() -> None:
    counts = of_fault(MISSES, '/filter')
    assert counts['/scan'].tolist() == [200, 200, 200]
    for topic in ('/map', '/path'):
        assert counts[topic][[0, 2]].tolist() == [200, 200], topic
        assert 100 < counts[topic][1] < 200, topic
    recording = stamps(small().start(1, 120.0, Fault(MISSES, '/filter', 20.0)))
    pauses = np.diff(recording['/map'])
    pauses = pauses[pauses > 0.2]
    assert len(pauses) > 5 and 0.9 < np.median(pauses) < 1.3


def test_messages_wait_longer_and_longer_on_a_starved_cpu() -> None:
    normal, starved = (stamps(small().start(1, 60.0, fault))
                       for fault in (NOTHING, Fault(STARVED, '', 20.0)))
    number = len(starved['/scan'])
    late = starved['/scan'] - normal['/scan'][:number]
    by_10_s = [part.mean() for part in np.array_split(late, 6)]
    assert by_10_s[0] == by_10_s[1] == 0.0 < by_10_s[2] < by_10_s[3] < by_10_s[4]
    assert 0.1 < by_10_s[5] < 0.5


@pytest.mark.parametrize('kind', [STALL, LOAD, STOP])
def test_something_else_follows_a_crash(kind: str) -> None:
    others = ('/battery',) if kind == STOP else ()
    normal, hit = (stamps(small(jitter_s=0.0).start(1, 60.0, fault)) for fault in (
        NOTHING, Fault(kind, '/filter', 20.0, follows_s=30.0, others=others)))
    begin = normal['/scan'][0]
    assert (hit['/map'] < begin + 20.0).all()
    assert np.array_equal(*(times['/charge'][times['/charge'] < begin + 29.0]
                            for times in (normal, hit)))
    later = hit['/charge'][hit['/charge'] >= begin + 30.0]
    if kind == STOP:
        assert not len(later)
        return
    late = hit['/scan'] - normal['/scan']
    while_it_lasts = (normal['/scan'] > begin + 30.0) & (normal['/scan'] < begin + 32.0)
    assert late[while_it_lasts].mean() > 0.05
    assert late[normal['/scan'] > begin + 33.0].max() < 0.001
    assert (kind == STALL) == (later[0] > begin + 31.9)


def test_who_is_hit_later_needs_nobody_who_was_hit() -> None:
    assert small().strangers_of('/battery', 3) == ('/driver',)
    assert small().strangers_of('/filter', 3) == ('/battery',)
    assert small().strangers_of('/planner', 3) == ()


def test_who_speaks_seldom_is_watched_for_three_of_its_longest_pauses() -> None:
    records = Records('long_pauses', 1)
    assert all('joystick' in source or 'teleop' in source for source in records.robot.seldom)
    for fault in records.faults((SELDOM,), most=1):
        assert (fault.recording.stamps_of(fault.source) < fault.onset).all()
        assert (fault.recording.end - fault.onset) / SECOND_NS > 60.0


def test_who_is_started_again_was_silent_and_has_another_phase() -> None:
    robot = small(jitter_s=0.0)
    normal, again = (stamps(robot.start(1, 60.0, fault))
                     for fault in (NOTHING, Fault(RESTART, '/driver', 20.0, 30.0)))
    shift = again['/scan'][250:450] - normal['/scan'][350:550]
    assert 0.002 < np.median(shift) < 0.098
    for topic in ('/scan', '/info', '/map', '/path'):
        assert np.array_equal(again[topic][:199], normal[topic][:199]), topic
        pauses = np.diff(again[topic])
        assert np.sum(pauses > 1.0) == 1 and 9.9 < pauses.max() < 10.3, topic
        # What answers to it has kept its delay.
        assert np.median(again[topic][250:450] - again['/scan'][250:450]) == pytest.approx(
            np.median(normal[topic][350:550] - normal['/scan'][350:550]), abs=0.001), topic
    assert np.array_equal(again['/charge'], normal['/charge'])


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


def everyday(kind: str, source: str = '') -> FaultRecord:
    """Return the first record of a kind of what people look at first, of a component if one is
    asked for."""
    return next(fault for fault in Records('everyday', 1).faults((kind,))
                if not source or fault.source == source)


@pytest.mark.parametrize('source, usual, other', [
    ('/state_publisher', 'link0, ', ''), ('/navigator', 'status=3', 'status=4'),
    ('/device0', 'level: 0', 'level: 0, 2')])
def test_another_value_comes_in_place_of_the_usual_one(source: str, usual: str,
                                                       other: str) -> None:
    fault = everyday(OTHER, source)
    kinds = fault.recording.event_types
    before, after = ({kinds[id_].type for id_ in fault.recording.ids[those]
                      if kinds[id_].source == source and '[' in kinds[id_].type
                      and 'Log' not in kinds[id_].type}
                     for those in (fault.recording.stamps < fault.onset,
                                   fault.recording.stamps >= fault.onset))
    assert len(before) == len(after) == 1 and before != after
    assert usual in before.pop() and other in after.pop()


def test_four_goals_in_five_fail_where_one_in_twelve_did() -> None:
    fault = everyday(FAILS)
    assert fault.source == '/gripper'
    goals = [index for index, kind in enumerate(fault.recording.event_types)
             if kind.source == fault.source and '[' in kind.type]
    assert len(goals) == 2
    failed, = (index for index in goals
               if fault.recording.event_types[index].type.endswith('=4]'))
    of_goals = np.isin(fault.recording.ids, goals)
    before = of_goals & (fault.recording.stamps < fault.onset)
    after = of_goals & (fault.recording.stamps >= fault.onset)
    assert np.mean(fault.recording.ids[before] == failed) < 0.2
    assert np.mean(fault.recording.ids[after] == failed) == pytest.approx(0.8, abs=0.15)


def test_who_floods_the_log_writes_a_hundred_warnings_a_second() -> None:
    fault = everyday(FLOOD)
    kinds = fault.recording.event_types
    warnings = fault.recording.stamps[np.array(
        [(kind.source, kind.type) == (fault.source, WARNING) for kind in kinds]
    )[fault.recording.ids]]
    assert np.sum(warnings < fault.onset) < 30
    assert np.sum(warnings >= fault.onset) == pytest.approx(6000, abs=60)


def test_what_is_latched_comes_at_every_start_but_that_with_the_fault() -> None:
    records = Records('everyday', 1)
    assert records.robot.latching == ['/map_server'] and '/map_server' not in records.robot.seldom
    for recording in records.training(Learning(2, 60.0, 1, 60.0)):
        assert len(recording.stamps_of('/map_server')) == 1
    absent = everyday(NEVER)
    assert not len(absent.recording.stamps_of(absent.source))
    assert absent.onset <= absent.recording.stamps[0] < absent.onset + SECOND_NS


def test_old_stamps_and_losses_are_those_of_one_component_after_the_onset() -> None:
    robot = draw('everyday', 1)
    source = robot.numbered[0]
    normal, old, lossy = (robot.start(1, 60.0, fault) for fault in (
        NOTHING, Fault(OLD, source, 30.0), Fault(LOSSES, source, 30.0)))
    assert same(normal, old)
    ours = np.isin(normal.ids, [index for index, kind in enumerate(normal.event_types)
                                if kind.source == source])
    after = ours & (normal.stamps >= normal.end - 30 * SECOND_NS)
    assert np.array_equal(normal.attributes != old.attributes, after)
    gone = ~np.isin(normal.stamps, lossy.stamps)
    assert not gone[~after].any() and gone[after].mean() == pytest.approx(0.3, abs=0.1)


def test_one_recording_to_train_on_has_a_hole() -> None:
    records = Records('hole', 1)
    recordings = records.training(Learning(2, 60.0, 1, 60.0))
    guilty, other = ([np.diff(stamps(recording)[f'{source}/data']).max()
                      for recording in recordings]
                     for source in (records.robot.regular[0], '/driver4'))
    assert guilty[0] > 5.9 > 2.5 > guilty[1]
    assert max(other) < 1.0


def test_late_answers_are_late_and_what_follows_too() -> None:
    robot = small()
    normal, late = (stamps(robot.start(1, 60.0, fault))
                    for fault in (NOTHING, Fault(LATE, '/filter', 20.0)))
    assert np.array_equal(normal['/scan'], late['/scan'])
    for topic in ('/map', '/path'):
        shift = late[topic][250:500] - normal[topic][250:500]
        assert np.median(shift) == pytest.approx(0.06, abs=0.001), topic
    assert np.array_equal(normal['/charge'], late['/charge'])


@pytest.mark.parametrize('gap_s, however_slow, lost', [(0.1, 0.0, 0.1), (0.2, 0.0, 0.0),
                                                       (0.1, 0.2, 0.1), (2.0, 0.2, 0.2)])
def test_queues_lose_what_comes_soon_after_another_and_links_lose_however_slow(
        gap_s: float, however_slow: float, lost: float) -> None:
    received = Conditions(lost=0.1, lost_however_slow=however_slow).received(
        np.arange(5000) * gap_s, np.random.default_rng(1))
    assert 1.0 - received.mean() == pytest.approx(lost, abs=0.02)


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


def test_feedback_comes_between_goal_and_result() -> None:
    robot = Robot(7, (
        Output('/client', '/goal', 'std_msgs/String', Sporadic(20.0)),
        Output('/server', '/result', 'std_msgs/String', Answer(0, 1.05, 0.01)),
        Output('/server', '/feedback', 'std_msgs/String', Feedback(1, 0.3)),
    ))
    recorded = stamps(robot.start(1, 3600.0))
    goals, results, feedback = recorded['/goal'], recorded['/result'], recorded['/feedback']
    assert len(goals) == pytest.approx(180, abs=50)
    assert abs(len(results) - len(goals)) <= 1
    assert len(feedback) == pytest.approx(3 * len(goals), abs=3)
    since = feedback[3:] - goals[np.searchsorted(goals, feedback[3:]) - 1]
    assert (since < 1.0).mean() > 0.95


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
