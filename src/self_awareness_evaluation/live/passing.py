"""How time passes in a live evaluation: waits that are told, and stretches that are noted."""
from __future__ import annotations

import contextlib
import os
import time
from typing import Callable, Iterator, Tuple

from self_awareness import progress
from self_awareness_evaluation.live.samples import Stretch


def say(text: str) -> None:
    """Print a line with the time of day."""
    progress.say(f'{time.strftime("%H:%M:%S")} {text}')


def wait(seconds: float, what: str) -> None:
    """Let time pass, and tell for what."""
    say(f'{what} ({seconds:g} s)')
    for _ in progress.waiting(seconds, what):
        pass


@contextlib.contextmanager
def stretch(number: int, kind: str, culprits: Tuple[str, ...], note: str, onset: float,
            over: Callable[[Stretch], None]) -> Iterator[None]:
    """Hand out the stretch of a with statement when it is over, with what the clock did in it.

    Args:
        number, kind, culprits, note, onset: see Stretch.
        over: gets the stretch.
    """
    ahead, load = time.time() - time.monotonic(), os.getloadavg()[0]
    yield
    end = time.time()
    over(Stretch(number, kind, onset, end, culprits, end - time.monotonic() - ahead, note, load))
