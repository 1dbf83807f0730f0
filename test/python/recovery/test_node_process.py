"""Which process a node is, and how it is ended: with real processes."""
from __future__ import annotations

import os
import signal
from pathlib import Path

import pytest
from launched import launched

from self_awareness.recovery.node_process import NodeProcess, NotItsProcess, process_of

GRACE_S = 0.3

OURSELVES = -2


def test_a_node_is_found_and_ends_when_it_is_told_to(tmp_path: Path) -> None:
    with launched(tmp_path, '__name:=player') as pid:
        process = process_of('/robot/player', pid)
        assert process.pid == pid and process.runs()
        assert process.end(20.0) == 'ended by SIGTERM'
        assert not process.runs()


@pytest.mark.parametrize('stopped', [True, False])
def test_who_hangs_or_is_deaf_is_killed_after_the_grace(tmp_path: Path, stopped: bool) -> None:
    with launched(tmp_path, '__name:=player', deaf=not stopped) as pid:
        process = process_of('/player', pid)
        if stopped:
            os.kill(pid, signal.SIGSTOP)
        assert process.end(GRACE_S) == 'ended by SIGKILL'


def test_another_process_with_the_same_id_is_left_alone(tmp_path: Path) -> None:
    with launched(tmp_path, '__name:=player') as pid:
        now = process_of('/player', pid)
        before = NodeProcess(pid, now.start - 1)
        assert not before.runs()
        before.signal(signal.SIGKILL)
        assert before.end(GRACE_S) == 'ended by SIGTERM', 'it has ended long ago'
        assert now.runs()


@pytest.mark.parametrize('name', ['/player2', '/robot/play', '/slam'])
def test_a_process_of_another_name_is_not_the_nodes(tmp_path: Path, name: str) -> None:
    with launched(tmp_path, '__name:=player') as pid:
        with pytest.raises(NotItsProcess, match='not started with its name'):
            process_of(name, pid)


def test_who_was_not_launched_would_stay_dead(tmp_path: Path) -> None:
    with launched(tmp_path, '__name:=player', by='terminal') as pid:
        with pytest.raises(NotItsProcess, match='not started by roslaunch'):
            process_of('/player', pid)


@pytest.mark.parametrize('pid', [-1, 0, 1, 2 ** 30, OURSELVES])
def test_what_is_no_process_of_a_node_is_refused(pid: int) -> None:
    with pytest.raises(NotItsProcess, match='/player says that it is process'):
        process_of('/player', os.getpid() if pid == OURSELVES else pid)
