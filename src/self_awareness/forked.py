"""A process that begins as a copy of this one, and does one thing, whatever is done to others."""
from __future__ import annotations

import multiprocessing
import os
import signal
import threading
from contextlib import contextmanager
from multiprocessing.connection import Connection
from typing import Callable, Iterator, List, Optional

from self_awareness import progress


class Forked:
    """A process and the pipe that its result comes by.

    It shares no lock and no queue with others: who is killed leaves nothing behind that somebody
    waits for.

    Args:
        work: returns the result; it may not raise.

    Raises:
        OSError: it cannot be started.
    """

    def __init__(self, work: Callable[[], bytes]) -> None:
        self.pipe, theirs = multiprocessing.Pipe(duplex=False)
        # Not spawned: that would run the program's script again. As a daemon, it ends with this
        # program even if nobody comes to call kill().
        self._process = multiprocessing.get_context('fork').Process(
            target=_work, args=(theirs, work), daemon=True)
        self._process.start()
        theirs.close()  # or the end of the process would not end the pipe

    def answer(self) -> Optional[bytes]:
        """Return its result, once the pipe is ready; None: it was killed."""
        try:
            return self.pipe.recv_bytes()
        except (EOFError, OSError):  # perhaps in the middle of its answer
            return None
        finally:
            self.pipe.close()
            self._process.join()

    def kill(self) -> None:
        """End it, whatever it does."""
        self._process.kill()
        self._process.join()


@contextmanager
def ctrl_c_waits() -> Iterator[None]:
    """Let Ctrl-C wait until the end of the block.

    In the middle of a fork, Python would print its KeyboardInterrupt, and drop it. To block the
    signal in this thread is not enough: any other one may take it.
    """
    if threading.current_thread() is not threading.main_thread():  # Ctrl-C does not come here
        yield
        return
    came: List[int] = []
    usual = signal.signal(signal.SIGINT, lambda number, _: came.append(number))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, usual)
        if came:
            signal.raise_signal(signal.SIGINT)


def _work(pipe: Connection, work: Callable[[], bytes]) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C: the parent ends this process
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    progress.silence()
    threading.Thread(target=_end_with_parent, daemon=True).start()
    pipe.send_bytes(work())


def _end_with_parent() -> None:
    parent = multiprocessing.parent_process()
    assert parent is not None
    parent.join()
    os._exit(1)
