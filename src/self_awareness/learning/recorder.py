"""The recorder of a learning, as a process of its own that ends with this one."""
from __future__ import annotations

import glob
import os
import signal
import subprocess
import time

import rospy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus

from self_awareness import EncodingRules, encoding_file
from self_awareness.learning.logs import HEARD_S
from self_awareness.learning.programs import executable

_END_S = 30.0  # to write the last file
_REFUSED = 1


class RecorderCrash(Exception):
    """The recorder has died, and another one can go on."""


class Recorder:
    """Records event logs until its `with` block ends; needs rospy.init_node().

    Args:
        prefix: of the files.
        encoding: how messages become events.
        subscribe: used or all, see launch/record.launch.
        robot_start: since 1970 [s].
        lock: a file descriptor that it keeps open for as long as it lives.
    """

    def __init__(self, prefix: str, encoding: EncodingRules, subscribe: str, robot_start: float,
                 lock: int) -> None:
        self.problem = ''
        """Why nothing is recorded, in its words; empty: it is, or has said nothing yet."""
        self.events = 0  # how many it has heard
        self._prefix = prefix
        self._file = ''  # that is written
        self._heard = 0.0  # for how long, since the file began [s]
        # [s of time.monotonic()]
        self._looked_at = self._event_at = time.monotonic()
        # Its diagnostics go through this node's: a name that nobody beats for any more would
        # become STALE when the monitor has taken over.
        diagnostics = rospy.resolve_name('~recording')
        self._subscriber = rospy.Subscriber(diagnostics, DiagnosticArray, self._on_diagnostics)
        name = f'{rospy.get_name()}_recorder'
        rospy.set_param(f'{name}/encoding', encoding_file.values(encoding))
        self._process = subprocess.Popen(
            ['setpriv', '--pdeathsig', 'INT', executable('record_events'),
             f'__name:={os.path.basename(name)}', f'_output:={prefix}',
             f'_subscribe:={subscribe}', f'_robot_start:={robot_start:.6f}',
             f'_diagnostics:={diagnostics}'],
            pass_fds=(lock,))

    def __enter__(self) -> Recorder:
        return self

    def __exit__(self, *_: object) -> None:
        self._subscriber.unregister()
        self._process.send_signal(signal.SIGINT)
        try:
            self._process.wait(_END_S)
        except subprocess.TimeoutExpired:
            self._process.kill()  # the file can be mended
            self._process.wait()

    def silent_for(self) -> float:
        """Return for how long it has heard nothing [s]."""
        return time.monotonic() - self._event_at

    def seconds(self) -> float:
        """Return for how long the robot was heard, for the file that is not complete yet [s].

        Call it often: a file is taken to begin when it is seen for the first time.
        """
        files = sorted(glob.glob(f'{glob.escape(self._prefix)}*.bag.active'))
        newest = files[-1] if files else ''
        now = time.monotonic()
        if newest != self._file:
            self._file, self._heard = newest, 0.0
        elif newest and self.events and self.silent_for() <= HEARD_S:
            self._heard += now - self._looked_at
        self._looked_at = now
        return self._heard

    def ended(self) -> bool:
        """Return whether it was told to end.

        Raises:
            ValueError: it refused what it was started with.
            RecorderCrash: it ended by itself.
        """
        code = self._process.poll()
        if code == _REFUSED:
            raise ValueError('the recorder cannot run; it says why above')
        if code:
            raise RecorderCrash(f'the recorder crashed (exit code {code})')
        return code is not None

    def _on_diagnostics(self, array: DiagnosticArray) -> None:
        for status in array.status:
            self.problem = '' if status.level == DiagnosticStatus.OK else status.message
            events = next((int(pair.value) for pair in status.values if pair.key == 'events'), 0)
            if events > self.events:
                self.events, self._event_at = events, time.monotonic()
