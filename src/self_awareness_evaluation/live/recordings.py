"""Recordings of starts of a robot, and the model of them, by the programs that users have."""
from __future__ import annotations

import time
from pathlib import Path
from typing import List, Protocol

from self_awareness.calibration.limits import BUDGET
from self_awareness.training.robot_graph import graph_file
from self_awareness_evaluation.live.listeners import STARTED_WITHIN_S
from self_awareness_evaluation.live.processes import (LiveError, Processes, await_condition, say,
                                                      wait)
from self_awareness_evaluation.records import Learning

APART_S = 70.0
"""From the end of one bag to the beginning of the next one [s].

Bags that follow each other within a minute count as one start."""

TRAINING, CALIBRATION, SESSION, MODEL = 'training', 'calibration', 'session', 'learned.model'
"""Prefixes of the recordings to learn from, to find limits by, and of the session; the model."""

BAGS, EVENTS = 'bags', 'events'
"""What is recorded: whole messages, or event logs."""

_WITHIN_S = 900.0


class System(Protocol):
    """A robot: start() waits until it is in normal operation, or raises LiveError."""

    def start(self) -> None:
        """Start it."""

    def end(self) -> None:
        """End it."""


class Recorder:
    """Records starts of a robot by record.launch, and learns from them."""

    def __init__(self, system: System, what: str, folder: Path, processes: Processes) -> None:
        """Record nothing yet.

        Args:
            system: to be started for each recording.
            what: BAGS or EVENTS.
            folder: exists; for recordings and the model. Recordings that it holds are used again.
            processes: to run the programs among.
        """
        self._system = system
        self._what = what
        self._folder = folder
        self._processes = processes
        self._ended = -APART_S  # the last one, by time.monotonic()

    def learn(self, learning: Learning, budget: float = BUDGET) -> Path:
        """Record, train and calibrate; return the model.

        Args:
            learning: how much.
            budget: false alarms an hour that the limits allow.

        Raises:
            LiveError: a program fails, or nothing is recorded.
        """
        for number in range(1, learning.starts + 1):
            self._record(f'{TRAINING}_{number}', learning.training_s)
        for number in range(1, learning.calibrations + 1):
            self._record(f'{CALIBRATION}_{number}', learning.calibration_s)
        model = str(self._folder / MODEL)
        say('training')
        self._run('train', *self._names(TRAINING), '-o', model)
        say('calibrating')
        self._run('calibrate', '--model', model, '--normal', *self._names(CALIBRATION),
                  '--budget', str(budget), '-o', model)
        return self._folder / MODEL

    def _run(self, program: str, *arguments: str) -> None:
        self._processes.run(program, _WITHIN_S, 'rosrun', 'self_awareness', program, *arguments)

    def _names(self, prefix: str) -> List[str]:
        return [str(path) for path in recordings(self._folder, prefix)]

    def _record(self, name: str, length_s: float) -> None:
        if recordings(self._folder, name):
            return
        self._system.start()
        left_s = self._ended + APART_S - time.monotonic()
        if self._what == BAGS and left_s > 0.0:
            wait(left_s, 'so that this start counts as another one')
        recorder = self._processes.start(f'record_{name}', *record_command(self._folder / name,
                                                                           self._what))
        await_condition(f'{name} is written',
                        lambda: any(self._folder.glob(f'{name}_*.bag.active')), STARTED_WITHIN_S)
        wait(length_s, f'recording {name}')
        self._processes.end(recorder)
        self._ended = time.monotonic()
        self._system.end()
        found = recordings(self._folder, name)
        if not found or (self._what == BAGS and not Path(graph_file(str(found[0]))).exists()):
            raise LiveError(f'{name}: record.launch has written no recording with its graph, see '
                            f'{self._folder}/record_{name}.log')


def record_command(prefix: Path, what: str, *arguments: str) -> List[str]:
    """Return the command that records; prefix: of the files; arguments: more of record.launch."""
    return ['roslaunch', '--wait', 'self_awareness', 'record.launch', f'what:={what}',
            f'output:={prefix}', *arguments]


def recordings(folder: Path, prefix: str) -> List[Path]:
    """Return the recordings of a folder with that prefix."""
    return sorted(folder.glob(f'{prefix}_*.bag'))
