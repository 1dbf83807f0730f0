#!/usr/bin/python3
"""A second monitor of one name refuses: the first one goes on, with its parameters."""

import os
import re
import signal

import rosgraph
import rospy
import rostest

from live_system import MonitorListener, Process, await_condition, pid_of
from monitor_case import MonitorCase, Talker

NAME = '/self_awareness'
REFUSED = re.compile(NAME + r' runs already \(pid (\d+) on \S+, since \d{4}-\d\d-\d\d [\d:]{8}\): '
                     'stop it first .*`rosnode kill ' + NAME + '`.* another name')
WAITS = 'self_awareness cannot run (see above), and is not started again'


def pid_or_none() -> int:
    try:
        return pid_of(NAME)
    except (OSError, rosgraph.MasterException):
        return 0


class TwoMonitorsTest(MonitorCase):

    def setUp(self) -> None:
        super().setUp()
        self.good = self.model()

    def launch(self, file: str, model: str, *arguments: str) -> Process:
        return Process('roslaunch', 'self_awareness', file, 'model:=' + model, *arguments,
                       env={'ROS_HOME': self.path('.ros')})

    def await_judging(self, listener: MonitorListener) -> None:
        before = len(listener.statuses)
        await_condition('it judges', lambda: len(listener.statuses) > before + 5, 60)

    def check(self, first: str, second: str, *arguments: str) -> None:
        """A second launch, with a mistyped model, changes nothing, then and later."""
        with Talker('/a'), MonitorListener() as listener, \
                self.launch(first, self.good, *arguments):
            self.await_judging(listener)
            pid = pid_of(NAME)
            parameters = rospy.get_param(NAME)
            all_names = set(rospy.get_param_names())
            with self.launch(second, self.path('mistyped'), *arguments) as process:
                await_condition('it waits', lambda: WAITS in process.output, 60)
                refused = [line for line in process.output.splitlines() if REFUSED.search(line)]
                self.assertEqual(len(refused), 1, process.output)
                self.assertEqual(int(REFUSED.search(refused[0]).group(1)), pid)
                self.await_judging(listener)
                self.assertNotIn('process has died', process.output)
                self.assertNotIn('has finished cleanly', process.output)
            self.assertEqual(pid_of(NAME), pid)
            self.assertEqual(rospy.get_param(NAME), parameters)
            left = set(rospy.get_param_names()) - all_names
            self.assertEqual([name for name in left if 'self_awareness' in name], [])

            # It is dead, registered, and started again with what it had.
            rospy.set_param(NAME + '/alarm_of', 7)
            os.kill(pid, signal.SIGKILL)
            await_condition('it is back', lambda: pid_or_none() not in (0, pid), 30)
            self.await_judging(listener)
            self.assertEqual(rospy.get_param(NAME + '/model'), self.good)
            self.assertEqual(rospy.get_param(NAME + '/alarm_of'), 7)

    def test_the_monitor_beside_the_learner(self) -> None:
        self.check('learn.launch', 'monitor.launch')

    def test_two_nodelets(self) -> None:
        self.check('monitor.launch', 'monitor.launch', 'standalone:=false')

    def test_one_that_does_not_answer_keeps_nobody_out(self) -> None:
        with Talker('/a'), MonitorListener() as listener, self.monitor(self.good) as hangs:
            self.await_judging(listener)
            hangs.send(signal.SIGSTOP)
            with self.launch('monitor.launch', self.good) as process:
                self.await_judging(listener)
                self.assertNotIn('runs already', process.output)
                self.assertNotEqual(pid_of(NAME), hangs.pid)


if __name__ == '__main__':
    rospy.init_node('two_monitors_test')
    rostest.rosrun('self_awareness', 'two_monitors', TwoMonitorsTest)
