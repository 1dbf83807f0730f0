"""Cuts a recording into stretches to draw: long ones, and single windows near the alarms."""
from __future__ import annotations

from typing import List, Sequence

import numpy as np

from self_awareness import Alarm, Verdicts
from self_awareness.stamps import SECOND_NS

MOST_LONG = 1000
"""Stretches of the whole recording, at most about so many."""
MOST_FINE = 1500
"""Windows that are stretches of their own, at most so many."""
MOST_CELLS = 20_000_000
"""Stretches times components, at most so many: they are kept in memory."""

_BEFORE = 5 * SECOND_NS
_AFTER = 15 * SECOND_NS


def cut(verdicts: Verdicts, components: int) -> np.ndarray:
    """Return the index of the first window of each stretch, in order.

    Near the beginning of an alarm, and if there is room of a suspicion, each window is one.

    Args:
        verdicts: at least one window.
        components: of the model.
    """
    windows = len(verdicts.start)
    most = max(1, min(MOST_LONG + MOST_FINE, MOST_CELLS // max(components, 1)))
    long = min(MOST_LONG, most)
    step = -(-windows // long)
    first = np.zeros(windows, dtype=bool)
    first[::step] = True
    room = most - int(first.sum())
    for begin, end in _near(verdicts, [*verdicts.alarms, *verdicts.suspicions]):
        end = min(end, begin + max(room, 0))
        room -= int((~first[begin:end]).sum())
        first[begin:end] = True
        if end < windows:
            first[end] = True  # the long stretch goes on after it
    return np.flatnonzero(first)


def _near(verdicts: Verdicts, stretches: Sequence[Alarm]) -> List[Sequence[int]]:
    starts = np.array([stretch.begin for stretch in stretches], dtype=np.int64)
    begins = np.searchsorted(verdicts.start, starts - _BEFORE)
    ends = np.searchsorted(verdicts.start, starts + _AFTER)
    return list(zip(begins.tolist(), ends.tolist()))
