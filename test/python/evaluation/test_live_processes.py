"""The processes of a live session: ended together, and their master, a real one."""
from __future__ import annotations

import os
from pathlib import Path
from typing import Set

import pytest
import rosgraph
import rosnode

from self_awareness_evaluation.live.master import unregister
from self_awareness_evaluation.live.processes import (LiveError, Processes, await_condition,
                                                      free_port)
from self_awareness_evaluation.live.session import used

STARTED_WITHIN_S = 60.0


def test_processes_are_ended_and_failures_are_told(tmp_path: Path) -> None:
    with Processes(tmp_path) as processes:
        asleep = processes.start('asleep', 'sleep', '1000')
        processes.run('right', 10.0, 'echo', 'well')
        with pytest.raises(LiveError, match='exit code 3.*wrong.log'):
            processes.run('wrong', 10.0, 'sh', '-c', 'exit 3')
    assert asleep.poll() is not None
    assert (tmp_path / 'right.log').read_text() == 'well\n'
    with pytest.raises(LiveError, match='not within 0 s: a wonder'):
        await_condition('a wonder', lambda: False, 0.0)
    with pytest.raises(LiveError, match=f'process {asleep.pid} has ended'):
        used(asleep.pid)


def test_what_a_process_uses() -> None:
    found = used(os.getpid())
    assert 5.0 < found['memory_mb'] < 1e4 and found['threads'] >= 1 and found['files'] >= 3


def nodes() -> Set[str]:
    """Return the names of those that publish, subscribe or serve, but for roscore's own."""
    return set(rosnode.get_node_names()) - {'/rosout'}


def test_who_ended_without_unregistering_is_unknown_to_the_master(
        tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    port = free_port()
    monkeypatch.setenv('ROS_MASTER_URI', f'http://127.0.0.1:{port}')
    monkeypatch.setenv('ROS_LOG_DIR', str(tmp_path))
    with Processes(tmp_path) as processes:
        processes.start('roscore', 'roscore', '-p', str(port))
        await_condition('the master answers', rosgraph.is_master_online, STARTED_WITHIN_S)
        for number, name in enumerate(('/camera', '/lidar', '/lidar_driver')):
            gone = f'http://127.0.0.1:{number + 1}'
            node = rosgraph.Master(name)
            node.registerPublisher(f'{name}/out', 'std_msgs/String', gone)
            node.registerSubscriber('/tf', 'std_msgs/String', gone)
            node.registerService(f'{name}/get_loggers', f'rosrpc://127.0.0.1:{number + 1}', gone)
        assert nodes() == {'/camera', '/lidar', '/lidar_driver'}

        unregister(['/lidar', '/never_there'])
        assert nodes() == {'/camera', '/lidar_driver'}
    with pytest.raises(LiveError, match='the master does not answer any more'):
        unregister(['/camera'])
