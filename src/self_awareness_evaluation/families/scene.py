"""What the messages of one recording have in common: its time, its chance, the robot's state."""
from __future__ import annotations

import zlib
from typing import Dict, List, Tuple

import numpy as np

from self_awareness_evaluation.families.conditions import Activity, Conditions
from self_awareness_evaluation.families.faults import STALL, Fault

LEAD_S = 10.0
"""A recording begins on a robot that has run for this long [s]; the longest answers fit into it.
"""

LASTS_S = 2.0  # what follows a crash lasts for so long [s]


class Scene:
    """A stretch of one start of a robot, while it is simulated.

    Times are seconds since the robot's start, float64. What holds for a whole start (phases of
    timers, the time of day) is drawn by `of_start`, all else by `of_recording`. Every purpose has
    a stream of its own: what one output draws does not change another one.
    """

    def __init__(self, robot_seed: int, start_seed: int, recorded_from: float, end: float,
                 conditions: Conditions, activities: Dict[str, Activity], fault: Fault) -> None:
        self.recorded_from = recorded_from
        self.begin = recorded_from - LEAD_S
        self.end = end
        self.conditions = conditions
        self.fault = fault
        self.published: List[np.ndarray] = []
        self.answers: Dict[int, Tuple[np.ndarray, np.ndarray]] = {}
        """When an output was asked, and when it answered [s]."""
        self._seed = (robot_seed, start_seed)
        self._recording = round(recorded_from * 1e3)
        self._edges = {name: activity.edges(self.begin, self.end, self.of_recording(name))
                       for name, activity in activities.items()}
        self.stalls = conditions.stalls(self.begin, end, self.of_recording('stalls'))
        """When the host stalls, and for how long [s]."""
        if fault.kind == STALL:
            self._stall_once_more(recorded_from + fault.follows_s)
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

    def in_fault(self, times: np.ndarray) -> np.ndarray:
        """Return which times [s] lie in the fault."""
        return ((times >= self.recorded_from + self.fault.onset_s)
                & (times < self.recorded_from + self.fault.relief_s))

    def has(self, kind: str, source: str, times: np.ndarray) -> np.ndarray:
        """Return at which times [s] a component has a fault of a kind."""
        is_one = (self.fault.kind, self.fault.source) == (kind, source)
        return self.in_fault(times) & is_one

    def _stall_once_more(self, begin: float) -> None:
        begins, lengths = self.stalls
        place = np.searchsorted(begins, begin)
        self.stalls = np.insert(begins, place, begin), np.insert(lengths, place, LASTS_S)
