#!/usr/bin/python3
"""Nodes that may be absent, and nodes that are started again, by hand or by roslaunch."""

import os
import re
import signal
import subprocess
from typing import List

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticStatus
from rosgraph_msgs.msg import Log

from accept_test import NODE, TrainedCase, talker
from live_system import MonitorListener, Process, again_if_disturbed, await_condition
from self_awareness.msg import Incident, Incidents, SelfAwareness
from self_awareness.srv import Mute


def driver(rate: float = 12.5):
    return talker('driver', '/scan', rate)


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

    def await_windows(self, listener: MonitorListener, number: int) -> int:
        """Waits for so many windows; returns how many there were before."""
        seen = len(listener.statuses)
        await_condition('windows', lambda: len(listener.statuses) > seen + number, 60)
        return seen

    @again_if_disturbed
    def test_who_is_optional_may_be_absent_and_is_judged_while_there(self) -> None:
        rospy.set_param(NODE + '/optional', ['/driv*'])
        with talker('base', '/odom', 10), self.trained_monitor(), MonitorListener() as listener:
            self.await_heard(listener, '/base')
            await_condition('it is absent', lambda: any(
                status.message == 'optional (absent)'
                for status in listener.diagnostics('/driver')), 20)
            with driver():
                self.await_heard(listener, '/driver')
                await_condition('its rate', lambda: re.fullmatch(
                    r'[\d.]+ of 1[23](\.\d)? Hz', listener.value('/driver', '/scan') or ''), 20)
                await_condition('the share of its limit', lambda: re.fullmatch(
                    r'\d\d? %', listener.value('/base', 'share of limit') or ''), 20)
            seen = self.await_windows(listener, 100)
            self.assertFalse([status.message for status in listener.statuses[seen:]
                              if status.abnormal])
            self.assertFalse([alarm.message for alarm in listener.alarms
                              if alarm.level == SelfAwareness.ERROR])
            self.assertEqual(listener.diagnostics('/driver')[-1].message, 'optional (absent)')
            with driver(30):
                alarm = listener.await_alarm()
                self.assertEqual(alarm.component, '/driver', 'it is there, and too fast')

    @again_if_disturbed
    def test_a_node_that_is_started_again_is_followed(self) -> None:
        with talker('base', '/odom', 10), self.trained_monitor(), MonitorListener() as listener:
            for times in range(1, 5):
                with driver():
                    self.await_heard(listener, '/driver', '/base')
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

    @again_if_disturbed
    def test_of_a_fleet_it_is_followed_by_the_names_of_the_model_and_can_be_muted(self) -> None:
        subprocess.run(['rosrun', 'self_awareness', 'train', *self.bags, '-o', self.path('model'),
                        '--rename', '/r[0-9]+/(.*)', '/\\1'], check=True,
                       stdout=subprocess.DEVNULL)

        def of_r7(name: str, topic: str, rate: float) -> Process:
            return Process('rosrun', 'self_awareness', 'talker.py', '__ns:=/r7',
                           '__name:=' + name, '_output:=' + topic, '_rate:={}'.format(rate),
                           '_variation:=0.3')

        with of_r7('base', '/r7/odom', 10), self.trained_monitor(), \
                MonitorListener() as listener:
            rospy.wait_for_service(NODE + '/mute', 20)
            mute = rospy.ServiceProxy(NODE + '/mute', Mute)
            self.assertTrue(mute(component='/driver', duration=600).success)
            for times in range(4):
                with of_r7('driver', '/r7/scan', 12.5):
                    self.await_heard(listener, '/driver', '/base')
                    if times > 0:
                        await_condition('it is told how often', lambda: (
                            listener.value('/driver', 'restarts') or '').startswith(
                                'restarted {} time'.format(times)), 20)
                        await_condition('it is back', lambda: sum(
                            '/driver restarted at' in line for line in self.logged) == times, 60)
                await_condition('it is gone', lambda: listener.statuses[-1].abnormal, 40)
            status = listener.diagnostics('/driver')[-1]
            self.assertEqual(status.level, DiagnosticStatus.OK, status.message)
            self.assertTrue(any(
                re.fullmatch(r'muted \(.*\): /driver restarted 3 times in 10 min', line)
                for line in self.logged))
            self.assertNotIn('/driver restarted 3 times in 10 min', self.logged)
            self.assertFalse([each for each in self.incidents if 'restarted' in each.reason])
            with of_r7('driver', '/r7/scan', 12.5):
                await_condition('normal', lambda: not listener.statuses[-1].abnormal, 40)
                self.assertTrue(mute(component='/driver', duration=0).success)
                await_condition('it is told', lambda: (
                    listener.diagnostics('/driver')[-1].level == DiagnosticStatus.WARN), 40)

    @again_if_disturbed
    def test_what_stood_stands_again_until_it_was_heard_for_long_enough(self) -> None:
        hold_time = 2.0
        with talker('base', '/odom', 10):
            with self.trained_monitor() as monitor, MonitorListener() as listener:
                with driver() as victim:
                    self.await_heard(listener, '/driver', '/base')
                    victim.send(signal.SIGKILL)
                    alarm = listener.await_alarm()
                await_condition('it is kept', lambda: os.path.exists(
                    self.path('recorder/self_awareness.alarm')), 20)
                monitor.send(signal.SIGKILL)
                monitor.wait(10)
            with self.trained_monitor(settle_time=5.0, hold_time=hold_time), \
                    MonitorListener() as listener:
                await_condition('it stands again', lambda: any(
                    (each.level, each.alarm) == (SelfAwareness.ERROR, alarm.alarm)
                    for each in listener.alarms), 20)
                with driver() as victim:
                    await_condition('a message', lambda: float(
                        listener.value('/driver', 'events a second') or 0) > 0, 20)
                    victim.send(signal.SIGKILL)
                seen = self.await_windows(listener, 100)
                self.assertEqual({(each.level, each.alarm) for each in listener.statuses[seen:]},
                                 {(SelfAwareness.ERROR, alarm.alarm)}, 'one word is not enough')
                with driver():
                    started_at = rospy.get_time()
                    await_condition('it is over', lambda: (
                        listener.alarms[-1].level == SelfAwareness.OK), 40)
                    self.assertGreater(rospy.get_time() - started_at, hold_time)


if __name__ == '__main__':
    rospy.init_node('restarts_test')
    rostest.rosrun('self_awareness', 'restarts', RestartsTest)
