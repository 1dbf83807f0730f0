#!/usr/bin/python3
"""Nodes that may be absent, and nodes that are started again, by hand or by roslaunch."""

import re
from typing import List

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticStatus
from rosgraph_msgs.msg import Log

from live_system import MonitorListener, again_if_disturbed, await_condition
from monitor_case import TrainedCase, base, driver
from self_awareness.msg import Incident, Incidents

NODE = '/self_awareness'


class RestartsTest(TrainedCase):

    def setUp(self) -> None:
        super().setUp()
        self.incidents: List[Incident] = []
        subscriber = rospy.Subscriber(NODE + '/incidents', Incidents, lambda message:
                                      setattr(self, 'incidents', message.incidents))
        self.addCleanup(subscriber.unregister)
        self.logged: List[str] = []
        log = rospy.Subscriber('/rosout', Log, lambda message: self.logged.append(message.msg)
                               if message.name == NODE else None)
        self.addCleanup(log.unregister)

    @again_if_disturbed
    def test_who_is_optional_may_be_absent_and_is_judged_while_there(self) -> None:
        rospy.set_param(NODE + '/optional', ['/driv*'])
        with base(), self.trained_monitor(), MonitorListener() as listener:
            listener.await_heard('/base')
            await_condition('it is absent', lambda: any(
                status.message == 'optional (absent)'
                for status in listener.diagnostics('/driver')), 20)
            with driver():
                listener.await_heard('/driver')
                await_condition('its rate', lambda: re.fullmatch(
                    r'[\d.]+ of 1[23](\.\d)? Hz', listener.value('/driver', '/scan') or ''), 20)
                await_condition('the share of its limit', lambda: re.fullmatch(
                    r'\d\d? %', listener.value('/base', 'share of limit') or ''), 20)
            self.assertFalse([status.message for status in listener.next_statuses(100)
                              if status.abnormal])
            self.assertEqual(listener.errors, [])
            self.assertEqual(listener.diagnostics('/driver')[-1].message, 'optional (absent)')
            with driver(30):
                alarm = listener.await_alarm()
                self.assertEqual(alarm.component, '/driver', 'it is there, and too fast')

    @again_if_disturbed
    def test_a_node_that_is_started_again_is_followed(self) -> None:
        with base(), self.trained_monitor(), MonitorListener() as listener:
            for times in range(1, 5):
                with driver():
                    listener.await_heard('/driver', '/base')
                    if times > 1:
                        await_condition('it is back', lambda: len(
                            [line for line in self.logged
                             if '/driver restarted at' in line]) == times - 1, 40)
                await_condition('it is gone', lambda: listener.statuses[-1].abnormal, 40)
            self.assertTrue(any('UTC, back as usual' in line for line in self.logged))
            self.assertIn('/driver restarted 3 times in 10 min', self.logged)
            await_condition('it is told', lambda: (
                listener.value('/driver', 'restarts') == 'restarted 3 times in 10 min'), 20)
            of_driver = [each for each in self.incidents if each.component == '/driver']
            self.assertEqual(len(of_driver), 1, 'all of it is one incident')
            with driver():
                await_condition('normal', lambda: listener.diagnostics('communication')[
                    -1].level == DiagnosticStatus.OK, 40)


if __name__ == '__main__':
    rospy.init_node('restarts_test')
    rostest.rosrun('self_awareness', 'restarts', RestartsTest)
