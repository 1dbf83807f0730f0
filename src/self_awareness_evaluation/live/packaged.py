"""Nodes of Debian packages, which nobody here wrote: started, broken and mended."""
from __future__ import annotations

import contextlib
import shlex
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Dict, Iterator, List, Sequence, Tuple

import numpy as np
import rosbag
import rospy
from geometry_msgs.msg import TwistStamped
from matplotlib import image
from nav_msgs.msg import Odometry
from sensor_msgs.msg import (BatteryState, CameraInfo, Image, Imu, LaserScan, MagneticField,
                             NavSatFix)

from self_awareness_evaluation.live.processes import WARM_UP_S, Processes, unregister, wait
from self_awareness_evaluation.live.session import BUSY, Broken, heard, stopped
from self_awareness_follow_me import induction


@dataclass(frozen=True)
class Node:
    """A program of a ROS package."""

    name: str  # of the node, after the first slash
    command: str  # package, program and arguments, as a shell has them after rosrun
    # On which it publishes all the time, with spaces between; those of a nodelet come from its
    # manager.
    topics: str = ''
    file: str = ''  # of write_drivers(), the last argument; empty: none
    manager: str = ''  # node into which it loads a nodelet; empty: none


CAMERAS_HZ = {'front': 15.0, 'rear': 10.0}  # how often the cameras publish

# The kinds of faults.
KILL = 'killed (kill -9)'
STOP = 'stopped (SIGSTOP, SIGCONT)'
RESTART = 'ended and started again at once'
HALF_RATE = 'publishes at half its rate'
STARVE = 'four busy processes on every core'

_PLAY = 'rosbag play --loop --quiet'
_MANAGER = 'nodelet nodelet manager'


def _nodelet(name: str, kind: str, manager: str, arguments: str) -> Node:
    return Node(name, f'nodelet nodelet load {kind} {manager} {arguments}', manager=manager)


