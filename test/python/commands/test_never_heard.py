"""A component that does not come: a suspicion when it should have, an alarm long after."""
from __future__ import annotations

from typing import Any, Callable, List, Tuple

import pytest
from conftest import Message, jittery_robot

from self_awareness import DetectorParameters, TrainedModel, recordings
from self_awareness.commands import calibrate, score, train
from self_awareness.judging import evidence_judge
from self_awareness.parts import BagPart
from self_awareness.stamps import SECOND_NS

LENGTH_S = 90.0
LASER = '/laser'


def start(stamp: float, laser_after: float, length: float = LENGTH_S) -> List[Message]:
    """A start of the robot in which laser and slam come so late; without them if infinite."""
    robot = list(jittery_robot(stamp, length, int(stamp)))
    return [message for message in robot
            if message[1] == '/battery' or message[0] >= stamp + laser_after]


@pytest.fixture(scope='module', name='model')
def _model(tmp_path_factory: pytest.TempPathFactory) -> str:
    """A model of two starts, without the start-up, and with limits by a third."""
    from conftest import write_bag
    folder = tmp_path_factory.mktemp('starts')
    bags = [write_bag(folder / f'{number}.bag', start(1000.0 * number, after))
            for number, after in ((1, 14.4), (2, 14.6), (3, 12.0))]
    output = str(folder / 'm')
    assert train.main([*bags[:2], '--start', '20', '-o', output]) == 0
    assert calibrate.main(['--model', output, '--normal', bags[2], '-o', output]) == 0
    return output


def judged(model: str, bag: str) -> Tuple[Any, float]:
    """Return the verdicts on a bag, and the stamp of its first message [s]."""
    trained = TrainedModel.load(model)
    recording = recordings.read(trained, BagPart(bag))
    judge = evidence_judge(trained, DetectorParameters())
    return (judge(recording.stamps, recording.ids, recording.end),
            recording.origin / SECOND_NS)


def test_training_knows_when_each_came_although_it_leaves_the_start_out(model: str) -> None:
    calibration = TrainedModel.load(model).calibration
    types = [str(kind).split()[0] for kind in TrainedModel.load(model).event_types]
    firsts = dict(zip(types, calibration.firsts))
    assert firsts[LASER] == pytest.approx(12e9, abs=0.1e9)
    assert firsts['/battery'] == 0


def test_what_does_not_come_is_a_suspicion_and_then_an_alarm(
        model: str, make_bag: Callable[..., str], capsys) -> None:
    bag = make_bag('never.bag', start(5000.0, float('inf'), 180.0))
    verdicts, origin = judged(model, bag)
    suspicious = verdicts.start[verdicts.suspicion] / SECOND_NS - origin
    assert suspicious[0] == pytest.approx(2 * 14.6, abs=0.3)
    alarm, = verdicts.alarms
    assert alarm.begin / SECOND_NS - origin == pytest.approx(4 * 2 * 14.6, abs=0.5)
    assert score.main([bag, '--model', model, '--details']) == 0
    said = capsys.readouterr().out
    assert 'never heard' in said
    assert (f'{LASER} /scan std_msgs/String: not heard since the start, usually within '
            '12 to 14.6 s') in said
