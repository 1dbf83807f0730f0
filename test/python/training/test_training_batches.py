"""Training on batches of bags, and on top of a model: as if all were counted one by one."""
from __future__ import annotations

import os
import random
from pathlib import Path
from typing import Any, Callable, List, Optional, Tuple

import pytest
import rosbag
import rospy
from conftest import (error_of, jittery_robot, learned, printed_by, put, train_tuned, trained,
                      write_bag)
from std_msgs.msg import String

from self_awareness import EncodingRules, EvidenceModel, Learner, TrainedModel, Tuning, read_events
from self_awareness.commands import convert, train
from self_awareness.parts import BagPart
from self_awareness.recordings import RecordingEvents
from self_awareness.training import many_bags
from self_awareness.training.many_bags import Counting, Trained
from self_awareness.training.robot_graph import RobotGraph
from self_awareness.workers import InProcess, Processes, Workers

BAGS = 9


class InBatches(InProcess):
    """This process, with so many batches of bags."""

    def __init__(self, number: int) -> None:
        self._number = number

    def batches(self, tasks: int) -> int:
        """See Workers."""
        return min(self._number, tasks)


@pytest.fixture(scope='module', name='bags')
def _bags(tmp_path_factory: pytest.TempPathFactory) -> List[str]:
    """Nine recordings, with event types that appear late, and in another order than by name."""
    folder = tmp_path_factory.mktemp('batches')
    paths = []
    for index in range(BAGS):
        start = 10000.0 * (index + 1)
        name = f'/extra_{"abcde"[7 * index % 5]}'
        extra = [(start + index + 1.5 * i, name, '/e') for i in range(20)]
        paths.append(write_bag(folder / f'{index}.bag',
                               sorted([*jittery_robot(start, 30.0, index), *extra])))
    return paths


def counted(bags: List[str], workers: Optional[Workers] = None, **options: Any) -> Trained:
    return many_bags.train([BagPart(bag) for bag in bags], Counting(), workers, **options)


def at_once(bags: List[str]) -> TrainedModel:
    """Return what one training counts that takes all bags, without sums."""
    whole = Learner(encoding=EncodingRules.defaults())
    for bag, recording in zip(bags, counted(bags).model.recordings):
        events = read_events(bag, EncodingRules.defaults())
        whole.count(RecordingEvents(events.event_types, events.stamps, events.ids,
                                    fingerprint=recording.fingerprint, bag=recording.bag,
                                    attributes=events.attributes))
    return whole.model()


def failure(bags: List[str], workers: Workers, **options: Any) -> str:
    with pytest.raises(ValueError) as error:
        counted(bags, workers, **options)
    return str(error.value)


@pytest.mark.parametrize('bad, base', [([], False), ([], True), ([0], True), ([4, 5], False),
                                       ([1, 8], True)])
def test_a_file_is_the_same_however_it_was_counted(bags: List[str], bad: List[int], base: bool,
                                                   tmp_path: Path) -> None:
    named = [f'/nowhere/{i}.bag' if i in bad else bag for i, bag in enumerate(bags)]
    options = ['--skip-bad']
    if base:  # one recording: the next belongs to the second half
        options += ['--add-to', str(tmp_path / 'base')]
        first = write_bag(tmp_path / 'first.bag', jittery_robot(1000.0, 30.0, 77))
        trained([first], tmp_path / 'base')
    one, two = (trained(named, tmp_path / jobs, '--jobs', jobs, *options) for jobs in ('1', '2'))
    assert two.calibration is not None
    assert len(two.recordings) == BAGS - len(bad) + base
    assert learned(two, calibrations=True) == learned(one, calibrations=True)


@pytest.mark.parametrize('batches', [1, 2, 5])
@pytest.mark.parametrize('bad', [[], [0], [2, 3, 4], [0, 1, 5, 8]])
def test_sums_are_what_one_training_counts(bags: List[str], batches: int, bad: List[int]) -> None:
    named = [f'/nowhere/{i}.bag' if i in bad else bag for i, bag in enumerate(bags)]
    said: List[str] = []
    said_one_by_one: List[str] = []
    summed = counted(named, InBatches(batches), skip_bad=True, tell=said.append)
    one_by_one = counted(named, skip_bad=True, tell=said_one_by_one.append)
    good = [bag for bag in named if bag in bags]
    assert learned(summed.model) == learned(at_once(good))
    assert [each.part.path for each in summed.trained_on] == good
    assert said == said_one_by_one and len(said) == BAGS
    assert summed.bad == one_by_one.bad and len(summed.bad) == len(bad)


