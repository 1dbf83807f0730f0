"""The processes of nodes: which one a node is, also when it hangs, and how it is ended.

A node that hangs cannot say which process it is. So this is asked while it is well, and
remembered with the time at which the process was started: process ids are given again.
"""
from __future__ import annotations

import contextlib
import os
import re
import signal
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Callable, Optional, Sequence, Set, Tuple

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
    """A process, told from others that had or will have its id by when the kernel started it."""

    pid: int
    start: int

    def runs(self) -> bool:
        """Return whether it has not ended; one that nobody has waited for yet has."""
        found = _stat(self.pid)
        return found is not None and int(found[_START]) == self.start and found[_STATE] not in (
            'Z', 'X')

    def ends_within(self, seconds: float, check: Callable[[], None]) -> bool:
        """Wait so long for its end; return whether it came. What `check` raises ends the wait."""
        deadline = time.monotonic() + seconds
        while self.runs():
            check()
            if time.monotonic() > deadline:
                return False
            time.sleep(_POLL_S)
        return True

    def end(self, grace: float, check: Callable[[], None] = lambda: None) -> str:
        """End it by SIGTERM, and by SIGKILL if it has not ended after the grace [s].

        It calls `check` before each signal, and while it waits: what that raises prevents the
        next signal. It returns what ended the process, in words.

        Raises:
            OSError: it may not be sent signals, or does not even end by SIGKILL.
        """
        for number, name, within in ((signal.SIGTERM, 'SIGTERM', grace),
                                     (signal.SIGKILL, 'SIGKILL', _KILLED_WITHIN_S)):
            check()
            if self.runs():
                with contextlib.suppress(ProcessLookupError):
                    os.kill(self.pid, number)
            if self.ends_within(within, check):
                return f'ended by {name}'
        raise OSError(f'process {self.pid} does not even end by SIGKILL')


def process_of(node: str, pid: int) -> NodeProcess:
    """Return the process that a node says it is, after a look whether that is so.

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
    if not any(_LAUNCHER.fullmatch(word) for each in line_of(pid) - {pid}
               for word in _command_line(each)[:2]):
        raise NotItsProcess(f'{node} was not started by roslaunch: it would stay dead')
    return NodeProcess(pid, int(found[_START]))


def begun(pid: int) -> Optional[float]:
    """Return when a process was started [s since 1970]; None: there is none."""
    found = _stat(pid)
    if found is None:
        return None
    boot = re.search(r'^btime (\d+)$', (PROC / 'stat').read_text(), re.MULTILINE)
    ticks = int(found[_START]) / os.sysconf('SC_CLK_TCK')
    return None if boot is None else int(boot.group(1)) + ticks


def has_another_name(pid: int, node: str) -> bool:
    """Return whether a process is another node, by the name that it was started with."""
    names = [word for word in _command_line(pid) if word.startswith('__name:=')]
    return bool(names) and f'__name:={node.rsplit("/", 1)[-1]}' not in names


def line_of(pid: int) -> Set[int]:
    """Return a process, and those that it was started by, one by the other."""
    line: Set[int] = set()
    while pid > 1 and pid not in line and len(line) < _MOST_ANCESTORS:
        line.add(pid)
        found = _stat(pid)
        pid = 0 if found is None else int(found[_PARENT])
    return line


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
