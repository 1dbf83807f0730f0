"""Recordings of a small robot for the tests of the evaluation: a fast topic and a slow one."""
from __future__ import annotations

import random
from typing import List, Tuple

import numpy as np

from self_awareness import EventType
from self_awareness.stamps import SECOND_NS
from self_awareness_evaluation.records import WindowedEvents

LASER = EventType('/player', '/scan', 'sensor_msgs/LaserScan')
BATTERY = EventType('/power', '/battery', 'sensor_msgs/BatteryState')

START = 1_000 * SECOND_NS


def robot(seconds: float, seed: int,
          silent: Tuple[Tuple[float, float], ...] = ()) -> WindowedEvents:
    """Return a recording with /scan at 50 Hz and /battery at 4 Hz, both with a little jitter.

    Args:
        seconds: its length.
        seed: of the jitter.
        silent: stretches without /scan, from and to [s].
    """
    chance = random.Random(seed)
    found: List[Tuple[int, int]] = []
    for id_, rate in enumerate((50.0, 4.0)):
        for index in range(int(seconds * rate)):
            at = (index + chance.uniform(0.0, 0.2)) / rate
            if id_ or not any(begin <= at < end for begin, end in silent):
                found.append((START + round(at * SECOND_NS), id_))
    found.sort()
    stamps, ids = zip(*found)
    return WindowedEvents([LASER, BATTERY], np.array(stamps, dtype=np.int64),
                          np.array(ids, dtype=np.uint32), START + round(seconds * SECOND_NS))
