#!/usr/bin/python3
"""A master that comes late, hangs, dies and is restarted, and a dead node that it still knows."""

import glob
import json
import os
import signal
import sys
import time
from typing import Any, Dict, List, TypeVar

import rosgraph
import rostest
from diagnostic_msgs.msg import DiagnosticStatus

from live_system import Process, again_if_disturbed, await_condition, make_model, path_of
from monitor_case import FolderCase
from self_awareness import EncodingRules, read_events
from self_awareness.msg import SelfAwareness
from self_awareness_evaluation.live.processes import free_port

_Kept = TypeVar('_Kept', bound=Process)

LISTENER = os.path.join(os.path.dirname(os.path.abspath(__file__)), 'listener.py')
COMPONENTS = (('/talker', '/from/talker', 0.05), ('/beside', '/from/beside', 0.5))
"""Source, topic and mean period [s]."""
LONGEST_HEARTBEAT_S = 2.5
LONGEST_END_S = 3.0
"""After a signal."""
LONGEST_SILENCE_S = 5.0
"""After a restart of the master."""


class Listener(Process):
    """listener.py, a client of the monitor that only needs the master to come to life."""

    def messages(self, topic: str, since: float = 0, **fields: Any) -> List[Dict[str, Any]]:
        """The messages of a topic since then [s of time.monotonic()] that have these fields."""
        lines = self.output.split('\n')[:-1]  # the last one is empty, or not complete yet
        messages = [json.loads(line) for line in lines if line.startswith('{')]
        return [message for message in messages
                if message['topic'] == topic and message['at'] > since
                and all(message[name] == value for name, value in fields.items())]

    def await_message(self, topic: str, since: float = 0, number: int = 1, timeout: float = 30,
                      **fields: Any) -> Dict[str, Any]:
        """Waits for so many of these messages; returns the last."""
        try:
            return await_condition(
                '{} of {} with {} since {:.2f}'.format(number, topic, fields, since),
                lambda: (self.messages(topic, since, **fields)[number - 1:] or [None])[-1],
                timeout)
        except AssertionError as error:
            raise AssertionError('{}; the last at {:.2f}:\n{}'.format(
                error, time.monotonic(), self.output[-1500:]))

    def longest_heartbeat(self) -> float:
        """The longest time between two statuses of the monitor itself [s]."""
        beats = [message['at'] for message in self.messages('diagnostics', task='monitor')]
        return max(later - earlier for earlier, later in zip(beats, beats[1:]))


