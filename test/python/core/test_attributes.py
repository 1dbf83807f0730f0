"""Attributes of messages on their way from bags to alarms (docs/attributes.md)."""
from __future__ import annotations

from pathlib import Path
from typing import Any, Callable, Dict, List

import numpy as np
import pytest
import rosbag
import rospy
from conftest import train_tuned
from sensor_msgs.msg import PointCloud2
from std_msgs.msg import Header

from self_awareness import EncodingRules, EvidenceModel, TrainedModel, read_events
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


def record(path: Path, begin: float, seed: int, length_s: float = LENGTH_S,
           change: Change = lambda message, last: None) -> str:
    """Record a lidar and what follows it; from FAULT_S on, something changes of the lidar."""
    rng = np.random.default_rng(seed)
    last = PointCloud2()
    with rosbag.Bag(str(path), 'w') as bag:
        for number in range(round(length_s / PERIOD_S)):
            now = begin + number * PERIOD_S + rng.uniform(0.0, 0.004)
            cloud = PointCloud2(data=rng.bytes(int(rng.uniform(20000, 30000))))
            cloud.header = Header(number, rospy.Time.from_sec(now - rng.uniform(0.01, 0.03)), 'l')
            if number * PERIOD_S >= FAULT_S:
                change(cloud, last)
            else:
                last = cloud
            _write(bag, '/lidar', '/points', cloud, now)
            _write(bag, '/slam', '/map_used', Header(number, cloud.header.stamp, 'm'), now + 0.03)
    return str(path)


def _write(bag: rosbag.Bag, source: str, topic: str, message: Any, stamp: float) -> None:
    bag.write(topic, message, rospy.Time.from_sec(stamp), connection_header={
        'topic': topic, 'type': message._type, 'md5sum': message._md5sum,
        'message_definition': message._full_text, 'callerid': source})


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


def alarms(folder: Path, recording: str, model: str = 'robot') -> List[Any]:
    from self_awareness import load
    return list(load(str(folder / f'{model}.model')).judge(recording))


def test_the_channels_watch_where_training_says_what_is_usual(folder: Path) -> None:
    model = TrainedModel.load(str(folder / 'frozen.model'))
    watched = {(track.name, model.event_types[track.to_id].source)
               for track in EvidenceModel(model).tracks}
    assert {('age', '/lidar'), ('lost', '/lidar'), ('size', '/lidar'),
            ('frozen', '/lidar')} <= watched


@pytest.mark.parametrize('channel', FAULTS)
def test_a_fault_is_found_in_bag_and_log(folder: Path, channel: str) -> None:
    bag = record(folder / f'{channel}.bag', 90000.0, 9, change=FAULTS[channel])
    log = str(folder / f'{channel}.events.bag')
    assert convert.main([bag, '-o', log]) == 0
    model = 'frozen' if channel == 'frozen' else 'robot'
    found = [alarms(folder, recording, model) for recording in (bag, log)]
    assert [each.begin for each in found[0]] == [each.begin for each in found[1]]
    first = found[0][0]
    assert first.evidence == channel
    assert first.suspects[0].component == '/lidar'
    assert first.suspects[0].reason.words.startswith(WORDS[channel])
    late = first.begin / 1e9 - 90000.0 - FAULT_S
    assert 0.0 < late <= WITHIN_S[channel]


def test_a_log_has_the_attributes_of_its_bag(folder: Path) -> None:
    bag, log = str(folder / '0.bag'), str(folder / '0.events.bag')
    assert convert.main([bag, '-o', log]) == 0
    one = read_events(bag, EncodingRules.defaults())
    other = read_events(log, EncodingRules.defaults(), recording=0)
    assert one.attributes.any()
    assert np.array_equal(one.attributes, other.attributes)


@pytest.mark.parametrize('compression', [rosbag.Compression.NONE, rosbag.Compression.LZ4])
def test_attributes_do_not_depend_on_the_compression(folder: Path, tmp_path: Path,
                                                     compression: str) -> None:
    copy = tmp_path / 'copy.bag'
    with rosbag.Bag(str(folder / '0.bag')) as bag, \
            rosbag.Bag(str(copy), 'w', compression=compression) as packed:
        for topic, message, stamp, header in bag.read_messages(return_connection_header=True):
            packed.write(topic, message, stamp, connection_header=header)
    one, other = (read_events(str(path), EncodingRules.defaults())
                  for path in (folder / '0.bag', copy))
    assert np.array_equal(one.attributes, other.attributes)
