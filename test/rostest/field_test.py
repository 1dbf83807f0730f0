#!/usr/bin/python3
"""What people in the field look at first: transforms, latched topics, log floods, goals, losses.

The faults of ../shared/cases 07, 19, 21, 34 and 11, live: this process is the node that has them.
"""

import os
import random
import shutil
import tempfile
import threading
import time
from typing import Any, Dict, Sequence, Tuple

import genpy.dynamic
import rosbag
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import TransformStamped
from nav_msgs.msg import OccupancyGrid, Odometry
from rosgraph_msgs.msg import Log

from live_system import START_S, MonitorListener, again_if_disturbed, await_condition
from monitor_case import MonitorCase, learned
from self_awareness.msg import SelfAwareness

NODE = '/field_robot'
FRAMES = ('base', 'camera', 'laser')
HOUR_S = 3600.0
START_TIME_S = 6.0
STARTS = 3
"""As many as it takes to expect a latched message after each start."""


def message_class(name: str, definition: str, used: Any) -> Any:
    """The class of a message whose package need not be installed."""
    text = '{}\n{}\nMSG: {}\n{}'.format(definition, '=' * 80, used._type, used._full_text)
    return genpy.dynamic.generate_dynamic(name, text)[name]


TRANSFORMS = message_class('tf2_msgs/TFMessage', 'geometry_msgs/TransformStamped[] transforms',
                           TransformStamped)
RESULT = message_class('field/GoActionResult', 'actionlib_msgs/GoalStatus status', GoalStatus)


class Robot:
    """Makes the messages of one node, with a fault or without."""

    periods: Dict[str, Tuple[Any, float]] = {
        '/tf': (TRANSFORMS, 0.05), '/odom': (Odometry, 0.05), '/go/result': (RESULT, 1.0),
        '/rosout': (Log, 2.0)}
    """Class and mean period [s] by topic."""

    def __init__(self) -> None:
        self.age = 0.0       # of the transforms [s]
        self.frames: Sequence[str] = FRAMES
        self.status = GoalStatus.SUCCEEDED

    def message(self, topic: str, stamp: rospy.Time) -> Any:
        if topic == '/tf':
            message = TRANSFORMS([TransformStamped(child_frame_id=name) for name in self.frames])
            for transform in message.transforms:
                transform.header.stamp = stamp - rospy.Duration.from_sec(self.age)
                transform.transform.translation.x = random.random()
            return message
        if topic == '/odom':
            odometry = Odometry()
            odometry.header.stamp = stamp
            odometry.pose.pose.position.x = random.random()
            return odometry
        if topic == '/rosout':
            return Log(name=NODE, level=Log.WARN, msg='the path is blocked')
        return RESULT(GoalStatus(status=self.status))

    def write(self, path: str, seed: int) -> str:
        """Writes 120 s of a start of its own."""
        rng = random.Random(seed)
        start = START_S + HOUR_S * seed
        messages = [(start + 0.3, '/map', OccupancyGrid(), {'latching': '1'})]
        for topic, (_, period) in self.periods.items():
            stamp = start + rng.uniform(0, period)
            while stamp < start + 120:
                message = self.message(topic, rospy.Time.from_sec(stamp))
                messages.append((stamp, topic, message, {}))
                stamp += period * rng.uniform(0.7, 1.3)
        numbers: Dict[str, int] = {}
        with rosbag.Bag(path, 'w') as bag:
            for stamp, topic, message, more in sorted(messages, key=lambda each: each[0]):
                if topic == '/odom':
                    message.header.seq = numbers[topic] = numbers.get(topic, 0) + 1
                bag.write(topic, message, rospy.Time.from_sec(stamp), connection_header=dict(
                    more, topic=topic, type=message._type, md5sum=message._md5sum,
                    message_definition=message._full_text, callerid=NODE))
        return path


