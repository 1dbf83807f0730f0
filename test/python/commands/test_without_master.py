"""Programs that need a master, where none answers."""
from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from contextlib import contextmanager
from pathlib import Path
from typing import Iterator, Sequence

import pytest
from conftest import take_sigint

NOBODY = 'http://127.0.0.1:1/'
LONG_S = 60.0


@contextmanager
def _started(program: str, *words: str) -> Iterator[subprocess.Popen[str]]:
    code = f'import sys; from self_awareness.commands import {program}; sys.exit({program}.main())'
    with subprocess.Popen((sys.executable, '-c', code, *words), text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, preexec_fn=take_sigint,
                          env={**os.environ, 'ROS_MASTER_URI': NOBODY,
                               'PYTHONUNBUFFERED': '1'}) as process:
        watchdog = threading.Timer(LONG_S, process.kill)
        watchdog.start()
        try:
            yield process
        finally:
            watchdog.cancel()
            process.kill()


# 0: rospy has not ended its threads in time, and so the process is ended (ros_node.py).
@pytest.mark.parametrize('program, words, codes', [('component', ['player'], (130,)),
                                                   ('learn', [], (0, 130)),
                                                   ('only_one', ['learn', '__name:=x'], (130,))])
def test_ctrl_c_ends_who_waits_for_it_without_a_traceback(program: str, words: Sequence[str],
                                                          codes: Sequence[int]) -> None:
    with _started(program, *words) as process:
        assert process.stdout is not None
        assert any('master' in line for line in process.stdout)
        process.send_signal(signal.SIGINT)
        assert 'Traceback' not in process.stdout.read()
        assert process.wait(LONG_S) in codes


def test_who_writes_the_graph_says_once_that_it_cannot(tmp_path: Path) -> None:
    with _started('record_graph', str(tmp_path / 'normal')) as process:
        assert process.stdout is not None
        line = process.stdout.readline()
        assert f'record_graph: warning: no master at {NOBODY}' in line
        with pytest.raises(subprocess.TimeoutExpired):
            process.wait(2.5)  # it asks once a second
        process.send_signal(signal.SIGINT)
        assert 'no master' not in process.stdout.read()
    assert not list(tmp_path.iterdir())


def test_who_writes_the_graph_into_no_folder_says_once_how_to_make_it(tmp_path: Path) -> None:
    with _started('record_graph', str(tmp_path / 'new' / 'normal')) as process:
        assert process.stdout is not None
        told = process.stdout.read()
        assert process.wait(LONG_S) == 1
    assert told.count('mkdir -p') == 1 and f"mkdir -p '{tmp_path / 'new'}'" in told
