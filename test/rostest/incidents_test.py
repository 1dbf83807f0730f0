#!/usr/bin/python3
"""Incidents: one line for one cause, on a topic and in a file that outlives the monitor."""

import json
import os
import signal
import subprocess
from typing import Any, Dict, List

import rospy
import rostest

from live_system import (MonitorListener, Process, again_if_clock_was_set, await_condition,
                         operation, write_bag)
from monitor_case import MonitorCase
from self_awareness.msg import Incident, Incidents, SelfAwareness

NODE, NODELET = '/self_awareness', '/watch'


def talker(name: str, topic: str, rate: float) -> Process:
    """A node whose periods vary as those of operation()."""
    return Process('rosrun', 'self_awareness', 'talker.py', '__name:=' + name, '_output:=' + topic,
                   '_rate:={}'.format(rate), '_variation:=0.3')


def driver() -> Process:
    return talker('driver', '/scan', 12.5)


def run_program(*command: str) -> str:
    done = subprocess.run(['rosrun', 'self_awareness', *command], stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


class IncidentsTest(MonitorCase):

    def setUp(self) -> None:
        super().setUp()
        self.latest: Dict[str, List[Incident]] = {}
        for name in (NODE, NODELET):
            subscriber = rospy.Subscriber(
                name + '/incidents', Incidents,
                lambda message, name=name: self.latest.update({name: message.incidents}))
            self.addCleanup(subscriber.unregister)
        bags = [write_bag(self.path('{}.bag'.format(seed)), operation(
            [('/driver', '/scan', 0.08), ('/base', '/odom', 0.1)], 120, seed)) for seed in (1, 2)]
        run_program('train', *bags, '-o', self.path('model'))

    def trained_monitor(self) -> Process:
        options: Dict[str, Any] = {'recorder/after': 1}
        return self.monitor(self.path('model'), detector='evidence', **options)

    def nodelet(self) -> Process:
        rospy.set_param(NODELET, {'model': self.path('model'), 'settle_time': 0.5,
                                  'unknown': 'ignore', 'poll_interval': 0.1,
                                  'recorder': {'directory': self.path('other')}})
        self.addCleanup(rospy.delete_param, NODELET)
        return Process('rosrun', 'nodelet', 'nodelet', 'standalone',
                       'self_awareness/SelfAwareness', '__name:=' + NODELET[1:])

    def of_driver(self, name: str = NODE) -> List[Incident]:
        return [each for each in self.latest.get(name, []) if each.component == '/driver'
                and each.level == SelfAwareness.ERROR]

    def await_incident(self, what: str, name: str = NODE, **fields: Any) -> Incident:
        """The only incident of the driver, once it is so."""
        def found() -> bool:
            of = self.of_driver(name)
            return len(of) == 1 and all(getattr(of[0], field) == value
                                        for field, value in fields.items())
        await_condition(what, found, 40)
        return self.of_driver(name)[0]

    def await_heard(self, listener: MonitorListener) -> None:
        for node in ('/driver', '/base'):
            await_condition(node + ' is heard', lambda: (
                float(listener.value(node, 'events a second') or 0) > 5), 30)
        listener.await_settled()

    def listed(self, *options: str) -> List[Dict[str, Any]]:
        return json.loads(run_program('incidents', '--json', '--file',
                                      self.path('recorder/self_awareness.incidents'), *options))

    @again_if_clock_was_set
    def test_an_incident_is_opened_repeated_and_over_and_outlives_the_monitor(self) -> None:
        with talker('base', '/odom', 10):
            with self.trained_monitor() as monitor, MonitorListener() as listener:
                await_condition('no incident yet', lambda: self.latest.get(NODE) == [], 20)
                with driver() as victim:
                    self.await_heard(listener)
                    victim.send(signal.SIGKILL)
                    alarm = listener.await_alarm()
                    opened = self.await_incident('it is opened', over=False)
                self.assertEqual((opened.id, opened.kind, opened.alarms, opened.model),
                                 (alarm.alarm, alarm.kind, 1, self.path('model')))
                self.assertIn(opened.recording, alarm.message)
                with driver() as victim:
                    over = self.await_incident('it is over', over=True)
                    self.assertGreater(over.ended, over.opened)
                    self.await_heard(listener)
                    victim.send(signal.SIGKILL)
                    again = self.await_incident('it is the same again', over=False, alarms=2)
                self.assertEqual(again.id, opened.id)
                self.assertNotEqual(again.last, opened.last)
                await_condition('it is in the file', lambda: os.path.exists(
                    self.path('recorder/self_awareness.incidents'))
                    and any(each['alarms'] == 2 for each in self.listed()), 20)
                monitor.send(signal.SIGKILL)
                monitor.wait(10)
            kept, = [each for each in self.listed('--component', '/driver')
                     if each['level'] == 'ERROR']
            self.assertEqual((kept['id'], kept['over']), (opened.id, False))
            self.latest.clear()
            with self.trained_monitor(), MonitorListener() as listener:
                stands = self.await_incident('it stands again', over=False)
                self.assertEqual((stands.id, stands.alarms), (opened.id, 2))
                self.assertEqual(stands.recording, opened.recording)
                with driver():
                    self.await_incident('it is over at last', over=True, alarms=2)
                listener.await_settled()
            shown = run_program('incidents', str(opened.id), '--file',
                                self.path('recorder/self_awareness.incidents'))
            self.assertIn('/driver died', shown)
            self.assertIn('score {} --model {} --report'.format(
                opened.recording, self.path('model')), shown)

    @again_if_clock_was_set
    def test_a_nodelet_and_a_node_have_their_own(self) -> None:
        with talker('base', '/odom', 10), self.trained_monitor(), self.nodelet(), \
                MonitorListener() as listener, MonitorListener(NODELET) as other, \
                driver() as victim:
            self.await_heard(listener)
            self.await_heard(other)
            victim.send(signal.SIGKILL)
            of_node = self.await_incident('that of the node')
            of_nodelet = self.await_incident('that of the nodelet', NODELET)
            self.assertTrue(of_node.recording.startswith(self.path('recorder')))
            self.assertTrue(of_nodelet.recording.startswith(self.path('other')))
            await_condition('its file', lambda: os.path.exists(
                self.path('other/watch.incidents')), 20)


if __name__ == '__main__':
    rospy.init_node('incidents_test')
    rostest.rosrun('self_awareness', 'incidents', IncidentsTest)
