#!/usr/bin/python3
"""The live view, in a pseudo-terminal of 80 columns."""

import fcntl
import os
import pty
import re
import signal
import struct
import subprocess
import termios
import threading
from contextlib import suppress
from typing import List

import rosgraph
import rospy
import rostest

from live_system import MonitorListener, Process, again_if_disturbed, await_condition, path_of
from monitor_case import MonitorCase, Talker
from self_awareness.msg import SelfAwareness

_ESCAPES = re.compile(r'\x1b(\[[0-9;?]*[A-Za-z]|[()][A-Z0-9]|[=>]|[78])|[\x0e\x0f]')


class Terminal:
    """A program in a terminal of its own, ended with the `with` block."""

    def __init__(self, *command: str, **environment: str) -> None:
        self._ours, theirs = pty.openpty()
        fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack('HHHH', 24, 80, 0, 0))
        self._process = subprocess.Popen(
            ('setpriv', '--pdeathsig', 'TERM') + command, stdin=theirs, stdout=theirs,
            stderr=theirs, start_new_session=True,
            env=dict(os.environ, TERM='xterm', LC_ALL='C.UTF-8', **environment))
        os.close(theirs)
        self._said: List[bytes] = []
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self) -> None:
        with suppress(OSError):  # nobody has the other end any more
            for data in iter(lambda: os.read(self._ours, 65536), b''):
                self._said.append(data)

    @property
    def text(self) -> str:
        """All that was drawn so far, without escape sequences."""
        return _ESCAPES.sub('', b''.join(self._said).decode('utf-8', 'replace'))

    def await_text(self, text: str, after: int = 0) -> None:
        await_condition(text, lambda: text in self.text[after:], 30)

    def press(self, keys: str) -> int:
        """Press keys; return how much was drawn before."""
        drawn = len(self.text)
        os.write(self._ours, keys.encode())
        return drawn

    def wait(self) -> int:
        code = self._process.wait(20)
        self._reader.join(5)
        return code

    def __enter__(self) -> 'Terminal':
        return self

    def __exit__(self, *_) -> None:
        if self._process.poll() is None:
            self._process.kill()
            self._process.wait()
        os.close(self._ours)


def top(**environment: str) -> Terminal:
    return Terminal(path_of('top'), **environment)


@again_if_disturbed
class TopTest(MonitorCase):

    def test_it_shows_what_the_monitor_says_and_takes_keys(self) -> None:
        # Windows are long, since an alarm is held: a hiccup of a busy machine must not raise one.
        model = self.model(window=10**9)
        with self.monitor(model, hold_time=600), MonitorListener() as listener:
            with Talker('/a'), top() as terminal:
                listener.await_settled()
                terminal.await_text('OK  normal communication')
                terminal.await_text('component (by level)')
                terminal.await_text(rospy.get_name() + ' ')
                terminal.await_text('by name', terminal.press('s'))
                drawn = terminal.press('fnobody\r')
                terminal.await_text('by name, nobody)', drawn)
                drawn = terminal.press('f' + '\x7f' * 6 + '\r')
                terminal.await_text('(by name) ', drawn)
                terminal.await_text(rospy.get_name() + ' ', drawn)
                drawn = terminal.press('m')
                terminal.await_text('mute {} for 10 minutes?'.format(rospy.get_name()), drawn)
                drawn = terminal.press('y')
                terminal.await_text('not told until', drawn)
                terminal.await_text('muted: {} until'.format(rospy.get_name()), drawn)
                terminal.await_text('told again: ' + rospy.get_name(), terminal.press('u'))
                terminal.await_text('nothing stands, and nobody is new', terminal.press('a'))
                terminal.await_text('the last ', terminal.press('d'))
                terminal.press('q')
                self.assertEqual(terminal.wait(), 0)
            alarm = listener.await_alarm()
            with top() as terminal:
                terminal.await_text(' % of the threshold ')
                # If it is a death, it is asked for.
                terminal.await_text('no model that judges by evidence', terminal.press('ay'))
            with Talker('/a'), top() as terminal:
                terminal.await_text('raised 1 times')
                terminal.await_text('({})'.format(alarm.alarm))
                await_condition('normal windows while the alarm is held', lambda: (
                    not listener.statuses[-1].abnormal), 20)
                terminal.await_text('the alarm is cleared', terminal.press('c'))
                await_condition('it is cleared', lambda: (
                    listener.alarms[-1].level == SelfAwareness.OK), 20)

    def test_a_monitor_that_hangs_is_stale_and_keys_go_on(self) -> None:
        with self.monitor(self.model()) as monitor, MonitorListener() as listener:
            with Talker('/a'), top() as terminal:
                listener.await_settled()
                terminal.await_text('OK  normal communication')
                monitor.send(signal.SIGSTOP)
                terminal.await_text('STALE  the monitor has not been heard for')
                terminal.await_text('asked ...', terminal.press('c'))
                terminal.await_text('not done: the call before is', terminal.press('d'))
                terminal.await_text('no answer for')
                terminal.await_text('by name', terminal.press('s'))
                terminal.press('q')
                self.assertEqual(terminal.wait(), 0)

    def test_it_ends_when_the_master_is_gone(self) -> None:
        port = '11399'
        address = 'http://127.0.0.1:' + port
        with Process('rosmaster', '--core', '-p', port,
                     env={'ROS_MASTER_URI': address}) as master:
            await_condition('the master', lambda: rosgraph.is_master_online(address), 30)
            with top(ROS_MASTER_URI=address) as terminal:
                terminal.await_text('waiting for the monitor')
                master.stop()
                self.assertEqual(terminal.wait(), 1)
                self.assertIn('top: error: the master is gone', terminal.text)
        with top(ROS_MASTER_URI=address) as terminal:
            self.assertEqual(terminal.wait(), 1)
            self.assertIn('no master answers at ' + address, terminal.text)


if __name__ == '__main__':
    rospy.init_node('top_test')
    rostest.rosrun('self_awareness', 'top', TopTest)
