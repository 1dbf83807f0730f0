"""What the live evaluations ask of a master: a real one, on a port of its own."""
from __future__ import annotations

from pathlib import Path
from typing import Set

import pytest
import rosgraph
import rosnode

from self_awareness_evaluation.live.master import unregister
from self_awareness_evaluation.live.processes import (LiveError, Processes, await_condition,
                                                      free_port)

STARTED_WITHIN_S = 60.0


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