def test_the_order_of_bags_changes_no_limit(bags: List[str]) -> None:
    found = []
    for order in (bags, random.Random(1).sample(bags, len(bags))):
        of_order = counted(order)
        many_bags.preliminary_limits(of_order)
        names = [str(kind) for kind in of_order.model.event_types]
        found.append({(track.channel, names[track.from_id], names[track.to_id]): repr(limit)
                      for track, limit in zip(EvidenceModel(of_order.model).tracks,
                                              of_order.model.calibration.limits)})
    assert found[0] == found[1]


@pytest.mark.parametrize('batches', [1, 5])
def test_the_first_bad_bag_ends_it(bags: List[str], batches: int) -> None:
    said: List[str] = []
    named = [*bags[:3], '/nowhere/a.bag', bags[3], '/nowhere/b.bag']
    error = failure(named, InBatches(batches), tell=said.append)
    assert error.startswith('/nowhere/a.bag: no such file')
    assert [line.split(':')[0] for line in said] == bags[:3]


@pytest.mark.parametrize('batches', [1, 4])
def test_the_same_recording_is_found_in_batches(bags: List[str], batches: int,
                                                tmp_path: Path) -> None:
    again = tmp_path / 'again.bag'
    again.symlink_to(bags[1])
    error = failure([*bags[:3], str(again), bags[4]], InBatches(batches), skip_bad=True)
    assert error == f'{again}: the same recording as {bags[1]}; name it once'


@pytest.mark.parametrize('batches', [1, 3, 9])
@pytest.mark.parametrize('nameless, named', [([0], 0), ([3], 3), ([1, 2, 3, 4], 1),
                                             ([0, 1, 2], 2)])
def test_the_bag_without_senders_is_named_in_batches(make_bag: Callable[..., str], batches: int,
                                                     nameless: List[int], named: int) -> None:
    bags = [make_bag(f'{i}.bag', jittery_robot(1000.0 * i, 3.0, i), sources=i not in nameless)
            for i in range(5)]
    error = failure(bags, InBatches(batches), skip_bad=True)
    assert error.startswith(f'{bags[named]}: no connection of this bag names its sender')


@pytest.mark.parametrize('workers, expected', [
    (InProcess(), 'xxxxx----'), (InBatches(3), 'xx-xx-x--'), (Processes(2), 'xx--xx---')])
def test_so_many_events_are_kept_for_the_limits(bags: List[str], workers: Workers,
                                                expected: str, monkeypatch) -> None:
    everything = counted(bags)
    events = [each.events.stamps.size for each in everything.trained_on]
    monkeypatch.setattr(many_bags, '_MOST_EVENTS_OF_BATCH', 2 * max(events))
    monkeypatch.setattr(many_bags, '_MOST_EVENTS', 5 * max(events))
    some = counted(bags, workers)
    kept = ''.join('x' if each.events is not None else '-' for each in some.trained_on)
    assert kept == expected
    for each in (everything, some):
        many_bags.preliminary_limits(each)
    assert some.model.calibration is not None
    assert learned(some.model, calibrations=True) == learned(everything.model, calibrations=True)


def test_a_batch_that_takes_the_memory_is_named(bags: List[str], monkeypatch) -> None:
    monkeypatch.setattr(many_bags, '_count', lambda *_: os.kill(os.getpid(), 9))
    error = failure(bags, Processes(2))
    assert error.startswith(f'one of {bags[0]} to {bags[3]}: a process that worked on it')


LENGTH_S = 40.0


@pytest.fixture(scope='module', name='five')
def _five(tmp_path_factory: pytest.TempPathFactory) -> List[str]:
    folder = tmp_path_factory.mktemp('many')
    return [write_bag(folder / f'{index}.bag',
                      jittery_robot(10000.0 * (index + 1), LENGTH_S, index)) for index in range(5)]


