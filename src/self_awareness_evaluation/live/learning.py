"""Makes a model of a live evaluation's recordings, by the programs that users have."""
from __future__ import annotations

from pathlib import Path
from typing import Sequence

from self_awareness.calibration.limits import BUDGET
from self_awareness_evaluation.live.passing import say
from self_awareness_evaluation.live.processes import Processes

_WITHIN_S = 900.0


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
