"""How much memory a process has, over time."""
from __future__ import annotations

import threading
import time
from dataclasses import dataclass
from pathlib import Path
from typing import List, Optional, Sequence

import numpy as np

KB_PER_MB = 1000.0
WARM_UP_S = 300.0
"""Until then memory may grow: the flight recorder fills its five minutes [s]."""

_LEAST_S = 300.0  # a slope of less is one of chance
_PERIOD_S = 1.0


@dataclass(frozen=True)
class Usage:
    """What a process uses.

    Args:
        at_s: since the process was watched [s].
        resident_kb: resident memory [1000 bytes].
        threads, files: number of its threads, and of open files and connections.
    """

    at_s: float
    resident_kb: float
    threads: int
    files: int


class MemoryWatch:
    """Looks at a process once a second, until the `with` block ends."""

    def __init__(self, pid: int) -> None:
        self._process = Path('/proc') / str(pid)
        self._begin = time.monotonic()
        self._over = threading.Event()
        self._lock = threading.Lock()
        self._seen: List[Usage] = []  # Guarded by _lock.
        self._thread = threading.Thread(target=self._watch, daemon=True)

    def __enter__(self) -> MemoryWatch:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._over.set()
        self._thread.join()

    @property
    def seen(self) -> List[Usage]:
        """All so far."""
        with self._lock:
            return list(self._seen)

    def _watch(self) -> None:
        while not self._over.wait(_PERIOD_S):
            try:
                usage = self._look()
            except FileNotFoundError:  # it has ended, which others notice
                return
            with self._lock:
                self._seen.append(usage)

    def _look(self) -> Usage:
        fields = dict(line.split(':', 1) for line in
                      (self._process / 'status').read_text().splitlines())
        # "kB" of /proc are 1024 bytes.
        resident_kb = int(fields['VmRSS'].split()[0]) * 1024 / 1000.0
        return Usage(time.monotonic() - self._begin, resident_kb, int(fields['Threads']),
                     len(list((self._process / 'fd').iterdir())))


def slope_mb_per_hour(seen: Sequence[Usage]) -> Optional[float]:
    """Return the slope of the line through the resident memory after WARM_UP_S [MB an hour].

    Returns:
        None: too little was seen for one.
    """
    later = [usage for usage in seen if usage.at_s >= WARM_UP_S]
    if len(later) < 2 or later[-1].at_s - later[0].at_s < _LEAST_S:
        return None
    slope, _ = np.polyfit([usage.at_s / 3600.0 for usage in later],
                          [usage.resident_kb / KB_PER_MB for usage in later], 1)
    return float(slope)
