"""The messages of the simulated robot as ROS messages: plausible in type, size and content.

What matters to the scenario is when a message comes, its header stamp and, for some types, one
value. The rest follows from `Message.content`, and is a real robot's in this: measurements differ
from message to message, lists vary in length, some things never change.
"""
from __future__ import annotations

import math
import random
from typing import Any, Callable, Dict, Optional

import genpy
import roslib.message

from self_awareness.stamps import SECOND_NS
from self_awareness.yaml_section import SectionError
from self_awareness_follow_me.component import Message
from self_awareness_follow_me.component_spec import Value

_VALUE_FIELDS = {'actionlib_msgs/GoalStatus': 'status',
                 'std_msgs/Bool': 'data',
                 'std_msgs/String': 'data'}

_LASER_BEAMS = 180


class MessageType:
    """Makes ROS messages of one type, and reads them.

    Raises:
        SectionError: the type is unknown here.
    """

    def __init__(self, datatype: str) -> None:
        message_class = roslib.message.get_message_class(datatype)
        if message_class is None:
            package = datatype.split('/')[0]
            raise SectionError(f'message type {datatype} not found: install the Python messages '
                               f'of {package} (ros-noetic-{package.replace("_", "-")} or '
                               f'python3-{package.replace("_", "-")}), or correct the scenario')
        self.message_class: Any = message_class
        self._value_field = _VALUE_FIELDS.get(datatype)
        self._list_field = _LIST_FIELDS.get(datatype)
        self._fill = _FILL.get(datatype)
        # One message is filled again and again: it is serialized before the next one is asked for.
        self._message = message_class()

    @property
    def has_stamp(self) -> bool:
        """Whether messages have a stamp."""
        return self._stamped(self._message) is not None

    @property
    def has_header(self) -> bool:
        """Whether messages begin with a header."""
        return bool(self.message_class._has_header)

    @property
    def has_list(self) -> bool:
        """Whether messages have a list that is empty if they are."""
        return self._list_field is not None

    def to_ros(self, message: Message, sequence: int = 0) -> Any:
        """Return a ROS message that is valid until the next call.

        Args:
            message: what it says; without a value, the field for it keeps its default.
            sequence: the header's number; a rospy publisher overwrites it.
        """
        stamped = self._stamped(self._message)
        if stamped is not None:
            stamped.stamp = genpy.Time(*divmod(message.stamp, SECOND_NS))
            if hasattr(stamped, 'seq'):
                stamped.seq = sequence
        if message.content is None:
            if self._list_field is not None:
                setattr(self._message, self._list_field, [])
        elif self._fill is not None:
            self._fill(self._message, message.content)
        if self._value_field is not None and message.value is not None:
            setattr(self._message, self._value_field, message.value)
        return self._message

    def from_ros(self, topic: str, ros_message: Any, received: int) -> Message:
        """Return what the scenario reads in a ROS message.

        Args:
            topic: as the scenario calls it.
            ros_message: of this type.
            received: clock of the host at its arrival (ns), the stamp of a type that has none.
        """
        stamped = self._stamped(ros_message)
        value: Optional[Value] = None
        if self._value_field is not None:
            value = getattr(ros_message, self._value_field)
        return Message(topic, received if stamped is None else stamped.stamp.to_nsec(), value)

    @staticmethod
    def _stamped(message: Any) -> Any:
        """Return the part that has the stamp: the header, or the goal's id."""
        return getattr(message, 'header', getattr(message, 'goal_id', None))


def _laser_scan(scan: Any, content: int) -> None:
    noise = random.Random(content)
    scan.angle_min, scan.angle_max, scan.angle_increment = -1.5708, 1.5708, 3.1416 / _LASER_BEAMS
    scan.range_min, scan.range_max = 0.05, 8.0
    scan.ranges = [2.0 + 0.02 * noise.random() for _ in range(_LASER_BEAMS)]


def _odometry(odometry: Any, content: int) -> None:
    odometry.child_frame_id = 'base_link'
    odometry.pose.pose = _pose(content)