class LiveRobot(Robot):
    """Sends them, until the `with` block ends."""

    def __init__(self, latched: bool = True) -> None:
        super().__init__()
        self.lost = 0.0  # share of /odom
        self.log_period = self.periods['/rosout'][1]
        self._publishers = {topic: rospy.Publisher(topic, its_class, queue_size=100)
                            for topic, (its_class, _) in self.periods.items()
                            if topic != '/rosout'}
        self._map = rospy.Publisher('/map', OccupancyGrid, queue_size=1, latch=True)
        if latched:
            self._map.publish(OccupancyGrid())
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run)

    def __enter__(self) -> 'LiveRobot':
        self._thread.start()
        return self

    def __exit__(self, *_) -> None:
        self._ended.set()
        self._thread.join()
        for publisher in [self._map, *self._publishers.values()]:
            publisher.unregister()

    def _run(self) -> None:
        due = dict.fromkeys(self.periods, time.monotonic())
        while not self._ended.wait(0.005):
            now = time.monotonic()
            for topic in [topic for topic in due if due[topic] <= now]:
                period = self.log_period if topic == '/rosout' else self.periods[topic][1]
                due[topic] = now + period * random.uniform(0.7, 1.3)
                self._send(topic)

    def _send(self, topic: str) -> None:
        if topic == '/rosout':
            rospy.logwarn('the path is blocked')
        elif topic == '/odom' and random.random() < self.lost:
            self._publishers[topic].impl.seq += 1  # it was sent, and nobody got it
        else:
            self._publishers[topic].publish(self.message(topic, rospy.Time.now()))


class FieldTest(MonitorCase):

    trained: str

    @classmethod
    def setUpClass(cls) -> None:
        folder = tempfile.mkdtemp()
        cls.addClassCleanup(shutil.rmtree, folder)
        cls.trained = os.path.join(folder, 'model')
        learned([Robot().write(os.path.join(folder, '{}.bag'.format(seed)), seed)
                 for seed in range(STARTS)], START_TIME_S).save(cls.trained)

    def find(self, kind: str, level: int, words: str, seconds: float, latched: bool = True,
             **fault: Any) -> None:
        """The node is named with these words soon after what a fault says of it is so."""
        with LiveRobot(latched) as sent, MonitorListener() as listener, \
                self.monitor(self.trained, detector='evidence', unknown='warn', subscribe='all'):
            listener.await_settled()
            listener.next_statuses(20)
            self.assertEqual(listener.errors, [], 'an alarm before the fault')
            self.assertFalse(any(words in each.message for each in listener.alarms))
            began = rospy.get_time()
            for name, value in fault.items():
                setattr(sent, name, value)
            try:
                said = await_condition(words, lambda: next(
                    (each for each in listener.alarms
                     if (each.kind, each.level) == (kind, level) and words in each.message), None),
                    seconds + 10)
            except AssertionError:
                print([(each.kind, each.level, each.message) for each in listener.alarms])
                raise
            self.assertLess(said.header.stamp.to_sec() - began, seconds, said.message)
            self.assertEqual(said.component, NODE)

    @again_if_disturbed
    def test_old_stamps_of_transforms(self) -> None:
        self.find(SelfAwareness.STALE, SelfAwareness.ERROR, '/tf', 3, age=5.0)

    @again_if_disturbed
    def test_a_transform_that_is_missing(self) -> None:
        self.find(SelfAwareness.STRANGER, SelfAwareness.WARN, 'without laser', 5,
                  frames=FRAMES[:2])

    @again_if_disturbed
    def test_what_was_latched_in_each_start_and_is_not_there(self) -> None:
        self.find(SelfAwareness.NEVER_CAME, SelfAwareness.WARN, '/map', 3 * START_TIME_S,
                  latched=False)

    @again_if_disturbed
    def test_a_flood_of_log_lines(self) -> None:
        # Of who logs seldom, some 700 lines are needed; a busy machine sends 70 a second.
        self.find(SelfAwareness.FAST, SelfAwareness.ERROR, '/rosout', 15, log_period=0.01)

    @again_if_disturbed
    def test_goals_that_never_failed_before(self) -> None:
        self.find(SelfAwareness.STRANGER, SelfAwareness.WARN, 'status.status=4', 5,
                  status=GoalStatus.ABORTED)

    @again_if_disturbed
    def test_messages_that_are_lost(self) -> None:
        self.find(SelfAwareness.LOSSY, SelfAwareness.ERROR, 'messages', 8, lost=0.3)


if __name__ == '__main__':
    rospy.init_node(NODE[1:])  # as rostest calls it, too
    rostest.rosrun('self_awareness', NODE[1:], FieldTest)
