"""The evaluation: the same windows, alarms and records for all systems."""
from __future__ import annotations

import numpy as np

from self_awareness import DEFAULT_WINDOW, DetectorParameters, EventType, Learner, PaperModel
from self_awareness.stamps import SECOND_NS
from self_awareness_evaluation.records import WindowedEvents, persistent, settling, stamps_by
from self_awareness_evaluation.simulated import fault_record, graph_of, normal_record
from self_awareness_evaluation.systems import Paper
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


def test_types_not_in_the_vocabulary_are_told_apart_behind_it() -> None:
    recording = robot(20.0, 1)
    camera = EventType('/camera', '/image', 'sensor_msgs/Image')
    encoded = recording.encoded([camera, BATTERY])
    assert encoded.event_types == [camera, BATTERY, LASER]
    assert ([encoded.event_types[id_] for id_ in encoded.ids]
            == [recording.event_types[id_] for id_ in recording.ids])


def test_stamps_of_every_topic() -> None:
    recording = robot(20.0, 1, silent=((8.0, 12.0),))
    by_topic = stamps_by(recording, lambda event_type: event_type.scope)
    assert list(by_topic) == ['/scan', '/battery']
    for id_, stamps in enumerate(by_topic.values()):
        assert np.array_equal(stamps, recording.stamps[recording.ids == id_])
    # A type that never came is left out.
    more = WindowedEvents([*recording.event_types, EventType('/a', '/b', 'c')], recording.stamps,
                          recording.ids, recording.end)
    assert list(stamps_by(more, lambda event_type: event_type)) == [LASER, BATTERY]


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


def test_a_record_knows_who_does_not_subscribe_from_the_onset_on() -> None:
    scenario = load_scenario()
    record = fault_record(scenario, 3, 'unsubscribed:navigation')
    (start, before), (onset, after) = record.recording.subscriptions
    assert start < record.onset == onset
    assert before - after == {('/navigation', '/pose_hypotheses')} and not after - before
    assert record.recording.end >= onset + 60 * SECOND_NS
    normal = normal_record(scenario, 3, 'training 1', 5.0)
    assert [present for _, present in normal.subscriptions] == [before]
    assert {edge[1:] for edge in graph_of(scenario)} <= {(topic, node) for node, topic in before}


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


def test_a_fault_record_begins_its_fault_at_the_onset() -> None:
    record = fault_record(load_scenario(), 3, 'cc1')
    assert record.culprits == ('/player',)
    start = int(record.recording.stamps[0]) // SECOND_NS * SECOND_NS
    assert 50.0 <= (record.onset - start) / SECOND_NS < 52.0
    last = int(record.recording.stamps_of('/player')[-1])
    assert -0.2 < (last - record.onset) / SECOND_NS < 0.05
