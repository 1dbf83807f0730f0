#!/usr/bin/python3
"""Without a robot, learn.launch and the monitor say why they hear nothing; no such time counts."""

import re

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticStatus

from live_system import MonitorListener, Process, again_if_disturbed, await_condition, operation, \
    write_bag
from monitor_case import MonitorCase, Talker
from self_awareness.msg import Components

NO_ROBOT = 'nothing is heard: no node of a robot publishes anything; learning: 0.0 min of 3.0 min'
SILENT = 'nothing is heard: nothing is sent on /scan; learning: '


def minutes(status: DiagnosticStatus) -> float:
    return float(re.search(r'learning: ([0-9.]+) min of 3\.0 min', status.message).group(1))


@again_if_disturbed
class NoRobotTest(MonitorCase):

    def test_a_monitor_beside_a_player_names_it(self) -> None:
        bag = write_bag(self.path('robot.bag'), operation(
            [('/lidar', '/a', 0.1), ('/slam', '/b', 0.1), ('/base', '/c', 0.1)], 60, 1))
        with self.monitor(self.model(sources={'/a': '/lidar'})), MonitorListener() as listener, \
                Process('rosbag', 'play', '--loop', '--quiet', bag):
            said = listener.await_diagnostics(
                'communication', ' plays 3 topics; players are left out: use `score BAG`',
                DiagnosticStatus.WARN)
            self.assertRegex(said.message, r'nothing has been heard for 1\d s: /play_\d+ plays')
            components = {each.name: each for each in rospy.wait_for_message(
                '/self_awareness/components', Components, 20).components}
            self.assertEqual(components['/lidar'].state, 'not heard yet')
            # This process looks at the monitor: it is in the graph, and nobody is unlisted.
            self.assertEqual(components[rospy.get_name()].not_watched,
                             'it publishes nothing that is listened to')

    def test_what_is_not_heard_is_told_and_does_not_count(self) -> None:
        def last() -> DiagnosticStatus:
            statuses = listener.diagnostics('communication')
            return statuses[-1] if statuses else DiagnosticStatus()

        with MonitorListener() as listener, Process(
                'roslaunch', 'self_awareness', 'learn.launch', 'model:=' + self.path('model'),
                'hours:=0.05', 'subscribe:=all') as process:
            await_condition('no robot', lambda: last().message.startswith(NO_ROBOT), 60)
            self.assertEqual(last().level, DiagnosticStatus.WARN)
            with Talker('/scan') as talker:
                await_condition('it counts', lambda: last().level == DiagnosticStatus.OK
                                and minutes(last()) > 0.1, 60)
                self.assertIn('the robot is heard', process.output)
                talker.stop()
                await_condition('silence', lambda: last().message.startswith(SILENT), 30)
                counted, seen = minutes(last()), len(listener.diagnostics('communication'))
                await_condition('8 s more', lambda: len(
                    listener.diagnostics('communication')) > seen + 8, 30)
                self.assertEqual(minutes(last()), counted)
            for why in (NO_ROBOT, SILENT):
                said = 'does not count: ' + why.replace('nothing is heard: ', '').split(';')[0]
                self.assertGreaterEqual(process.output.count(said), 1, said)
            self.assertLess(process.output.count('nothing is heard'), 8, process.output)


if __name__ == '__main__':
    rospy.init_node('no_robot_test')
    rostest.rosrun('self_awareness', 'no_robot', NoRobotTest)
