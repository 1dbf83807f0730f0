"""What the messages of one recording have in common: its time, its chance, the robot's state."""
from __future__ import annotations

import zlib
from typing import Dict, List, NamedTuple, Tuple

import numpy as np

from self_awareness_evaluation.families.conditions import Activity, Conditions

LEAD_S = 10.0
"""A recording begins on a robot that has run for this long [s]; the longest answers fit into it.
"""


class Asked(NamedTuple):
    """What was asked of an output, and when it answered [s]; of the same length."""

    asked: np.ndarray
    answered: np.ndarray


class Scene:
    """A stretch of one start of a robot, while it is simulated.

    Times are seconds since the robot's start, float64. What holds for a whole start (phases of
    timers, the time of day) is drawn by `of_start`, all else by `of_recording`. Every purpose has
    a stream of its own: what one output draws does not change another one.

    Args:
        robot_seed: of the robot, at least 0.
        start_seed: of the start, at least 0.
        begin: of the recording [s].
        end: of the recording [s].
        conditions: of the robot.
        activities: of the robot, by name.
    """

    def __init__(self, robot_seed: int, start_seed: int, begin: float, end: float,
                 conditions: Conditions, activities: Dict[str, Activity]) -> None:
        self.begin = begin - LEAD_S
        self.end = end
        self.conditions = conditions
        self.published: List[np.ndarray] = []
        self.asked: Dict[int, Asked] = {}
        self._seed = (robot_seed, start_seed)
        self._recording = round(begin * 1e3)
        self._edges = {name: activity.edges(self.begin, self.end, self.of_recording(name))
                       for name, activity in activities.items()}
        self._stalls = conditions.stalls(self.begin, end, self.of_recording('stalls'))
        self._day_phase = self.of_start('time of day').uniform(0.0, 1.0)

    def of_start(self, purpose: str) -> np.random.Generator:
        """Return what draws the same in all recordings of a start."""
        return np.random.default_rng((*self._seed, zlib.crc32(purpose.encode())))

    def of_recording(self, purpose: str) -> np.random.Generator:
        """Return what draws for this recording only."""
        return np.random.default_rng((*self._seed, zlib.crc32(purpose.encode()), self._recording))

    def load(self, times: np.ndarray) -> np.ndarray:
        """Return by how much longer work takes at some times, 1 or more."""
        return self.conditions.load(times, self._day_phase)

    def during(self, activity: str, times: np.ndarray) -> np.ndarray:
        """Return which times [s] lie in an activity; an empty name: all do."""
        if not activity:
            return np.ones(len(times), dtype=bool)
        # Before the first edge the activity is off, after it on, and so on.
        return np.searchsorted(self._edges[activity], times, side='right') % 2 == 1

    def stalls(self) -> Tuple[np.ndarray, np.ndarray]:
        """Return when the host stalls in the recording, and for how long [s]."""
        return self._stalls

    def stall(self, begin: float, length: float) -> None:
        """Let the host stall once more [s], before anything was published."""
        begins, lengths = self._stalls
        place = np.searchsorted(begins, begin)
        self._stalls = (np.insert(begins, place, begin), np.insert(lengths, place, length))