NODES = (  # in the order in which they are started
    # Drivers, replayed from bags of a minute, whose stamps vary as those of devices do.
    Node('lidar', _PLAY, '/scan', 'lidar.bag'),
    Node('imu', _PLAY, '/imu/data /imu/mag', 'imu.bag'),
    Node('base', _PLAY, '/odom /battery', 'base.bag'),
    Node('gps', _PLAY, '/fix /vel', 'gps.bag'),
    Node('depth_camera', _PLAY, '/depth/image_raw /depth/camera_info', 'depth_camera.bag'),
    # Cameras, which publish the same picture over and over.
    *(Node(name, f'image_publisher image_publisher _publish_rate:={rate_hz:g}',
           f'/{name}/image_raw /{name}/camera_info', f'{name}.png')
      for name, rate_hz in CAMERAS_HZ.items()),
    # Two managers with nodelets.
    Node('vision', _MANAGER, '/front/image_mono /front/image_color /front/image_rect '
         '/front/preview/image_raw /front/preview/camera_info /front_edges/image'),
    _nodelet('front_debayer', 'image_proc/debayer', 'vision', 'image_raw:=/front/image_raw '
             'image_mono:=/front/image_mono image_color:=/front/image_color'),
    _nodelet('front_rectify', 'image_proc/rectify', 'vision', 'image_mono:=/front/image_mono '
             'camera_info:=/front/camera_info image_rect:=/front/image_rect'),
    _nodelet('front_preview', 'image_proc/crop_decimate', 'vision',
             '_decimation_x:=2 _decimation_y:=2 '
             'camera/image_raw:=/front/image_raw camera/camera_info:=/front/camera_info '
             'camera_out/image_raw:=/front/preview/image_raw '
             'camera_out/camera_info:=/front/preview/camera_info'),
    _nodelet('front_edges', 'opencv_apps/edge_detection', 'vision', 'image:=/front/image_color'),
    Node('depth', _MANAGER, '/depth/image /depth/points /depth/foremost'),
    _nodelet('depth_metric', 'depth_image_proc/convert_metric', 'depth',
             'image_raw:=/depth/image_raw image:=/depth/image'),
    _nodelet('depth_points', 'depth_image_proc/point_cloud_xyz', 'depth',
             'image_rect:=/depth/image camera_info:=/depth/camera_info points:=/depth/points'),
    _nodelet('depth_foremost', 'depth_image_proc/crop_foremost', 'depth',
             'image_raw:=/depth/image_raw image:=/depth/foremost'),
    # The same and more as nodes of their own.
    Node('rear/image_proc', 'image_proc image_proc',
         '/rear/image_mono /rear/image_rect /rear/image_color /rear/image_rect_color'),
    Node('rear_threshold', 'opencv_apps threshold image:=/rear/image_raw',
         '/rear_threshold/image'),
    Node('rear_contours', 'opencv_apps find_contours image:=/rear/image_raw',
         '/rear_contours/contours /rear_contours/image'),
    # Transforms.
    Node('robot_state_publisher', 'robot_state_publisher robot_state_publisher', '/tf'),
    Node('joint_state_publisher', 'joint_state_publisher joint_state_publisher', '/joint_states'),
    Node('gps_mount', 'tf2_ros static_transform_publisher 0 0 0.4 0 0 0 base_link gps'),
    Node('map_to_odom', 'tf static_transform_publisher 0 0 0 0 0 0 map odom 50', '/tf'),
    # An action server and who asks it.
    Node('transforms', 'tf2_ros buffer_server',
         '/tf2_buffer_server/status /tf2_buffer_server/result'),
    Node('planner', 'rostopic rostopic pub --rate 0.5 /tf2_buffer_server/goal '
         'tf2_msgs/LookupTransformActionGoal '
         '"{goal: {target_frame: base_link, source_frame: laser}}"', '/tf2_buffer_server/goal'),
    # Topic tools.
    Node('scan_throttle', 'topic_tools throttle messages /scan 4 /scan_slow', '/scan_slow'),
    Node('points_throttle', 'topic_tools throttle messages /depth/points 2 /points_slow',
         '/points_slow'),
    Node('imu_drop', 'topic_tools drop /imu/data 1 2 /imu_half', '/imu_half'),
    Node('scan_relay', 'topic_tools relay /scan /scan_relayed', '/scan_relayed'),
    Node('position', 'topic_tools transform /odom /position geometry_msgs/Point '
         'm.pose.pose.position --import geometry_msgs', '/position'),
    Node('joystick', 'rostopic rostopic pub --rate 5 /cmd_vel_joystick geometry_msgs/Twist '
         '"{linear: {x: 0.1}}"', '/cmd_vel_joystick'),
    Node('velocity_mux', 'topic_tools mux /cmd_vel /cmd_vel_joystick /cmd_vel_planner',
         '/cmd_vel'),
    # Diagnostics.
    Node('diagnostic_aggregator', 'diagnostic_aggregator aggregator_node', '/diagnostics_agg'),
    Node('cpu_monitor', 'diagnostic_common_diagnostics cpu_monitor.py', '/diagnostics'),
    Node('ram_monitor', 'diagnostic_common_diagnostics ram_monitor.py', '/diagnostics'),
)

# Kind, node (empty: the whole machine) and length [s], in the order in which they are induced.
FAULTS = (
    *((KILL, node, 10.0) for node in ('lidar', 'vision', 'robot_state_publisher', 'joystick')),
    *((STOP, node, 10.0) for node in ('depth_camera', 'transforms')),
    *((RESTART, node, 10.0) for node in ('base', 'rear_threshold')),
    *((HALF_RATE, node, 20.0) for node in CAMERAS_HZ), (STARVE, '', 15.0))

_ROBOT_DESCRIPTION = """\
<robot name="cart">
  <link name="base_link"/><link name="laser"/><link name="pan"/><link name="camera"/>
  <joint name="laser_mount" type="fixed">
    <parent link="base_link"/><child link="laser"/><origin xyz="0.2 0 0.1"/></joint>
  <joint name="pan_joint" type="continuous">
    <parent link="base_link"/><child link="pan"/><axis xyz="0 0 1"/><origin xyz="0 0 0.5"/></joint>
  <joint name="camera_joint" type="revolute">
    <parent link="pan"/><child link="camera"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
</robot>
"""

