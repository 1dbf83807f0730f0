"""`convert`: event logs, which every program reads like the bags that they were made of."""
from __future__ import annotations

import json
import os
import shutil
from pathlib import Path
from typing import Callable, Tuple

import pytest
from conftest import error_of, learned, printed_by, robot, trained

from self_awareness import TrainedModel
from self_awareness.commands import calibrate, convert, info, score, train
from self_awareness.parts import BagPart, expand
from self_awareness.training.robot_graph import RobotGraph, graph_file

Bags = Tuple[str, str]


@pytest.fixture(scope='module')
def log(long_bags: Bags, tmp_path_factory: pytest.TempPathFactory) -> str:
    """An event log of two recordings."""
    path = str(tmp_path_factory.mktemp('log') / 'robot.events.bag')
    assert convert.main([*long_bags, '-o', path]) == 0
    return path


def test_a_log_gives_the_same_model_limits_and_windows(long_bags: Bags, log: str,
                                                       tmp_path: Path) -> None:
    results = []
    for name, parts in (('bag', list(long_bags)), ('log', [f'{log}#1', f'{log}#2'])):
        model, csv = str(tmp_path / f'{name}.model'), tmp_path / f'{name}.csv'
        before = learned(trained([parts[0]], Path(model), '--detector', 'both'), calibrations=True)
        assert calibrate.main(['--model', model, '--normal', parts[1], '-o', model]) == 0
        said = printed_by(score, [parts[1], '--model', model, '--csv',
                                  str(csv)]).replace(parts[1], '')
        windows = csv.read_text().replace(parts[1], '')
        results.append((before, learned(TrainedModel.load(model), calibrations=True), said,
                        windows))
    assert results[0] == results[1]
    assert len(results[0][3].splitlines()) > 1000


def test_who_subscribes_to_what_comes_along(long_bags: Bags, tmp_path: Path) -> None:
    bag, log = str(tmp_path / 'a.bag'), str(tmp_path / 'log.bag')
    shutil.copy(long_bags[0], bag)
    RobotGraph({'/scan': {'/laser'}}, {'/scan': {'/slam', '/recorder_1_1795206536731'}},
               {'/laser': 'base'}).save(graph_file(bag))
    assert convert.main([bag, '-o', log]) == 0
    of_bag, of_log = (trained([path], tmp_path / 'm') for path in (bag, log))
    assert of_bag.hosts['/laser'] == of_log.hosts['/laser'] == 'base'
    assert of_log.graph == of_bag.graph and ('/laser', '/scan', '/slam') in of_bag.graph


def test_the_encoding_of_the_log_is_that_of_the_model(long_bags: Bags, tmp_path: Path) -> None:
    encoding, log, other = (str(tmp_path / name) for name in ('e.yaml', 'log.bag', 'other'))
    Path(encoding).write_text('exclude_topics: [/charge]\n')
    assert convert.main([long_bags[0], '-o', log, '--encoding', encoding]) == 0
    model = trained([log], tmp_path / 'm')
    assert model.encoding.exclude_topics == ['/charge'] and len(model.event_types) == 2
    trained([long_bags[0]], Path(other))
    assert 'another encoding' in error_of(score, [log, '--model', other])
    assert 'another encoding' in error_of(train, [log, '--add-to', other, '-o', other])


def test_a_robot_without_senders_stays_without(make_bag: Callable[..., str], tmp_path: Path,
                                               capsys) -> None:
    bag, log = make_bag('a.bag', robot(1000.0), sources=False), str(tmp_path / 'log.bag')
    assert convert.main([bag, '-o', log]) == 0
    of_bag, of_log = (trained([path], tmp_path / 'm') for path in (bag, log))
    assert of_bag.encoding.source == 'none'
    assert learned(of_log, calibrations=True) == learned(of_bag, calibrations=True)
    said = capsys.readouterr().out
    assert f'{bag}: names no senders: sources are not told apart (source: none)' in said
    assert said.count('no bag names the senders of its messages: sources are not told apart') == 2


def test_info_says_what_is_in_a_log(log: str) -> None:
    assert printed_by(info, [log]) == 'event log    2 recordings, 4 min, nodes: 3\n'
    said = printed_by(info, [log, '--details'])
    for text in ('event log    2 recordings, 4 min, nodes: 3\n',
                 '#2 tuesday.bag: 120.0 s, 5125 events, from 1970-01-01 05:33:20',
                 '20  /laser /scan std_msgs/String', 'event types  3'):
        assert text in said
    found = json.loads(printed_by(info, [log, '--json']))
    assert [recording['robot_start_ns'] for recording in found['recordings']] == [None, None]
    assert found['recordings'][0]['encoding']['source'] == 'callerid'
    assert '--tuning: is for one model' in error_of(info, [log, '--tuning'])


def test_parts_name_the_bag_or_the_recording(log: str, tmp_path: Path) -> None:
    for text, part in (('a.bag', BagPart('a.bag')), ('a@b.bag', BagPart('a@b.bag')),
                       ('a@b.bag@7-9.25', BagPart('a@b.bag', 7.0, 9.25)),
                       ('a.bag#2', BagPart('a.bag', None, None, 1, False))):
        assert BagPart.parse(text) == part
    (tmp_path / 'run@3').touch()
    assert BagPart.parse(str(tmp_path / 'run@3')) == BagPart(str(tmp_path / 'run@3'))
    assert str(BagPart.parse('a.bag#2@3-4')) == 'a.bag#2@3-4'
    assert [str(part) for part in expand([BagPart.parse(log)])] == [f'{log}#1', f'{log}#2']
    for text in (f'{log}#3', f'{log}#0', f'{log}@1-2'):
        with pytest.raises(ValueError, match='recordings'):
            expand([BagPart.parse(text)])


def test_what_is_no_bag_and_what_is_no_log_is_told(robot_bags: Bags, log: str,
                                                   tmp_path: Path) -> None:
    again = str(tmp_path / 'again.bag')
    assert 'is an event log already' in error_of(convert, [log, '-o', again])
    error = error_of(train, [f'{robot_bags[0]}#1', '-o', str(tmp_path / 'm')])
    assert 'no event log' in error and robot_bags[0] in error
    assert os.listdir(tmp_path) == []