@again_if_disturbed
class MasterTest(FolderCase):

    def setUp(self) -> None:
        super().setUp()
        self.model = self.path('model')
        make_model(self.model, COMPONENTS)
        self.port = free_port()
        self.uri = 'http://localhost:{}'.format(self.port)
        self.environment = {'ROS_MASTER_URI': self.uri, 'ROS_HOSTNAME': 'localhost'}

    def start(self, *command: str) -> Process:
        """Starts a process that is killed when the test ends: with no master, none ends well."""
        return self.keep(Process(*command, env=self.environment))

    def keep(self, process: _Kept) -> _Kept:
        self.addCleanup(process.stop)
        self.addCleanup(process.send, signal.SIGKILL)
        return process

    def start_master(self) -> Process:
        # Not roscore: that runs the master as a child in a process group of its own.
        master = self.start('rosmaster', '--core', '-p', str(self.port))
        await_condition('the master answers', self.master().is_online, 30)
        return master

    def start_monitor(self, name: str = 'self_awareness') -> Process:
        # A busy machine may hold messages back for some windows, so an alarm needs a second.
        return self.start(path_of('self_awareness_node'), '__name:=' + name,
                          '_model:=' + self.model, '_detector:=paper',
                          '_unknown:=ignore', '_poll_interval:=0.2', '_settle_time:=1.0',
                          '_alarm_windows:=10', '_alarm_of:=15', '_hold_time:=1.0',
                          '_recorder/directory:=' + self.path('recorder'))

    def start_component(self, name: str) -> Process:
        topic, period = next((topic, period) for source, topic, period in COMPONENTS
                             if source == name)
        return self.start(path_of('talker'), '__name:=' + name[1:], '_output:=' + topic,
                          '_rate:={}'.format(1 / period))

    def start_listener(self) -> Listener:
        return self.keep(Listener(sys.executable, LISTENER, env=self.environment))

    def master(self) -> rosgraph.Master:
        return rosgraph.Master('/master_test', master_uri=self.uri)

    def registered(self, kind: int, name: str) -> List[str]:
        """Nodes that publish (0), subscribe to (1) or serve (2) this name, as the master knows."""
        return dict(self.master().getSystemState()[kind]).get(name, [])

    def await_normal(self, listener: Listener) -> None:
        """Waits until normal operation has been going on for a while; there was no alarm."""
        listener.await_message('status', settling=False, abnormal=False, number=20)
        self.check_no_alarm(listener)

    def check_no_alarm(self, listener: Listener, since: float = 0) -> None:
        """There was none; a busy machine may have made single windows a suspicion."""
        self.assertEqual(listener.messages('alarm', since, level=SelfAwareness.ERROR), [])

    def test_master_comes_late(self) -> None:
        monitor = self.start_monitor()
        await_condition('the monitor misses the master',
                        lambda: 'Failed to contact master' in monitor.output, 30)
        self.start_master()
        listener = self.start_listener()
        listener.await_message('diagnostics', task='monitor', level=DiagnosticStatus.OK, number=3)
        self.start_component('/talker')
        self.start_component('/beside')
        self.await_normal(listener)
        self.assertTrue(monitor.running())

    def test_master_hangs_and_dies(self) -> None:
        master = self.start_master()
        self.start_monitor()
        listener = self.start_listener()
        self.start_component('/beside')
        talker = self.start_component('/talker')
        self.await_normal(listener)

        hung = time.monotonic()
        master.send(signal.SIGSTOP)
        warning = listener.await_message('diagnostics', hung, task='monitor',
                                         level=DiagnosticStatus.WARN)
        self.assertEqual(warning['message'], 'the master does not answer')
        self.check_no_alarm(listener)
        killed = time.monotonic()
        talker.send(signal.SIGKILL)
        alarm = listener.await_message('alarm', killed, level=SelfAwareness.ERROR)
        self.assertEqual(alarm['suspects'][0], '/talker')
        listener.await_message('diagnostics', killed, task='/talker',
                               level=DiagnosticStatus.ERROR)
        listener.await_message('diagnostics', killed, task='monitor', number=2)

        woken = time.monotonic()
        master.send(signal.SIGCONT)
        self.start_component('/talker')
        listener.await_message('alarm', woken, level=SelfAwareness.OK)
        listener.await_message('diagnostics', woken, task='monitor', message='listening')

        dead = time.monotonic()
        master.send(signal.SIGKILL)
        warning = listener.await_message('diagnostics', dead, task='monitor',
                                         level=DiagnosticStatus.WARN)
        self.assertEqual(warning['message'], 'the master does not answer')
        listener.await_message('status', warning['at'], abnormal=False, number=20)
        self.check_no_alarm(listener, dead)
        self.assertLess(listener.longest_heartbeat(), LONGEST_HEARTBEAT_S)

    def test_the_nodes_end_whatever_the_master_does(self) -> None:
        for hangs in (True, False):
            master = self.start_master()
            nodes = [self.start_monitor(), self.start(
                path_of('record_events'), '__name:=recorder_1', '_min_space:=0',
                '_subscribe:=all', '_output:=' + self.path('log'))]
            learner = self.start(path_of('learn'), '--subscribe', 'all', '__name:=learner',
                                 '_model:=' + self.path('learned'))
            listener = self.start_listener()
            listener.await_message('diagnostics', task='monitor')  # it hears what comes now
            self.start_component('/talker')
            listener.await_message('diagnostics', task='/talker', message='heard')
            for recorder in ('/recorder_1', '/learner_recorder'):
                await_condition(recorder + ' listens', lambda: (
                    recorder in self.registered(1, '/from/talker')), 30)
            seen = time.monotonic()
            listener.await_message('status', seen, number=10)  # messages for the recorders, too
            master.send(signal.SIGSTOP if hangs else signal.SIGKILL)
            late = self.start_monitor('late')  # waits for the master from the start
            told = time.monotonic()
            for node, number in zip(nodes, (signal.SIGTERM, signal.SIGINT)):
                node.send(number)
            for node in (late, learner):
                node.send(signal.SIGTERM)
                node.wait(20)
            for node in nodes:
                self.assertEqual(node.wait(20), 0, node.output)
            self.assertLess(time.monotonic() - told, LONGEST_END_S)
            log, = glob.glob(self.path('log*.bag'))
            self.assertGreater(read_events(log, EncodingRules.defaults(),
                                           recording=0).stamps.size, 0)
            self.doCleanups()
            self.setUp()

    def test_master_is_restarted(self) -> None:
        master = self.start_master()
        monitor = self.start_monitor()
        listener = self.start_listener()
        listener.await_message('diagnostics', task='monitor', number=2)
        for process in (master, listener):
            process.send(signal.SIGKILL)
            process.wait(10)

        # One talker registers before the monitor notices that the master is another one.
        monitor.send(signal.SIGSTOP)
        self.start_master()
        self.start_component('/talker')
        await_condition('the talker registers', lambda: self.registered(0, '/from/talker'), 30)
        monitor.send(signal.SIGCONT)

        noticed = time.monotonic()
        for topic in ('/self_awareness/status', '/self_awareness/alarm', '/diagnostics'):
            await_condition('the monitor publishes ' + topic, lambda: (
                '/self_awareness' in self.registered(0, topic)), 20)
        await_condition('the monitor listens', lambda: (
            '/self_awareness' in self.registered(1, '/from/talker')), 20)
        self.assertLess(time.monotonic() - noticed, LONGEST_SILENCE_S)
        for service in ('reset', 'clear', 'reload', 'set_logger_level'):
            await_condition('the monitor serves ' + service, lambda: (
                self.registered(2, '/self_awareness/' + service)), 20)
        with Process('rosservice', 'call', '/self_awareness/reset',
                     env=self.environment) as client:
            self.assertEqual(client.wait(30), 0, client.output)
            self.assertIn('success: True', client.output)

        # The other one registers afterwards. Both are heard, and so is the monitor itself.
        self.start_component('/beside')
        listener = self.start_listener()
        for task in ('/talker', '/beside'):
            listener.await_message('diagnostics', task=task, message='heard')
        listener.await_message('diagnostics', task='monitor', message='listening')
        heard = time.monotonic()  # until then, one of them was missing
        listener.await_message('status', heard, settling=False, abnormal=False, number=20)
        self.check_no_alarm(listener, heard)


if __name__ == '__main__':
    rostest.rosrun('self_awareness', 'master', MasterTest)
