"""Which process a node is, and how it is ended: with real processes."""
from __future__ import annotations

import os
from pathlib import Path

import pytest
from launched import launched

from self_awareness.recovery.node_process import NodeProcess, NotItsProcess, process_of

OURSELVES = -2


def test_a_node_ends_when_it_is_told_to_and_nobody_else_does(tmp_path: Path) -> None:
    with launched(tmp_path, '__name:=player') as pid:
        process = process_of('/robot/player', pid)
        with_the_same_id = NodeProcess(pid, process.start - 1)
        assert not with_the_same_id.runs()
        assert with_the_same_id.end(0.3) == 'ended by SIGTERM', 'it has ended long ago'
        assert not process.ends_within(0.3, lambda: None), 'it gets no signal'
        assert process.pid == pid and process.runs()
        assert process.end(20.0) == 'ended by SIGTERM'
        assert not process.runs()


@pytest.mark.parametrize('name', ['/player2', '/robot/play', '/slam'])
def test_a_process_of_another_name_is_not_the_nodes(tmp_path: Path, name: str) -> None:
    with launched(tmp_path, '__name:=player') as pid:
        with pytest.raises(NotItsProcess, match='not started with its name'):
            process_of(name, pid)


@pytest.mark.parametrize('pid', [-1, 0, 1, 2 ** 30, OURSELVES])
def test_what_is_no_process_of_a_node_is_refused(pid: int) -> None:
    with pytest.raises(NotItsProcess, match='/player says that it is process'):
        process_of('/player', os.getpid() if pid == OURSELVES else pid)
