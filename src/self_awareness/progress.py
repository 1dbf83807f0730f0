"""Progress bars of long work, on standard error; silent where that is no terminal."""
from __future__ import annotations

import sys
import threading
import time
from contextlib import contextmanager
from typing import Callable, Iterable, Iterator, Sequence, TypeVar

from tqdm import tqdm

_Item = TypeVar('_Item')

_silent = False

# tqdm's own lock is one for all processes that are forked: who is killed with it stops the others.
tqdm.set_lock(threading.RLock())


def silence() -> None:
    """Show nothing from now on: another process shows the progress of the whole."""
    global _silent
    _silent = True


@contextmanager
def messages(description: str) -> Iterator[Callable[[int, int], None]]:
    """Show how much of a bag is read; hands out the callback progress(done, all) for readers."""
    if _silent:
        yield lambda done, total: None
        return
    with tqdm(desc=description, unit='msg', leave=False, disable=None) as bar:
        def update(done: int, total: int) -> None:
            bar.total = total
            bar.update(done - bar.n)
        yield update


def each(items: Sequence[_Item], description: str) -> Iterable[_Item]:
    """Return the items one by one and show how many are done."""
    return tqdm(items, desc=description, leave=False, disable=None)


@contextmanager
def items(total: int, description: str) -> Iterator[Callable[..., object]]:
    """Show how many things are done; hands out what is called when one, or N, are done."""
    with tqdm(desc=description, total=total, leave=False, disable=None) as bar:
        yield bar.update


def say(text: str) -> None:
    """Print a line on standard output at once, above the bars that are shown."""
    tqdm.write(text)
    sys.stdout.flush()


def waiting(seconds: float, description: str) -> Iterator[float]:
    """Let time pass and show how much; hands out the seconds passed, ten times a second."""
    begin = time.monotonic()
    passed = 0.0  # the bar itself counts only while it is shown
    with tqdm(desc=description, total=seconds, unit='s', leave=False, disable=None,
              bar_format='{desc} {bar} {n:.0f}/{total:.0f} s') as bar:
        while passed < seconds:
            time.sleep(0.1)
            bar.update(min(time.monotonic() - begin, seconds) - passed)
            passed = min(time.monotonic() - begin, seconds)
            yield passed
