"""Names of robots' nodes: of fleets, and with numbers that differ from start to start."""
from __future__ import annotations

import json
from pathlib import Path
from typing import Iterable, List, Tuple

import pytest
from conftest import Message, error_of, jittery_robot, printed_by, trained, write_bag

from self_awareness import EncodingRules, EventType, TrainedModel, load
from self_awareness.commands import calibrate, info, merge, score, train
from self_awareness.parts import BagPart, by_folder
from self_awareness.training.many_bags import Counting
from self_awareness.training.numbered_names import Heard, find
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


NUMBERED_S = 40.0
NUMBERS = (48213, 7, 91002, 33333)
PLAIN = '/ns/worker'


def heard(*names: str, start: int = 0, robot: str = '') -> Heard:
    """A recording of nodes, each with a topic in its namespace."""
    return Heard.of(robot, str(start), {EventType(name, f'{name}/state', 'T') for name in names})


@pytest.mark.parametrize('names, one', [
    (['/matlab_global_node_48213', '/matlab_global_node_91002'], '/matlab_global_node'),
    (['/rviz-7', '/rviz-3', '/rviz-7', '/rviz-9', '/rviz-1'], '/rviz'),
    (['/ns/worker_48213', '/ns/worker_5'], '/ns/worker'),
    (['/node_17_main', '/node_18_main'], '/node_main'),
    (['/node_17_291', '/node_18_292'], '/node'),
    (['/cam_1_291', '/cam_1_292'], '/cam_1'),
])
def test_what_differs_by_a_number_from_start_to_start_is_one(names: List[str], one: str) -> None:
    recordings = [heard(name, '/lidar_2', start=start) for start, name in enumerate(names)]
    found, = find(recordings)
    assert found.examples == tuple(sorted(set(names)))
    for each in recordings:
        renamed = each.renamed([found.rename])
        assert renamed.sources == {one, '/lidar_2'}
        assert renamed.scopes == {f'{one}/state', '/lidar_2/state'}


@pytest.mark.parametrize('recordings', [
    [['/camera_1', '/camera_2'], ['/camera_1', '/camera_2']],
    [['/camera_1', '/camera_2'], ['/camera_1'], ['/camera_2']],
    [['/robot_1'], ['/robot_1'], ['/robot_1']],
    [['/robot_1'], ['/robot_1'], ['/robot_2'], ['/robot_2']],  # two robots, of two starts each
    [['/node_1']],
    [['/node_1'], ['/other_2']],
    [['/ns/1'], ['/ns/2']],
])
def test_what_is_numbered_on_purpose_stays(recordings: List[List[str]]) -> None:
    assert find([heard(*names, start=start) for start, names in enumerate(recordings)]) == []


def test_recordings_of_one_start_say_nothing() -> None:
    assert find([heard('/node_1', start=5), heard('/node_2', start=5)]) == []
    assert len(find([heard('/node_1', start=5), heard('/node_1', start=5),
                     heard('/node_2', start=6)])) == 1


def test_a_number_may_be_that_of_a_robot() -> None:
    assert find([heard(f'/base_{number}', start=number, robot=f'r{number}')
                 for number in range(4)]) == []
    assert len(find([heard(f'/base_{number}', start=number, robot='r1')
                     for number in range(4)])) == 1


def test_numbers_within_numbers_are_all_taken_away() -> None:
    names = [[f'/ns_{number}/worker_{2 * number}', f'/ns_{number}/cam_1', f'/ns_{number}/cam_2']
             for number in NUMBERS]
    found = find([heard(*each, start=start) for start, each in enumerate(names)])
    renamed = heard(*names[0]).renamed([each.rename for each in found])
    assert renamed.sources == {'/ns/worker', '/ns/cam_1', '/ns/cam_2'}


def test_a_name_that_is_taken_is_not_given_again() -> None:
    found, = find([heard('/matlab', f'/matlab_{number}', start=number) for number in NUMBERS])
    assert heard('/matlab', '/matlab_4').renamed([found.rename]).sources == {'/matlab',
                                                                             '/matlab_N'}


def numbered_robot(start: float, number: int, until: float = NUMBERED_S) -> Iterable[Message]:
    """The robot, and a node of 10 Hz with a number in its name and that of its topic."""
    name = f'{PLAIN}_{number}'
    more = [(start + 0.003 + 0.1 * i, name, f'{name}/out') for i in range(int(10 * until))]
    return sorted([*jittery_robot(start, NUMBERED_S, number), *more])


@pytest.fixture(scope='module', name='bags')
def _bags(tmp_path_factory: pytest.TempPathFactory) -> List[str]:
    folder = tmp_path_factory.mktemp('numbered')
    return [write_bag(folder / f'{number}.bag', numbered_robot(1000.0 * place, number))
            for place, number in enumerate(NUMBERS, 1)]


def names(model: TrainedModel) -> List[Tuple[str, str]]:
    return sorted((kind.source, kind.scope) for kind in model.event_types)


ONE = [('/battery', '/charge'), ('/laser', '/scan'), (PLAIN, f'{PLAIN}/out'), ('/slam', '/map')]


def test_training_takes_it_as_one_and_says_so(bags, tmp_path: Path, capsys) -> None:
    model = trained(bags, tmp_path / 'm', '--jobs', '2')
    assert names(model) == sorted(ONE)
    assert f'and 1 more: differ by a number alone from start to start: taken as one, {PLAIN} ' in \
        capsys.readouterr().out
    crash = write_bag(tmp_path / 'crash.bag', numbered_robot(9000.0, 51511, 20.0))
    assert [(alarm.kind, alarm.culprit) for alarm in load(str(tmp_path / 'm')).judge(crash)
            if alarm.level == 'ERROR'] == [('silent', PLAIN)]


def test_what_is_added_later_is_the_same(bags, tmp_path: Path) -> None:
    base = tmp_path / 'base'
    trained(bags[:1], base)
    assert names(trained(bags[1:], tmp_path / 'm', '--add-to', str(base))) == sorted(ONE)


def test_models_are_merged_likewise(bags, tmp_path: Path) -> None:
    models = [str(tmp_path / f'{place}.model') for place in range(3)]
    for model, of_model in zip(models, (bags[:1], bags[1:3], bags[3:])):
        trained(of_model, Path(model))
    assert merge.main([*models, '-o', str(tmp_path / 'all')]) == 0
    assert names(TrainedModel.load(str(tmp_path / 'all'))) == sorted(ONE)


def test_a_rename_that_leaves_the_number_is_told(bags, tmp_path: Path, capsys) -> None:
    model = trained(bags, tmp_path / 'm', '--rename', '/ns/(.*)', '/x/\\1')
    assert 'renamed already: let that rule take the number away' in capsys.readouterr().out
    assert len(names(model)) == 3 + len(NUMBERS)
    named = trained(bags, tmp_path / 'm', '--rename', '/ns/worker_[0-9]+(.*)', '/own\\1')
    assert ('/own', '/own/out') in names(named) and len(names(named)) == 4


def test_a_model_that_knows_several_is_told(bags, tmp_path: Path, capsys) -> None:
    apart, other = (trained([bag], tmp_path / f'm{place}')
                    for place, bag in enumerate(bags[:2]))
    apart.merge(other)  # as earlier versions did
    apart.watch()
    apart.save(str(tmp_path / 'apart'))
    model = trained(bags[2:], tmp_path / 'm', '--add-to', str(tmp_path / 'apart'))
    assert 'the model knows several of them' in capsys.readouterr().out
    assert len(names(model)) == 3 + len(NUMBERS)
