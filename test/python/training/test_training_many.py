"""Training on many bags: in this process, in several, without bad bags, and on top of a model."""
from __future__ import annotations

import pickle
from collections import Counter
from pathlib import Path
from typing import Callable, List, Tuple

import numpy as np
import pytest
import rosbag
from conftest import jittery_robot, learned, robot, train_tuned, write_bag

from self_awareness import (EncodingRules, EventType, EvidenceModel, Learner,
                            TrainedModel, Tuning, read_events)
from self_awareness.commands import train
from self_awareness.training.robot_graph import RobotGraph

LENGTH_S = 40.0


@pytest.fixture(scope='module', name='bags')
def _bags(tmp_path_factory: pytest.TempPathFactory) -> List[str]:
    """Five recordings; what each of them has that the others lack comes at different times."""
    folder = tmp_path_factory.mktemp('many')
    paths = []
    for index in range(5):
        start = 10000.0 * (index + 1)
        extra = [(start + index + 1.5 * i, f'/extra_{"abc"[index % 3]}', '/e') for i in range(20)]
        paths.append(write_bag(folder / f'{index}.bag',
                               sorted([*jittery_robot(start, LENGTH_S, index), *extra])))
    return paths


def trained(bags: List[str], output: Path, *options: str) -> TrainedModel:
    assert train.main([*bags, '-o', str(output), *options]) == 0
    return TrainedModel.load(str(output))


def test_counts_and_limits_are_those_of_one_process(bags: List[str], tmp_path: Path) -> None:
    alone = trained(bags, tmp_path / 'alone', '--jobs', '1')
    together = trained(bags, tmp_path / 'together', '--jobs', '3')
    assert learned(together) == learned(alone)
    assert [each.bag for each in together.recordings] == [f'{i}.bag' for i in range(5)]
    one, other = alone.calibration, together.calibration
    assert np.array_equal(one.limits, other.limits, equal_nan=True)
    assert np.isfinite(one.limits).any()
    assert (one.false_alarms_per_hour, one.windows) == (other.false_alarms_per_hour, other.windows)


def test_bags_counted_apart_are_what_one_training_counts(bags: List[str], tmp_path: Path) -> None:
    learner = Learner(encoding=EncodingRules.defaults())
    for bag, recording in zip(bags, trained(bags, tmp_path / 'm').recordings):
        events = read_events(bag, EncodingRules.defaults())
        learner.count(events.event_types, events.stamps, events.ids, recording.fingerprint,
                      attributes=events.attributes, bag=recording.bag)
    assert learned(TrainedModel.load(str(tmp_path / 'm'))) == learned(learner.model())


def test_a_learning_ends_with_its_model() -> None:
    learner = Learner()
    events = [EventType('', '/a', '')], np.arange(3), np.zeros(3)
    learner.count(*events)
    learner.model()
    calls: List[Callable[[], object]] = [learner.model, lambda: learner.count(*events)]
    for more in calls:
        with pytest.raises(RuntimeError, match='is over'):
            more()


@pytest.mark.parametrize('jobs', ['1', '2'])
def test_a_single_bag_is_cut_in_two(bags: List[str], jobs: str, tmp_path: Path) -> None:
    events = read_events(bags[0], EncodingRules.defaults())
    model = trained(bags[:1], tmp_path / 'm', '--jobs', jobs)
    learner = Learner(encoding=EncodingRules.defaults())
    learner.count(events.event_types, events.stamps, events.ids, model.recordings[0].fingerprint,
                  attributes=events.attributes, bag=model.recordings[0].bag)
    for half in (0, 1):
        counts = EvidenceModel.of_all_pairs(model, half)
        counted = sum(counts.events(k) for k in range(len(model.event_types)))
        assert 0.4 < counted / len(events.stamps) < 0.6
    assert learned(model) == learned(learner.model())


