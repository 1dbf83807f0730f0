"""What happens to any node: as a with statement that hands out its onset, and undoes it."""
from __future__ import annotations

import contextlib
import os
import random
import signal
import threading
import time
from typing import ContextManager, Iterator

from self_awareness_follow_me import induction
from self_awareness_follow_me.effects import Starvation

_BURST_S = (0.2, 1.5)  # at least and at most
_BETWEEN_BURSTS_S = 20.0  # on the average

BUSY = Starvation(ramp=0.0, slowdown=1.0, workers_per_core=4)
"""Four busy processes on every core take the machine."""


@contextlib.contextmanager
def broken_by(what: ContextManager[None]) -> Iterator[float]:
    """Hand out since when something is broken that another with statement breaks and mends."""
    with what:
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
def bursts(chance: random.Random) -> Iterator[float]:
    """Let busy processes on all cores take the machine for a moment now and then."""
    over = threading.Event()

    def take() -> None:
        while not over.wait(chance.expovariate(1.0 / _BETWEEN_BURSTS_S)):
            with induction.starved(BUSY):
                over.wait(chance.uniform(*_BURST_S))

    thread = threading.Thread(target=take)
    thread.start()
    try:
        yield time.time()
    finally:
        over.set()
        thread.join()
