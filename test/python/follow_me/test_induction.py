"""Faults that are induced in the running robot, as far as they need no master."""
from __future__ import annotations

import multiprocessing
import os
import time
from pathlib import Path
from typing import List

import pytest

from self_awareness_evaluation.live.processes import becomes_true
from self_awareness_follow_me import induction
from self_awareness_follow_me.effects import Starvation

TAKES_S = 0.2
"""So long, in the test, it takes to start a worker."""
BUSY_WITHIN_S = 60.0


def busy_s(pid: int) -> float:
    """Return how long a process has taken the CPU [s]."""
    fields = Path(f'/proc/{pid}/stat').read_text(encoding='ascii').rpartition(')')[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf('SC_CLK_TCK')


def test_no_worker_is_busy_before_all_have_started(monkeypatch: pytest.MonkeyPatch) -> None:
    start = multiprocessing.Process.start
    workers: List[multiprocessing.Process] = []

    def start_slowly(worker: multiprocessing.Process) -> None:
        start(worker)
        workers.append(worker)
        time.sleep(TAKES_S)

    def busy() -> List[float]:
        return [busy_s(int(worker.pid or 0)) for worker in workers]

    monkeypatch.setattr(multiprocessing.Process, 'start', start_slowly)
    with induction.starved(Starvation(ramp=0.0, slowdown=1.0, workers_per_core=4)):
        at_first = busy()
        assert becomes_true(lambda: min(busy()) >= 2 * TAKES_S, BUSY_WITHIN_S), 'all are busy'
    assert len(workers) == 4 * len(os.sched_getaffinity(0))
    assert max(at_first) < TAKES_S
    assert not any(worker.is_alive() for worker in workers), 'they end with the fault'
