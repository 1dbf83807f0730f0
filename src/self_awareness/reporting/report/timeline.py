"""The score over the whole recording, and the evidence of each component: what is drawn of it.

It is cut into stretches: long ones, and single windows near the alarms.
"""
from __future__ import annotations

from dataclasses import dataclass
from typing import List, Optional, Sequence, Tuple

import numpy as np

from self_awareness import EvidenceLanes
from self_awareness.reporting.report.judged import Judged
from self_awareness.stamps import SECOND_NS

MOST_LANES = 40  # components that have a lane of their own, at most so many
MOST_LONG = 1000  # stretches of the whole recording, at most about so many
MOST_FINE = 1500  # windows that are stretches of their own, at most so many
SHOWN_LIMITS = 4.0
"""Scores beyond so many limits are drawn at the edge; those within the limits are not drawn."""

_BEFORE = 5 * SECOND_NS
_AFTER = 15 * SECOND_NS


@dataclass(frozen=True)
class Lanes:
    """The evidence of components over the stretches of a timeline."""

    names: List[str]  # of the components, from top to bottom
    shares: np.ndarray  # the largest share of its limit, float [lanes, stretches]; 1 is the limit
    left_out: int  # number of components with evidence that have no lane
    largest_left_out: float  # the largest share of these
    # The evidence by stretch of all components, and which track was strongest when.
    of: EvidenceLanes


@dataclass(frozen=True)
class Timeline:
    """The score by stretch of time."""

    # Of the stretches [s] from the recording's first message; one more than stretches.
    edges: np.ndarray
    lowest: np.ndarray  # score of each stretch, in units of the threshold's size; NaN: none
    highest: np.ndarray  # likewise
    abnormal: np.ndarray  # whether a window of it is
    unit: float  # the threshold's size; 1: not calibrated
    # The threshold in this unit: -1 of evidence, 1 of the paper's; None: not calibrated.
    limit: Optional[float]
    # Start and end [s] of the times in which no alarm is raised.
    settling: List[Tuple[float, float]]
    lanes: Optional[Lanes]  # the evidence of components; None: there is none, or nobody wants it


def cut(judged: Judged) -> np.ndarray:
    """Return the index of the first window of each stretch, in order; there is one at least.

    Near the beginning of an alarm, and if there is room of a suspicion, each window is one.
    """
    verdicts = judged.verdicts
    windows = len(verdicts.start)
    first = np.zeros(windows, dtype=bool)
    first[::-(-windows // MOST_LONG)] = True
    room = MOST_LONG + MOST_FINE - int(first.sum())
    starts = np.array([each.begin for each in [*verdicts.alarms, *verdicts.suspicions]],
                      dtype=np.int64)
    near = (np.searchsorted(verdicts.start, starts + around) for around in (-_BEFORE, _AFTER))
    for begin, end in zip(*(each.tolist() for each in near)):
        end = min(end, begin + max(room, 0))
        room -= int((~first[begin:end]).sum())
        first[begin:end] = True
        if end < windows:
            first[end] = True  # the long stretch goes on after it
    return np.flatnonzero(first)


def _select_lanes(found: EvidenceLanes, first: Sequence[str]) -> Lanes:
    """Return the lanes of the named components, and of those with the most evidence."""
    shares, names = found.shares, found.components
    largest = shares.max(axis=1, initial=0.0)
    rank = {name: index for index, name in enumerate(dict.fromkeys(first))}
    order = sorted(np.flatnonzero(largest > 0).tolist(),
                   key=lambda lane: (rank.get(names[lane], len(rank)), -largest[lane]))
    kept, rest = order[:MOST_LANES], order[MOST_LANES:]
    return Lanes([names[lane] for lane in kept], shares[kept], len(rest),
                 float(largest[rest].max()) if rest else 0.0, found)


def timeline(judged: Judged, first: Optional[Sequence[str]] = None) -> Timeline:
    """Return the score of a recording, with at least one window, by stretch.

    Args:
        judged: the recording.
        first: components whose lanes come first, the most important one first; None: no lanes.
    """
    verdicts, window, begins = judged.verdicts, judged.by.trained.window, cut(judged)
    found = None if first is None else judged.lanes(verdicts.start[begins])
    threshold = judged.by.threshold
    unit = abs(threshold) if threshold else 1.0
    starts = (np.append(verdicts.start, verdicts.start[-1] + window)
              - judged.recording.origin) / SECOND_NS
    scores = verdicts.score / unit
    if judged.by.evidence is None:
        scores = np.nan_to_num(scores)  # the paper's score of silence is 0
    steps = np.flatnonzero(np.diff(np.concatenate(([0], verdicts.settling.astype(np.int8), [0]))))
    return Timeline(
        edges=np.append(starts[:-1][begins], starts[-1]),
        lowest=np.fmin.reduceat(scores, begins),
        highest=np.fmax.reduceat(scores, begins),
        abnormal=np.logical_or.reduceat(verdicts.abnormal, begins),
        unit=unit,
        limit=None if threshold is None else threshold / unit,
        settling=[(float(starts[a]), float(starts[b])) for a, b in steps.reshape(-1, 2)],
        lanes=None if found is None else _select_lanes(found, first or []))
