#!/usr/bin/python3
"""What an operator accepts is normal from now on, for other starts, too."""

import os

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticStatus

from live_system import MonitorListener, again_if_disturbed, await_condition, talker
from monitor_case import TrainedCase, accept, base, driver, subscribers
from self_awareness.msg import SelfAwareness

NODE = '/self_awareness'


class AcceptTest(TrainedCase):

    def await_value(self, listener: MonitorListener, key: str, words: str) -> None:
        await_condition('{}: {}'.format(key, words), lambda: (
            words in (listener.value('communication', key) or '')), 20)

    def await_normal(self, listener: MonitorListener) -> None:
        """Of what the robot says: that the machine is busy is no matter here."""
        def is_normal() -> bool:
            status = listener.diagnostics('communication')[-1]
            return (status.level != DiagnosticStatus.ERROR
                    and 'unknown events' not in status.message)
        await_condition('normal', is_normal, 20)

    @again_if_disturbed
    def test_a_new_node_is_told_once_and_accepted_for_other_starts(self) -> None:
        file = self.path('model.accepted')
        with base(), driver():
            with self.trained_monitor() as monitor, MonitorListener() as listener:
                listener.await_heard('/driver', '/base')
                with talker('joystick', '/joy', 10):
                    await_condition('it is told', lambda: any(
                        alarm.level == SelfAwareness.WARN and '/joystick' in alarm.message
                        for alarm in listener.alarms), 20)
                    self.await_normal(listener)
                    self.await_value(listener, 'not accepted, events so far', '/joystick on /joy')
                    said = accept(component='/joystick', topic='/joy', kind='stranger')
                    self.assertTrue(said.success, said.message)
                    self.assertIn('normal from now on: /joystick on /joy (stranger)',
                                  said.message)
                    self.await_value(listener, 'accepted', '/joystick on /joy (stranger), by '
                                     + rospy.get_name())
                    await_condition('it is not listed as new', lambda: not listener.value(
                        'communication', 'not accepted, events so far'), 20)
                    self.assertEqual(1, sum('unknown events' in alarm.message
                                            and '/joystick' in alarm.message
                                            for alarm in listener.alarms), 'it was told once')
                    await_condition('its file', lambda: os.path.exists(file), 20)
                monitor.stop()
            with self.trained_monitor() as monitor, MonitorListener() as listener:
                with talker('joystick', '/joy', 10):
                    listener.await_heard('/driver', '/base')
                    await_condition('it listens', lambda: NODE in subscribers('/joy'), 20)
                    with talker('another', '/new', 10):  # as long as it takes to tell of it
                        await_condition('another is told', lambda: any(
                            '/another' in alarm.message for alarm in listener.alarms), 20)
                    self.assertFalse([alarm for alarm in listener.alarms
                                      if '/joystick' in alarm.message])
                    said = accept(component='/joystick', topic='/joy', kind='stranger',
                                  undo=True)
                    self.assertTrue(said.success, said.message)
                    await_condition('it is told again', lambda: any(
                        '/joystick' in alarm.message for alarm in listener.alarms), 20)

    @again_if_disturbed
    def test_what_stands_is_accepted_until_it_is_trained(self) -> None:
        with self.trained_monitor(), MonitorListener() as listener, base():
            with driver():
                listener.await_heard('/driver', '/base')
            alarm = listener.await_alarm()
            self.assertEqual(alarm.component, '/driver')
            self.assertIn('does not stand any more', accept(alarm=alarm.alarm + 1).message)
            said = accept(alarm=alarm.alarm)
            self.assertTrue(said.success, said.message)
            self.assertIn('/driver on /scan (silent)', said.message)
            self.await_normal(listener)
            await_condition('it is not watched', lambda: (
                listener.value('/driver', 'death found after [s]') == 'not watched: accepted'), 20)
            self.assertIn('(silent)', listener.value('/driver', 'accepted'))
            self.await_value(listener, 'not watched', '/driver (accepted)')
            self.assertIn('not watched: accepted', listener.diagnostics('/driver')[-1].message)
            self.assertFalse([status.message for status in listener.next_statuses(50)
                              if any(each.component == '/driver' for each in status.suspects)])
            said = accept(component='/driver', undo=True)
            self.assertTrue(said.success, said.message)
            self.assertIn('judged again', said.message)
            await_condition('it is an alarm again', lambda: (
                listener.alarms[-1].level == SelfAwareness.ERROR), 20)
            self.assertFalse(accept(component='/driver', undo=True).success, 'it is not accepted')


if __name__ == '__main__':
    rospy.init_node('accept_test')
    rostest.rosrun('self_awareness', 'accept', AcceptTest)
