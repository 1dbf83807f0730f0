"""Makes a model of a live evaluation's recordings, by the programs that users have."""
from __future__ import annotations

import time
from pathlib import Path
from typing import Sequence

from self_awareness.calibration.limits import BUDGET
from self_awareness_evaluation.live.passing import say, wait
from self_awareness_evaluation.live.processes import Processes

APART_S = 70.0
"""From the end of one recording to the beginning of the next one [s].

Recordings that follow each other within a minute count as one start."""

_WITHIN_S = 900.0


class Apart:
    """Keeps recordings so far apart that each counts as another start of the robot."""

    def __init__(self) -> None:
        self._ended = -APART_S  # the last one, by time.monotonic()

    def wait(self) -> None:
        """Wait until another recording may begin."""
        left_s = self._ended + APART_S - time.monotonic()
        if left_s > 0.0:
            wait(left_s, 'so that this start counts as another one')

    def ended(self) -> None:
        """Take note that a recording has just ended."""
        self._ended = time.monotonic()


def learn(processes: Processes, model: Path, training: Sequence[Path], normal: Sequence[Path],
          *options: str, budget: float = BUDGET) -> None:
    """Train and calibrate.

    Args:
        processes: to run the programs among.
        model: to be written.
        training: recordings to learn from.
        normal: recordings to find the limits by.
        options: of train.
        budget: false alarms an hour that the limits allow.

    Raises:
        LiveError: a program fails.
    """
    say('training')
    processes.run('train', _WITHIN_S, 'rosrun', 'self_awareness', 'train', *map(str, training),
                  *options, '-o', str(model))
    say('calibrating')
    processes.run('calibrate', _WITHIN_S, 'rosrun', 'self_awareness', 'calibrate',
                  '--model', str(model), '--normal', *map(str, normal), '--budget', str(budget),
                  '-o', str(model))
