"""Makes what the replayed drivers and the cameras publish: small bags, and pictures."""
from __future__ import annotations

from pathlib import Path
from typing import Any, Dict, Tuple

import numpy as np
import rosbag
import rospy
from geometry_msgs.msg import TwistStamped
from matplotlib import image
from nav_msgs.msg import Odometry
from sensor_msgs.msg import (BatteryState, CameraInfo, Image, Imu, LaserScan, MagneticField,
                             NavSatFix)

from self_awareness_evaluation.live.packaged_nodes import CAMERAS_HZ

_LENGTH_S = 60.0
_JITTER = 0.02  # of the period, as one standard deviation
_BEGIN_S = 1.0e9  # any time but 0
_SEED = 1
_WIDTH, _HEIGHT = 64, 48
_FOCAL_LENGTH = 60.0  # pixels


def write(folder: Path) -> None:
    """Write everything into a folder that exists; it is the same every time."""
    random = np.random.default_rng(_SEED)
    for name, topics in _bags().items():
        _write_bag(folder / f'{name}.bag', topics, random)
    across, down = np.meshgrid(np.linspace(0.0, 1.0, _WIDTH), np.linspace(0.0, 1.0, _HEIGHT))
    for name in CAMERAS_HZ:
        image.imsave(str(folder / f'{name}.png'),
                     np.dstack([across, down, (across + down > 1.0).astype(float)]))


_Topics = Dict[Tuple[str, ...], Tuple[float, Tuple[Any, ...]]]
"""The rate [Hz] and the messages of topics that are published at the same time."""


def _bags() -> Dict[str, _Topics]:
    info = CameraInfo(height=_HEIGHT, width=_WIDTH, distortion_model='plumb_bob', D=[0.0] * 5,
                      K=[_FOCAL_LENGTH, 0, _WIDTH / 2, 0, _FOCAL_LENGTH, _HEIGHT / 2, 0, 0, 1],
                      P=[_FOCAL_LENGTH, 0, _WIDTH / 2, 0, 0, _FOCAL_LENGTH, _HEIGHT / 2, 0,
                         0, 0, 1, 0], R=[1, 0, 0, 0, 1, 0, 0, 0, 1])
    info.header.frame_id = 'camera'
    depth = Image(height=_HEIGHT, width=_WIDTH, encoding='16UC1', step=2 * _WIDTH,
                  data=np.full((_HEIGHT, _WIDTH), 1500, dtype='<u2').tobytes())
    depth.header.frame_id = 'camera'
    odometry = Odometry(child_frame_id='base_link')
    odometry.header.frame_id = 'odom'
    odometry.pose.pose.orientation.w = 1.0
    scan = LaserScan(angle_min=-1.5, angle_max=1.5, angle_increment=0.02, range_max=10.0,
                     ranges=[2.0] * 151)
    scan.header.frame_id = 'laser'
    return {
        'lidar': {('/scan',): (10.0, (scan,))},
        'imu': {('/imu/data',): (50.0, (Imu(),)), ('/imu/mag',): (20.0, (MagneticField(),))},
        'base': {('/odom',): (20.0, (odometry,)),
                 ('/battery',): (1.0, (BatteryState(),))},
        'gps': {('/fix', '/vel'): (5.0, (NavSatFix(), TwistStamped()))},
        'depth_camera': {('/depth/image_raw', '/depth/camera_info'): (8.0, (depth, info))}}


def _write_bag(path: Path, topics: _Topics, random: np.random.Generator) -> None:
    with rosbag.Bag(str(path), 'w') as bag:
        for names, (rate_hz, messages) in topics.items():
            number = round(_LENGTH_S * rate_hz)
            jitter = np.clip(random.normal(0.0, _JITTER, number), -0.2, 0.2)
            for second in (np.arange(number) + 0.5 + jitter) / rate_hz:
                stamp = rospy.Time.from_sec(_BEGIN_S + float(second))
                for name, message in zip(names, messages):
                    message.header.stamp = stamp
                    bag.write(name, message, stamp)
