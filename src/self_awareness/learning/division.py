"""What of the recordings is trained on, and what the limits are found on (docs/learn.md)."""
from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import List, Sequence, Set

from self_awareness.learning.logs import Log
from self_awareness.parts import BagPart

_TRAINING_SHARE = 2.0 / 3.0
_SHORTEST_CALIBRATION_S = 30  # a part of a recording, method.md, section 5.1
_SHORTEST_TRAINING_S = 10
_BETWEEN_S = 1  # no event belongs to both


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
