#!/usr/bin/python3
"""All nodes of one computer fall silent: the monitor names the computer."""

import signal
import subprocess

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticStatus

from live_system import (MonitorListener, Process, again_if_disturbed, await_condition,
                         operation, write_bag)
from monitor_case import MonitorCase
from self_awareness.msg import SelfAwareness

NODES = (('/laser', '/scan', 0.08), ('/imu', '/imu/data', 0.1), ('/camera', '/image', 0.1),
         ('/faces', '/people', 0.1))
BASE = '127.0.0.2'
"""Where the first two of them run. All of 127.0.0.0/8 is this computer."""
SAID = 'everything on host {} fell silent: 2 nodes'.format(BASE)


class HostsTest(MonitorCase):

    def trained(self) -> str:
        bags = [write_bag(self.path('{}.bag'.format(seed)), operation(NODES, 120, seed))
                for seed in (1, 2)]
        subprocess.run(['rosrun', 'self_awareness', 'train', *bags, '-o', self.path('model')],
                       check=True, stdout=subprocess.DEVNULL)
        return self.path('model')

    def start(self, node: str, topic: str, period: float, address: str) -> Process:
        process = Process('rosrun', 'self_awareness', 'talker.py', '__name:=' + node[1:],
                          '_output:=' + topic, '_rate:={}'.format(1 / period), '_variation:=0.3',
                          env={'ROS_IP': address})
        self.addCleanup(process.stop)
        return process

    def await_heard(self, listener: MonitorListener, name: str) -> None:
        await_condition(name + ' is heard', lambda: (
            float(listener.value(name, 'events a second') or 0) > 5), 30)

    @again_if_disturbed
    def test_the_computer_is_the_finding(self) -> None:
        model = self.trained()
        base = [self.start(*node, BASE) for node in NODES[:2]]
        for node in NODES[2:]:
            self.start(*node, '127.0.0.1')
        with self.monitor(model, detector='evidence', settle_time=1.0, subscribe='all'), \
                MonitorListener() as listener:
            for name, _, _ in NODES:
                self.await_heard(listener, name)
            listener.await_settled()
            for process in base:
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
