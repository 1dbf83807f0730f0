"""The messages of the simulated robot as ROS messages: plausible in type and size, no more.

What matters to the scenario is when a message comes, its header stamp and, for some types, one
value; the rest of the content never changes.
"""
from __future__ import annotations

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
_IMAGE_BYTES = 256
_PATH_POSES = 5


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
        # One message is filled again and again: it is serialized before the next one is asked for.
        self._message = message_class()
        fill = _FILL.get(datatype)
        if fill is not None:
            fill(self._message)

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


def _laser_scan(scan: Any) -> None:
    scan.angle_min, scan.angle_max, scan.angle_increment = -1.5708, 1.5708, 3.1416 / _LASER_BEAMS
    scan.range_min, scan.range_max = 0.05, 8.0
    scan.ranges = [2.0] * _LASER_BEAMS


def _odometry(odometry: Any) -> None:
    odometry.child_frame_id = 'base_link'
    odometry.pose.pose.orientation.w = 1.0


def _pose_array(poses: Any) -> None:
    poses.poses = [_pose()]


def _pose_with_covariance(pose: Any) -> None:
    pose.pose.pose.orientation.w = 1.0


def _pose_stamped(pose: Any) -> None:
    pose.pose.orientation.w = 1.0


def _path(path: Any) -> None:
    pose_class = roslib.message.get_message_class('geometry_msgs/PoseStamped')
    path.poses = [pose_class(pose=_pose()) for _ in range(_PATH_POSES)]


def _compressed_image(image: Any) -> None:
    image.format = 'jpeg'
    image.data = bytes(_IMAGE_BYTES)


def _joint_state(joints: Any) -> None:
    joints.name = ['pan', 'tilt']
    joints.position = [0.0, 0.0]


def _goal_status(status: Any) -> None:
    status.goal_id.id = 'person'


def _pose() -> Any:
    pose = roslib.message.get_message_class('geometry_msgs/Pose')()
    pose.orientation.w = 1.0
    return pose


_FILL: Dict[str, Callable[[Any], None]] = {
    'actionlib_msgs/GoalStatus': _goal_status,
    'geometry_msgs/PoseArray': _pose_array,
    'geometry_msgs/PoseStamped': _pose_stamped,
    'geometry_msgs/PoseWithCovarianceStamped': _pose_with_covariance,
    'nav_msgs/Odometry': _odometry,
    'nav_msgs/Path': _path,
    'sensor_msgs/CompressedImage': _compressed_image,
    'sensor_msgs/JointState': _joint_state,
    'sensor_msgs/LaserScan': _laser_scan,
}
