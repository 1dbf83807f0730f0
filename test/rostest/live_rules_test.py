#!/usr/bin/python3
"""The monitor at its edges: what it listens to, what it ignores, and what it says of bad input."""

import os
import random
import re
import signal
import statistics
import time
from contextlib import ExitStack
from typing import Dict, Tuple

import rospkg
import rospy
import rosservice
import rostest
import yaml
from diagnostic_msgs.msg import DiagnosticStatus
from std_msgs.msg import Float64, String
from visualization_msgs.msg import Marker

import self_awareness
from live_system import (MonitorListener, Process, again_if_disturbed, await_condition, ours,
                         pid_of, talker)
from monitor_case import MonitorCase, Talker, subscribers
from self_awareness.msg import SelfAwareness


def cpu_s(pid: int) -> float:
    """Processor time of a process until now [s], in steps of 10 ms."""
    with open('/proc/{}/stat'.format(pid)) as stat:
        user, system = stat.read().rsplit(')', 1)[1].split()[11:13]
    return (int(user) + int(system)) / os.sysconf('SC_CLK_TCK')


class LiveRulesTest(MonitorCase):

    # What it listens to

    @again_if_disturbed
    def test_a_lazy_publisher_is_woken_only_where_asked_to(self) -> None:
        with Talker('/a'), Talker('/lazy') as lazy:
            for policy, woken in (('used', False), ('model', False), ('all', True)):
                with self.monitor(self.model(), subscribe=policy), MonitorListener() as listener:
                    listener.await_settled()
                    # Two more polls of the master, and it would have been.
                    listener.await_heartbeats(2)
                    self.assertEqual(lazy.publisher.get_num_connections() > 0, woken, policy)
                await_condition('the monitor is gone',
                                lambda: '/self_awareness' not in subscribers('/a'), 20)

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
    def test_a_topic_whose_type_changes_is_an_unknown_event(self) -> None:
        with self.monitor(self.model(threshold=0.3)), MonitorListener() as listener:
            with Talker('/a'):
                listener.await_settled()
                self.assertEqual(sum(s.unknown_events for s in listener.statuses), 0)
            with Talker('/a', Float64):
                await_condition('unknown events', lambda: any(
                    s.unknown_events for s in listener.statuses), 20)
                suspect = await_condition('it is a suspect', lambda: next(
                    (x for s in listener.statuses for x in s.suspects
                     if x.type == 'std_msgs/Float64'), None), 20)
                self.assertIn('never seen in training', suspect.reason)

    @again_if_disturbed
    def test_unknown_events_may_be_an_alarm(self) -> None:
        with Talker('/a'), self.monitor(self.model(), unknown='error', subscribe='all'), \
                MonitorListener() as listener:
            listener.await_settled()
            with Talker('/joystick'):
                status = await_condition('the joystick is judged', lambda: next(
                    (s for s in listener.statuses if s.unknown_events and not s.settling),
                    None), 20)
            self.assertEqual(status.level, SelfAwareness.ERROR, status.message)
            self.assertIn('unknown events', status.evidence)

    @again_if_disturbed
    def test_what_is_sent_by_hand_is_a_suspicion_that_names_rostopic(self) -> None:
        with Talker('/a'), self.monitor(self.model(), unknown='warn'), \
                MonitorListener() as listener:
            listener.await_settled()
            with Process('rostopic', 'pub', '-1', '/a', 'std_msgs/String', 'data: by hand'):
                status = await_condition('the only message is judged', lambda: next(
                    (s for s in listener.statuses if s.unknown_events and not s.settling),
                    None), 20)
        self.assertEqual(status.level, SelfAwareness.WARN, status.message)
        self.assertIn('never seen in training, 1 in this window', status.message)

    @again_if_disturbed
    def test_the_type_field_is_read_from_live_messages(self) -> None:
        types = {'visualization_msgs/Marker': 'action'}
        with Talker('/a'), Talker('/marker', Marker), \
                self.monitor(self.model(threshold=0.9, type_fields=types), subscribe='all'), \
                MonitorListener() as listener:
            listener.await_settled()
            await_condition('the action is in the type', lambda: any(
                x.type == 'visualization_msgs/Marker[action=0]'
                for s in listener.statuses for x in s.suspects), 20)

    # Who tells its mode

    def mode_model(self) -> str:
        """A model of three starts of a robot that drives for 30 s, and is docked for 60 s.

        /planner plans while it drives; this node says so on /state; /imu comes all the time.
        """
        encoding = self_awareness.EncodingRules.defaults()
        encoding.exclude_topics += ['/rosout']
        encoding.mode = ('/state', 'data')
        text = 'std_msgs/String'
        types = [self_awareness.EventType(source, topic, kind) for source, topic, kind in (
            (rospy.get_name(), '/state', text),
            (rospy.get_name(), '/state', text + '[mode: DRIVING]'),
            (rospy.get_name(), '/state', text + '[mode: DOCKED]'),
            ('/planner', '/plan', text), ('/imu', '/imu', text))]
        learner = self_awareness.Learner(encoding=encoding)
        recordings = []
        for seed in range(3):
            rng = random.Random(seed)
            events = [(0.1 * (i + 0.3 * rng.random()), 4) for i in range(2700)]
            for begin in (0.0, 90.0, 180.0):
                events += [(begin, 1), (begin, 0), (begin + 30.0, 2), (begin + 30.0, 0)]
                events += [(begin + 0.5 + 0.1 * (i + 0.3 * rng.random()), 3) for i in range(294)]
            stamps = [int((1e3 * (seed + 1) + at) * 1e9) for at, _ in sorted(events)]
            ids = [event for _, event in sorted(events)]
            learner.count(types, stamps, ids, fingerprint=seed)
            recordings.append((stamps, ids, seed))
        model = learner.model()
        calibrator = self_awareness.Calibrator(model, 5 * 10**9)
        for stamps, ids, fingerprint in recordings:
            calibrator.add(stamps, ids, fingerprint)
        model.calibration = calibrator.find(0.5)
        model.save(self.path('model'))
        return self.path('model')

    def await_mode(self, listener: MonitorListener, pattern: str) -> None:
        await_condition('mode: ' + pattern, lambda: re.fullmatch(
            pattern, listener.value('monitor', 'mode') or ''), 20)

    @again_if_disturbed
    def test_a_mode_that_was_latched_tells_of_a_death(self) -> None:
        state = rospy.Publisher('/state', String, latch=True, queue_size=1)
        self.addCleanup(state.unregister)
        state.publish('DRIVING')
        with talker('imu', '/imu', 10), talker('planner', '/plan', 10) as planner, \
                self.monitor(self.mode_model(), detector='evidence', unknown='warn',
                             settle_time=1), MonitorListener() as listener:
            listener.await_heard('/planner', '/imu')
            self.await_mode(listener, r'DRIVING \(/state\), for [0-9]+ s')
            seen = len(listener.statuses)
            state.publish('LOST')
            self.await_mode(listener, r'LOST \(/state\), for [0-9]+ s, not seen in training')
            state.publish('DRIVING')
            self.await_mode(listener, r'DRIVING \(/state\), for [0-9]+ s')
            await_condition('both are told', lambda: sum(
                s.events for s in listener.statuses[seen:]) > 40, 20)
            self.call('/self_awareness/reset')  # the mode lasts
            listener.await_settled()
            planner.send(signal.SIGKILL)
            alarm = listener.await_alarm(30)
            self.assertEqual(alarm.suspects[0].source, '/planner')
            self.assertIn('of the mode DRIVING (/state)', alarm.message)
            self.assertEqual(sum(s.unknown_events for s in listener.statuses), 0)

    @again_if_disturbed
    def test_anonymous_names_are_one_source(self) -> None:
        """Two starts of an anonymous node are the same source of the model."""
        learner = self_awareness.Learner(
            encoding=self_awareness.EncodingRules.defaults(), paper=True)
        event = self_awareness.EventType('/talker', '/scan', 'std_msgs/String')
        learner.count([event], [10**12 + i * 10**8 for i in range(500)], [0] * 500)
        learner.model().save(self.path('anonymous'))
        with self.monitor(self.path('anonymous')), MonitorListener() as listener:
            for number in ('1795206538727453261', '4242_1795206538727'):
                heard = len(listener.diagnostics('/talker'))
                with talker('talker_' + number, '/scan', 10):
                    await_condition(number + ' is heard', lambda: any(
                        status.message == 'heard' and float(status.values[-1].value) > 5
                        for status in listener.diagnostics('/talker')[heard:]), 30)
            self.assertEqual(sum(s.unknown_events for s in listener.statuses), 0)

    @again_if_disturbed
    def test_monitors_in_one_manager_are_not_part_of_the_robot(self) -> None:
        """Nodelets in one manager share its name; a monitor there does not hear itself."""
        model = self.model(threshold=0.99, bonds=True)  # so that unknown events are named
        with Talker('/a'), Process('rosrun', 'nodelet', 'nodelet', 'manager',
                                   '__name:=robot_manager'):
            loads = [Process('rosrun', 'nodelet', 'nodelet', 'load',
                             'self_awareness/SelfAwareness', 'robot_manager', '__name:=' + name,
                             '_model:=' + model, '_detector:=paper', '_settle_time:=0.5',
                             '_subscribe:=all')
                     for name in ('watch_1', 'watch_2')]
            with loads[0], loads[1], MonitorListener('/watch_1') as first, \
                    MonitorListener('/watch_2') as second:
                for listener in (first, second):
                    listener.await_settled()
                # What else happens there is heard: the nodelets' bonds.
                await_condition('the bonds are heard', lambda: all(
                    any(x.scope == '/robot_manager/bond' for s in monitor.statuses
                        for x in s.suspects) for monitor in (first, second)), 20)
                topics = {x.scope for s in first.statuses + second.statuses for x in s.suspects}
                self.assertFalse({t for t in topics if 'watch' in t or 'diagnostics' in t}, topics)

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
    def test_the_processor_time_is_that_of_the_whole_process(self) -> None:
        topics = ['/topic{}'.format(number) for number in range(25)]
        with ExitStack() as busy, \
                self.monitor(self.model(topics=topics), diagnostic_period=0.5), \
                MonitorListener() as listener:
            for topic in topics:
                busy.enter_context(Talker(topic))
            listener.await_settled()
            pid = pid_of('/self_awareness')

            def await_report() -> Tuple[float, float]:
                """Time and processor time [s] right after the next report."""
                listener.await_heartbeats(1)
                return time.monotonic(), cpu_s(pid)

            begin, spent_before = await_report()
            first = len(listener.diagnostics('monitor'))
            listener.await_heartbeats(8)
            end, spent = await_report()
            reports = listener.diagnostics('monitor')[first:]
            told = statistics.mean(float(pair.value) for report in reports
                                   for pair in report.values
                                   if pair.key == 'share of a core spent')
            share = (spent - spent_before) / (end - begin)
            self.assertGreater(share, 0.005, 'too little to measure')
            self.assertAlmostEqual(told, share, delta=0.3 * share)

    @again_if_disturbed
    def test_not_calibrated_is_said_and_never_alarms(self) -> None:
        with self.monitor(self.model(threshold=None)), MonitorListener() as listener:
            with Talker('/a'):
                listener.await_settled()
            await_condition('silence', lambda: listener.statuses[-1].events == 0, 20)
            listener.next_statuses(20)
            self.assertEqual({s.level for s in listener.statuses}, {SelfAwareness.OK})
            self.assertEqual(listener.alarms, [])
            self.assertIn('not calibrated', listener.statuses[-1].message)
            status = listener.diagnostics('communication')[-1]
            self.assertEqual(status.level, DiagnosticStatus.WARN)
            self.assertIn('not calibrated', status.message)

    @again_if_disturbed
    def test_a_model_of_another_robot_is_said(self) -> None:
        model = self.model(topics=('/theirs', '/a'))
        with ExitStack() as robot, self.monitor(model, subscribe='all'), \
                MonitorListener() as listener:
            for topic in ('/a', '/b'):
                robot.enter_context(Talker(topic))
            listener.await_settled()
            await_condition('both are heard', lambda: (
                listener.value('monitor', 'publishers heard') == '2'), 20)
            self.assertNotIn('this robot', listener.diagnostics('communication')[-1].message)
            robot.enter_context(Talker('/c'))
            status = await_condition('it is said', lambda: next(
                (s for s in listener.diagnostics('communication') if 'this robot' in s.message),
                None), 20)
            self.assertEqual(status.level, DiagnosticStatus.WARN)
            self.assertIn('the model knows 1 of the 3 event types that were heard: is it of this '
                          'robot?', status.message)

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
