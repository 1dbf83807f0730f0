"""When an event type was silent while an alarm stood, as its messages in the recording say."""
from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Optional

import numpy as np

from self_awareness import Alarm, Suspect
from self_awareness.reporting.report.judged import Judged
from self_awareness.stamps import SECOND_NS

CLEARLY_LONGER = 3
"""A pause is a silence if it is so many times as long as the longest one in training."""


@dataclass(frozen=True)
class Silence:
    """Times in seconds from the recording's first message.

    Args:
        begin: its last message, or the recording's first one.
        back: its next message; None: there is none until the recording's end.
    """

    begin: float
    back: Optional[float]


def silence_of(judged: Judged, alarm: Alarm, suspect: Suspect) -> Optional[Silence]:
    """Return the longest silence of a suspect's event type while an alarm stood.

    None: it was not silent, or it is not about its own messages: an answer that does not come may
    come without its question.
    """
    reason = suspect.reason
    if reason.kind in ('never came', 'stranger') or (reason.after and reason.kind != 'died'):
        return None
    looks_back = 0.0 if math.isnan(reason.lasted) else reason.lasted
    silence = _longest(judged, judged.edges_of(suspect.id),
                       suspect.since - int(looks_back * SECOND_NS), alarm.end)
    if reason.kind == 'died' and not reason.after:
        return silence
    usual = judged.by.trained.longest_gap(suspect.id) / SECOND_NS
    end = judged.seconds(judged.recording.end) if silence.back is None else silence.back
    return silence if usual > 0 and end - silence.begin > CLEARLY_LONGER * usual else None


def silence_of_all(judged: Judged, alarm: Alarm) -> Silence:
    """Return the longest time without any event, or any of some computers, as an alarm stood."""
    edges = (judged.edges_of_components(alarm.silent.components)
             if alarm.silent is not None and alarm.silent.hosts else judged.edges_of_all())
    return _longest(judged, edges, alarm.begin, alarm.end)


def _longest(judged: Judged, edges: np.ndarray, begin: int, end: int) -> Silence:
    """Return the longest of the gaps between edges that a stretch of time meets."""
    first = min(max(int(np.searchsorted(edges, begin, side='right')) - 1, 0), len(edges) - 2)
    last = int(np.searchsorted(edges, end, side='right')) + 1
    longest = first + int(np.argmax(np.diff(edges[first:max(last, first + 2)])))
    at_end = longest == len(edges) - 2
    return Silence(judged.seconds(int(edges[longest])),
                   None if at_end else judged.seconds(int(edges[longest + 1])))
