"""Recordings of starts of a robot, and the model of them, by the programs that users have."""
from __future__ import annotations

import time
from pathlib import Path
from typing import List, Protocol

from self_awareness.training.robot_graph import graph_file
from self_awareness_evaluation.live.processes import (STARTED_WITHIN_S, LiveError, Processes,
                                                      await_condition, say, wait)
from self_awareness_evaluation.records import Learning

APART_S = 70.0
"""From the end of one bag to the beginning of the next one [s].

Bags that follow each other within a minute count as one start."""

BAGS, EVENTS = 'bags', 'events'
"""What is recorded: whole messages, or event logs."""

_TRAINING, _CALIBRATION, _MODEL = 'training', 'calibration', 'learned.model'  # names of files
_WITHIN_S = 900.0


class System(Protocol):
    """A robot: start() waits until it is in normal operation, or raises LiveError."""

    def start(self) -> None:
        """Start it."""

    def end(self) -> None:
        """End it."""


def learn(system: System, what: str, learning: Learning, budget: float, folder: Path,
          processes: Processes) -> Path:
    """Record starts of a robot by record.launch, train and calibrate; return the model.

    Args:
        system: to be started for each recording.
        what: BAGS or EVENTS.
        learning: how much.
        budget: false alarms an hour that the limits allow.
        folder: exists; for recordings and the model. Recordings that it holds are used again.
        processes: to run the programs among.

    Raises:
        LiveError: a program fails, or nothing is recorded.
    """
    ended = -APART_S  # the last one, by time.monotonic()
    for prefix, number, length_s in (
            (_TRAINING, learning.starts, learning.training_s),
            (_CALIBRATION, learning.calibrations, learning.calibration_s)):
        for name in (f'{prefix}_{turn}' for turn in range(1, number + 1)):
            if not _recorded(folder, name):
                not_before = ended + APART_S if what == BAGS else ended
                ended = _record(system, what, folder, name, length_s, not_before, processes)
    model = str(folder / _MODEL)
    for arguments in (['train', *_recorded(folder, _TRAINING)],
                      ['calibrate', '--model', model, '--normal',
                       *_recorded(folder, _CALIBRATION), '--budget', str(budget)]):
        say(arguments[0])
        processes.run(arguments[0], _WITHIN_S, 'rosrun', 'self_awareness', *arguments, '-o', model)
    return folder / _MODEL


def _record(system: System, what: str, folder: Path, name: str, length_s: float,
            not_before: float, processes: Processes) -> float:
    """Record a start of the robot; return when that ended, by time.monotonic()."""
    system.start()
    if not_before > time.monotonic():
        wait(not_before - time.monotonic(), 'so that this start counts as another one')
    recorder = processes.start(
        f'record_{name}', 'roslaunch', '--wait', 'self_awareness', 'record.launch',
        f'what:={what}', f'output:={folder / name}')
    await_condition(f'{name} is written', lambda: any(folder.glob(f'{name}_*.bag.active')),
                    STARTED_WITHIN_S)
    wait(length_s, f'recording {name}')
    processes.end(recorder)
    ended = time.monotonic()
    system.end()
    found = _recorded(folder, name)
    if not found or (what == BAGS and not Path(graph_file(found[0])).exists()):
        raise LiveError(f'{name}: record.launch has written no recording with its graph, see '
                        f'{folder}/record_{name}.log')
    return ended


def _recorded(folder: Path, prefix: str) -> List[str]:
    return sorted(str(path) for path in folder.glob(f'{prefix}_*.bag'))
