"""The processes of nodes: which one a node is, also when it hangs, and how it is ended.

A node that hangs cannot say which process it is. So this is asked while it is well, and
remembered with the time at which the process was started: process ids are given again.
"""
from __future__ import annotations

import os
import re
import signal
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Optional, Sequence, Tuple

PROC = Path('/proc')
_POLL_S = 0.02
_KILLED_WITHIN_S = 2.0
_MOST_ANCESTORS = 20
_LAUNCHER = re.compile(r'(.*/)?roslaunch')
# In /proc/PID/stat, behind the name of the program, which may have any characters.
_STATE, _PARENT, _START = 0, 1, 19


class NotItsProcess(ValueError):
    """A process is not that of the node, or must not be ended; the message says why."""


@dataclass(frozen=True)
class NodeProcess:
    """A process, told from others that had or will have its id.

    Args:
        pid: its id.
        start: when it was started, by the kernel's count.
    """

    pid: int
    start: int

    def runs(self) -> bool:
        """Return whether it has not ended; one that nobody has waited for yet has."""
        found = _stat(self.pid)
        return found is not None and int(found[_START]) == self.start and found[_STATE] not in (
            'Z', 'X')

    def signal(self, number: int) -> None:
        """Send it a signal, if it has not ended.

        Raises:
            OSError: it may not be sent one.
        """
        if self.runs():
            try:
                os.kill(self.pid, number)
            except ProcessLookupError:
                pass

    def ends_within(self, seconds: float) -> bool:
        """Wait for its end; return whether it came in time."""
        deadline = time.monotonic() + seconds
        while self.runs():
            if time.monotonic() > deadline:
                return False
            time.sleep(_POLL_S)
        return True

    def end(self, grace: float) -> str:
        """End it by SIGTERM, and by SIGKILL if it has not ended after the grace [s].

        Returns:
            what ended it, in words.

        Raises:
            OSError: it may not be sent signals, or does not even end by SIGKILL.
        """
        for number, name, within in ((signal.SIGTERM, 'SIGTERM', grace),
                                     (signal.SIGKILL, 'SIGKILL', _KILLED_WITHIN_S)):
            self.signal(number)
            if self.ends_within(within):
                return f'ended by {name}'
        raise OSError(f'process {self.pid} does not even end by SIGKILL')


def process_of(node: str, pid: int) -> NodeProcess:
    """Return the process that a node says it is, after a look whether that is so.

    Args:
        node: its full name.
        pid: the process id, as the node tells it.

    Raises:
        NotItsProcess: there is none, it was not started with the name of the node, or not by
            roslaunch, so that nobody would start it again.
    """
    found = None if pid <= 1 or pid == os.getpid() else _stat(pid)
    words = _command_line(pid)
    if found is None or not words:
        raise NotItsProcess(f'{node} says that it is process {pid}, which is none of this machine')
    if f'__name:={node.rsplit("/", 1)[-1]}' not in words:
        raise NotItsProcess(f'{node} says that it is process {pid}, which was not started with '
                            'its name (__name:=)')
    if not _is_launched(int(found[_PARENT])):
        raise NotItsProcess(f'{node} was not started by roslaunch: it would stay dead')
    return NodeProcess(pid, int(found[_START]))


def _is_launched(pid: int) -> bool:
    """Return whether a process is roslaunch, or was started below it."""
    for _ in range(_MOST_ANCESTORS):
        if any(_LAUNCHER.fullmatch(word) for word in _command_line(pid)[:2]):
            return True
        found = _stat(pid)
        if found is None or pid <= 1:
            return False
        pid = int(found[_PARENT])
    return False


def _command_line(pid: int) -> Sequence[str]:
    try:
        return (PROC / str(pid) / 'cmdline').read_bytes().decode(errors='replace').split('\0')
    except OSError:
        return ()


def _stat(pid: int) -> Optional[Tuple[str, ...]]:
    """Return what the kernel says of a process; None: there is none."""
    try:
        text = (PROC / str(pid) / 'stat').read_text(errors='replace')
    except OSError:
        return None
    return tuple(re.sub(r'.*\) ', '', text, flags=re.DOTALL).split())
