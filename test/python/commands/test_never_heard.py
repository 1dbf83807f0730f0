"""A component that does not come: a suspicion when it should have, an alarm long after."""
from __future__ import annotations

import json
from pathlib import Path
from typing import Callable, List

import pytest
from conftest import Message, jittery_robot, write_bag

from self_awareness import TrainedModel
from self_awareness.commands import calibrate, score, train

LENGTH_S = 90.0
LASER = '/laser'


def start(stamp: float, laser_after: float, length: float = LENGTH_S) -> List[Message]:
    """A start of the robot in which laser and slam come so late; without them if infinite."""
    robot = list(jittery_robot(stamp, length, int(stamp)))
    return [message for message in robot
            if message[1] == '/battery' or message[0] >= stamp + laser_after]


@pytest.fixture(scope='module')
def model(tmp_path_factory: pytest.TempPathFactory) -> str:
    """A model of two starts, without the start-up, and with limits by a third."""
    folder = tmp_path_factory.mktemp('starts')
    bags = [write_bag(folder / f'{number}.bag', start(1000.0 * number, after))
            for number, after in ((1, 14.4), (2, 14.6), (3, 12.0))]
    output = str(folder / 'm')
    assert train.main([*bags[:2], '--start', '20', '-o', output]) == 0
    assert calibrate.main(['--model', output, '--normal', bags[2], '-o', output]) == 0
    return output


def test_training_knows_when_each_came_although_it_leaves_the_start_out(model: str) -> None:
    trained = TrainedModel.load(model)
    firsts = dict(zip([kind.source for kind in trained.event_types], trained.calibration.firsts))
    assert firsts[LASER] == pytest.approx(12e9, abs=0.1e9)
    assert firsts['/battery'] == 0


def test_what_does_not_come_is_a_suspicion_and_then_an_alarm(
        model: str, make_bag: Callable[..., str], tmp_path: Path, capsys) -> None:
    bag = make_bag('never.bag', start(5000.0, float('inf'), 180.0))
    said = tmp_path / 'said.json'
    assert score.main([bag, '--model', model, '--details', '--json', str(said)]) == 0
    found = json.loads(said.read_text())['recordings'][0]['alarms']
    assert (found[0]['level'], found[0]['begin_s']) == ('WARN', pytest.approx(2 * 14.6, abs=0.3))
    assert [each['begin_s'] for each in found if each['level'] == 'ERROR'] == [
        pytest.approx(4 * 2 * 14.6, abs=0.5)]
    printed = capsys.readouterr().out
    assert 'never heard' in printed
    assert (f'{LASER} /scan std_msgs/String: not heard since the start, usually within '
            '12 to 14.6 s') in printed
