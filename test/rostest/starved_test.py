#!/usr/bin/python3
"""A machine with too much to do is told from its nodes, live and in a file of the recorder."""

import multiprocessing
import os
import re
import time

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticStatus

from live_system import (MonitorListener, Process, again_if_disturbed, await_condition,
                         run_program)
from monitor_case import TrainedCase, base, driver
from self_awareness.msg import SelfAwareness

PRESSURE = '/proc/pressure/cpu'
"""Where the kernel tells for how long processes wait; not every one does."""
LOOP = 'while True: pass'
MOST_WAITING = 0.3
"""Share of the time for which processes wait, at most, where a test can tell a load of its own."""


def waited() -> float:
    """For how long processes have waited for a processor since the machine began [s]."""
    with open(PRESSURE) as file:
        return int(file.read().split('total=')[1].split()[0]) / 1e6


@again_if_disturbed
class StarvedTest(TrainedCase):

    def setUp(self) -> None:
        super().setUp()
        if not os.path.exists(PRESSURE):
            self.skipTest('this kernel does not tell its pressure: no ' + PRESSURE)

    def test_busy_loops_are_the_machines_fault(self) -> None:
        with driver(), base(), self.monitor(self.path('model'), detector='evidence'), \
                MonitorListener() as listener:
            before, since = waited(), time.monotonic()
            listener.await_heard('/driver', '/base')
            share = (waited() - before) / (time.monotonic() - since)
            if share > MOST_WAITING:  # to the monitor, that is usual
                self.skipTest('this machine has too much to do already: processes wait for '
                              '{:.0%} of the time'.format(share))
            began = rospy.get_time()
            loops = [Process('python3', '-c', LOOP)
                     for _ in range(2 * multiprocessing.cpu_count())]
            try:
                said = await_condition('the machine is starved', lambda: next(
                    (status for status in listener.statuses
                     if status.kind == SelfAwareness.BUSY_MACHINE
                     and status.header.stamp.to_sec() > began), None), 20)
                self.assertLess(said.header.stamp.to_sec() - began, 3)
                self.assertEqual(said.level, SelfAwareness.WARN)
                self.assertEqual([suspect.component for suspect in said.suspects], [])
                self.assertEqual(said.component, '')
                self.assertRegex(said.message,
                                 r'the machine has been starved for \d\.\d s \(load ')
                listener.await_diagnostics('communication', 'starved', DiagnosticStatus.WARN)
            finally:
                for loop in loops:
                    loop.stop()
            await_condition('it is over', lambda: (
                listener.statuses[-1].level == SelfAwareness.OK), 20)
            response = self.call('/self_awareness/dump')
            path = re.search(r' go to (\S+\.bag)$', response.message).group(1)
            await_condition('it is written', lambda: os.path.exists(path), 20)
        printed = run_program('score', path, '--model', self.path('model'), '--unknown', 'ignore',
                              '--settle-time', '0.5', '--details')
        self.assertIn('machine has been starved for', printed)
        self.assertIn('alarms: 0,', printed)


if __name__ == '__main__':
    rospy.init_node('starved')  # as rostest calls it, too
    rostest.rosrun('self_awareness', 'starved', StarvedTest)
