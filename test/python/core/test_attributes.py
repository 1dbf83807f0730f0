"""Attributes of messages on their way from bags to alarms (docs/method.md, section 3.10)."""
from __future__ import annotations

from pathlib import Path
from typing import Callable, Dict

import numpy as np
import pytest
import rosbag
import rospy
from conftest import put, train_tuned
from sensor_msgs.msg import PointCloud2
from std_msgs.msg import Header

from self_awareness import load
from self_awareness.commands import calibrate, convert, train

FAULT_S = 60.0
LENGTH_S = 120.0
PERIOD_S = 0.1

Change = Callable[[PointCloud2, PointCloud2], None]
"""Changes a message, given the last one before the fault."""


def stale(message: PointCloud2, last: PointCloud2) -> None:
    message.header.stamp = last.header.stamp


def empty(message: PointCloud2, _: PointCloud2) -> None:
    message.data = b''


def frozen(message: PointCloud2, last: PointCloud2) -> None:
    message.data = last.data


def lossy(message: PointCloud2, _: PointCloud2) -> None:
    message.header.seq += message.header.seq // 50  # 2 of 100


FAULTS: Dict[str, Change] = {'age': stale, 'size': empty, 'frozen': frozen, 'lost': lossy}
WITHIN_S = {'age': 2.0 * PERIOD_S + 1.3, 'size': 5.0, 'frozen': 5.0, 'lost': 30.0}
WORDS = {'age': 'stamps ', 'size': 'messages of about ', 'frozen': 'the same content for ',
         'lost': 'messages missing '}


def record(path: Path, begin: float, seed: int,
           change: Change = lambda message, last: None) -> str:
    """Record a lidar and what follows it; from FAULT_S on, something changes of the lidar."""
    rng = np.random.default_rng(seed)
    last = PointCloud2()
    with rosbag.Bag(str(path), 'w') as bag:
        for number in range(round(LENGTH_S / PERIOD_S)):
            now = begin + number * PERIOD_S + rng.uniform(0.0, 0.004)
            cloud = PointCloud2(data=rng.bytes(int(rng.uniform(20000, 30000))))
            cloud.header = Header(number, rospy.Time.from_sec(now - rng.uniform(0.01, 0.03)), 'l')
            if number * PERIOD_S >= FAULT_S:
                change(cloud, last)
            else:
                last = cloud
            put(bag, '/lidar', '/points', cloud, now)
            put(bag, '/slam', '/map_used', Header(number, cloud.header.stamp, 'm'), now + 0.03)
    return str(path)


@pytest.fixture(scope='module')
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a model of the robot."""
    path = tmp_path_factory.mktemp('attributes')
    bags = [record(path / f'{number}.bag', 10000.0 * (number + 1), number) for number in range(5)]
    assert train.main([*bags[:4], '-o', str(path / 'robot.model')]) == 0
    # Contents that change for minutes change always, so that recordings may be short.
    model = train_tuned(bags[:4], path / 'frozen.model', changing_time=60.0)
    assert calibrate.main(['--model', model, '--normal', bags[4], '-o', model]) == 0
    return path


@pytest.mark.parametrize('channel', FAULTS)
def test_a_fault_is_found_in_bag_and_log(folder: Path, channel: str) -> None:
    bag = record(folder / f'{channel}.bag', 90000.0, 9, FAULTS[channel])
    log = str(folder / f'{channel}.events.bag')
    assert convert.main([bag, '-o', log]) == 0
    system = load(str(folder / ('frozen.model' if channel == 'frozen' else 'robot.model')))
    found = [list(system.judge(recording)) for recording in (bag, log)]
    assert [each.begin for each in found[0]] == [each.begin for each in found[1]]
    first = found[0][0]
    assert first.evidence == channel
    assert first.suspects[0].component == '/lidar'
    assert first.suspects[0].reason.words.startswith(WORDS[channel])
    late = first.begin / 1e9 - 90000.0 - FAULT_S
    assert 0.0 < late <= WITHIN_S[channel]
