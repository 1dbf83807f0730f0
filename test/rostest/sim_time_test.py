#!/usr/bin/python3
"""Simulated time: /clock is absent, comes twice, stands still, jumps, ends."""

import glob
import random
import re
import threading
import time
from typing import List

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from rosgraph_msgs.msg import Clock
from std_msgs.msg import String

from live_system import (START_S, THRESHOLD, MonitorListener, Process, again_if_disturbed,
                         await_condition, make_model, ours)
from monitor_case import FolderCase
from self_awareness import EncodingRules, read_events
from self_awareness.msg import SelfAwareness

COMPONENTS = (('/laser', '/scan', 0.05), ('/battery', '/charge', 0.5))
"""Source, topic and mean period [s]."""
LONGEST_HEARTBEAT_S = 2.5
CLOCK_WAS_SET = 'ROS time was set'
NO_CLOCK = re.compile('ROS time has stood still for|no /clock for')
END_S = 4294967295.99
"""Of ROS time [s]."""


class SimulatedRobot:
    """Publishes /clock and the components' messages; the clock is set and stopped at will.

    Args:
        pace: of its time, in which its messages come, too.
    """

    def __init__(self, pace: float = 1) -> None:
        self.published = 0
        self.silent = False  # no messages any more; the clock goes on
        self.standing = False  # no /clock and no messages any more
        self._pace = pace
        self.ahead = START_S - self._time()  # of the clock [s]
        self._clock = rospy.Publisher('/clock', Clock, queue_size=100)
        self._publishers = {topic: rospy.Publisher(topic, String, queue_size=100)
                            for _, topic, _ in COMPONENTS}
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run)

    def __enter__(self) -> 'SimulatedRobot':
        self._thread.start()
        return self

    def __exit__(self, *_) -> None:
        self._ended.set()
        self._thread.join()
        for publisher in [self._clock] + list(self._publishers.values()):
            publisher.unregister()

    def _time(self) -> float:
        return self._pace * time.monotonic()

    def _run(self) -> None:
        rng = random.Random(0)
        due = {topic: self._time() for topic in self._publishers}
        while not self._ended.wait(0.01):
            if self.standing:
                continue
            now = self._time()
            self._clock.publish(Clock(rospy.Time.from_sec(min(now + self.ahead, END_S))))
            for _, topic, period in COMPONENTS:
                if due[topic] <= now and not self.silent:
                    self._publishers[topic].publish(String())
                    self.published += 1
                    due[topic] += period * rng.uniform(0.7, 1.3)


