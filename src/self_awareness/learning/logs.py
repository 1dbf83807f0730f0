"""The event logs of a learning: the folder that they lie in, what can be used of it,
and what of that is trained on (docs/learn.md)."""
from __future__ import annotations

import fcntl
import glob
import os
import time
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from typing import Dict, Iterator, List, Sequence, Set

import numpy as np
import rosbag

from self_awareness import (BagError, EncodingRules, read_events, recordings_in_event_log,
                            summarise_bag)
from self_awareness.parts import BagPart
from self_awareness.stamps import SECOND_NS

HEARD_S = 10.0  # for so long after an event the robot counts as heard [s]

_ACTIVE = '.active'
_LOCK = '.lock'
_UNLOCKED_S = 30.0  # a recorder that was told to end has ended by then
_POLL_S = 0.1

_TRAINING_SHARE = 2.0 / 3.0
_SHORTEST_CALIBRATION_S = 30  # a part of a recording, method.md, section 5.1
_SHORTEST_TRAINING_S = 10
_BETWEEN_S = 1  # no event belongs to both


@dataclass(frozen=True)
class Log:
    """A recording in an event log."""

    part: BagPart  # the whole recording
    seconds: float  # its length
    robot_start: int  # when the robot was started [ns]
    heard: float = 0.0  # for how long the robot was heard [s]


class LogFolder:
    """A folder of event logs, made if it is not there; those of another encoding are left out."""

    def __init__(self, path: str, encoding: EncodingRules) -> None:
        self.path = path
        self._encoding = encoding
        self._known: Dict[str, List[Log]] = {}  # by file; empty: it is left out
        os.makedirs(path, exist_ok=True)

    @property
    def logs(self) -> List[Log]:
        """The recordings that can be used, by the names of the files: in the order of time."""
        return [log for path in sorted(self._known) for log in self._known[path]]

    @property
    def hours(self) -> float:
        """For how long the robot was heard in all recordings."""
        return sum(log.heard for log in self.logs) / 3600.0

    @property
    def starts(self) -> int:
        """How many starts of the robot the recordings are of."""
        return len({log.robot_start for log in self.logs})

    @contextmanager
    def locked(self) -> Iterator[int]:
        """Keep others from recording here; hands out what keeps them, for who records to inherit.

        Raises:
            ValueError: another one records here, and goes on.
        """
        with open(os.path.join(self.path, _LOCK), 'w', encoding='ascii') as lock:
            deadline = time.monotonic() + _UNLOCKED_S
            while True:
                try:
                    fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
                    break
                except BlockingIOError:
                    if time.monotonic() > deadline:
                        raise ValueError(f'{self.path}: somebody else learns here; name another '
                                         'folder') from None
                time.sleep(_POLL_S)
            yield lock.fileno()

    def mend(self) -> List[str]:
        """Complete the files that a crash left behind; return a line for each.

        Nobody may record here.
        """
        return [_mended(path) for path in
                sorted(glob.glob(os.path.join(glob.escape(self.path), f'*.bag{_ACTIVE}')))]

    def look(self) -> List[str]:
        """Read the files that are new; return what is wrong with those that are left out."""
        problems = []
        for path in sorted(glob.glob(os.path.join(glob.escape(self.path), '*.bag'))):
            if path not in self._known:
                try:
                    self._known[path] = self._read(path)
                except (BagError, OSError) as error:
                    self._known[path] = []
                    problems.append(f'left out: {error}')
        return problems

    def _read(self, path: str) -> List[Log]:
        """Return the recordings of a file in which somebody was heard.

        All of it is read: a part may be damaged.
        """
        number = recordings_in_event_log(path)
        if number is None:
            summarise_bag(path)  # says what is wrong with the file, if it is that
            raise BagError(f'{path}: a bag, and no event log')
        logs = []
        for recording in range(number):
            summary = summarise_bag(path, recording)
            if summary.encoding != self._encoding:
                raise BagError(f'{path}: was recorded by another encoding')
            stamps = read_events(path, self._encoding, recording=recording).stamps
            if len(stamps):
                silences = np.diff(np.append(stamps, summary.end)) / SECOND_NS
                logs.append(Log(BagPart(path, recording=recording, alone=number == 1),
                                (summary.end - summary.start) / SECOND_NS, summary.robot_start,
                                float(np.clip(silences, 0.0, HEARD_S).sum())))
        return logs


@dataclass(frozen=True)
class Division:
    """Parts of recordings; none of the training overlaps with one of the calibration."""

    training: List[BagPart] = field(default_factory=list)
    calibration: List[BagPart] = field(default_factory=list)


def divide(logs: Sequence[Log], start_up: float) -> Division:
    """Cut every recording: the beginning is trained on, the limits are found on the end.

    So both know every start of the robot. What is too short to be cut is trained on as a whole,
    and what is left of a start that soon ended again is left out.

    Args:
        logs: in the order of time.
        start_up: left out after each start of the robot [s].
    """
    division = Division()
    started: Set[int] = set()
    for log in logs:
        begin = 0.0 if log.robot_start in started else start_up
        started.add(log.robot_start)
        length = log.seconds - begin
        if length < _SHORTEST_TRAINING_S:
            continue
        # Whole seconds, as they are printed.
        cut = round(begin + _TRAINING_SHARE * length)
        if log.seconds - cut - _BETWEEN_S < _SHORTEST_CALIBRATION_S:
            division.training.append(replace(log.part, start=begin or None))
            continue
        division.training.append(replace(log.part, start=begin, end=float(cut)))
        division.calibration.append(replace(log.part, start=float(cut + _BETWEEN_S)))
    return division


def _mended(path: str) -> str:
    try:
        with rosbag.Bag(path, 'a', allow_unindexed=True) as bag:
            for _ in bag.reindex():
                pass
    except (rosbag.ROSBagException, OSError, EOFError) as error:
        return f'left out: {path}: cannot be mended ({error}); remove it'
    complete = path[:-len(_ACTIVE)]
    os.rename(path, complete)
    return f'mended: {complete}'
