#!/usr/bin/python3
"""The monitor at its edges: what it hears, when it settles, bad input, systems that mean ill."""

import os
import re
import socket
import statistics
import subprocess
import time
from contextlib import ExitStack
from typing import List

import rosgraph
import rospkg
import rospy
import rosservice
import rostest
import yaml
from diagnostic_msgs.msg import DiagnosticStatus
from roscpp.srv import GetLoggers, SetLoggerLevel
from std_msgs.msg import Float64, String

from live_system import (MonitorListener, Process, again_if_disturbed, await_condition, ours,
                         talker)
from monitor_case import MadeUpPublishers, MonitorCase, Talker
from self_awareness.msg import SelfAwareness


class OtherString(String):
    """A type of the same name as std_msgs/String, with another md5 sum and definition."""

    _md5sum = '0123456789abcdef0123456789abcdef'
    _full_text = 'string data\nstring more\n'


@again_if_disturbed
class LiveRulesTest(MonitorCase):

    # What it listens to

    def test_a_topic_whose_type_changes_is_unknown_unless_the_type_has_the_same_name(self) -> None:
        with self.monitor(self.model(threshold=0.3), unknown='error'), \
                MonitorListener() as listener:
            with Talker('/a'):
                listener.await_settled()
            before = len(listener.statuses)
            with Talker('/a', OtherString):
                await_condition('its messages are heard, and are those of the model', lambda: (
                    len(listener.statuses) > before + 20
                    and all(s.events > 0 and s.level == SelfAwareness.OK and not s.unknown_events
                            for s in listener.statuses[-15:])), 30)
            with Talker('/a', Float64):
                status = await_condition('it is judged', lambda: next(
                    (s for s in listener.statuses if s.unknown_events and not s.settling),
                    None), 20)
        self.assertEqual(status.level, SelfAwareness.ERROR, status.message)
        self.assertIn('std_msgs/Float64', [suspect.type for suspect in status.suspects])
        self.assertIn('never seen in training', status.message)

    # When it settles

    def test_the_first_message_of_a_publisher_that_was_there_lets_nothing_settle(self) -> None:
        rare = rospy.Publisher('/rare', String, queue_size=1)
        self.addCleanup(rare.unregister)
        with Talker('/a'), self.monitor(self.model(topics=('/a', '/rare'))), \
                MonitorListener() as listener:
            listener.await_settled()
            await_condition('the monitor listens', rare.get_num_connections, 20)
            listener.await_heartbeats(2)
            self.assertEqual(listener.value('monitor', 'publishers heard'), '1',
                             'its own reports, which it hears, do not count')
            seen = len(listener.statuses)
            rare.publish()
            await_condition('it is heard', lambda: (
                listener.value('monitor', 'publishers heard') == '2'), 20)
            listener.next_statuses(5)
            self.assertEqual({s.settling for s in listener.statuses[seen:]}, {False})

    # By the paper's detector: the whole robot settles.

    def test_settling_does_not_wait_for_the_next_poll_of_the_master(self) -> None:
        model = self.model(topics=('/a', '/late'), sources={'/late': '/late'})
        with Talker('/a'), self.monitor(model, poll_interval=3600), \
                MonitorListener() as listener:
            listener.await_settled()
            with talker('late', '/late', 10):
                await_condition('settling', lambda: listener.statuses[-1].settling, 20)

    # ~reload

    def test_reload_takes_the_model_that_is_set_now(self) -> None:
        first, second = self.model(name='first'), self.model(name='second', topics=('/a', '/b'))
        with Talker('/a'), Talker('/b'), self.monitor(first), MonitorListener() as listener:
            listener.await_settled()
            rospy.set_param('/self_awareness/model', second)
            response = self.call('/self_awareness/reload')
            self.assertTrue(response.success, response.message)
            self.assertIn(second, response.message)
            await_condition('the other model is said', lambda: (
                listener.value('communication', 'model') == second), 20)
            listener.await_settled()
            await_condition('events of both', lambda: listener.statuses[-1].events > 2, 20)
            for bad in (self.path('missing'), 42):
                rospy.set_param('/self_awareness/model', bad)
                response = self.call('/self_awareness/reload')
                self.assertFalse(response.success)
                self.assertIn('the old model stays', response.message)
            self.assertEqual(listener.value('communication', 'model'), second)
            # As after a restart of the master, which forgets its parameters.
            rospy.delete_param('/self_awareness/model')
            self.assertIn(second, self.call('/self_awareness/reload').message)

    def test_after_reload_windows_are_judged_in_the_pace_of_the_new_model(self) -> None:
        arrivals: List[float] = []
        with self.monitor(self.model(window=4 * 10**9)), MonitorListener() as listener:
            with Talker('/a'):
                listener.next_statuses(1)
                self.model(window=10**8)
                self.assertTrue(self.call('/self_awareness/reload').success)
                listener.await_settled()
            # In silence, no event tells the monitor that a window is over.
            await_condition('silence', lambda: listener.statuses[-1].events == 0, 20)
            subscriber = rospy.Subscriber('/self_awareness/status', SelfAwareness,
                                          lambda _: arrivals.append(time.monotonic()))
            self.addCleanup(subscriber.unregister)
            await_condition('20 statuses', lambda: len(arrivals) > 20, 20)
        gaps = [later - earlier for earlier, later in zip(arrivals, arrivals[1:])]
        self.assertGreater(statistics.median(gaps), 0.05, gaps)

    # What it says of itself

    def test_reset_and_clear(self) -> None:
        with self.monitor(self.model(), hold_time=600) as monitor, \
                MonitorListener() as listener:
            with Talker('/a'):
                listener.await_settled()
                self.assertEqual(self.call('/self_awareness/clear').message, 'there is no alarm')
            listener.await_alarm()  # silence
            with Talker('/a'):
                await_condition('normal windows while the alarm is held', lambda: (
                    listener.statuses[-1].level == SelfAwareness.ERROR
                    and not listener.statuses[-1].abnormal), 20)
                self.assertTrue(self.call('/self_awareness/clear').success)
                await_condition('the alarm is cleared', lambda: (
                    listener.alarms[-1].level == SelfAwareness.OK), 20)
                self.assertEqual(listener.alarms[-1].message,
                                 'cleared by hand, by ' + rospy.get_name())
                taken_back = await_condition('it is on record', lambda: (
                    listener.value('monitor', 'alarm taken back')), 20)
                self.assertIn(' by {} at 20'.format(rospy.get_name()), taken_back)
                self.assertTrue(self.call('/self_awareness/reset').success)
                await_condition('settling', lambda: listener.statuses[-1].settling, 20)
            # Who calls in a loop is answered sometimes.
            answers = [self.call('/self_awareness/reload') for _ in range(200)]
            self.assertTrue(0 < sum(answer.success for answer in answers) < 10)
            self.assertIn('too many calls', answers[-1].message)
            monitor.stop()  # what it logs comes when the buffer is emptied
            self.assertLess(len(monitor.output), 20000)

    def test_a_model_that_is_missing_is_said_and_can_be_loaded_later(self) -> None:
        with self.monitor(self.path('later')), MonitorListener() as listener, Talker('/a'):
            listener.await_diagnostics('communication', self.path('later') + ': no such file',
                                       DiagnosticStatus.ERROR)
            response = self.call('/self_awareness/reload')
            self.assertFalse(response.success)
            self.assertIn('no such file', response.message)
            self.model(name='later')
            self.assertTrue(self.call('/self_awareness/reload').success)
            self.assertEqual(listener.await_settled().level, SelfAwareness.OK)
            # A file that cannot be used does not take the model that is in use away, nor does a
            # pipe, whose reader would wait for ever.
            with open(self.path('later'), 'w') as file:
                file.write('no model')
            response = self.call('/self_awareness/reload')
            self.assertFalse(response.success)
            self.assertIn('the old model stays', response.message)
            os.remove(self.path('later'))
            os.mkfifo(self.path('later'))
            self.assertIn('not a file', self.call('/self_awareness/reload').message)
            listener.next_statuses(5)

    def test_bad_parameters_are_named(self) -> None:
        # Of each kind; test/python/test_monitor_manual.py has the range of every parameter.
        cases = [('settle_time', '-1'), ('settle_time', '.nan'), ('settle_time', 'soon'),
                 ('poll_interval', '1e12'), ('queue_size', '0'), ('queue_size', '1.5'),
                 ('alarm_windows', '6'), ('detector', 'oracle'), ('detector', '7'),
                 ('source_diagnostics', 'maybe'), ('hardware_id', '5'), ('optional', '/a'),
                 ('recorder/memory', '1e12')]
        model = self.model()
        with ExitStack() as all_at_once:
            monitors = [all_at_once.enter_context(self.monitor(
                model, 'bad_{}'.format(number), **{name: value}))
                for number, (name, value) in enumerate(cases)]
            for (name, value), monitor in zip(cases, monitors):
                self.assertEqual(monitor.wait(40), 1, '{}={}'.format(name, value))
                self.assertRegex(monitor.output, name + ' is .*, it must be ', value)

    def test_a_bad_parameter_of_a_nodelet_is_named(self) -> None:
        with Process('rosrun', 'nodelet', 'nodelet', 'standalone', 'self_awareness/SelfAwareness',
                     '__name:=self_awareness', '_settle_time:=-1') as manager:
            await_condition('the parameter is named', lambda: (
                'settle_time is -1' in manager.output), 20)

    def test_defaults_are_those_of_the_configuration_and_what_is_unknown_is_told(self) -> None:
        path = os.path.join(rospkg.RosPack().get_path('self_awareness'),
                            'config', 'self_awareness.yaml')
        with open(path) as file:
            configuration = yaml.safe_load(file)
        with ours('self_awareness_node', '_treshold:=1') as monitor:
            await_condition('the monitor serves', lambda: rosservice.get_service_node(
                '/self_awareness/reload'), 20)
            monitor.stop()  # the log comes when the buffer is emptied
            self.assertIn('/self_awareness/treshold is not a parameter', monitor.output)
            logged = dict(re.findall(r'/self_awareness/([\w/]+): (.*?)(?:\x1b.*)?$',
                                     monitor.output, re.MULTILINE))
        configuration.update({'recorder/' + name: default for name, default
                              in configuration.pop('recorder').items()})
        for name, default in configuration.items():
            self.assertEqual(yaml.safe_load(logged[name]), default, name)

    # In a system that is broken, or means ill

    def test_rosnode_kill_ends_it_in_order_whatever_it_logs(self) -> None:
        """roscpp takes its ports away before it says that it ends."""
        for level in 2 * ('info', 'debug'):
            with Talker('/a'), self.monitor(self.model()) as monitor, \
                    MonitorListener() as listener:
                listener.await_settled()
                # As rqt does: it lists the loggers at first, where that is offered.
                services = dict(rosgraph.Master(rospy.get_name()).getSystemState()[2])
                if '/self_awareness/get_loggers' in services:
                    rospy.ServiceProxy('/self_awareness/get_loggers', GetLoggers)()
                for logger in ('ros.self_awareness', 'ros.roscpp', 'ros'):
                    rospy.ServiceProxy('/self_awareness/set_logger_level', SetLoggerLevel)(
                        logger, level)
                self.assertTrue(any(s.events for s in listener.next_statuses(10)))
                subprocess.run(['rosnode', 'kill', '/self_awareness'], check=True,
                               stdout=subprocess.DEVNULL)
                self.assertEqual(monitor.wait(20), 0, monitor.output)
                self.assertNotIn('Assertion', monitor.output, level)

    def test_who_does_not_answer_is_not_heard_and_not_silent(self) -> None:
        model = self.model(topics=('/a', '/b'), sources={'/b': '/made_up_0'})
        with Talker('/a'), socket.create_server(('127.0.0.1', 0)) as silent, \
                MadeUpPublishers(['/b'], 'http://127.0.0.1:{}/'.format(silent.getsockname()[1])), \
                self.monitor(model, alarm_windows=1), MonitorListener() as listener:
            warning = listener.await_diagnostics(
                'monitor', '/made_up_0 on /b (does not answer)', DiagnosticStatus.WARN)
            self.assertTrue(warning.message.startswith('not heard: '), warning.message)
            listener.await_settled()
            listener.await_diagnostics('/made_up_0', 'not heard by the monitor: does not answer')
            self.assertEqual([s.message for s in listener.statuses
                              if '/made_up' in s.message and 'silent' in s.message], [])


if __name__ == '__main__':
    rospy.init_node('live_rules')  # as rostest calls it, too
    rostest.rosrun('self_awareness', 'live_rules', LiveRulesTest)
