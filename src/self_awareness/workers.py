"""Who does the work: this process, several of this machine, or those of an existing cluster.

All give the same results in the same order: nothing else depends on who did the work.
"""
from __future__ import annotations

import asyncio
import concurrent.futures
import logging
import math
import multiprocessing
import os
import pickle
import signal
import threading
import traceback
import warnings
from abc import ABC, abstractmethod
from collections import deque
from contextlib import contextmanager, suppress
from multiprocessing import connection
from typing import (Any, Callable, Deque, Dict, Generator, Iterator, List, Optional, Sequence,
                    Tuple, TypeVar)

from self_awareness import progress

_Shared = TypeVar('_Shared')
_Task = TypeVar('_Task')
_Result = TypeVar('_Result')

_AHEAD = 2  # tasks for each worker that may be under way, or done and waiting for their turn
_LARGEST_BATCH = 8  # the most tasks of a batch, unless there are more workers than this
_RETRIES = 2
_ATTEMPTS = 1 + _RETRIES
_LOOK_AGAIN_S = 0.2
_CONNECT_S = 10.0


class Workers(ABC):
    """Applies a function to many tasks. Close it at the end."""

    near = True  # whether arguments and results are handed over at little cost

    @abstractmethod
    def map(self, function: Callable[[_Shared, _Task], _Result], shared: _Shared,
            tasks: Sequence[_Task], description: str) -> Generator[_Result, None, None]:
        """Yield function(shared, task) of every task, in their order.

        Only a few results exist at a time. A caller that may stop early closes the iterator.

        Args:
            function: defined in a module, not within a function.
            shared: what all tasks need; handed over once.
            tasks: each says by str() what it is.
            description: of the progress bar.

        Raises:
            ValueError: the work cannot be done there.
            Exception: what the function raises.
        """

    def batches(self, tasks: int) -> int:
        """Return into how many batches tasks are best cut, where their results can be added up.

        Args:
            tasks: how many there are, more than 0.

        Raises:
            ValueError: the work cannot be done there.
        """
        return tasks  # nothing is copied: summing up early saves nothing

    def close(self) -> None:
        """Give back what does the work."""


class InProcess(Workers):
    """One task after the other, in this process: arguments and results are not copied."""

    def map(self, function: Callable[[_Shared, _Task], _Result], shared: _Shared,
            tasks: Sequence[_Task], description: str) -> Generator[_Result, None, None]:
        """See Workers."""
        for task in tasks:
            yield function(shared, task)


class Processes(Workers):
    """Parallel processes of this machine.

    Args:
        number: of processes, more than 0.
    """

    def __init__(self, number: int) -> None:
        self._number = number

    def map(self, function: Callable[[_Shared, _Task], _Result], shared: _Shared,
            tasks: Sequence[_Task], description: str) -> Generator[_Result, None, None]:
        """See Workers. What is shared and the tasks are inherited by fork, and not copied.

        Each task has a process of its own. If that is killed, another one does its work.
        """
        number = min(self._number, len(tasks))
        running: Dict[Any, Tuple[_Forked, int, int]] = {}  # by pipe; task and attempt
        outcomes: Dict[int, Optional[bytes]] = {}  # that wait for their turn
        begun = 0

        def begin(index: int, attempt: int) -> None:
            with _ctrl_c_waits():
                process = _Forked(lambda: _outcome(function, shared, tasks[index]))
                running[process.pipe] = process, index, attempt

        try:
            with progress.items(len(tasks), description) as one_done:
                for turn, task in enumerate(tasks):
                    while True:
                        while (len(running) < number
                               and begun < min(len(tasks), turn + _AHEAD * number)):
                            begin(begun, 1)
                            begun += 1
                        if turn in outcomes:
                            break
                        # A signal that comes just before the wait does not end it: look again.
                        for pipe in connection.wait(list(running), _LOOK_AGAIN_S):
                            process, index, attempt = running[pipe]
                            outcome = process.answer()
                            del running[pipe]  # not before: who interrupts it ends all of them
                            if outcome is None and attempt < _ATTEMPTS:
                                begin(index, attempt + 1)
                            else:
                                outcomes[index] = outcome
                    yield _result(outcomes.pop(turn), task)
                    one_done()
        finally:
            for process, _, _ in running.values():
                process.kill()

    def batches(self, tasks: int) -> int:
        """See Workers."""
        return _batches(tasks, self._number)


