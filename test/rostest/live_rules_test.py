#!/usr/bin/python3
"""The monitor at its edges: what it listens to, what it ignores, and what it says of bad input."""

import os
import re
from contextlib import ExitStack
from typing import Dict

import rospkg
import rospy
import rosservice
import rostest
import yaml
from diagnostic_msgs.msg import DiagnosticStatus
from std_msgs.msg import Float64, String

from live_system import MonitorListener, Process, again_if_disturbed, await_condition, ours
from monitor_case import MonitorCase, Talker, subscribers
from self_awareness.msg import SelfAwareness


class OtherString(String):
    """A type of the same name as std_msgs/String, with another md5 sum and definition."""

    _md5sum = '0123456789abcdef0123456789abcdef'
    _full_text = 'string data\nstring more\n'


class LiveRulesTest(MonitorCase):

    # What it listens to

    @again_if_disturbed
    def test_a_used_topic_is_heard_and_left_again(self) -> None:
        with Talker('/a'), Talker('/used'), \
                self.monitor(self.model()), MonitorListener() as listener:
            listener.await_settled()
            other = rospy.Subscriber('/used', String)
            await_condition('unknown events', lambda: any(
                s.unknown_events for s in listener.statuses), 20)
            other.unregister()
            await_condition('the monitor leaves', lambda: (
                '/self_awareness' not in subscribers('/used')), 20)

    @again_if_disturbed
    def test_the_first_message_of_a_latching_connection_is_no_event(self) -> None:
        latching = rospy.Publisher('/latched', String, latch=True, queue_size=1)
        self.addCleanup(latching.unregister)
        latching.publish('published long ago')
        with Talker('/a'), self.monitor(self.model(), subscribe='all'), \
                MonitorListener() as listener:
            listener.await_settled()
            await_condition('both are heard', lambda: (
                listener.value('monitor', 'publishers heard') == '2'), 20)
            latching.publish('published now')
            await_condition('the second message is an event', lambda: any(
                s.unknown_events for s in listener.statuses), 20)
            listener.next_statuses(10)
            self.assertEqual(sum(s.unknown_events for s in listener.statuses), 1)

    @again_if_disturbed
    def test_a_topic_whose_type_changes_is_unknown_unless_the_type_has_the_same_name(self) -> None:
        with self.monitor(self.model(threshold=0.3)), MonitorListener() as listener:
            with Talker('/a'):
                listener.await_settled()
            before = len(listener.statuses)
            with Talker('/a', OtherString):
                await_condition('its messages are heard, and are those of the model', lambda: (
                    len(listener.statuses) > before + 20
                    and all(s.events > 0 and s.level == SelfAwareness.OK and not s.unknown_events
                            for s in listener.statuses[-15:])), 30)
            with Talker('/a', Float64):
                suspect = await_condition('it is a suspect', lambda: next(
                    (x for s in listener.statuses for x in s.suspects
                     if x.type == 'std_msgs/Float64'), None), 20)
            self.assertIn('never seen in training', suspect.reason)

    @again_if_disturbed
    def test_what_is_sent_by_hand_is_judged_as_unknown_events_are(self) -> None:
        with Talker('/a'), self.monitor(self.model(), unknown='error'), \
                MonitorListener() as listener:
            listener.await_settled()
            with Process('rostopic', 'pub', '-1', '/a', 'std_msgs/String', 'data: by hand'):
                status = await_condition('the only message is judged', lambda: next(
                    (s for s in listener.statuses if s.unknown_events and not s.settling),
                    None), 20)
        self.assertEqual(status.level, SelfAwareness.ERROR, status.message)
        self.assertIn('never seen in training, 1 in this window', status.message)

    # What it says of itself

    @again_if_disturbed
    def test_reset_and_clear(self) -> None:
        with self.monitor(self.model(), hold_time=600), MonitorListener() as listener:
            self.assertFalse(listener.diagnostics('communication')
                             and listener.alarms, 'nothing was heard yet')
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
                self.assertTrue(self.call('/self_awareness/reset').success)
                await_condition('settling', lambda: listener.statuses[-1].settling, 20)
            levels = [a.level for a in listener.alarms]
            # The first silent window is a suspicion, as a single one before may have been.
            raised = levels.index(SelfAwareness.ERROR)
            self.assertEqual(levels[raised - 1:raised + 2],
                             [SelfAwareness.WARN, SelfAwareness.ERROR, SelfAwareness.OK])
            self.assertEqual(levels.count(SelfAwareness.ERROR), 1)

    @again_if_disturbed
    def test_a_model_that_is_missing_is_said_and_can_be_loaded_later(self) -> None:
        with self.monitor(self.path('later')), MonitorListener() as listener, Talker('/a'):
            status = await_condition('the error in the diagnostics', lambda: next(
                iter(listener.diagnostics('communication')), None), 20)
            self.assertEqual(status.level, DiagnosticStatus.ERROR)
            self.assertIn(self.path('later') + ': no such file', status.message)
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
        bad: Dict[str, tuple] = {
            'settle_time': ('-1', '.nan', 'soon'), 'hold_time': ('-0.1', '.inf'),
            'alarm_windows': ('0', '6'), 'alarm_of': ('-3',), 'subscribe': ('everything',),
            'silence': ('golden',), 'poll_interval': ('0', '1e12'),
            'queue_size': ('0', '1.5'), 'detector': ('oracle', '7'), 'unknown': ('panic',),
            'diagnostic_period': ('-1', '0', 'abc'), 'source_diagnostics': ('maybe',),
            'hardware_id': ('5',), 'recorder/memory': ('1e12',), 'optional': ('/a', '5'),
            'diagnostic_bytes': ('99',)}
        model = self.model()
        cases = [(name, value) for name, values in bad.items() for value in values]
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

    def test_the_defaults_are_those_of_the_configuration_file(self) -> None:
        path = os.path.join(rospkg.RosPack().get_path('self_awareness'),
                            'config', 'self_awareness.yaml')
        with open(path) as file:
            configuration = yaml.safe_load(file)
        with ours('self_awareness_node') as monitor:
            await_condition('the monitor serves', lambda: rosservice.get_service_node(
                '/self_awareness/reload'), 20)
            monitor.stop()  # the log comes when the buffer is emptied
            logged = dict(re.findall(r'/self_awareness/([\w/]+): (.*?)(?:\x1b.*)?$',
                                     monitor.output, re.MULTILINE))
        configuration.update({'recorder/' + name: default for name, default
                              in configuration.pop('recorder').items()})
        for name, default in configuration.items():
            self.assertEqual(yaml.safe_load(logged[name]), default, name)

    def test_an_unknown_parameter_is_a_warning(self) -> None:
        with self.monitor(self.model(), treshold=1) as monitor:
            await_condition('the warning', lambda: (
                '/self_awareness/treshold is not a parameter' in monitor.output), 20)
            self.assertTrue(monitor.running())
            monitor.stop()  # what it logs of the others comes when the buffer is emptied
            self.assertIn('/self_awareness/alarm_of: 5', monitor.output)


if __name__ == '__main__':
    rospy.init_node('live_rules')  # as rostest calls it, too
    rostest.rosrun('self_awareness', 'live_rules', LiveRulesTest)
