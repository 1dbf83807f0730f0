#!/usr/bin/python3
"""All nodes of one computer fall silent: the monitor names the computer."""

import signal

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticStatus

from live_system import MonitorListener, Process, again_if_disturbed, await_condition, talker
from monitor_case import TrainedCase
from self_awareness.msg import SelfAwareness

NODES = [('/laser', '/scan', 0.08), ('/imu', '/imu/data', 0.1), ('/camera', '/image', 0.1),
         ('/faces', '/people', 0.1)]
BASE = '127.0.0.2'
"""Where the first two of them run. All of 127.0.0.0/8 is this computer."""
SAID = 'everything on host {} fell silent: 2 nodes'.format(BASE)
SENTENCE = 'everything on host {} fell silent at '.format(BASE)


class HostsTest(TrainedCase):

    components = NODES

    @again_if_disturbed
    def test_the_computer_is_the_finding(self) -> None:
        # In Python: a node of roscpp that has an address of the loopback hears 127.0.0.1 only.
        base = [Process('rostopic', 'pub', '-r', '{:g}'.format(1 / period), topic,
                        'std_msgs/String', 'data: x', '__name:=' + name[1:],
                        env={'ROS_IP': BASE})
                for name, topic, period in NODES[:2]]
        others = [talker(name[1:], topic, 1 / period) for name, topic, period in NODES[2:]]
        for process in base + others:
            self.addCleanup(process.stop)
        with self.trained_monitor(unknown='ignore', settle_time=1.0), \
                MonitorListener() as listener:
            listener.await_heard(*(name for name, _, _ in NODES))
            for process in base:
                process.send(signal.SIGSTOP)  # as a computer that lost its network
            alarm = await_condition('the computer is named', lambda: next(
                (alarm for alarm in listener.alarms
                 if SENTENCE in alarm.message and alarm.level == SelfAwareness.ERROR), None), 20)
            self.assertEqual((alarm.kind, alarm.component, alarm.reason),
                             (SelfAwareness.ALL_SILENT, '', SAID))
            self.assertTrue({suspect.source for suspect in alarm.suspects} >= {'/laser', '/imu'})
            await_condition('diagnostics say it', lambda: any(
                SENTENCE in status.message and status.level == DiagnosticStatus.ERROR
                for status in listener.diagnostics('communication')), 10)


if __name__ == '__main__':
    rospy.init_node('hosts')  # as rostest calls it, too
    rostest.rosrun('self_awareness', 'hosts', HostsTest)
