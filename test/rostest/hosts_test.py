#!/usr/bin/python3
"""All nodes of one computer fall silent: the monitor names the computer."""

import signal

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticStatus

from live_system import MonitorListener, again_if_disturbed, await_condition, talker
from monitor_case import TrainedCase
from self_awareness.msg import SelfAwareness

NODES = [('/laser', '/scan', 0.08), ('/imu', '/imu/data', 0.1), ('/camera', '/image', 0.1),
         ('/faces', '/people', 0.1)]
BASE, HERE = '127.0.0.2', '127.0.0.1'
"""Where the first two of them run, and the others. All of 127.0.0.0/8 is this computer."""
SAID = 'everything on host {} fell silent: 2 nodes'.format(BASE)


class HostsTest(TrainedCase):

    components = NODES

    @again_if_disturbed
    def test_the_computer_is_the_finding(self) -> None:
        nodes = [talker(name[1:], topic, 1 / period, env={'ROS_IP': address})
                 for (name, topic, period), address in zip(NODES, (BASE, BASE, HERE, HERE))]
        for process in nodes:
            self.addCleanup(process.stop)
        with self.trained_monitor(unknown='ignore', settle_time=1.0), \
                MonitorListener() as listener:
            listener.await_heard(*(name for name, _, _ in NODES))
            for process in nodes[:2]:
                process.send(signal.SIGSTOP)  # as a computer that lost its network
            alarm = await_condition('the computer is named', lambda: next(
                (alarm for alarm in listener.alarms
                 if SAID in alarm.message and alarm.level == SelfAwareness.ERROR), None), 20)
            self.assertEqual((alarm.kind, alarm.component, alarm.reason),
                             (SelfAwareness.ALL_SILENT, '', SAID))
            self.assertTrue({suspect.source for suspect in alarm.suspects} >= {'/laser', '/imu'})
            await_condition('diagnostics say it', lambda: any(
                SAID in status.message and status.level == DiagnosticStatus.ERROR
                for status in listener.diagnostics('communication')), 10)


if __name__ == '__main__':
    rospy.init_node('hosts')  # as rostest calls it, too
    rostest.rosrun('self_awareness', 'hosts', HostsTest)
