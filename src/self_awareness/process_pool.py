"""Processes of this machine that do one task after the other, whatever is done to them.

Each process has a pipe of its own, and shares no lock and no queue with the others: who is killed
leaves nothing behind that somebody waits for.
"""
from __future__ import annotations

import multiprocessing
import multiprocessing.connection
import os
import select
import signal
import threading
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from multiprocessing.connection import Connection
from typing import Any, Callable, Iterator, List, Optional, Sequence, Tuple

from self_awareness import progress

_ATTEMPTS = 3
_LOOK_AGAIN_S = 0.2


@dataclass
class _Process:
    """A process, this end of its pipe, and the number of its task; None: it is free."""

    process: Any  # multiprocessing.Process of a context
    pipe: Connection
    task: Optional[int] = None
    attempt: int = 0


class ProcessPool:
    """Processes that work on numbered tasks.

    They start when they are needed; close them at the end. A task whose process is
    killed is begun again in a new one, up to two times.

    Args:
        number: of processes at most.
        work: returns the result of a task; runs in a process that begins as a copy of this one
            (fork). It may not raise.
    """

    def __init__(self, number: int, work: Callable[[int], bytes]) -> None:
        self._number = number
        self._work = work
        self._processes: List[_Process] = []

    @property
    def has_room(self) -> bool:
        """Whether a process is free for a task."""
        return (len(self._processes) < self._number
                or any(each.task is None for each in self._processes))

    def begin(self, task: int) -> None:
        """Give a task to a process that is free; there must be one.

        Raises:
            OSError: a process cannot be started.
        """
        free = next((each for each in self._processes if each.task is None), None)
        self._begin(free or self._start(), task, 1)

    def wait(self) -> List[Tuple[int, Optional[bytes]]]:
        """Wait until tasks end; return them with their results, and None for what is given up.

        Raises:
            OSError: a process cannot be started again.
        """
        ended: List[Tuple[int, Optional[bytes]]] = []
        while not ended:
            busy = [each for each in self._processes if each.task is not None]
            # A signal that comes just before the system call does not end it: look again.
            ready = multiprocessing.connection.wait([each.pipe for each in busy], _LOOK_AGAIN_S)
            for each in busy:
                if each.pipe in ready:
                    ended += self._receive(each)
        return ended

    def close(self) -> None:
        """End all processes, whatever they do."""
        for each in self._processes:
            each.process.kill()
        for each in self._processes:
            each.process.join()

    def _receive(self, worker: _Process) -> List[Tuple[int, Optional[bytes]]]:
        """Return the task of a process, if it has ended, with its result."""
        task, worker.task = worker.task, None
        assert task is not None
        try:
            return [(task, worker.pipe.recv_bytes())]
        except (EOFError, OSError):  # it was killed, perhaps in the middle of its answer
            self._processes.remove(worker)
            worker.pipe.close()
            worker.process.join()
        if worker.attempt == _ATTEMPTS:
            return [(task, None)]
        self._begin(self._start(), task, worker.attempt + 1)
        return []

    def _begin(self, worker: _Process, task: int, attempt: int) -> None:
        worker.task, worker.attempt = task, attempt
        with suppress(OSError):  # it was killed while it was free: wait() sees that, too
            worker.pipe.send(task)

    def _start(self) -> _Process:
        with _ctrl_c_waits():
            mine, theirs = multiprocessing.Pipe()
            # Not spawned: that would run the program's script again. As a daemon, it ends with
            # this program even if nobody comes to call close().
            process = multiprocessing.get_context('fork').Process(
                target=_serve, daemon=True,
                args=(theirs, [mine, *(each.pipe for each in self._processes)], self._work))
            process.start()
            theirs.close()  # or the end of the process would not end the pipe
            started = _Process(process, mine)
            self._processes.append(started)
        return started


@contextmanager
def _ctrl_c_waits() -> Iterator[None]:
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


def _serve(pipe: Connection, of_parent: Sequence[Connection],
           work: Callable[[int], bytes]) -> None:
    for each in of_parent:  # copies: as long as they are open, no pipe ends with the parent
        each.close()
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C: the parent ends this process
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    progress.silence()
    threading.Thread(target=_end_with_parent, args=(pipe.fileno(),), daemon=True).start()
    with suppress(EOFError, OSError):  # the parent is gone
        while True:
            pipe.send_bytes(work(pipe.recv()))


def _end_with_parent(pipe: int) -> None:
    hung_up = select.poll()
    hung_up.register(pipe, 0)  # no data, only the end
    hung_up.poll()
    os._exit(1)
