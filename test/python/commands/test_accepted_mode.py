"""A mode that is accepted: `score` judges as the monitor does."""
from __future__ import annotations

import json
import random
from pathlib import Path
from typing import Any, Collection, Dict, List

import pytest
from conftest import Message, write_bag

from self_awareness import Acceptance, accepted_file
from self_awareness.commands import calibrate, score, train
from self_awareness.training.robot_graph import RobotGraph, graph_file

NODES = ('/arm', '/base', '/camera', '/lidar', '/imu')
OFF = NODES[:4]
STOP_S, END_S = 30.0, 50.0


def _recording(path: Path, start: float, seed: int, length: float = 120.0,
               off: Collection[str] = ()) -> str:
    """All send by timers of their own, and some stop; only /imu is heard by somebody."""
    rng = random.Random(seed)
    messages: List[Message] = []
    for number, node in enumerate(NODES):
        stamp = start + rng.uniform(0.0, 0.1)
        while stamp < start + (STOP_S if node in off else length):
            messages.append((stamp, node, f'{node}/out'))
            stamp += rng.uniform(0.08, 0.12) + 0.003 * number
    graph = RobotGraph({f'{node}/out': {node} for node in NODES},
                       {'/imu/out': {'/base'}})
    graph.save(graph_file(str(path)))
    return write_bag(path, sorted(messages))


@pytest.fixture(name='model', scope='module')
def _model(tmp_path_factory: pytest.TempPathFactory) -> str:
    folder = tmp_path_factory.mktemp('modes')
    bags = [_recording(folder / f'{number}.bag', 10000.0 * (number + 1), number)
            for number in range(3)]
    path = str(folder / 'robot.model')
    assert train.main([*bags[:2], '-o', path]) == 0
    assert calibrate.main(['--model', path, '--normal', bags[2], '-o', path]) == 0
    return path


def _alarms(model: str, bag: str, values: Path) -> List[Dict[str, Any]]:
    assert score.main([bag, '--model', model, '--json', str(values)]) == 0
    found: List[Dict[str, Any]] = json.loads(values.read_text())['recordings'][0]['alarms']
    return found


def test_a_mode_that_is_accepted_is_normal_and_a_death_is_found_as_before(
        model: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    values = tmp_path / 'values.json'
    mode = _recording(tmp_path / 'mode.bag', 50000.0, 7, END_S, OFF)
    dead = _recording(tmp_path / 'dead.bag', 60000.0, 8, END_S, OFF[:1])
    three = _recording(tmp_path / 'three.bag', 70000.0, 9, END_S, OFF[:3])
    new = _alarms(model, mode, values)
    assert 'new mode' in {each['kind'] for each in new}
    before = [_alarms(model, bag, values) for bag in (dead, three)]
    assert all(before) and before[0][0]['culprit'] == '/arm'

    accepted_file.keep([Acceptance(kind='new mode', together=OFF)], model)
    try:
        capsys.readouterr()
        assert _alarms(model, mode, values) == []
        assert ('accepted, so not judged: /arm /base /camera /lidar (new mode)'
                in capsys.readouterr().out)
        assert [_alarms(model, bag, values) for bag in (dead, three)] == before
    finally:
        accepted_file.keep([], model)
