"""Who does the work: results in order, no more of them than needed, and nothing left behind."""
from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any, Callable, Tuple

import pytest
from conftest import wait_until
from tqdm import tqdm

from self_awareness import progress
from self_awareness.workers import InProcess, Processes, Workers

PROGRAM = """
import signal
import sys
signal.signal(signal.SIGINT, signal.default_int_handler)  # who runs the tests may ignore it
sys.path.insert(0, {tests!r})
from pathlib import Path
from test_workers import answer_at_length, begin_and_hang, Connection, interrupt, Processes
{first}
list(Processes(2).map({work}, Path({folder!r}), range(1, 3), "test"))
"""

EVERYONE = [InProcess(), Processes(1), Processes(3)]


def times(factor: int, number: int) -> int:
    return factor * number


def after_the_next(folder: Path, number: int) -> int:
    """Return once the next task has begun: tasks end in another order than they begin."""
    (folder / str(number)).touch()
    if number % 2 == 0:
        wait_until((folder / str(number + 1)).exists, 'the next task')
    return number


def fail_at_two(_: None, number: int) -> int:
    if number == 2:
        raise ValueError('two is too much')
    return number


def begin_and_hang(folder: Path, number: int) -> None:
    (folder / f'{number}').write_text(str(os.getpid()))
    signal.pause()


@pytest.mark.parametrize('workers', EVERYONE)
def test_results_come_in_order(workers: Workers) -> None:
    assert list(workers.map(times, 3, range(20), 'test')) == list(range(0, 60, 3))


def test_results_come_in_order_whoever_is_ready_first(tmp_path: Path) -> None:
    assert list(Processes(2).map(after_the_next, tmp_path, range(6), 'test')) == list(range(6))


@pytest.mark.parametrize('workers', EVERYONE)
def test_an_error_comes_when_it_is_its_turn(workers: Workers) -> None:
    results = workers.map(fail_at_two, None, range(5), 'test')
    assert [next(results), next(results)] == [0, 1]
    with pytest.raises(ValueError, match='two is too much') as error:
        next(results)
    if isinstance(workers, Processes):
        assert 'fail_at_two' in str(error.value.__cause__), 'where it was raised'


def test_work_begins_only_a_little_ahead(tmp_path: Path) -> None:
    results = Processes(2).map(after_the_next, tmp_path, range(100), 'test')
    next(results)
    assert len(list(tmp_path.iterdir())) <= 5  # two for each process, and the one that came
    results.close()


@pytest.mark.parametrize('tasks, processes, batches', [
    (1, 1, 1), (2, 2, 2), (16, 2, 2), (17, 2, 3), (49, 2, 7), (30, 20, 20), (10000, 20, 500)])
def test_batches_are_few_and_not_long(tasks: int, processes: int, batches: int) -> None:
    assert Processes(processes).batches(tasks) == batches
    assert InProcess().batches(tasks) == tasks


def test_a_process_that_is_killed_is_replaced(tmp_path: Path) -> None:
    results = Processes(2).map(die_once, tmp_path, range(40), 'test')
    assert list(results) == list(range(40))
    assert len(list(tmp_path.iterdir())) == 14


def die_once(folder: Path, number: int) -> int:
    """Die in every third task, at its first attempt."""
    mark = folder / str(number)
    if number % 3 == 0 and not mark.exists():
        mark.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return number


def test_a_process_may_be_killed_in_the_middle_of_its_answer(tmp_path: Path) -> None:
    results = Processes(2).map(answer_at_length, tmp_path, range(6), 'test')
    assert next(results) == 0  # nobody reads the others' answers now: they fill their pipes
    wait_until(lambda: len(begun(tmp_path)) >= 3, 'two others answer')
    for pid in filter(alive, begun(tmp_path)):
        os.kill(pid, signal.SIGKILL)
    assert [len(result) for result in results] == [LONG] * 5


LONG = 10_000_000


def answer_at_length(folder: Path, number: int) -> Any:
    (folder / f'{number}').write_text(str(os.getpid()))
    return bytes(LONG) if number else 0


@pytest.mark.parametrize('whom', [os.kill, os.killpg])
def test_ctrl_c_ends_all_at_once(whom: Callable[[int, int], None], tmp_path: Path) -> None:
    program = program_of('begin_and_hang', tmp_path)
    with subprocess.Popen([sys.executable, '-c', program], start_new_session=True,
                          stderr=subprocess.PIPE, text=True) as process:
        wait_until(lambda: len(begun(tmp_path)) == 2, 'two processes hang')
        whom(process.pid, signal.SIGINT)
        _, said = process.communicate(timeout=2.0)
    assert not any(map(alive, begun(tmp_path)))
    assert said.count('Traceback') == 1 and said.endswith('KeyboardInterrupt\n')


def test_ctrl_c_ends_who_is_in_the_middle_of_an_answer(tmp_path: Path) -> None:
    program = program_of('answer_at_length', tmp_path, 'Connection.recv_bytes = interrupt')
    ended = subprocess.run([sys.executable, '-c', program], stderr=subprocess.DEVNULL,
                           timeout=30.0)
    assert ended.returncode == -signal.SIGINT
    assert not any(map(alive, begun(tmp_path)))


def program_of(work: str, folder: Path, first: str = '') -> str:
    return PROGRAM.format(tests=str(Path(__file__).parent), work=work, folder=str(folder),
                          first=first)


def interrupt(_: Connection) -> bytes:
    raise KeyboardInterrupt


def alive(pid: int) -> bool:
    try:
        return Path(f'/proc/{pid}/stat').read_text().rsplit(')', 1)[1].split()[0] != 'Z'
    except (FileNotFoundError, ProcessLookupError):
        return False


def begun(folder: Path) -> Tuple[int, ...]:
    texts = [path.read_text() for path in folder.glob('[0-9]*')]
    return tuple(int(text) for text in texts if text)


def test_what_is_not_wanted_any_more_is_not_waited_for(tmp_path: Path) -> None:
    results = Processes(2).map(_second_hangs, tmp_path, range(8), 'test')
    assert next(results) == 0
    wait_until(lambda: begun(tmp_path), 'a process hangs')
    results.close()
    assert not any(map(alive, begun(tmp_path)))


def _second_hangs(folder: Path, number: int) -> int:
    if number > 0:
        begin_and_hang(folder, number)
    return number


@pytest.mark.parametrize('how', [signal.SIGTERM, signal.SIGKILL])
def test_no_process_outlives_the_program(how: signal.Signals, tmp_path: Path) -> None:
    program = program_of('begin_and_hang', tmp_path)
    with subprocess.Popen([sys.executable, '-c', program]) as process:
        wait_until(lambda: len(begun(tmp_path)) == 2, 'two processes hang')
        os.kill(process.pid, how)
        process.wait()
    wait_until(lambda: not any(map(alive, begun(tmp_path))), 'the processes end')


def test_waiting_ends_where_no_bar_is_shown() -> None:
    passed = list(progress.waiting(0.25, 'a moment'))
    assert passed[-1] == 0.25
    assert passed == sorted(passed)
    assert len(passed) <= 3


def test_who_is_killed_stops_no_other_process() -> None:
    pid = os.fork()
    if pid == 0:
        tqdm.get_lock().acquire()
        os.kill(os.getpid(), signal.SIGKILL)
    os.waitpid(pid, 0)
    begun = threading.Event()

    def show() -> None:
        with progress.items(1, 'work'):
            begun.set()
    threading.Thread(target=show, daemon=True).start()
    assert begun.wait(10.0)