def _pose_array(poses: Any, content: int) -> None:
    poses.poses = [_pose(content + i) for i in range(random.Random(content).randint(1, 4))]


def _pose_with_covariance(pose: Any, content: int) -> None:
    pose.pose.pose = _pose(content)


def _pose_stamped(pose: Any, content: int) -> None:
    pose.pose = _pose(content)


def _path(path: Any, content: int) -> None:
    path.poses = [_new('geometry_msgs/PoseStamped', pose=_pose(content + i * SECOND_NS))
                  for i in range(random.Random(content).randint(4, 8))]


def _grid_cells(cells: Any, content: int) -> None:
    noise = random.Random(content)
    cells.cell_width = cells.cell_height = 0.05
    cells.cells = [_new('geometry_msgs/Point', x=2.0 * noise.random(), y=noise.random())
                   for _ in range(noise.randint(5, 15))]


def _map_metadata(metadata: Any, _: int) -> None:
    metadata.resolution, metadata.width, metadata.height = 0.05, 400, 400
    metadata.origin.orientation.w = 1.0


def _twist(twist: Any, content: int) -> None:
    twist.linear.x = 0.3
    twist.angular.z = 0.2 * math.sin(content / SECOND_NS)


def _compressed_image(image: Any, content: int) -> None:
    noise = random.Random(content)
    size = noise.randint(230, 280)
    image.format = 'jpeg'
    image.data = noise.getrandbits(8 * size).to_bytes(size, 'little')


def _joint_state(joints: Any, content: int) -> None:
    joints.name = ['pan', 'tilt']
    joints.position = [math.sin(content / SECOND_NS), 0.2 * math.cos(content / SECOND_NS)]


def _region(region: Any, content: int) -> None:
    noise = random.Random(content)
    region.x_offset, region.y_offset = noise.randint(0, 320), noise.randint(0, 240)
    region.width = region.height = noise.randint(60, 90)


def _battery_state(battery: Any, content: int) -> None:
    battery.voltage = round(24.0 + math.cos(content / (600.0 * SECOND_NS)), 2)


def _goal_status(status: Any, _: int) -> None:
    status.goal_id.id = 'person'


def _pose(content: int) -> Any:
    """Return where the robot is at a time (ns): it goes round in a circle."""
    angle = 0.1 * content / SECOND_NS
    pose = _new('geometry_msgs/Pose')
    pose.position.x, pose.position.y = 3.0 * math.cos(angle), 3.0 * math.sin(angle)
    pose.orientation.z, pose.orientation.w = math.sin(angle / 2.0), math.cos(angle / 2.0)
    return pose


def _new(datatype: str, **fields: Any) -> Any:
    return roslib.message.get_message_class(datatype)(**fields)


_FILL: Dict[str, Callable[[Any, int], None]] = {
    'actionlib_msgs/GoalStatus': _goal_status,
    'geometry_msgs/PoseArray': _pose_array,
    'geometry_msgs/PoseStamped': _pose_stamped,
    'geometry_msgs/PoseWithCovarianceStamped': _pose_with_covariance,
    'geometry_msgs/Twist': _twist,
    'nav_msgs/GridCells': _grid_cells,
    'nav_msgs/MapMetaData': _map_metadata,
    'nav_msgs/Odometry': _odometry,
    'nav_msgs/Path': _path,
    'sensor_msgs/BatteryState': _battery_state,
    'sensor_msgs/CompressedImage': _compressed_image,
    'sensor_msgs/JointState': _joint_state,
    'sensor_msgs/LaserScan': _laser_scan,
    'sensor_msgs/RegionOfInterest': _region,
}

# What an empty message has nothing in.
_LIST_FIELDS = {
    'geometry_msgs/PoseArray': 'poses',
    'nav_msgs/GridCells': 'cells',
    'nav_msgs/Path': 'poses',
    'sensor_msgs/CompressedImage': 'data',
    'sensor_msgs/LaserScan': 'ranges',
}
