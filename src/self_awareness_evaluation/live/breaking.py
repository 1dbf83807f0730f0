"""What happens to any node: as a with statement that hands out its onset, and undoes it."""
from __future__ import annotations

import contextlib
import os
import random
import signal
import threading
import time
from typing import Iterator

from self_awareness_follow_me import induction
from self_awareness_follow_me.effects import Starvation

_BURST_S = (0.2, 1.5)  # at least and at most
_BETWEEN_BURSTS_S = 20.0  # on the average
_BUSY = Starvation(ramp=0.0, slowdown=1.0, workers_per_core=4)
_BURSTS_SEED = 1


@contextlib.contextmanager
def nothing() -> Iterator[float]:
    """Break nothing."""
    yield time.time()


@contextlib.contextmanager
def stopped(pid: int) -> Iterator[float]:
    """Stop a process; it goes on at the end, if it still is there."""
    os.kill(pid, signal.SIGSTOP)
    try:
        yield time.time()
    finally:
        with contextlib.suppress(ProcessLookupError):  # it was killed, as it hung
            os.kill(pid, signal.SIGCONT)


@contextlib.contextmanager
def starved() -> Iterator[float]:
    """Let four busy processes on every core take the machine."""
    with induction.starved(_BUSY):
        yield time.time()


class Bursts:
    """Busy processes on all cores for a moment now and then; each run goes on where one ended."""

    def __init__(self) -> None:
        self._random = random.Random(_BURSTS_SEED)

    @contextlib.contextmanager
    def run(self) -> Iterator[float]:
        """Take the machine now and then while the with statement lasts."""
        over = threading.Event()
        thread = threading.Thread(target=self._take, args=(over,))
        thread.start()
        try:
            yield time.time()
        finally:
            over.set()
            thread.join()

    def _take(self, over: threading.Event) -> None:
        while not over.wait(self._random.expovariate(1.0 / _BETWEEN_BURSTS_S)):
            with induction.starved(_BUSY):
                over.wait(self._random.uniform(*_BURST_S))
