from __future__ import annotations

import os
import signal
import threading

from tqdm import tqdm

from self_awareness import progress


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
