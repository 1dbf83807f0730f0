"""The messages of the simulated robot as ROS messages: plausible in type, size and content.

What matters to the scenario is when a message comes, its header stamp and, for some types, one
value. The rest follows from `Message.content`, and is a real robot's in this: measurements differ
from message to message, lists vary in length, some things never change.
"""
from __future__ import annotations

import math
import random
from operator import attrgetter
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
            noise = random.Random(message.content)
            for path, value in self._fill(message.content, noise).items():
                owner, _, name = path.rpartition('.')
                setattr(attrgetter(owner)(self._message) if owner else self._message, name, value)
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


def _pose(content: int) -> Any:
    """Return where the robot is at a time (ns): it goes round in a circle."""
    angle = 0.1 * content / SECOND_NS
    pose = _new('geometry_msgs/Pose')
    pose.position.x, pose.position.y = 3.0 * math.cos(angle), 3.0 * math.sin(angle)
    pose.orientation.z, pose.orientation.w = math.sin(angle / 2.0), math.cos(angle / 2.0)
    return pose


def _new(datatype: str, **fields: Any) -> Any:
    return roslib.message.get_message_class(datatype)(**fields)


# What the fields of a message hold, by the time (ns) that it is from, and noise that it seeds.
_FILL: Dict[str, Callable[[int, random.Random], Dict[str, Any]]] = {
    'actionlib_msgs/GoalStatus': lambda _, __: {'goal_id.id': 'person'},
    'geometry_msgs/PoseArray': lambda at, noise: {
        'poses': [_pose(at + i) for i in range(noise.randint(1, 4))]},
    'geometry_msgs/PoseStamped': lambda at, _: {'pose': _pose(at)},
    'geometry_msgs/PoseWithCovarianceStamped': lambda at, _: {'pose.pose': _pose(at)},
    'geometry_msgs/Twist': lambda at, _: {
        'linear.x': 0.3, 'angular.z': 0.2 * math.sin(at / SECOND_NS)},
    'nav_msgs/GridCells': lambda _, noise: {
        'cell_width': 0.05, 'cell_height': 0.05,
        'cells': [_new('geometry_msgs/Point', x=2.0 * noise.random(), y=noise.random())
                  for _ in range(noise.randint(5, 15))]},
    'nav_msgs/MapMetaData': lambda _, __: {
        'resolution': 0.05, 'width': 400, 'height': 400, 'origin.orientation.w': 1.0},
    'nav_msgs/Odometry': lambda at, _: {'child_frame_id': 'base_link', 'pose.pose': _pose(at)},
    'nav_msgs/Path': lambda at, noise: {
        'poses': [_new('geometry_msgs/PoseStamped', pose=_pose(at + i * SECOND_NS))
                  for i in range(noise.randint(4, 8))]},
    'sensor_msgs/BatteryState': lambda at, _: {
        'voltage': round(24.0 + math.cos(at / (600.0 * SECOND_NS)), 2)},
    'sensor_msgs/CompressedImage': lambda _, noise: {
        'format': 'jpeg',
        'data': noise.getrandbits(8 * (size := noise.randint(230, 280))).to_bytes(size, 'little')},
    'sensor_msgs/JointState': lambda at, _: {
        'name': ['pan', 'tilt'],
        'position': [math.sin(at / SECOND_NS), 0.2 * math.cos(at / SECOND_NS)]},
    'sensor_msgs/LaserScan': lambda _, noise: {
        'angle_min': -1.5708, 'angle_max': 1.5708, 'angle_increment': 3.1416 / _LASER_BEAMS,
        'range_min': 0.05, 'range_max': 8.0,
        'ranges': [2.0 + 0.02 * noise.random() for _ in range(_LASER_BEAMS)]},
    'sensor_msgs/RegionOfInterest': lambda _, noise: {
        'x_offset': noise.randint(0, 320), 'y_offset': noise.randint(0, 240),
        'width': (size := noise.randint(60, 90)), 'height': size},
}

# What an empty message has nothing in.
_LIST_FIELDS = {
    'geometry_msgs/PoseArray': 'poses',
    'nav_msgs/GridCells': 'cells',
    'nav_msgs/Path': 'poses',
    'sensor_msgs/CompressedImage': 'data',
    'sensor_msgs/LaserScan': 'ranges',
}
