"""Nodes of Debian packages, which nobody here wrote: what is started, and what is broken."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Dict, Tuple


@dataclass(frozen=True)
class Node:
    """A program of a ROS package."""

    name: str  # of the node, after the first slash
    package: str  # of ROS
    program: str  # of the package
    arguments: Tuple[str, ...]  # to the program; remappings and private parameters included
    # On which it publishes all the time; those of a nodelet come from its manager.
    topics: Tuple[str, ...] = ()
    file: str = ''  # of drivers.write, the last argument; empty: none
    manager: str = ''  # node into which it loads a nodelet; empty: none


CAMERAS_HZ = {'front': 15.0, 'rear': 10.0}  # how often the cameras publish

# The kinds of faults.
KILL = 'killed (kill -9)'
STOP = 'stopped (SIGSTOP, SIGCONT)'
RESTART = 'ended and started again at once'
HALF_RATE = 'publishes at half its rate'
STARVE = 'four busy processes on every core'


def _driver(name: str, *topics: str) -> Node:
    """Return the replay of the bag of that name."""
    return Node(name, 'rosbag', 'play', ('--loop', '--quiet'), topics, f'{name}.bag')


def _camera(name: str, rate_hz: float) -> Node:
    """Return a camera that publishes the same picture over and over."""
    return Node(name, 'image_publisher', 'image_publisher',
                (f'_publish_rate:={rate_hz:g}',),
                (f'/{name}/image_raw', f'/{name}/camera_info'), f'{name}.png')


def _manager(name: str, *topics: str) -> Node:
    return Node(name, 'nodelet', 'nodelet', ('manager',), topics)


def _nodelet(name: str, kind: str, manager: str, *arguments: str) -> Node:
    return Node(name, 'nodelet', 'nodelet', ('load', kind, manager, *arguments), manager=manager)


def _tool(name: str, program: str, output: str, *arguments: str) -> Node:
    """Return a node of topic_tools."""
    return Node(name, 'topic_tools', program, arguments, (output,))


_GOAL = '{goal: {target_frame: base_link, source_frame: laser}}'

NODES = (
    # Drivers, replayed from bags of a minute, whose stamps vary as those of devices do.
    _driver('lidar', '/scan'),
    _driver('imu', '/imu/data', '/imu/mag'),
    _driver('base', '/odom', '/battery'),
    _driver('gps', '/fix', '/vel'),
    _driver('depth_camera', '/depth/image_raw', '/depth/camera_info'),
    # Cameras.
    *(_camera(name, rate_hz) for name, rate_hz in CAMERAS_HZ.items()),
    # Two managers with nodelets.
    _manager('vision', '/front/image_mono', '/front/image_color', '/front/image_rect',
             '/front/preview/image_raw', '/front/preview/camera_info',
             '/front_edges/image'),
    _nodelet('front_debayer', 'image_proc/debayer', 'vision', 'image_raw:=/front/image_raw',
             'image_mono:=/front/image_mono', 'image_color:=/front/image_color'),
    _nodelet('front_rectify', 'image_proc/rectify', 'vision', 'image_mono:=/front/image_mono',
             'camera_info:=/front/camera_info', 'image_rect:=/front/image_rect'),
    _nodelet('front_preview', 'image_proc/crop_decimate', 'vision',
             '_decimation_x:=2', '_decimation_y:=2',
             'camera/image_raw:=/front/image_raw', 'camera/camera_info:=/front/camera_info',
             'camera_out/image_raw:=/front/preview/image_raw',
             'camera_out/camera_info:=/front/preview/camera_info'),
    _nodelet('front_edges', 'opencv_apps/edge_detection', 'vision', 'image:=/front/image_color'),
    _manager('depth', '/depth/image', '/depth/points', '/depth/foremost'),
    _nodelet('depth_metric', 'depth_image_proc/convert_metric', 'depth',
             'image_raw:=/depth/image_raw', 'image:=/depth/image'),
    _nodelet('depth_points', 'depth_image_proc/point_cloud_xyz', 'depth',
             'image_rect:=/depth/image', 'camera_info:=/depth/camera_info',
             'points:=/depth/points'),
    _nodelet('depth_foremost', 'depth_image_proc/crop_foremost', 'depth',
             'image_raw:=/depth/image_raw', 'image:=/depth/foremost'),
    # The same and more as nodes of their own.
    Node('rear/image_proc', 'image_proc', 'image_proc', (),
         ('/rear/image_mono', '/rear/image_rect', '/rear/image_color',
          '/rear/image_rect_color')),
    Node('rear_threshold', 'opencv_apps', 'threshold', ('image:=/rear/image_raw',),
         ('/rear_threshold/image',)),
    Node('rear_contours', 'opencv_apps', 'find_contours', ('image:=/rear/image_raw',),
         ('/rear_contours/contours', '/rear_contours/image')),
    # Transforms.
    Node('robot_state_publisher', 'robot_state_publisher', 'robot_state_publisher', (),
         ('/tf',)),
    Node('joint_state_publisher', 'joint_state_publisher', 'joint_state_publisher', (),
         ('/joint_states',)),
    Node('gps_mount', 'tf2_ros', 'static_transform_publisher',
         ('0', '0', '0.4', '0', '0', '0', 'base_link', 'gps')),
    Node('map_to_odom', 'tf', 'static_transform_publisher',
         ('0', '0', '0', '0', '0', '0', 'map', 'odom', '50'), ('/tf',)),
    # An action server and who asks it.
    Node('transforms', 'tf2_ros', 'buffer_server', (),
         ('/tf2_buffer_server/status', '/tf2_buffer_server/result')),
    Node('planner', 'rostopic', 'rostopic',
         ('pub', '--rate', '0.5', '/tf2_buffer_server/goal', 'tf2_msgs/LookupTransformActionGoal',
          _GOAL), ('/tf2_buffer_server/goal',)),
    # Topic tools.
    _tool('scan_throttle', 'throttle', '/scan_slow', 'messages', '/scan', '4', '/scan_slow'),
    _tool('points_throttle', 'throttle', '/points_slow', 'messages', '/depth/points', '2',
          '/points_slow'),
    _tool('imu_drop', 'drop', '/imu_half', '/imu/data', '1', '2', '/imu_half'),
    _tool('scan_relay', 'relay', '/scan_relayed', '/scan', '/scan_relayed'),
    _tool('position', 'transform', '/position', '/odom', '/position', 'geometry_msgs/Point',
          'm.pose.pose.position', '--import', 'geometry_msgs'),
    Node('joystick', 'rostopic', 'rostopic',
         ('pub', '--rate', '5', '/cmd_vel_joystick', 'geometry_msgs/Twist',
          '{linear: {x: 0.1}}'), ('/cmd_vel_joystick',)),
    _tool('velocity_mux', 'mux', '/cmd_vel', '/cmd_vel', '/cmd_vel_joystick', '/cmd_vel_planner'),
    # Diagnostics.
    Node('diagnostic_aggregator', 'diagnostic_aggregator', 'aggregator_node', (),
         ('/diagnostics_agg',)),
    Node('cpu_monitor', 'diagnostic_common_diagnostics', 'cpu_monitor.py', (), ('/diagnostics',)),
    Node('ram_monitor', 'diagnostic_common_diagnostics', 'ram_monitor.py', (), ('/diagnostics',)),
)
"""In the order in which they are started."""

FAULTS = (
    (KILL, 'lidar', 10.0),
    (KILL, 'vision', 10.0),
    (KILL, 'robot_state_publisher', 10.0),
    (KILL, 'joystick', 10.0),
    (STOP, 'depth_camera', 10.0),
    (STOP, 'transforms', 10.0),
    (RESTART, 'base', 10.0),
    (RESTART, 'rear_threshold', 10.0),
    (HALF_RATE, 'front', 20.0),
    (HALF_RATE, 'rear', 20.0),
    (STARVE, '', 15.0),
)
"""Kind, node (empty: the whole machine) and length [s], in the order in which they are induced."""

_ROBOT_DESCRIPTION = """\
<robot name="cart">
  <link name="base_link"/><link name="laser"/><link name="pan"/><link name="camera"/>
  <joint name="laser_mount" type="fixed">
    <parent link="base_link"/><child link="laser"/><origin xyz="0.2 0 0.1"/>
  </joint>
  <joint name="pan_joint" type="continuous">
    <parent link="base_link"/><child link="pan"/><axis xyz="0 0 1"/><origin xyz="0 0 0.5"/>
  </joint>
  <joint name="camera_joint" type="revolute">
    <parent link="pan"/><child link="camera"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
</robot>
"""

PARAMETERS: Dict[str, Any] = {
    '/robot_description': _ROBOT_DESCRIPTION,
    '/diagnostic_aggregator/analyzers': {
        'computer': {'type': 'diagnostic_aggregator/GenericAnalyzer', 'path': 'computer',
                     'contains': ['CPU', 'RAM']}}}
"""What the nodes read from the parameter server."""
