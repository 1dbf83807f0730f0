"""How much memory and processor time a process takes, and whether memory grows."""
from __future__ import annotations

import os
import time
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple, Optional, Sequence

import numpy as np

from self_awareness_evaluation.live.processes import LiveError
from self_awareness_evaluation.live.rows import Row

WARM_UP_S = 300.0
"""Until then memory may grow: the flight recorder fills its five minutes [s]."""

_LEAST_S = 300.0  # a slope of less is one of chance
_USER, _SYSTEM = 11, 12  # in /proc/PID/stat, behind the name of the program


class Usage(NamedTuple):
    """What a process uses.

    at [s of the steady clock]; processor time so far [s]; resident memory [MB]; its threads; its
    open files and connections.
    """

    at: float
    cpu_s: float
    memory_mb: float
    threads: int
    files: int


def look(pid: int) -> Usage:
    """Return what a process uses now.

    Raises:
        LiveError: it has ended.
    """
    try:
        return _usage(Path('/proc') / str(pid))
    except (FileNotFoundError, ProcessLookupError) as error:
        raise LiveError(f'process {pid} has ended') from error


def _usage(process: Path) -> Usage:
    fields = dict(line.split(':', 1) for line in (process / 'status').read_text().splitlines())
    times = (process / 'stat').read_text().rpartition(')')[2].split()
    ticks = int(times[_USER]) + int(times[_SYSTEM])
    # "kB" of /proc are 1024 bytes.
    return Usage(time.monotonic(), ticks / os.sysconf('SC_CLK_TCK'),
                 int(fields['VmRSS'].split()[0]) * 1024 / 1e6, int(fields['Threads']),
                 len(list((process / 'fd').iterdir())))


def added(row: Row, before: Usage, after: Usage) -> Row:
    """Return a row with what the monitor used."""
    return replace(row, memory_mb=after.memory_mb, threads=after.threads, files=after.files,
                   cpu=(after.cpu_s - before.cpu_s) / (after.at - before.at))


def slope_mb_per_hour(rows: Sequence[Row]) -> Optional[float]:
    """Return the slope of the line through the resident memory after WARM_UP_S [MB an hour].

    Returns:
        None: too little was seen for one.
    """
    seen = [(row.onset + row.lasted_s - rows[0].onset, row.memory_mb) for row in rows
            if row.memory_mb is not None]
    later = [(at_s, memory_mb) for at_s, memory_mb in seen if at_s >= WARM_UP_S]
    if len(later) < 2 or later[-1][0] - later[0][0] < _LEAST_S:
        return None
    slope, _ = np.polyfit([at_s / 3600.0 for at_s, _ in later],
                          [memory_mb for _, memory_mb in later], 1)
    return float(slope)
