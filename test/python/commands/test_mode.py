"""A mode that a robot tells when it changes, from bags to alarms."""
from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any, Dict, List, Optional, Tuple

import conftest
import pytest
import rosbag
import rospy
from std_msgs.msg import Int32, String

from self_awareness import TrainedModel, encoding_file
from self_awareness.commands import calibrate, convert, info, merge, score, train

DRIVE_S, CHARGE_S, CYCLES = 20.0, 60.0, 4
LENGTH_S = CYCLES * (DRIVE_S + CHARGE_S)
STATE, PLAN, IMU = '/logic/current_state', '/plan', '/imu'
ENCODING = f'mode: {{topic: {STATE}, field: data}}\n'


def write(path: Path, start: float, planner_dies: float = math.inf,
          lost_at: Optional[float] = None) -> str:
    """Write a recording of a robot that drives and charges in turn, and plans while it drives.

    It says so when it begins to, latched. While it is lost, it says that, and plans nothing.

    Args:
        planner_dies, lost_at: seconds after the start; it is lost for 12 s.
    """
    def is_lost(at: float) -> bool:
        return lost_at is not None and lost_at <= at < lost_at + 12.0

    messages: List[Tuple[float, str, str, Any]] = []
    for cycle in range(CYCLES):
        begin = cycle * (DRIVE_S + CHARGE_S)
        messages.append((begin, '/logic', STATE, String('DRIVING')))
        messages.append((begin + DRIVE_S, '/logic', STATE, String('CHARGING')))
        for step in range(round(DRIVE_S / 0.1)):
            at = begin + 0.3 + 0.1 * step + 0.002 * (step * 7 % 5)
            if at < begin + DRIVE_S and at < planner_dies and not is_lost(at):
                messages.append((at, '/planner', PLAN, Int32(step)))
    if lost_at is not None:
        messages.append((lost_at, '/logic', STATE, String('LOST')))
        messages.append((lost_at + 12.0, '/logic', STATE, String('DRIVING')))
    for step in range(round(LENGTH_S / 0.1)):
        messages.append((0.007 + 0.1 * step + 0.002 * (step * 3 % 4), '/imu', IMU, Int32(step)))
    with rosbag.Bag(str(path), 'w') as bag:
        for at, source, topic, message in sorted(messages, key=lambda each: each[0]):
            header = {'topic': topic, 'type': message._type, 'md5sum': message._md5sum,
                      'message_definition': message._full_text, 'callerid': source}
            if topic == STATE:
                header['latching'] = '1'
            bag.write(topic, message, rospy.Time.from_sec(start + at), connection_header=header)
    return str(path)


def learn(folder: Path, bags: List[str], encoding: str) -> str:
    """Train and calibrate; return the model."""
    file = folder / 'encoding.yaml'
    file.write_text(encoding)
    model = str(folder / 'robot.model')
    assert train.main([*bags[:-1], '--detector', 'both', '--encoding', str(file),
                       '-o', model]) == 0
    assert calibrate.main(['--model', model, '--normal', bags[-1], '-o', model]) == 0
    return model


@pytest.fixture()
def encoding(tmp_path: Path) -> str:
    """The file that names the mode."""
    file = tmp_path / 'encoding.yaml'
    file.write_text(ENCODING)
    return str(file)


@pytest.fixture(scope='module')
def normal(tmp_path_factory: pytest.TempPathFactory) -> List[str]:
    folder = tmp_path_factory.mktemp('normal')
    return [write(folder / f'{number}.bag', 10000.0 * number) for number in range(1, 5)]


@pytest.fixture(scope='module')
def model(normal: List[str], tmp_path_factory: pytest.TempPathFactory) -> str:
    return learn(tmp_path_factory.mktemp('mode'), normal, ENCODING)


@pytest.fixture(scope='module')
def plain(normal: List[str], tmp_path_factory: pytest.TempPathFactory) -> str:
    return learn(tmp_path_factory.mktemp('plain'), normal, 'mode: {}\n')