def test_more_is_added_to_a_model(five: List[str], tmp_path: Path) -> None:
    whole = trained(five, tmp_path / 'whole', '--bin', '0.02', '--window', '0.2', '--horizon', '5')
    model = tmp_path / 'm'
    trained(five[:3], model, '--bin', '0.02', '--window', '0.2', '--horizon', '5')
    continued = trained(five[3:], model, '--add-to', str(model))
    assert learned(continued) == learned(whole)  # the halves go on in turn
    found = continued.calibration
    assert [each.bag for each in found.recordings] == ['3.bag', '4.bag']
    assert found.windows < whole.calibration.windows
    assert [path.name for path in tmp_path.iterdir() if path.name.startswith('m')] == ['m']


def test_limits_of_a_model_do_not_outlast_what_is_added(five: List[str], robot_bags,
                                                        evidence_model: str,
                                                        tmp_path: Path) -> None:
    model = trained([robot_bags[0]], tmp_path / 'm', '--add-to', evidence_model)
    assert model.calibration is None  # 30 s are too little for others
    assert len(model.recordings) == 2


def test_the_graph_is_kept_unless_another_is_asked_for(five: List[str], tmp_path: Path,
                                                       monkeypatch) -> None:
    output = tmp_path / 'm'
    model = trained(five[:1], output)
    model.graph = {('/laser', '/scan', '/slam')}
    model.save(str(output))
    assert trained(five[1:2], output, '--add-to', str(output)).graph == model.graph
    monkeypatch.setattr('self_awareness.training.robot_graph.fetch',
                        lambda: RobotGraph({'/x': {'/a'}}, {'/x': {'/b'}}))
    again = trained(five[2:3], output, '--add-to', str(output), '--graph')
    assert again.graph == {('/a', '/x', '/b')}


def test_what_is_in_the_model_already_is_not_added(five: List[str], tmp_path: Path) -> None:
    model = tmp_path / 'm'
    trained(five[:2], model, '--end', '20')
    before = model.read_bytes()
    error = error_of(train, [five[1], '--add-to', str(model), '-o', str(model)])
    assert five[1] in error and '1.bag, which the model was trained on' in error
    assert model.read_bytes() == before
    assert len(trained([five[1]], model, '--add-to', str(model), '--start', '21').recordings) == 3


def test_the_tuning_of_a_model_stays_when_more_is_added(five: List[str], tmp_path: Path) -> None:
    def relations(model: TrainedModel) -> int:
        return sum(track.name == 'pairs' for track in EvidenceModel(model).tracks)

    base = train_tuned(five[:2], tmp_path / 'base', least_told=1e6)
    model = trained(five[2:4], tmp_path / 'm', '--add-to', base, '--jobs', '2')
    assert model.tuning == TrainedModel.load(base).tuning != Tuning()
    assert relations(model) == 0 < relations(trained(five[:4], tmp_path / 'default'))


def test_what_is_latched_after_the_end_is_no_part_of_it(tmp_path: Path) -> None:
    bag, log = tmp_path / 'a.bag', tmp_path / 'a.log'
    with rosbag.Bag(str(bag), 'w') as written:
        for stamp, source, topic in jittery_robot(1000.0, 60.0, 1):
            put(written, source, topic, String('x'), stamp)
        header = {'topic': '/lamp', 'type': String._type, 'md5sum': String._md5sum,
                  'message_definition': String._full_text, 'callerid': '/lamp', 'latching': '1'}
        written.write('/lamp', String('on'), rospy.Time(1050), connection_header=header)
    printed_by(convert, [str(bag), '-o', str(log)])
    for path in (bag, log):
        model = trained([str(path)], tmp_path / 'm', '--end', '40')
        assert '/lamp' not in {each.source for each in model.event_types}


@pytest.mark.parametrize('option', [('--bin', '0.01'), ('--window', '0.1'), ('--horizon', '1'),
                                    ('--encoding', 'e.yaml'), ('--detector', 'paper'),
                                    ('--rename', '/a', '/b')])
def test_how_a_model_counts_is_not_changed(option: Tuple[str, ...], model_file: str,
                                           five: List[str], tmp_path: Path) -> None:
    arguments = [five[0], '--add-to', model_file, *option, '-o', str(tmp_path / 'm')]
    error = error_of(train, arguments)
    assert f'{option[0]}: leave it out' in error and model_file in error
    assert not (tmp_path / 'm').exists()