PARAMETERS: Dict[str, Any] = {  # what the nodes read from the parameter server
    '/robot_description': _ROBOT_DESCRIPTION,
    '/diagnostic_aggregator/analyzers': {
        'computer': {'type': 'diagnostic_aggregator/GenericAnalyzer', 'path': 'computer',
                     'contains': ['CPU', 'RAM']}}}

_LENGTH_S = 60.0
_JITTER = 0.02  # of the period, as one standard deviation
_BEGIN_S = 1.0e9  # any time but 0
_WIDTH, _HEIGHT = 64, 48
_FOCAL_LENGTH = 60.0  # pixels


def write_drivers(folder: Path) -> None:
    """Write everything into a folder that exists; it is the same every time."""
    random = np.random.default_rng(1)
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
        'base': {('/odom',): (20.0, (odometry,)), ('/battery',): (1.0, (BatteryState(),))},
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


class PackagedSystem:
    """All NODES as processes; `rospy.init_node` has been called."""

    def __init__(self, folder: Path, processes: Processes) -> None:
        """Start nothing yet; folder: for what drivers replay."""
        write_drivers(folder)
        self._folder = folder
        self._processes = processes
        self._running: Dict[str, subprocess.Popen] = {}

    def start(self) -> None:
        """Start all; wait until they have published on all their topics, or raise LiveError."""
        for name, value in PARAMETERS.items():
            rospy.set_param(name, value)
        self._start(NODES)
        wait(WARM_UP_S, 'warming up')

    def end(self) -> None:
        """End all nodes, the last one first: nodelets before their managers."""
        self._end([node for node in NODES if node.name in self._running])

    def broken(self, kind: str, node: str) -> Broken:
        """Return what induces and undoes a fault; it raises LiveError if it cannot be induced, or
        the node does not publish again."""
        if kind == KILL:
            return self._killed(node)
        if kind == STOP:
            return stopped(self._running[node].pid)
        if kind == RESTART:
            return self._restarted(node)
        return _halved(node) if kind == HALF_RATE else induction.starved(BUSY)

    @contextlib.contextmanager
    def _killed(self, name: str) -> Iterator[None]:
        self._running[name].kill()
        yield
        self._restart(name)

    @contextlib.contextmanager
    def _restarted(self, name: str) -> Iterator[float]:
        onset = time.time()
        self._restart(name)
        yield onset

    def _restart(self, name: str) -> None:
        """Start a node again, and those that load a nodelet into it: they end when it dies."""
        nodes = [node for node in NODES if name in (node.name, node.manager)]
        self._end(nodes)
        self._start(nodes)

    def _start(self, nodes: Sequence[Node]) -> None:
        with heard([(f'/{node.name}', topic) for node in nodes for topic in node.topics.split()]):
            for node in nodes:
                self._running[node.name] = self._processes.start(
                    node.name.replace('/', '_'), *self._command(node))

    def _end(self, nodes: Sequence[Node]) -> None:
        for node in reversed(nodes):
            self._processes.end(self._running.pop(node.name))
        unregister([f'/{node.name}' for node in nodes])

    def _command(self, node: Node) -> List[str]:
        namespace, _, name = f'/{node.name}'.rpartition('/')
        file = [str(self._folder / node.file)] if node.file else []
        return ['rosrun', *shlex.split(node.command), *file, f'__name:={name}',
                f'__ns:={namespace or "/"}']


@contextlib.contextmanager
def _halved(name: str) -> Iterator[None]:
    # Installed with the nodes; only here it is needed.
    from dynamic_reconfigure.client import Client
    client = Client(f'/{name}', timeout=10.0)
    try:
        client.update_configuration({'publish_rate': CAMERAS_HZ[name] / 2.0})
        yield
    finally:
        client.update_configuration({'publish_rate': CAMERAS_HZ[name]})
        client.close()
