#!/usr/bin/python3
"""The monitor in a system of ROS 1 that is broken, or means ill."""

import os
import resource
import socket
import struct
import time
from contextlib import ExitStack
from typing import List
from urllib.parse import urlsplit
from xmlrpc.client import ServerProxy

import rosgraph
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticStatus

from fake_publisher import FakePublisher, string_header
from live_system import MonitorListener, Process, again_if_clock_was_set, await_condition
from monitor_case import MonitorCase, Talker, subscribers
from self_awareness.msg import SelfAwareness

MEGABYTE = 10**6
AT_ONCE_S = 5.0
"""Within so long the monitor hears whom it can hear, and names the others."""


def slave_uri(node: str = '/self_awareness') -> str:
    return rosgraph.Master(rospy.get_name()).lookupNode(node)


def slave_socket() -> socket.socket:
    address = urlsplit(slave_uri())
    return socket.create_connection((address.hostname or '', address.port or 0), timeout=5)


def resident_bytes(node: str = '/self_awareness') -> int:
    pid = ServerProxy(slave_uri(node)).getPid(rospy.get_name())[2]  # type: ignore
    return resident_of(pid)


def resident_of(pid: int) -> int:
    with open('/proc/{}/statm'.format(pid)) as statm:
        return int(statm.read().split()[1]) * os.sysconf('SC_PAGESIZE')


def monitor_pid() -> int:
    return ServerProxy(slave_uri()).getPid(rospy.get_name())[2]  # type: ignore


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

    # Who is heard

    @again_if_clock_was_set
    def test_forged_updates_and_lost_registrations_silence_nobody(self) -> None:
        with Talker('/a'), self.monitor(self.model()), MonitorListener() as listener:
            listener.await_settled()
            uri = slave_uri()
            for publishers in ([], ['http://127.0.0.1:9/'], ['http://no-such-host.invalid:1/']):
                ServerProxy(uri).publisherUpdate('/master', '/a', publishers)
                self.await_heard(listener, AT_ONCE_S)
            # As `rosnode cleanup` does with a node that it cannot reach.
            master = ServerProxy(rosgraph.get_master_uri())
            master.unregisterSubscriber('/self_awareness', '/a', uri)
            master.unregisterPublisher('/self_awareness', '/self_awareness/alarm', uri)
            self.assertNotIn('/self_awareness', subscribers('/a'))
            await_condition('it is registered again',
                            lambda: '/self_awareness' in subscribers('/a'), AT_ONCE_S)
            self.await_heard(listener, AT_ONCE_S)
            self.check_no_error(listener)

    @again_if_clock_was_set
    def test_a_thousand_idle_connections_keep_nobody_out(self) -> None:
        model = self.model()
        with ExitStack() as stack:
            with Talker('/a'):
                # So few files that the idle connections take all of them.
                stack.enter_context(self.limited_monitor(model, files=256))
                listener = stack.enter_context(MonitorListener())
                listener.await_settled()
                idle = self.idle_connections(400)
                self.addCleanup(lambda: [each.close() for each in idle])
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

    @again_if_clock_was_set
    def test_who_does_not_answer_is_not_heard_and_not_silent(self) -> None:
        model = self.model(topics=('/a', '/b'), sources={'/b': '/fake'})
        with Talker('/a'), FakePublisher('/b', b'', answers=False), \
                self.monitor(model, alarm_windows=1), MonitorListener() as listener:
            warning = self.await_warning(listener, '/fake on /b (does not answer)')
            self.assertTrue(warning.message.startswith('not heard: '), warning.message)
            listener.await_settled()
            component = await_condition('the component is told', lambda: next(
                (s for s in listener.diagnostics('/fake') if 'monitor' in s.message), None), 20)
            self.assertIn('not heard by the monitor: does not answer', component.message)
            said = [s.message for s in listener.statuses]
            self.assertEqual([each for each in said if '/fake' in each and 'silent' in each], [])

    # What it costs

    @again_if_clock_was_set
    def test_announced_gigabytes_take_no_memory(self) -> None:
        huge = struct.pack('<I', 900 * MEGABYTE)
        type_fields = {'std_msgs/String': 'data'}  # the content of messages is needed
        with Talker('/a'), self.monitor(self.model(type_fields=type_fields, threshold=-1.0),
                                        subscribe='all'), MonitorListener() as listener:
            listener.await_settled()
            pid = monitor_pid()
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

    @again_if_clock_was_set
    def test_a_header_without_an_end_is_cut_off(self) -> None:
        with Talker('/a'), self.monitor(self.model()), MonitorListener() as listener:
            listener.await_settled()
            pid = monitor_pid()
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
    resource.setrlimit(resource.RLIMIT_NOFILE, (4096, resource.getrlimit(resource.RLIMIT_NOFILE)[1]))
    rostest.rosrun('self_awareness', 'hostile', HostileTest)
