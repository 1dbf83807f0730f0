"""Writes a bag like that of a robot with a camera: large images, and many small messages."""
from __future__ import annotations

import random
from typing import Any, Dict, Iterator, List, NamedTuple, Tuple

import genpy
import rosbag
from geometry_msgs.msg import PoseWithCovarianceStamped, TwistStamped
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Log
from sensor_msgs.msg import BatteryState, CameraInfo, Image, Imu, JointState, MagneticField, Range

START_S = 1_600_000_000
_IMAGE = Image(height=480, width=640, encoding='rgb8', step=1920)
_IMAGE_BYTES = _IMAGE.step * _IMAGE.height
_LOG_EVERY_S = 2.0
_SHORTEST_STEP_S = 1e-5  # between two messages of one topic


class Topic(NamedTuple):
    """What a node publishes each `every` of its cycles, `delay` [s] after the cycle's start."""

    name: str
    kind: Any
    every: int = 1
    delay: float = 0.0


NODES: Dict[str, Tuple[float, List[Topic]]] = {
    '/camera': (10.0, [Topic('/camera/image_raw', _IMAGE),
                       Topic('/camera/camera_info', CameraInfo(D=[0.0] * 5), 1, 0.0005),
                       Topic('/camera/temperature', BatteryState(), 10, 0.001)]),
    '/imu': (200.0, [Topic('/imu/data', Imu()), Topic('/imu/mag', MagneticField(), 4, 0.0004),
                     Topic('/imu/raw', Imu(), 1, 0.0002)]),
    '/base': (100.0, [Topic('/odom', Odometry()), Topic('/joint_states', JointState(), 1, 0.001),
                      Topic('/battery', BatteryState(), 100, 0.002),
                      Topic('/wheel_speed', TwistStamped(), 1, 0.0005)]),
    '/sonar': (40.0, [Topic(f'/sonar/{i}', Range(), 1, 0.002 * i) for i in range(6)]),
    '/filter': (100.0, [Topic('/filter/pose', PoseWithCovarianceStamped()),
                        Topic('/filter/twist', TwistStamped(), 1, 0.0003),
                        Topic('/filter/odom', Odometry(), 2, 0.0006)]),
    '/planner': (20.0, [Topic('/plan/twist', TwistStamped()),
                        Topic('/plan/goal', PoseWithCovarianceStamped(), 40, 0.003),
                        Topic('/plan/state', JointState(), 2, 0.001)]),
    '/arm': (50.0, [Topic('/arm/joint_states', JointState(position=[0.0] * 6)),
                    Topic('/arm/wrench', TwistStamped(), 1, 0.0008),
                    Topic('/arm/goal', JointState(position=[0.0] * 6), 5, 0.002)]),
    '/guard': (25.0, [Topic('/guard/twist', TwistStamped()),
                      Topic('/guard/range', Range(), 1, 0.004),
                      Topic('/guard/state', BatteryState(), 25, 0.001)]),
}
"""Cycles a second and topics, by node; every node also logs from time to time."""


def write(path: str, seconds: float, seed: int) -> int:
    """Write the bag, uncompressed, with rosbag's default size of chunks.

    Returns:
        the number of messages.
    """
    rng = random.Random(seed)
    pixels = rng.getrandbits(8 * _IMAGE_BYTES).to_bytes(_IMAGE_BYTES, 'little')
    messages = sorted(_messages(seconds, rng), key=lambda message: message[0])
    with rosbag.Bag(path, 'w') as bag:
        for stamp, node, topic, kind in messages:
            time = genpy.Time.from_sec(stamp)
            if kind is _IMAGE:
                kind.data = pixels
            bag.write(topic, kind, time, connection_header={
                'topic': topic, 'callerid': node, 'type': kind._type, 'md5sum': kind._md5sum,
                'message_definition': kind._full_text, 'latching': '0'})
    return len(messages)


def _messages(seconds: float, rng: random.Random) -> Iterator[Tuple[float, str, str, Any]]:
    for node, (rate, topics) in NODES.items():
        stamp = START_S + rng.random()
        cycle = 0
        while stamp < START_S + seconds:
            for topic in topics:
                if cycle % topic.every == 0:
                    delay = topic.delay * rng.uniform(0.5, 1.5)
                    yield stamp + delay, node, topic.name, topic.kind
            cycle += 1
            stamp += max(rng.gauss(1.0, 0.03) / rate, _SHORTEST_STEP_S)
        stamp = START_S + rng.expovariate(1.0 / _LOG_EVERY_S)
        log = Log(level=Log.INFO, name=node, msg='nothing out of the ordinary', line=42)
        while stamp < START_S + seconds:
            yield stamp, node, '/rosout', log
            stamp += rng.expovariate(1.0 / _LOG_EVERY_S)
