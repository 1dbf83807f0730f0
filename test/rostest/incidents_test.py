#!/usr/bin/python3
"""Incidents: one line for one cause, on a topic and in a file that outlives the monitor."""

import json
import os
import signal
from typing import Any, Dict, List, Optional, Tuple

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticStatus

from live_system import (MonitorListener, Process, again_if_disturbed, await_condition,
                         run_program)
from monitor_case import TrainedCase, base, driver
from self_awareness.msg import Incident, Incidents, SelfAwareness
from self_awareness.srv import Mute, MuteResponse

NODE = '/self_awareness'


class IncidentsTest(TrainedCase):

    def setUp(self) -> None:
        super().setUp()
        self.latest: Optional[List[Incident]] = None
        subscriber = rospy.Subscriber(NODE + '/incidents', Incidents, lambda message: setattr(
            self, 'latest', message.incidents))
        self.addCleanup(subscriber.unregister)

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

    @again_if_disturbed
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
            with self.monitored(), MonitorListener() as listener:
                stands = self.await_incident('it stands again', over=False)
                self.assertEqual((stands.id, stands.alarms), (opened.id, 2))
                self.assertEqual(stands.recording, opened.recording)
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

    def await_level(self, listener: MonitorListener, level: int, words: str) -> None:
        """Waits for a status of the whole, from now on."""
        seen = len(listener.diagnostics('communication'))
        await_condition('{} with {}'.format(level, words), lambda: any(
            each.level == level and words in each.message
            for each in listener.diagnostics('communication')[seen:]), 20)

    @again_if_disturbed
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
            self.await_level(listener, DiagnosticStatus.OK, 'muted (/driv* until')
            self.assertEqual(listener.diagnostics('/driver')[-1].level, DiagnosticStatus.OK)
            self.assertIn('by ' + rospy.get_name(), listener.value('monitor', 'mute 1') or '')
            self.assertNotIn('[ERROR]', monitor.output)
            # By the log: a starved machine can make another one suspect, who is told at once.
            await_condition('its time is over', lambda: 'mute ended, since its time is over: '
                            '/driv*; 1 alarms and' in monitor.output, 60)
            self.await_level(listener, DiagnosticStatus.ERROR, 'stopped sending')
            self.assertIsNone(listener.value('monitor', 'mute 1'))
            await_condition('it is told', lambda: '[ERROR]' in monitor.output, 20)

    @again_if_disturbed
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


if __name__ == '__main__':
    rospy.init_node('incidents_test')
    rostest.rosrun('self_awareness', 'incidents', IncidentsTest)
