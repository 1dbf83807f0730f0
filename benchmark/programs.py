"""Programs that a benchmark runs to their end, and what they used."""
from __future__ import annotations

import os
import subprocess
import time
from pathlib import Path
from typing import NamedTuple, Sequence


class Usage(NamedTuple):
    """What a process used, in all its threads."""

    wall_s: float
    peak_bytes: int
    """The most of its memory that was resident."""
    read_bytes: int
    """By read(2), from any file."""


def run(command: Sequence[str]) -> Usage:
    """Run a program to its end.

    Raises:
        RuntimeError: the program failed.
    """
    begin = time.perf_counter()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)  # keeps the counts of the process
    wall = time.perf_counter() - begin
    io = dict(line.split(': ') for line in
              Path(f'/proc/{process.pid}/io').read_text().splitlines())
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = status
    if status != 0:
        raise RuntimeError(f'{" ".join(command)} failed')
    return Usage(wall, 1024 * usage.ru_maxrss, int(io['rchar']))


def built(name: str) -> str:
    """Return the path of a program of this package.

    Raises:
        FileNotFoundError: it is not built, or its workspace is not sourced.
    """
    for prefix in os.environ.get('CMAKE_PREFIX_PATH', '').split(':'):
        path = Path(prefix) / 'lib' / 'self_awareness' / name
        if os.access(path, os.X_OK):
            return str(path)
    raise FileNotFoundError(f'{name} is not built, or its workspace not sourced')