class _Forked:
    """A process that begins as a copy of this one, and the pipe that its result comes by.

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
            target=_work_alone, args=(theirs, work), daemon=True)
        self._process.start()
        theirs.close()  # or the end of the process would not end the pipe

    def answer(self) -> Optional[bytes]:
        """Return its result, once the pipe is ready; None: it was killed."""
        try:
            answer: Optional[bytes] = self.pipe.recv_bytes()
        except (EOFError, OSError):  # perhaps in the middle of its answer
            answer = None
        self.pipe.close()
        self._process.join()
        return answer

    def kill(self) -> None:
        """End it, whatever it does."""
        self._process.kill()
        self._process.join()


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


def _work_alone(pipe: connection.Connection, work: Callable[[], bytes]) -> None:
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


def on_this_machine(jobs: int) -> Workers:
    """Return workers that do so many tasks at a time: 1 is this process."""
    return InProcess() if jobs == 1 else Processes(jobs)


class Cluster(Workers):
    """The workers of an existing dask.distributed cluster.

    Args:
        address: of its scheduler.

    Raises:
        ValueError: dask.distributed is not installed, or no scheduler answers.
    """

    near = False

    def __init__(self, address: str) -> None:
        try:
            import distributed.scheduler  # optional: only needed with a cluster
        except ImportError as error:
            raise ValueError('--scheduler needs dask.distributed, which is not installed '
                             f'({error}); its package is python3-distributed') from error
        self._address = address
        self._killed = distributed.scheduler.KilledWorker
        for name in ('asyncio', 'distributed', 'distributed.client'):  # exceptions say it
            logging.getLogger(name).setLevel(logging.CRITICAL)
        try:
            distributed.comm.resolve_address(address)  # fails at once, a client late
            self._client = distributed.Client(address, timeout=_CONNECT_S, set_as_default=False)
        except (OSError, ValueError, asyncio.TimeoutError) as error:
            raise ValueError(f'--scheduler {address}: no scheduler of dask.distributed answers '
                             f'there ({error})') from error

    def map(self, function: Callable[[_Shared, _Task], _Result], shared: _Shared,
            tasks: Sequence[_Task], description: str) -> Generator[_Result, None, None]:
        """See Workers. If a worker dies, another one does its work."""
        futures = set()
        there: Any = None

        def submit(index: int) -> Any:
            future = self._submit(_call, function, there, tasks[index])
            futures.add(future)
            return future

        def result(future: Any, task: _Task) -> _Result:
            with self._explained(task):
                data = future.result()
            futures.remove(future)
            return pickle.loads(data)

        try:
            with self._connected():
                # As the result of a task, it is made again when the workers that hold it die.
                there = self._submit(pickle.loads, pickle.dumps(shared))
                futures.add(there)
                yield from _in_order(tasks, submit, result, self._threads, description)
        finally:
            # Without a connection there is nothing to cancel.
            with suppress(OSError, asyncio.TimeoutError):
                self._client.cancel(list(futures))

    def batches(self, tasks: int) -> int:
        """See Workers; by the workers that are there now."""
        with self._connected():
            return _batches(tasks, self._threads())

    def close(self) -> None:
        """Disconnect; the cluster goes on."""
        self._client.close()

    def _submit(self, function: Callable[..., Any], *arguments: Any) -> Any:
        with warnings.catch_warnings():
            warnings.filterwarnings('ignore', message='(?s).*[Ll]arge object')  # see map()
            return self._client.submit(function, *arguments, pure=False, retries=_RETRIES)

    def _threads(self) -> int:
        return sum(self._client.nthreads().values())

    @contextmanager
    def _connected(self) -> Iterator[None]:
        try:
            yield
        except (concurrent.futures.CancelledError, OSError, asyncio.TimeoutError) as error:
            raise ValueError(f'--scheduler {self._address}: the connection was lost ({error})'
                             ) from error

    @contextmanager
    def _explained(self, task: object) -> Iterator[None]:
        try:
            yield
        except self._killed as error:
            raise ValueError(f'{task}: worker after worker died of it (of too little memory?)'
                             ) from error
        except ModuleNotFoundError as error:
            raise ValueError(f'--scheduler {self._address}: its workers lack something ({error}); '
                             'start them where the setup.bash of self_awareness was sourced'
                             ) from error


def _batches(tasks: int, workers: int) -> int:
    # Handing over a sum takes as long as counting a short bag: so few of them, but one for each
    # worker. Where a batch has as many tasks as there are workers, the results of the others
    # arrive while a worker is busy with it. Larger batches only lose more work when a worker dies.
    largest = max(workers, _LARGEST_BATCH)
    return min(tasks, max(workers, math.ceil(tasks / largest), 1))


def _in_order(tasks: Sequence[_Task], submit: Callable[[int], Any],
              result: Callable[[Any, _Task], _Result], workers: Callable[[], int],
              description: str) -> Generator[_Result, None, None]:
    waiting: Deque[Any] = deque()
    with progress.items(len(tasks), description) as one_done:
        for index, task in enumerate(tasks):
            while len(waiting) >= _AHEAD * max(workers(), 1):
                yield result(*waiting.popleft())
                one_done()
            waiting.append((submit(index), task))
        while waiting:
            yield result(*waiting.popleft())
            one_done()


def _call(function: Callable[[_Shared, _Task], _Result], shared: _Shared, task: _Task) -> bytes:
    # Results wait for their turn as bytes: histograms are smaller so.
    return pickle.dumps(function(shared, task))


def _outcome(function: Callable[[_Shared, _Task], _Result], shared: _Shared,
             task: _Task) -> bytes:
    try:
        return pickle.dumps((function(shared, task), None, ''))
    except Exception as error:
        return pickle.dumps((None, error, traceback.format_exc()))


def _result(outcome: Optional[bytes], task: object) -> Any:
    if outcome is None:
        raise ValueError(f'{task}: a process that worked on it was killed, and so were those that '
                         'tried again (for too little memory?); try fewer --jobs')
    result, error, where = pickle.loads(outcome)
    if error is not None:
        raise error from RuntimeError(f'in a process:\n{where}')
    return result
