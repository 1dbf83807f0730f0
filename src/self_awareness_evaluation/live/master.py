"""The master of a live evaluation, on a free port of the loopback interface."""
from __future__ import annotations

import contextlib
import os
import subprocess
from pathlib import Path
from typing import Iterator

import rospy

from self_awareness_evaluation.live.listeners import STARTED_WITHIN_S
from self_awareness_evaluation.live.processes import Processes, await_condition, free_port


@contextlib.contextmanager
def own_master(folder: Path) -> Iterator[Processes]:
    """Start a master and make this process a node of it; nothing of it runs on afterwards.

    Args:
        folder: exists; for the logs of all processes that are started.

    Raises:
        LiveError: the master does not answer in time.
    """
    port = free_port()
    os.environ.update(ROS_MASTER_URI=f'http://127.0.0.1:{port}', ROS_IP='127.0.0.1',
                      ROS_LOG_DIR=str(folder / 'log'))
    os.environ.pop('ROS_HOSTNAME', None)
    with Processes(folder) as processes:
        processes.start('roscore', 'roscore', '-p', str(port))
        await_condition('the master answers', _answers, STARTED_WITHIN_S)
        # What it logs would be heard by the monitor.
        rospy.init_node('evaluate', disable_signals=True, disable_rosout=True)
        try:
            yield processes
        finally:
            rospy.signal_shutdown('the evaluation is over')


def _answers() -> bool:
    """Return whether the master answers."""
    return subprocess.run(['rosnode', 'list'], stdout=subprocess.DEVNULL,
                          stderr=subprocess.DEVNULL, check=False).returncode == 0