def alarms(model: str, recording: str) -> List[Dict[str, Any]]:
    """Return the alarms of a recording, as `score` says them."""
    output = Path(recording).with_suffix('.json')
    score.main(['--model', model, recording, '--json', str(output)])
    return [alarm for alarm in json.loads(output.read_text())['recordings'][0]['alarms']
            if alarm['level'] == 'ERROR']


def test_a_death_while_it_drives_is_found_soon(model: str, plain: str, tmp_path: Path) -> None:
    dies = DRIVE_S + CHARGE_S + 4.0
    bag = write(tmp_path / 'dead.bag', 90000.0, planner_dies=dies)
    found = alarms(model, bag)
    assert dies < found[0]['begin_s'] < dies + 8.0
    assert found[0]['culprit'] == '/planner'
    assert 'of the mode DRIVING (/logic/current_state)' in found[0]['reason']
    without = alarms(plain, bag)
    assert not without or without[0]['begin_s'] > dies + CHARGE_S


def test_a_mode_that_training_never_saw_is_no_stranger(model: str, tmp_path: Path,
                                                       capsys) -> None:
    bag = write(tmp_path / 'lost.bag', 90000.0, lost_at=2 * (DRIVE_S + CHARGE_S) + 2.0)
    capsys.readouterr()
    assert score.main(['--model', model, bag, '--details']) == 0
    said = capsys.readouterr().out
    assert said.startswith(f'{bag}: ') and ', nothing abnormal\n' in said
    assert said.count('LOST') == 1
    assert ('  modes never seen in training: they say nothing:\n'
            f'    /logic {STATE} std_msgs/String[mode: LOST]: 1\n') in said


def test_the_same_is_said_of_an_event_log(model: str, encoding: str, tmp_path: Path) -> None:
    bag = write(tmp_path / 'dead.bag', 90000.0, planner_dies=DRIVE_S + CHARGE_S + 4.0)
    log = str(tmp_path / 'dead.events.bag')
    assert convert.main([bag, '--encoding', encoding, '-o', log]) == 0
    of_bag, of_log = (alarms(model, recording) for recording in (bag, log))
    assert of_bag and of_bag == of_log


def test_the_model_keeps_what_tells_the_mode(model: str, plain: str, tmp_path: Path,
                                             capsys) -> None:
    assert TrainedModel.load(model).encoding.mode == (STATE, 'data')
    assert encoding_file.values(TrainedModel.load(plain).encoding)['mode'] == {}
    capsys.readouterr()
    assert info.main([model, '--details']) == 0
    assert STATE in capsys.readouterr().out
    assert merge.main([model, plain, '-o', str(tmp_path / 'both.model')]) != 0
    assert 'mode' in capsys.readouterr().err


def test_a_field_that_the_messages_lack_is_named(normal: List[str], tmp_path: Path,
                                                 capsys) -> None:
    file = tmp_path / 'encoding.yaml'
    file.write_text(f'mode: {{topic: {STATE}, field: state_name}}\n')
    assert train.main([normal[0], '--encoding', str(file),
                       '-o', str(tmp_path / 'm')]) != 0
    said = capsys.readouterr().err
    assert STATE in said and 'state_name' in said and '1.bag' in said


def test_a_recording_that_lasts_a_part_knows_the_mode(normal: List[str], encoding: str,
                                                      tmp_path: Path) -> None:
    trained = conftest.trained(normal, tmp_path / 'm', '--start', '3', '--encoding', encoding)
    driving = next(index for index, kind in enumerate(trained.event_types)
                   if str(kind).endswith('[mode: DRIVING]'))
    seconds = len(normal) * (CYCLES * DRIVE_S - 3.0)
    assert trained.gaps(driving) == pytest.approx(seconds, abs=3 * len(normal))