@pytest.mark.parametrize('jobs', ['1', '3'])
def test_bad_bags_are_named_and_skipped_if_asked_for(bags: List[str], make_bag, jobs: str,
                                                     tmp_path: Path, capsys) -> None:
    cut = tmp_path / 'cut.bag'
    cut.write_bytes(Path(bags[0]).read_bytes()[:3000])
    one_event = make_bag('one.bag', [(1.0, '/a', '/b')])
    missing = str(tmp_path / 'missing.bag')
    named = [str(cut), bags[0], missing, bags[1], bags[2], one_event, bags[3]]
    expected = learned(trained(bags[:4], tmp_path / 'good'))
    capsys.readouterr()
    output = tmp_path / 'm'
    model = trained(named, output, '--skip-bad', '--jobs', jobs)
    assert learned(model) == expected  # halves and all
    said = capsys.readouterr()
    warnings = said.err.splitlines()
    assert len(warnings) == 3
    for bad, warning in zip((str(cut), missing, one_event), warnings):
        assert warning.startswith(f'train: warning: skipped: {bad}: ')
        assert warning.split('warning: ')[1] in said.out  # told when it happened, too

    before = output.read_bytes()
    assert train.main([*named, '-o', str(output), '--jobs', jobs]) == 1
    errors = capsys.readouterr().err.splitlines()  # of what is seen before the work
    assert [error.split(': ')[:3] for error in errors] == [['train', 'error', str(cut)],
                                                           ['train', 'error', missing]]
    assert output.read_bytes() == before


def test_a_bag_that_is_left_alone_is_trained_on_as_such(bags: List[str], tmp_path: Path) -> None:
    missing = str(tmp_path / 'missing.bag')
    model = trained([missing, bags[1]], tmp_path / 'm', '--skip-bad', '--jobs', '2')
    assert learned(model) == learned(trained([bags[1]], tmp_path / 'alone'))


def test_nothing_but_bad_bags_is_an_error(tmp_path: Path, capsys) -> None:
    missing = [str(tmp_path / f'{i}.bag') for i in range(2)]
    assert train.main([*missing, '--skip-bad', '-o', str(tmp_path / 'm')]) == 1
    assert capsys.readouterr().err.splitlines() == [
        f'train: error: {path}: no such file' for path in missing]
    assert not (tmp_path / 'm').exists()


def test_the_same_recording_is_found_whoever_counted_it(bags: List[str], tmp_path: Path,
                                                        capsys) -> None:
    again = tmp_path / 'again.bag'
    again.symlink_to(bags[0])
    assert train.main([*bags, str(again), '--jobs', '3', '-o', str(tmp_path / 'm')]) == 1
    assert f'{again}: the same recording as {bags[0]}' in capsys.readouterr().err


def test_values_of_a_type_field_are_too_many_together(make_bag: Callable[..., str],
                                                      tmp_path: Path, capsys) -> None:
    bags = [make_bag(f'{i}.bag', [(i + 0.001 * k, '/a', '/b') for k in range(600)],
                     text=f'{i}-{{}}') for i in (1, 2)]
    encoding = tmp_path / 'e.yaml'
    encoding.write_text('type_fields: {std_msgs/Header: frame_id}\n')
    arguments = ['--encoding', str(encoding), '-o', str(tmp_path / 'm')]
    for jobs in ('1', '2'):
        assert train.main([*bags, *arguments, '--jobs', jobs]) == 1
        error = capsys.readouterr().err
        assert bags[1] in error and 'more than 1000 values' in error


def test_more_is_added_to_a_model(bags: List[str], tmp_path: Path, capsys) -> None:
    whole = trained(bags, tmp_path / 'whole', '--bin', '0.02', '--window', '0.2', '--horizon', '5')
    model = tmp_path / 'm'
    trained(bags[:3], model, '--bin', '0.02', '--window', '0.2', '--horizon', '5')
    continued = trained(bags[3:], model, '--add-to', str(model))
    assert learned(continued) == learned(whole)  # the halves go on in turn
    found = continued.calibration
    assert [each.bag for each in found.recordings] == ['3.bag', '4.bag']
    assert found.windows < whole.calibration.windows
    assert [path.name for path in tmp_path.iterdir() if path.name.startswith('m')] == ['m']


@pytest.mark.parametrize('compression', [rosbag.Compression.BZ2, rosbag.Compression.LZ4])
def test_a_damaged_chunk_is_told_and_its_bag_left_out(bags: List[str], compression: str,
                                                      tmp_path: Path, capsys) -> None:
    bad = tmp_path / 'bad.bag'
    write_bag(bad, jittery_robot(70000.0, LENGTH_S, 7), compression=compression)
    content = bytearray(bad.read_bytes())
    at = content.index(b'compression=') + 1000
    content[at:at + 100] = bytes(100)
    bad.write_bytes(content)
    assert train.main([bags[0], str(bad), '-o', str(tmp_path / 'm')]) == 1
    error = capsys.readouterr().err
    assert error.count('\n') == 1 and f'{bad}: ' in error and 'chunk 1 of ' in error
    model = trained([bags[0], str(bad)], tmp_path / 'm', '--skip-bad')
    told = capsys.readouterr().err
    assert len(model.recordings) == 1 and f'skipped: {bad}: ' in told and 'chunk 1 of ' in told


