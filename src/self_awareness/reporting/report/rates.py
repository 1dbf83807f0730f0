"""How often an event type came near an alarm, beside what is usual: what explains a rate."""
from __future__ import annotations

import math
from dataclasses import dataclass
from typing import List, Optional, Tuple

import numpy as np

from self_awareness import Alarm, Suspect
from self_awareness.reporting.report.judged import Judged
from self_awareness.stamps import SECOND_NS

_STEPS_OF_SPAN = 4
_BEFORE_S, _AFTER_S, _LONGEST_S = 20.0, 10.0, 120.0


@dataclass(frozen=True)
class Counts:
    """Messages of an event type by time.

    Args:
        title: what is counted.
        times: ends of the spans [s] from the recording's first message.
        counts: messages in the span that ends then.
        usual: range of most counts in training.
        begin, end: of the alarm [s].
    """

    title: str
    times: List[float]
    counts: List[int]
    usual: Tuple[float, float]
    begin: float
    end: float


def counts_of(judged: Judged, alarm: Alarm, suspect: Suspect) -> Optional[Counts]:
    """Return the counts that speak against a suspect; None: its reason is no rate."""
    reason = suspect.reason
    known = reason.unit == 'Hz' and reason.lasted > 0
    if not known or math.isnan(reason.usual_shortest + reason.usual_longest):
        return None
    begin, end = judged.seconds(alarm.begin), judged.seconds(alarm.end)
    last = min(end + _AFTER_S, begin + _LONGEST_S, judged.seconds(judged.recording.end))
    times = np.arange(max(begin - _BEFORE_S, reason.lasted), last,
                      reason.lasted / _STEPS_OF_SPAN)
    stamps = (judged.edges_of(suspect.id)[1:-1] - judged.recording.origin) / SECOND_NS
    counts = (np.searchsorted(stamps, times, side='right')
              - np.searchsorted(stamps, times - reason.lasted, side='right'))
    return Counts(f'{judged.recording.event_types[suspect.id]} in {reason.lasted:g} s',
                  times.tolist(), counts.tolist(),
                  (reason.usual_shortest * reason.lasted, reason.usual_longest * reason.lasted),
                  begin, end)
