#!/usr/bin/python3
"""The monitor in a system of ROS 1 that is broken, or means ill."""

import os
import socket
import struct
import subprocess
import time
from contextlib import ExitStack
from typing import Any, List
from urllib.parse import urlsplit
from xmlrpc.client import ServerProxy

import rosgraph
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticStatus
from roscpp.srv import GetLoggers, SetLoggerLevel

from fake_publisher import FakePublisher, string_header
from live_system import MonitorListener, Process, again_if_disturbed, await_condition, pid_of
from monitor_case import MonitorCase, Talker, publishers, subscribers
from self_awareness.msg import SelfAwareness

MEGABYTE = 10**6
ALARM = '/self_awareness/alarm'
AT_ONCE_S = 5.0
"""Within so long the monitor hears whom it can hear, and names the others."""


def slave_uri() -> str:
    return rosgraph.Master(rospy.get_name()).lookupNode('/self_awareness')


def slave_socket() -> socket.socket:
    address = urlsplit(slave_uri())
    return socket.create_connection((address.hostname or '', address.port or 0), timeout=5)


def resident_of(pid: int) -> int:
    with open('/proc/{}/statm'.format(pid)) as statm:
        return int(statm.read().split()[1]) * os.sysconf('SC_PAGESIZE')


class HostileTest(MonitorCase):
    def check_no_error(self, listener: MonitorListener) -> None:
        self.assertEqual([alarm.message for alarm in listener.alarms
                          if alarm.level == SelfAwareness.ERROR], [])

    def await_heard(self, listener: MonitorListener, timeout: float = 20) -> None:
        """Waits for the next window that settled and has events."""
        seen = len(listener.statuses)
        await_condition('events are heard', lambda: any(
            s.events > 0 and not s.settling for s in listener.statuses[seen:]), timeout)

    def await_warning(self, listener: MonitorListener, part: str,
                      timeout: float = 20) -> DiagnosticStatus:
        seen = len(listener.diagnostics('monitor'))
        return await_condition('a warning of ' + part, lambda: next(
            (s for s in listener.diagnostics('monitor')[seen:]
             if part in s.message and s.level == DiagnosticStatus.WARN), None), timeout)

    @again_if_disturbed
    def test_rosnode_kill_ends_it_in_order(self) -> None:
        """roscpp takes its ports away before it says that it ends."""
        for attempt in range(4):
            with Talker('/a'), self.monitor(self.model()) as monitor, \
                    MonitorListener() as listener:
                listener.await_settled()
                subprocess.run(['rosnode', 'kill', '/self_awareness'], check=True,
                               stdout=subprocess.DEVNULL)
                self.assertEqual(monitor.wait(20), 0, monitor.output)
                self.assertNotIn('Assertion', monitor.output, attempt)

    # Who is heard

    @again_if_disturbed
    def test_forged_updates_and_lost_registrations_silence_nobody(self) -> None:
        with Talker('/a'), self.monitor(self.model()), MonitorListener() as listener:
            listener.await_settled()
            uri = slave_uri()
            slave: Any = ServerProxy(uri)
            for uris in ([], ['http://127.0.0.1:9/'], ['http://no-such-host.invalid:1/']):
                slave.publisherUpdate('/master', '/a', uris)
                self.await_heard(listener, AT_ONCE_S)
            # As `rosnode cleanup` does with a node that it cannot reach.
            master: Any = ServerProxy(rosgraph.get_master_uri())
            for answer in (master.unregisterSubscriber('/self_awareness', '/a', uri),
                           master.unregisterPublisher('/self_awareness', ALARM, uri)):
                self.assertEqual(answer[2], 1, 'one registration is taken back')
            await_condition('it is registered again', lambda: (
                '/self_awareness' in subscribers('/a')
                and '/self_awareness' in publishers(ALARM)), AT_ONCE_S)
            self.await_heard(listener, AT_ONCE_S)
            self.check_no_error(listener)

    @again_if_disturbed
    def test_a_thousand_idle_connections_keep_nobody_out(self) -> None:
        model = self.model()
        with ExitStack() as stack:
            with Talker('/a'):
                # So few files that the idle connections take all of them.
                stack.enter_context(self.limited_monitor(model, files=256))
                listener = stack.enter_context(MonitorListener())
                listener.await_settled()
                idle = self.idle_connections(400)
                for connection in idle:
                    self.addCleanup(connection.close)
            # The publisher starts again.
            with Talker('/a'):
                self.await_warning(listener, 'connections to this node were closed', 15)
                self.await_heard(listener, 15)

    def limited_monitor(self, model: str, files: int) -> Process:
        return Process('prlimit', '--nofile={}'.format(files), 'rosrun', 'self_awareness',
                       'self_awareness_node', '_model:=' + model, '_detector:=paper',
                       '_unknown:=ignore', '_settle_time:=0.5', '_poll_interval:=0.1',
                       '_recorder/directory:=' + self.path('recorder'))

    def idle_connections(self, number: int) -> List[socket.socket]:
        connections = []
        for _ in range(number):
            try:
                connections.append(slave_socket())
            except OSError:
                break  # there are enough
        return connections

    @again_if_disturbed
    def test_who_does_not_answer_is_not_heard_and_not_silent(self) -> None:
        model = self.model(topics=('/a', '/b'), sources={'/b': '/fake'})
        with Talker('/a'), FakePublisher('/b', b'', answers=False), \
                self.monitor(model, alarm_windows=1), MonitorListener() as listener:
            warning = self.await_warning(listener, '/fake on /b (does not answer)')
            self.assertTrue(warning.message.startswith('not heard: '), warning.message)
            listener.await_settled()
            await_condition('the component is told', lambda: any(
                'not heard by the monitor: does not answer' in s.message
                for s in listener.diagnostics('/fake')), 20)
            said = [s.message for s in listener.statuses]
            self.assertEqual([each for each in said if '/fake' in each and 'silent' in each], [])

    # Operators

    @again_if_disturbed
    def test_services_that_are_called_in_a_loop(self) -> None:
        with Talker('/a') as talker, self.monitor(self.model(), alarm_windows=1) as monitor, \
                MonitorListener() as listener:
            listener.await_settled()
            self.assertTrue(self.call('/self_awareness/dump').success)
            talker.stop()
            alarm = listener.await_alarm()
            self.check_answered_sometimes('clear')
            again = listener.alarms[-1]  # it is back
            self.assertEqual(again.level, SelfAwareness.ERROR)
            self.assertNotEqual(again.header.stamp, alarm.header.stamp)
            answer = self.call('/self_awareness/clear')
            self.assertFalse(answer.success)
            self.assertIn('too many calls', answer.message)
            self.assertIn('cleared by hand, by ' + rospy.get_name(),
                          [each.message for each in listener.alarms])
            taken_back = await_condition('it is on record', lambda: (
                listener.value('monitor', 'alarm taken back')), 20)
            self.assertIn(' by {} at 20'.format(rospy.get_name()), taken_back)
            self.check_answered_sometimes('reload')
            monitor.stop()  # what it logs comes when the buffer is emptied
            self.assertLess(len(monitor.output), 20000)

    @again_if_disturbed
    def test_a_logger_that_is_set_to_debug(self) -> None:
        with Talker('/a'), self.monitor(self.model()), MonitorListener() as listener:
            listener.await_settled()
            # As rqt does: it lists the loggers at first, where that is offered.
            services = dict(rosgraph.Master(rospy.get_name()).getSystemState()[2])
            if '/self_awareness/get_loggers' in services:
                rospy.ServiceProxy('/self_awareness/get_loggers', GetLoggers)()
            for logger in ('ros.self_awareness', 'ros.roscpp', 'ros'):
                rospy.ServiceProxy('/self_awareness/set_logger_level', SetLoggerLevel)(
                    logger, 'debug')
            self.await_heard(listener)

    def check_answered_sometimes(self, service: str) -> None:
        answers = [self.call('/self_awareness/' + service).success for _ in range(200)]
        self.assertLess(sum(answers), 10, service)
        self.assertGreater(sum(answers), 0, service)

    # What it costs

    @again_if_disturbed
    def test_announced_gigabytes_take_no_memory(self) -> None:
        huge = struct.pack('<I', 900 * MEGABYTE)
        type_fields = {'std_msgs/String': 'data'}  # the content of messages is needed
        with Talker('/a'), self.monitor(self.model(type_fields=type_fields, threshold=-1.0),
                                        subscribe='all'), MonitorListener() as listener:
            listener.await_settled()
            pid = pid_of('/self_awareness')
            before = resident_of(pid)
            with ExitStack() as stack:
                for number in range(3):
                    name = '/message_{}'.format(number)
                    message = string_header(name, name) + huge + bytes(200 * MEGABYTE)
                    stack.enter_context(FakePublisher(name, message, node=name))
                stack.enter_context(FakePublisher('/header', huge + bytes(200 * MEGABYTE),
                                                  node='/header'))
                self.await_warning(listener, '/header on /header (announces a header of 900 MB)')
                most = 0
                end = time.monotonic() + 3
                while time.monotonic() < end:
                    most = max(most, resident_of(pid))
                    time.sleep(0.01)
                self.assertLess(most, before + 60 * MEGABYTE)
                self.await_heard(listener, AT_ONCE_S)

    @again_if_disturbed
    def test_subscribers_that_announce_a_gigabyte_are_cut_off(self) -> None:
        with Talker('/a'), self.monitor(self.model()), MonitorListener() as listener:
            listener.await_settled()
            pid = pid_of('/self_awareness')
            before = resident_of(pid)
            slave: Any = ServerProxy(slave_uri())
            answer = slave.requestTopic(rospy.get_name(), '/self_awareness/status', [['TCPROS']])
            connections = [socket.create_connection((answer[2][1], answer[2][2]), timeout=15)
                           for _ in range(60)]
            for connection in connections:
                self.addCleanup(connection.close)
                connection.sendall(struct.pack('<I', 1000 * MEGABYTE) + b'abc')
            for connection in connections:
                self.assertEqual(connection.recv(1), b'', 'it is closed')
            self.assertLess(resident_of(pid), before + 60 * MEGABYTE)
            self.await_heard(listener, AT_ONCE_S)

    @again_if_disturbed
    def test_a_header_without_an_end_is_cut_off(self) -> None:
        with Talker('/a'), self.monitor(self.model()), MonitorListener() as listener:
            listener.await_settled()
            pid = pid_of('/self_awareness')
            before = resident_of(pid)
            with slave_socket() as connection:
                sent = 0
                part = b'x' * MEGABYTE
                try:
                    connection.sendall(b'POST / HTTP/1.1\r\nx: ')
                    while sent < 300:
                        connection.sendall(part)
                        sent += 1
                except OSError:
                    pass
                self.assertLess(sent, 300)
            await_condition('its memory is given back',
                            lambda: resident_of(pid) < before + 60 * MEGABYTE, AT_ONCE_S)
            self.await_heard(listener, AT_ONCE_S)


if __name__ == '__main__':
    rospy.init_node('hostile_test')
    rostest.rosrun('self_awareness', 'hostile', HostileTest)
