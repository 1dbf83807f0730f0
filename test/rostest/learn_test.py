#!/usr/bin/python3
"""launch/learn.launch: learns the robot through a crash, goes on as the monitor, finds a fault."""

import glob
import os
import re
import signal

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from std_srvs.srv import Trigger

from live_system import MonitorListener, Process, again_if_disturbed, await_condition, pid_of
from monitor_case import FolderCase
from self_awareness import TrainedModel
from self_awareness.msg import SelfAwareness

# 50 s are the least to find limits on, and a third of the recordings is for that.
HOURS = 0.06
LEARNING_S = 500
FINISH = '/self_awareness/finish'


def recorded(listener: MonitorListener) -> float:
    """How much the last status says to be recorded [min]; NaN: there is none yet."""
    statuses = listener.diagnostics('communication')
    match = re.match(r'learning: ([0-9.]+) min of 3\.6 min', statuses[-1].message
                     ) if statuses else None
    return float(match.group(1)) if match else float('nan')


class LearnCase(FolderCase):

    def setUp(self) -> None:
        super().setUp()
        self.model = self.path('robot.model')
        for topic in ('/scan', '/pose', '/odom'):
            rospy.wait_for_message(topic, rospy.AnyMsg, 60)
        # A driver that says how it is: as on most robots, somebody reads that.
        driver = rospy.Publisher('/diagnostics', DiagnosticArray, queue_size=10)
        timer = rospy.Timer(rospy.Duration(0.2), lambda _: driver.publish(DiagnosticArray()))
        self.addCleanup(timer.shutdown)

    def learn(self, hours: float) -> Process:
        # Limits of minutes are narrow: few false alarms are allowed on a busy machine.
        return Process('roslaunch', 'self_awareness', 'learn.launch', 'model:=' + self.model,
                       'hours:={}'.format(hours), 'start_up:=2', 'subscribe:=all',
                       'budget:=0.01')

    def await_log(self) -> None:
        """Waits until a log is being written."""
        await_condition('a log', lambda: glob.glob(self.model + '.logs/*.bag.active'), 30)


@again_if_disturbed
class LearnedTest(LearnCase):

    def test_from_nothing_to_an_alarm(self) -> None:
        with MonitorListener() as listener, self.learn(HOURS) as process:
            listener.await_next('communication', ', 1 start of the robot', DiagnosticStatus.OK, 60)
            self.await_log()
            # The last 20 s are lost.
            await_condition('30 s are recorded', lambda: recorded(listener) >= 0.5, 90)
            os.kill(pid_of('/self_awareness_recorder'), signal.SIGKILL)
            listener.await_next('communication', ', 2 starts of the robot',
                                DiagnosticStatus.OK, 60)
            self.assertGreater(recorded(listener), 0.0)
            self.assertIn('mended: ' + self.model + '.logs', process.output)

            settled = listener.await_settled(LEARNING_S)
            self.assertNotEqual(settled.level, SelfAwareness.ERROR)
            self.assertEqual(settled.unknown_events, 0)
            self.assertRegex(process.output, r'(?m)^learned from 2 starts, \d min: at most .*; '
                             'deaths of ')
            # Where the machine was busy all the time, as beside other tests, none is injected.
            self.assertRegex(process.output, r'(?m)^(faults: found \d+ of \d+, half of them |'
                             'no fault is injected into these, in which the machine was busy)')
            sources = {kind.source for kind in TrainedModel.load(self.model).event_types}
            self.assertLessEqual({'/player', '/slam', '/base', rospy.get_name()}, sources)
            self.assertEqual([name for name in sources if 'self_awareness' in name], [])

            os.kill(pid_of('/player'), signal.SIGKILL)
            listener.await_culprit('/player', '/scan')
            self.check_respawned(listener)

    def check_respawned(self, listener: MonitorListener) -> None:
        """A monitor that crashes comes back as the monitor."""
        pid = pid_of('/self_awareness')
        os.kill(pid, signal.SIGKILL)
        before = len(listener.statuses)
        said = len(listener.diagnostics('communication'))
        await_condition('the monitor is back', lambda: len(listener.statuses) > before, 60)
        self.assertNotEqual(pid_of('/self_awareness'), pid)
        self.assertEqual([status.message for status in listener.diagnostics('communication')[said:]
                          if 'learning' in status.message], [])


class NotLearnedTest(LearnCase):

    def test_too_little_is_said_and_recording_goes_on(self) -> None:
        with MonitorListener() as listener, self.learn(1.0):
            rospy.wait_for_service(FINISH, 60)
            finish = rospy.ServiceProxy(FINISH, Trigger)
            await_condition('it records', lambda: finish().success, 30)
            listener.await_next('communication', 'failed: the recordings are too short',
                                DiagnosticStatus.WARN, 60)
            await_condition('it records again', lambda: finish().success, 30)
            # The robot was not started again.
            listener.await_next('communication', ', 1 start of the robot',
                                DiagnosticStatus.WARN, 30)
            self.await_log()
        # Who ends it leaves complete logs; the recorder may end after the one who started it.
        await_condition('complete logs', lambda: not glob.glob(self.model + '.logs/*.active'), 30)
        self.assertTrue(glob.glob(self.model + '.logs/*.bag'))
        self.assertFalse(os.path.exists(self.model))


if __name__ == '__main__':
    rospy.init_node('learning')
    what = rospy.get_param('~what')
    rostest.rosrun('self_awareness', what,
                   {'learned': LearnedTest, 'not_learned': NotLearnedTest}[what])
