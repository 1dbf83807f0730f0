"""The recording of a live session, of everything that the robot says."""
from __future__ import annotations

import subprocess
from pathlib import Path

from self_awareness.evaluation.live.listeners import STARTED_WITHIN_S
from self_awareness.evaluation.live.processes import Processes, await_condition

_EXCLUDED = '/rosout_agg|/self_awareness/.*|/diagnostics.*'


def start_recorder(processes: Processes, bag: Path, *options: str) -> subprocess.Popen:
    """Start to record everything but what the monitor says, and return when it is recorded.

    Args:
        processes: to be started among.
        bag: to be written.
        options: of rosbag record.

    Raises:
        LiveError: rosbag writes nothing.
    """
    recorder = processes.start('record', 'rosbag', 'record', '--all', '--exclude', _EXCLUDED,
                               *options, '--output-name', str(bag), '__name:=record')
    active = Path(f'{bag}.active')
    await_condition(f'rosbag writes {bag.name}',
                    lambda: active.exists() and active.stat().st_size > 0, STARTED_WITHIN_S)
    return recorder
