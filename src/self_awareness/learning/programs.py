"""Runs the programs of this package that a learning consists of."""
from __future__ import annotations

import os
import shlex
import subprocess
import sys
import tempfile
from itertools import takewhile
from typing import Callable, Dict, Optional

import roslib.packages

from self_awareness.learning.logs import Division

_POLL_S = 0.5


class ProgramError(ValueError):
    """A program has ended with an error, and says which."""


def executable(name: str) -> str:
    """Return the path of a program or node of this package, as rosrun finds it.

    Raises:
        ValueError: it was not built or installed.
    """
    found = roslib.packages.find_node('self_awareness', name)
    if not found:
        raise ValueError(f'{name} is not there: was the package built?')
    return str(found[0])


def train_and_calibrate(division: Division, model: str, folder: str, budget: float,
                        interrupted: Callable[[], bool], add_to: Optional[str] = None) -> None:
    """Learn a model, and print what it can find.

    The programs are processes of their own: a robot runs beside them, so they stand back, and
    their memory is free afterwards.

    Args:
        division: what is trained and calibrated on.
        model: file to write, at the end.
        folder: where there is space for the model that has no limits yet.
        budget: false alarms an hour that the limits allow.
        interrupted: asked from time to time whether to stop.
        add_to: the model whose training it is added to; None: it is a new one.

    It also prints the commands, as they can be typed: there, the model that has no limits yet is
    `model`, too, since the folder that it lies in is gone afterwards.

    Raises:
        ProgramError: one of them says why it cannot do it, or is interrupted; or there is nothing
            to calibrate on.
    """
    if not division.calibration:
        raise ProgramError('the recordings are too short to find limits on: one must be 100 s or '
                           'longer after the start-up')
    with tempfile.TemporaryDirectory(prefix='.training', dir=folder) as temporary:
        counted = os.path.join(temporary, 'trained.model')
        base = [] if add_to is None else ['--add-to', add_to]
        named = {counted: model}
        # The verdict is that of calibrate, and what comes next is known to who calls.
        _run('learned from ', interrupted, named,
             'train', *base, *map(str, division.training), '-o', counted)
        _run('written: ', interrupted, named, 'calibrate', '--model', counted,
             '--normal', *map(str, division.calibration), '--budget', f'{budget:g}',
             '--inject', 'crash:*', '-o', model)


def _run(until: str, interrupted: Callable[[], bool], named: Dict[str, str],
         *command: str) -> None:
    """Run a program; what it prints goes on to the console, up to a line.

    Args:
        until: how that line begins.
        interrupted: whether to stop.
        named: what the command that is printed names in place of some of its words.
        command: the program and its arguments.
    """
    if interrupted():
        raise ProgramError(f'{command[0]}: interrupted')
    shown = ' '.join(shlex.quote(named.get(word, word)) for word in command)
    print(f'+ rosrun self_awareness {shown}', flush=True)
    with subprocess.Popen([executable(command[0]), *command[1:]], stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, universal_newlines=True) as process:
        while True:
            try:
                said, errors = process.communicate(timeout=_POLL_S)
                break
            except subprocess.TimeoutExpired:
                if interrupted():
                    process.terminate()
    for line in takewhile(lambda line: not line.startswith(until), said.splitlines()):
        print(line, flush=True)
    sys.stderr.write(errors)
    if process.returncode:
        lines = errors.strip().splitlines() or [f'{command[0]}: exit code {process.returncode}']
        raise ProgramError(lines[-1])
