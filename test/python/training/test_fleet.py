"""Learned on some robots, watching another: names are replaced, and a start is of one robot."""
from __future__ import annotations

import json
from pathlib import Path
from typing import Iterable

import pytest
from conftest import Message, error_of, jittery_robot, printed_by, trained, write_bag

from self_awareness import EncodingRules, TrainedModel
from self_awareness.commands import calibrate, info, score, train
from self_awareness.parts import BagPart, by_folder
from self_awareness.training.many_bags import Counting
from self_awareness.training.robot_graph import RobotGraph, graph_file

LENGTH_S = 60.0
RENAME = ['--rename', '/r[0-9]+/(.*)', '/\\1']


def of_robot(number: int, start: float) -> Iterable[Message]:
    """What a robot sends in its namespace; the second one has a lidar besides."""
    more = [(start + 0.7 + 0.5 * i, '/lidar', '/cloud') for i in range(int(LENGTH_S / 0.5) - 2)]
    messages = [*jittery_robot(start, LENGTH_S, int(start)), *(more if number == 2 else [])]
    return sorted((stamp, f'/r{number}{source}', f'/r{number}{topic}')
                  for stamp, source, topic in messages)


@pytest.fixture(scope='module', name='folder')
def _folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two recordings of each of four robots, in a folder each, at the same times."""
    folder = tmp_path_factory.mktemp('fleet')
    for number in range(1, 5):
        (folder / f'r{number}').mkdir()
        for start in (10000.0, 20000.0):
            bag = write_bag(folder / f'r{number}' / f'{start:g}.bag',
                            of_robot(number, start + number))
            RobotGraph({f'/r{number}/scan': {f'/r{number}/laser'}},
                       {f'/r{number}/scan': {f'/r{number}/slam'}},
                       {f'/r{number}/laser': f'pc{number}'}).save(graph_file(bag))
    return folder


@pytest.fixture(scope='module', name='fleet')
def _fleet(folder: Path, tmp_path_factory: pytest.TempPathFactory) -> str:
    """A model that was learned on three of them."""
    path = tmp_path_factory.mktemp('model') / 'fleet.model'
    trained([str(folder / f'r{number}') for number in (1, 2, 3)], path, '--robots-by-folder',
            *RENAME)
    return str(path)


def test_one_name_stands_for_that_of_every_robot(fleet: str) -> None:
    model = TrainedModel.load(fleet)
    assert {(kind.source, kind.scope) for kind in model.event_types} == {
        ('/laser', '/scan'), ('/slam', '/map'), ('/battery', '/charge'), ('/lidar', '/cloud')}
    assert model.encoding.rename == [('/r[0-9]+/(.*)', '/\\1')]
    assert model.graph == {('/laser', '/scan', '/slam')}
    assert set(model.hosts) == {'/laser'}
    assert {recording.robot for recording in model.recordings} == {'r1', 'r2', 'r3'}


def test_what_only_some_robots_have_is_named_and_missed_on_none_of_the_others(
        fleet: str, folder: Path, tmp_path: Path, capsys) -> None:
    line = '/lidar: optional, only r2 of 3 robots had it in training'
    said = printed_by(info, [fleet, '--details'])
    assert line in said and 'rename          /r[0-9]+/(.*) to /\\1' in said
    evidence = json.loads(printed_by(info, [fleet, '--json']))['evidence']
    assert evidence['robots'] == ['r1', 'r2', 'r3']
    assert evidence['optional'] == {'/lidar': ['r2']}
    model = TrainedModel.load(fleet)
    lidar = next(each for each in model.coverage() if each.component == '/lidar')
    # Else the recordings of the other robots would be silences of a minute.
    assert lidar.death_found_after is not None and lidar.death_found_after < 20.0
    calibrated = str(tmp_path / 'm')
    assert calibrate.main(['--model', fleet, '--normal', str(folder / 'r4'), '-o', calibrated,
                           '--robots-by-folder']) == 0
    assert [each.robot for each in TrainedModel.load(calibrated).calibration.recordings
            ] == ['r4', 'r4']
    capsys.readouterr()
    assert score.main([str(folder / 'r4'), '--model', calibrated]) == 0
    told = capsys.readouterr()
    assert '/lidar' not in told.out and 'warning' not in told.err


def test_a_rule_that_cannot_be_is_named(folder: Path, tmp_path: Path) -> None:
    error = error_of(train, [str(folder / 'r1'), '-o', str(tmp_path / 'm'), '--rename', '/r(',
                             '/x'])
    assert '--rename: ' in error and "'/r(' is not a regular expression" in error, error


def test_the_rules_of_a_model_stay_when_it_learns_more(folder: Path, fleet: str,
                                                       tmp_path: Path) -> None:
    more = trained([str(folder / 'r4')], tmp_path / 'm', '--add-to', fleet, '--robots-by-folder')
    assert len(more.event_types) == 4 and sorted({robot for robot, *_ in more.heard_in}) == [
        'r1', 'r2', 'r3', 'r4']


def test_the_topic_of_the_mode_is_as_the_renames_leave_it() -> None:
    written = EncodingRules.defaults()
    written.rename = [('/[^/]+/(.*)', '/\\1')]
    written.mode = ('/logic/state', 'data')
    assert Counting(written).renamed(written).mode == ('/logic/state', 'data')
    robots_own = EncodingRules.defaults()
    robots_own.mode = ('/r1/state', 'data')
    counting = Counting(robots_own, rename=(('/r[0-9]+/(.*)', '/\\1'),))
    assert counting.renamed(robots_own).mode == ('/state', 'data')


def test_a_folder_may_have_any_name() -> None:
    part, = by_folder([BagPart('/data/r\x1b1/monday.bag')])
    assert part.robot == 'r\ufffd1'
