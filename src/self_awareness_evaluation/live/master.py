"""The master of a live session, on a free port of the loopback interface."""
from __future__ import annotations

import contextlib
import os
from pathlib import Path
from typing import Iterator, Sequence

import rosgraph
import rosnode
import rospy

from self_awareness_evaluation.live.processes import (STARTED_WITHIN_S, LiveError, Processes,
                                                      await_condition, free_port)


@contextlib.contextmanager
def own_master(folder: Path, node: str, pinned: Sequence[str] = ()) -> Iterator[Processes]:
    """Start a master and make this process a node of it; nothing of it runs on afterwards.

    Args:
        folder: exists; for the logs of all processes that are started.
        node: what this process is called.
        pinned: command that runs the master on some cores; empty: on any.

    Raises:
        LiveError: the master does not answer in time.
    """
    port = free_port()
    os.environ.update(ROS_MASTER_URI=f'http://127.0.0.1:{port}', ROS_IP='127.0.0.1',
                      ROS_LOG_DIR=str(folder / 'log'))
    os.environ.pop('ROS_HOSTNAME', None)
    with Processes(folder) as processes:
        processes.start('roscore', *pinned, 'roscore', '-p', str(port))
        await_condition('the master answers', rosgraph.is_master_online, STARTED_WITHIN_S)
        # What it logs would be heard by the monitor.
        rospy.init_node(node, disable_signals=True, disable_rosout=True)
        try:
            yield processes
        finally:
            rospy.signal_shutdown('the session is over')


def unregister(ended: Sequence[str]) -> None:
    """Take back what nodes that have ended left at the master.

    When such a node is started again, the master has the one before shut down, at a port that
    another node may have by then.

    Args:
        ended: their names.

    Raises:
        LiveError: the master does not answer.
    """
    try:
        left = sorted(set(rosnode.get_node_names()) & set(ended))
        rosnode.cleanup_master_blacklist(rosgraph.Master('/evaluate'), left)
    except (rosnode.ROSNodeException, rosgraph.MasterException, OSError) as error:
        raise LiveError(f'the master does not answer any more: {error}') from error