def test_limits_of_a_model_do_not_outlast_what_is_added(bags: List[str], robot_bags,
                                                        evidence_model: str,
                                                        tmp_path: Path) -> None:
    model = trained([robot_bags[0]], tmp_path / 'm', '--add-to', evidence_model)
    assert model.calibration is None  # 30 s are too little for others
    assert len(model.recordings) == 2


def test_the_graph_is_kept_unless_another_is_asked_for(bags: List[str], tmp_path: Path,
                                                       monkeypatch) -> None:
    output = tmp_path / 'm'
    model = trained(bags[:1], output)
    model.graph = {('/laser', '/scan', '/slam')}
    model.save(str(output))
    assert trained(bags[1:2], output, '--add-to', str(output)).graph == model.graph
    monkeypatch.setattr('self_awareness.training.live_graph.fetch',
                        lambda: RobotGraph({'/x': {'/a'}}, {'/x': {'/b'}}))
    again = trained(bags[2:3], output, '--add-to', str(output), '--graph')
    assert again.graph == {('/a', '/x', '/b')}


def test_what_is_in_the_model_already_is_not_added(bags: List[str], tmp_path: Path,
                                                   capsys) -> None:
    model = tmp_path / 'm'
    trained(bags[:2], model, '--end', '20')
    before = model.read_bytes()
    assert train.main([bags[1], '--add-to', str(model), '-o', str(model)]) == 1
    error = capsys.readouterr().err
    assert bags[1] in error and '1.bag, which the model was trained on' in error
    assert model.read_bytes() == before
    assert len(trained([bags[1]], model, '--add-to', str(model), '--start', '21').recordings) == 3


def test_the_tuning_of_a_model_stays_when_more_is_added(bags: List[str], tmp_path: Path) -> None:
    def most_watched(model: TrainedModel) -> int:
        return max(Counter(track.to_id for track in EvidenceModel(model).tracks
                           if track.name == 'pairs').values())

    base = train_tuned(bags[:2], tmp_path / 'base', predecessors=1)
    model = trained(bags[2:4], tmp_path / 'm', '--add-to', base, '--jobs', '2')
    assert model.tuning == TrainedModel.load(base).tuning != Tuning()
    assert most_watched(model) == 1 < most_watched(trained(bags[:4], tmp_path / 'default'))


@pytest.mark.parametrize('option', [('--bin', '0.01'), ('--window', '0.1'), ('--horizon', '1'),
                                    ('--encoding', 'e.yaml')])
def test_how_a_model_counts_is_not_changed(option: Tuple[str, str], model_file: str,
                                           bags: List[str], tmp_path: Path, capsys) -> None:
    arguments = [bags[0], '--add-to', model_file, *option, '-o', str(tmp_path / 'm')]
    assert train.main(arguments) == 1
    error = capsys.readouterr().err
    assert option[0] in error and model_file in error
    assert not (tmp_path / 'm').exists()


def test_bags_without_senders_are_not_added_to_a_model_with_sources(
        make_bag, model_file: str, tmp_path: Path, capsys) -> None:
    nameless = make_bag('nameless.bag', robot(10.0), sources=False)
    arguments = [nameless, '--add-to', model_file, '-o', str(tmp_path / 'm')]
    assert train.main(arguments) == 1
    error = capsys.readouterr().err
    assert nameless in error and 'names its sender' in error


@pytest.mark.parametrize('value', ['0', '-1', 'many', '1.5', ''])
def test_there_is_a_number_of_jobs(value: str, bags: List[str], tmp_path: Path, capsys) -> None:
    assert train.main([bags[0], f'--jobs={value}', '-o', str(tmp_path / 'm')]) == 2
    assert '--jobs' in capsys.readouterr().err


def test_a_model_goes_to_another_process_as_it_is(evidence_model: str) -> None:
    model = TrainedModel.load(evidence_model)
    again = pickle.loads(pickle.dumps(model))
    assert again.calibration.limits
    assert learned(again, calibrations=True) == learned(model, calibrations=True)
    with pytest.raises(ValueError, match='another version'):
        TrainedModel.__new__(TrainedModel).__setstate__(b'x' * 100)
