#!/usr/bin/python3
"""What an operator sees and does: incidents, mutes, what is accepted, who is started again."""

import json
import os
import signal
from typing import Any, Dict, List, Optional, Tuple

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticStatus
from rosgraph_msgs.msg import Log

from live_system import (MonitorListener, Process, again_if_disturbed, await_condition,
                         run_program, talker)
from monitor_case import TrainedCase, accept, base, driver, subscribers
from self_awareness.msg import Incident, Incidents, SelfAwareness
from self_awareness.srv import Mute, MuteResponse

NODE = '/self_awareness'


@again_if_disturbed
class OperatorTest(TrainedCase):

    def setUp(self) -> None:
        super().setUp()
        self.latest: Optional[List[Incident]] = None
        subscriber = rospy.Subscriber(NODE + '/incidents', Incidents, lambda message: setattr(
            self, 'latest', message.incidents))
        self.addCleanup(subscriber.unregister)
        self.logged: List[str] = []
        log = rospy.Subscriber('/rosout', Log, lambda message: self.logged.append(message.msg)
                               if message.name == NODE else None)
        self.addCleanup(log.unregister)

    def monitored(self) -> Process:
        return self.trained_monitor(unknown='ignore', subscribe='used', **{'recorder/after': 1})

    def of_driver(self) -> List[Incident]:
        return [each for each in self.latest or [] if each.component == '/driver'
                and each.level == SelfAwareness.ERROR]

    def await_incident(self, what: str, **fields: Any) -> Incident:
        """The only incident of the driver, once it is so."""
        def found() -> bool:
            of = self.of_driver()
            return len(of) == 1 and all(getattr(of[0], field) == value
                                        for field, value in fields.items())
        try:
            await_condition(what, found, 40)
        except AssertionError:
            print('of {}: {}'.format(what, self.of_driver()))
            raise
        return self.of_driver()[0]

    def listed(self) -> List[Dict[str, Any]]:
        return json.loads(run_program('incidents', '--json', '--file',
                                      self.path('recorder/self_awareness.incidents')))

    def test_an_incident_is_opened_repeated_and_over_and_outlives_the_monitor(self) -> None:
        with base():
            with self.monitored() as monitor, MonitorListener() as listener:
                await_condition('no incident yet', lambda: self.latest == [], 20)
                with driver() as victim:
                    listener.await_heard('/driver', '/base')
                    victim.send(signal.SIGKILL)
                    alarm = listener.await_alarm()
                    opened = self.await_incident('it is opened', over=False)
                self.assertEqual((opened.id, opened.kind, opened.alarms, opened.model),
                                 (alarm.alarm, alarm.kind, 1, self.path('model')))
                self.assertIn(opened.recording, alarm.message)
                with driver() as victim:
                    over = self.await_incident('it is over', over=True)
                    self.assertGreater(over.ended, over.opened)
                    listener.await_heard('/driver', '/base')
                    victim.send(signal.SIGKILL)
                    again = self.await_incident('it is the same again', over=False, alarms=2)
                self.assertEqual(again.id, opened.id)
                self.assertNotEqual(again.last, opened.last)
                await_condition('it is in the file', lambda: os.path.exists(
                    self.path('recorder/self_awareness.incidents'))
                    and any(each['alarms'] == 2 for each in self.listed()), 20)
                monitor.send(signal.SIGKILL)
                monitor.wait(10)
            kept, = [each for each in self.listed()
                     if (each['component'], each['level']) == ('/driver', 'ERROR')]
            self.assertEqual((kept['id'], kept['over']), (opened.id, False))
            self.latest = None
            with MonitorListener() as listener, self.monitored():
                alarm = await_condition('its alarm is back', lambda: next(
                    iter(listener.alarms), None), 5)
                self.assertEqual((alarm.level, alarm.alarm, alarm.component),
                                 (SelfAwareness.ERROR, again.last, '/driver'))
                stands = self.await_incident('it stands again', over=False)
                self.assertEqual((stands.id, stands.alarms), (opened.id, 2))
                self.assertEqual(stands.recording, opened.recording)
                # Longer than it settles, and than it holds an alarm whose cause is over.
                self.assertEqual({(status.level, status.alarm)
                                  for status in listener.next_statuses(50)},
                                 {(SelfAwareness.ERROR, again.last)})
                with driver():
                    self.await_incident('it is over at last', over=True, alarms=2)
                listener.await_settled()
            shown = run_program('incidents', str(opened.id), '--file',
                                self.path('recorder/self_awareness.incidents'))
            self.assertIn('/driver (/scan) fell silent at ', shown)
            self.assertIn('score {} --model {} --report'.format(
                opened.recording, self.path('model')), shown)

    # What an operator mutes

    def mute(self, **what: Any) -> MuteResponse:
        rospy.wait_for_service(NODE + '/mute', 20)
        return rospy.ServiceProxy(NODE + '/mute', Mute)(**what)

    def test_what_is_muted_is_judged_and_told_when_the_mute_ends(self) -> None:
        with base(), self.monitored() as monitor, \
                MonitorListener() as listener, driver() as victim:
            listener.await_heard('/driver', '/base')
            said = self.mute(component='/driv*', duration=15.0)
            self.assertTrue(said.success, said.message)
            self.assertRegex(said.message, r'not told until \d+-.* UTC: /driv\*')
            victim.send(signal.SIGKILL)
            alarm = listener.await_alarm()
            self.assertEqual(alarm.component, '/driver', 'it is judged, and for programs, told')
            self.await_incident('it is counted', over=False)
            listener.await_next('communication', 'muted (/driv* until', DiagnosticStatus.OK)
            self.assertEqual(listener.diagnostics('/driver')[-1].level, DiagnosticStatus.OK)
            self.assertIn('by ' + rospy.get_name(), listener.value('monitor', 'mute 1') or '')
            self.assertNotIn('[ERROR]', monitor.output)
            # By the log: a starved machine can make another one suspect, who is told at once.
            await_condition('its time is over', lambda: 'mute ended, since its time is over: '
                            '/driv*; 1 alarms and' in monitor.output, 60)
            listener.await_next('communication', 'stopped sending', DiagnosticStatus.ERROR)
            self.assertIsNone(listener.value('monitor', 'mute 1'))
            await_condition('it is told', lambda: '[ERROR]' in monitor.output, 20)
            # What stands may be accepted, too.
            said = accept(alarm=alarm.alarm)
            self.assertIn('/driver on /scan (silent)', said.message)
            listener.await_diagnostics('/driver', 'not watched: accepted', DiagnosticStatus.OK)
            await_condition('it is over', lambda: (
                listener.alarms[-1].level != SelfAwareness.ERROR), 20)

    def test_a_mute_of_nothing_or_for_ever_is_refused(self) -> None:
        with self.monitored():
            refused: List[Tuple[Dict[str, Any], str]] = [
                ({'duration': 5.0}, 'name a component, a topic or a kind'),
                ({'component': '/a'}, '/a is not muted'),
                ({'component': '/a', 'duration': 1e9}, 'from 1 to 86400 s'),
                ({'component': '/a', 'duration': float('nan')}, 'from 1 to'),
                ({'kind': 'odd', 'duration': 5.0}, 'kind: odd is not a kind')]
            for what, why in refused:
                said = self.mute(**what)
                self.assertFalse(said.success)
                self.assertIn(why, said.message)
            # How many it takes depends on how long they take.
            await_condition('further calls are refused', lambda: 'too many calls' in self.mute(
                component='/a', duration=5.0).message, 20)

    # What an operator accepts

    def await_value(self, listener: MonitorListener, key: str, words: str) -> None:
        await_condition('{}: {}'.format(key, words), lambda: (
            words in (listener.value('communication', key) or '')), 20)

    def test_a_new_node_is_told_once_and_accepted_for_other_starts(self) -> None:
        file = self.path('model.accepted')
        with base():
            with driver(), self.trained_monitor() as monitor, MonitorListener() as listener:
                listener.await_heard('/driver', '/base')
                with talker('joystick', '/joy', 10):
                    await_condition('it is told', lambda: any(
                        alarm.level == SelfAwareness.WARN and '/joystick' in alarm.message
                        for alarm in listener.alarms), 20)
                    await_condition('it is told no more', lambda: 'unknown events' not in (
                        listener.diagnostics('communication')[-1].message), 20)
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
            rospy.set_param(NODE + '/optional', ['/driv*'])
            with self.trained_monitor() as monitor, MonitorListener() as listener:
                with talker('joystick', '/joy', 10):
                    listener.await_heard('/base')
                    listener.await_diagnostics('/driver', 'optional (absent)')
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
                    self.assertEqual(listener.errors, [])

    # Who is started again, by hand or by roslaunch

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
            of_driver = [each for each in self.latest or [] if each.component == '/driver']
            self.assertEqual(len(of_driver), 1, 'all of it is one incident')
            with driver():
                await_condition('normal', lambda: listener.diagnostics('communication')[
                    -1].level == DiagnosticStatus.OK, 40)


if __name__ == '__main__':
    rospy.init_node('operator_test')
    rostest.rosrun('self_awareness', 'operator', OperatorTest)