@again_if_disturbed
class SimTimeTest(FolderCase):

    def setUp(self) -> None:
        super().setUp()
        self.model = self.path('model')
        make_model(self.model, COMPONENTS, source='none')

    def start_monitor(self) -> Process:
        # A busy machine may hold messages back for some windows, so an alarm needs a second.
        return ours('self_awareness_node', '_model:=' + self.model,
                    '_detector:=paper', '_subscribe:=model', '_settle_time:=1.0',
                    '_alarm_windows:=10', '_alarm_of:=15',
                    '_recorder/directory:=' + self.path('recorder'))

    def check_heartbeats(self, listener: MonitorListener, clock_stands: bool = False) -> None:
        """None was left out since the first, and all are levels of a healthy monitor.

        Single windows of a replay may be a suspicion. A clock that stands still is one at first,
        and then an error of the monitor's own status.
        """
        beats = listener.heartbeats
        gaps = [later - earlier for earlier, later in zip(beats, beats[1:])]
        self.assertLess(max(gaps), LONGEST_HEARTBEAT_S, gaps)
        for task, healthy in (('communication', DiagnosticStatus.WARN),
                              ('monitor', DiagnosticStatus.OK)):
            self.assertEqual([(status.level, status.message)
                              for status in listener.diagnostics(task)
                              if status.level > healthy
                              and not (clock_stands and NO_CLOCK.match(status.message))], [], task)

    def await_clock_missed(self, listener: MonitorListener) -> None:
        """Waits until the monitor has warned that the clock stands, and calls it an error."""
        levels = await_condition('the clock is missed', lambda: (
            listener.diagnostics('monitor')[-1].level == DiagnosticStatus.ERROR
            and [s.level for s in listener.diagnostics('monitor') if NO_CLOCK.match(s.message)]),
            20)
        self.assertEqual(sorted(set(levels)), [DiagnosticStatus.WARN, DiagnosticStatus.ERROR])
        self.assertEqual(levels, sorted(levels))

    def check_no_alarm(self, listener: MonitorListener) -> None:
        self.assertEqual(listener.errors, [])
        self.assertNotIn(SelfAwareness.ERROR, {status.level for status in listener.statuses})

    def check_normal(self, statuses: List[SelfAwareness]) -> None:
        """These windows look like normal operation."""
        settled = [status for status in statuses if not status.settling]
        self.assertGreater(len(settled), 10)
        self.assertEqual({status.unknown_events for status in settled}, {0})
        scores = sorted(status.score for status in settled if status.events > 0)
        self.assertGreater(scores[len(scores) // 2], 3 * THRESHOLD)
        normal = [status for status in settled if not status.abnormal]
        self.assertGreater(len(normal), 0.8 * len(settled), [s.score for s in settled])

    def test_heartbeat_before_the_first_clock(self) -> None:
        with MonitorListener() as listener, self.start_monitor():
            await_condition('the monitor subscribes', lambda: (
                listener.value('monitor', 'subscriptions') == str(len(COMPONENTS))), 40)
            array = rospy.wait_for_message('/diagnostics', DiagnosticArray, 10)
            self.assertEqual(array.header.stamp, rospy.Time(0), 'there is a /clock')
            listener.await_heartbeats(5)
            self.check_heartbeats(listener, clock_stands=True)
            self.await_clock_missed(listener)
            self.assertIn('no /clock for', listener.diagnostics('monitor')[-1].message)
            self.assertEqual(listener.diagnostics('communication')[-1].message,
                             'waiting for the first message')
            self.assertEqual(listener.statuses, [])

    def test_two_publishers_of_the_clock_hide_no_death(self) -> None:
        with MonitorListener() as listener, self.start_monitor(), SimulatedRobot() as robot:
            listener.await_settled()
            with Process('rostopic', 'pub', '-r', '50', '/clock', 'rosgraph_msgs/Clock',
                         '{clock: {secs: 5000, nsecs: 0}}'):
                warning = listener.await_diagnostics('monitor', '/clock', DiagnosticStatus.WARN)
                self.assertIn(rospy.get_name(), warning.message)
                self.assertIn('/rostopic_', warning.message)
                listener.await_settled()
                seen = len(listener.statuses)
                await_condition('3 s', lambda: len(listener.statuses) > seen + 30, 20)
                self.check_no_alarm(listener)
                self.assertFalse(any(s.settling for s in listener.statuses[seen:]))
                robot.silent = True
                suspect = listener.await_alarm().suspects[0]
                self.assertEqual((suspect.source, suspect.scope), ('', '/scan'))
                listener.await_diagnostics('/scan', '', DiagnosticStatus.ERROR)

    def test_clock_is_set_and_stops(self) -> None:
        with MonitorListener() as listener, self.start_monitor() as monitor, \
                SimulatedRobot() as robot:
            listener.await_settled()
            for jump_s in (-500.0, 300.0):
                before = listener.statuses[-1]
                seen = len(listener.statuses)
                lines = monitor.output.count(CLOCK_WAS_SET)
                steps = int(listener.value('monitor', 'times the clock was set'))
                robot.ahead += jump_s
                after = await_condition('windows after a jump of {:g} s'.format(jump_s), lambda: [
                    status for status in listener.statuses[seen:]
                    if abs((status.window_start - before.window_start).to_sec()) > 200], 20)
                self.assertTrue(after[0].settling, 'after a jump of {:g} s'.format(jump_s))
                listener.await_settled()
                await_condition('2 s after it',
                                lambda: len(listener.statuses) > seen + 40, 20)
                self.check_normal(listener.statuses[seen:])
                self.assertEqual(monitor.output.count(CLOCK_WAS_SET), lines + 1)
                self.assertEqual(int(listener.value('monitor', 'times the clock was set')),
                                 steps + 1)
                self.check_heartbeats(listener)
            robot.standing = True
            listener.await_heartbeats(4)
            self.check_heartbeats(listener, clock_stands=True)
            self.await_clock_missed(listener)
            self.assertIn('not judged any more: ROS time stands still',
                          listener.diagnostics('communication')[-1].message)
            self.check_no_alarm(listener)

    def test_recordings_are_complete_and_end_where_the_clock_was_set(self) -> None:
        with MonitorListener('/recorder') as listener, \
                ours('record_events', '_subscribe:=all',
                     '_output:=' + self.path('run')), SimulatedRobot(pace=4) as robot:
            await_condition('it is recorded', lambda: (
                listener.value('recording', 'events') or '0') != '0', 20)
            before = robot.published
            for jump_s in (300.0, -1000.0, 0.0):
                seen = robot.published
                await_condition('more', lambda: robot.published > seen + 50, 20)
                robot.ahead += jump_s
        recorded = [read_events(log, EncodingRules.defaults(), recording=0).stamps
                    for log in glob.glob(self.path('run*.bag'))]
        self.assertEqual(len(recorded), 3)
        for stamps in recorded:
            self.assertLess(max(stamps) - min(stamps), 100 * 10**9)
        self.assertGreater(sum(map(len, recorded)), 0.8 * (robot.published - before))

    def test_the_end_of_ros_time(self) -> None:
        with MonitorListener() as listener, self.start_monitor() as monitor, \
                SimulatedRobot() as robot:
            listener.await_settled()
            robot.ahead += END_S - START_S - 3600
            await_condition('windows of the last hour', lambda: (
                listener.statuses[-1].window_start.to_sec() > END_S - 3600), 20)
            robot.ahead += 3600
            await_condition('ROS time stands still', lambda: any(
                NO_CLOCK.match(s.message) for s in listener.diagnostics('monitor')), 20)
            robot.ahead += START_S - END_S
            await_condition('windows of now', lambda: (
                listener.statuses[-1].window_start.to_sec() < END_S - 3600), 20)
            self.assertTrue(monitor.running())
            listener.await_settled()
            self.check_no_alarm(listener)


if __name__ == '__main__':
    rospy.init_node('sim_time_test')
    rostest.rosrun('self_awareness', 'sim_time', SimTimeTest)
