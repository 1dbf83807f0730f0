"""A mode that a robot tells when it changes, from bags to alarms."""
from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any, List, Tuple

import pytest
import rosbag
import rospy
from conftest import printed_by, trained
from std_msgs.msg import Int32, String

from self_awareness.commands import calibrate, info, score

DRIVE_S, CHARGE_S, CYCLES = 20.0, 60.0, 4
STATE, PLAN, IMU = '/logic/current_state', '/plan', '/imu'


def write(path: Path, start: float, planner_dies: float = math.inf) -> str:
    """Write a recording of a robot that drives and charges in turn, and plans while it drives.

    It says so when it begins to, latched.

    Args:
        planner_dies: seconds after the start.
    """
    messages: List[Tuple[float, str, str, Any]] = []
    for cycle in range(CYCLES):
        begin = cycle * (DRIVE_S + CHARGE_S)
        messages.append((begin, '/logic', STATE, String('DRIVING')))
        messages.append((begin + DRIVE_S, '/logic', STATE, String('CHARGING')))
        for step in range(round(DRIVE_S / 0.1) - 4):
            at = begin + 0.3 + 0.1 * step + 0.002 * (step * 7 % 5)
            if at < planner_dies:
                messages.append((at, '/planner', PLAN, Int32(step)))
    for step in range(round(CYCLES * (DRIVE_S + CHARGE_S) / 0.1)):
        messages.append((0.007 + 0.1 * step + 0.002 * (step * 3 % 4), '/imu', IMU, Int32(step)))
    with rosbag.Bag(str(path), 'w') as bag:
        for at, source, topic, message in sorted(messages, key=lambda each: each[0]):
            header = {'topic': topic, 'type': message._type, 'md5sum': message._md5sum,
                      'message_definition': message._full_text, 'callerid': source,
                      'latching': '1' if topic == STATE else '0'}
            bag.write(topic, message, rospy.Time.from_sec(start + at), connection_header=header)
    return str(path)


@pytest.fixture(scope='module')
def model(tmp_path_factory: pytest.TempPathFactory) -> str:
    """A model of four recordings that knows the mode."""
    folder = tmp_path_factory.mktemp('mode')
    bags = [write(folder / f'{number}.bag', 10000.0 * number) for number in range(1, 5)]
    encoding, path = folder / 'encoding.yaml', folder / 'robot.model'
    encoding.write_text(f'mode: {{topic: {STATE}, field: data}}\n')
    assert trained(bags[:-1], path, '--encoding', str(encoding)).encoding.mode == (STATE, 'data')
    assert calibrate.main(['--model', str(path), '--normal', bags[-1], '-o', str(path)]) == 0
    return str(path)


def test_a_death_while_it_drives_is_found_soon(model: str, tmp_path: Path) -> None:
    dies, said = DRIVE_S + CHARGE_S + 4.0, tmp_path / 'said.json'
    bag = write(tmp_path / 'dead.bag', 90000.0, planner_dies=dies)
    assert score.main(['--model', model, bag, '--json', str(said)]) == 0
    found = next(alarm for alarm in json.loads(said.read_text())['recordings'][0]['alarms']
                 if alarm['level'] == 'ERROR')
    assert dies < found['begin_s'] < dies + 8.0 and found['culprit'] == '/planner'
    assert 'of the mode DRIVING (/logic/current_state)' in found['reason']
    assert STATE in printed_by(info, [model, '--details'])
