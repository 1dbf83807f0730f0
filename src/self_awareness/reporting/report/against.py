"""What speaks against a suspect: its delays or its rate, beside those of training."""
from __future__ import annotations

import math
from dataclasses import dataclass
from typing import List, Optional, Tuple, Union

import numpy as np

from self_awareness import Alarm, Reason, Suspect
from self_awareness.reporting.delay_bins import log_bins, paper_bins
from self_awareness.reporting.report.judged import Judged
from self_awareness.stamps import SECOND_NS

_LAST_OF_OPEN_BIN = 2.0
_STEPS_OF_SPAN = 4
_LEAST_SPAN_S = 1.0
_BEFORE_S, _AFTER_S, _LONGEST_S = 20.0, 10.0, 120.0


@dataclass(frozen=True)
class Histogram:
    """Delays in training, and what was seen.

    Args:
        caption: what is drawn.
        edges: of the bins [s]; one more than bins. The last bin may have no end: it is drawn to
            twice its beginning.
        counts: by bin.
        seen: delay that was seen [s]; None: there is no single one.
        seen_text: what to write beside it.
        usual: range of most delays in training [s]; None: not known.
    """

    caption: str
    edges: List[float]
    counts: List[int]
    seen: Optional[float]
    seen_text: str
    usual: Optional[Tuple[float, float]]


@dataclass(frozen=True)
class Counts:
    """Messages of an event type by time.

    Args:
        caption: what is drawn.
        times: ends of the spans [s] from the recording's first message.
        counts: messages in the span that ends then.
        usual: range of most counts in training.
        begin, end: of the alarm [s].
    """

    caption: str
    times: List[float]
    counts: List[int]
    usual: Tuple[float, float]
    begin: float
    end: float


Evidence = Union[Histogram, Counts]


def against(judged: Judged, alarm: Alarm, suspect: Suspect) -> Optional[Evidence]:
    """Return what speaks against a suspect; None: its reason is neither a delay nor a rate."""
    return _delays(judged, suspect) or _rate(judged, alarm, suspect)


def _delays(judged: Judged, suspect: Suspect) -> Optional[Histogram]:
    trained = judged.by.trained
    names = [str(kind) for kind in trained.event_types]
    seen = _seen(suspect.reason)
    after = suspect.reason.after
    if seen is None or suspect.id >= len(names) or after not in ('', *names):
        return None
    other = names.index(after) if after else suspect.id
    bins = (paper_bins(trained, other, suspect.id) if judged.by.evidence is None
            else log_bins(judged.by.evidence.delays(other, suspect.id)))
    if not bins:
        return None
    begin, end, _ = bins[-1]
    last = end if math.isfinite(end) else _LAST_OF_OPEN_BIN * begin
    caption = (f'gaps between two {names[suspect.id]}' if other == suspect.id
               else f'delays from {names[other]} to {names[suspect.id]}')
    usual = (suspect.reason.usual_shortest, suspect.reason.usual_longest)
    known = suspect.reason.unit == 's' and not math.isnan(sum(usual))
    return Histogram(f'{caption}; shaded: what is usual' if known else caption,
                     [*(low for low, _, _ in bins), last], [count for _, _, count in bins],
                     *seen, usual if known else None)


def _seen(reason: Reason) -> Optional[Tuple[Optional[float], str]]:
    """Return the delay that was seen [s], if it is one, and its words."""
    if reason.unit == 's' and reason.value > 0 and reason.kind not in ('never came', 'stranger'):
        return reason.value, f'now: {seconds(reason.value)}'
    if reason.unit == 'requests':
        return None, f'now: none after the last {reason.value:.0f}'
    return None


def seconds(value: float) -> str:
    """Return seconds in the unit that shows them."""
    if value < 0.0995:
        return f'{1000 * value:.3g} ms'
    return f'{value:.3g} s' if value < 99.5 else f'{value:.0f} s'


def _rate(judged: Judged, alarm: Alarm, suspect: Suspect) -> Optional[Counts]:
    reason = suspect.reason
    known = reason.unit == 'Hz' and reason.lasted > 0
    if not known or math.isnan(reason.usual_shortest + reason.usual_longest):
        return None
    begin, end = judged.seconds(alarm.begin), judged.seconds(alarm.end)
    last = min(end + _AFTER_S, begin + _LONGEST_S, judged.seconds(judged.recording.end))
    span = max(reason.lasted, _LEAST_SPAN_S)
    usual = reason.usual * span
    spread = max(min(reason.usual_longest - reason.usual, reason.usual) * reason.lasted
                 * math.sqrt(span / reason.lasted), 1.0)
    times = np.arange(max(begin - _BEFORE_S, span), last, span / _STEPS_OF_SPAN)
    if not len(times):
        return None
    stamps = (judged.edges_of(suspect.id)[1:-1] - judged.recording.origin) / SECOND_NS
    counts = (np.searchsorted(stamps, times, side='right')
              - np.searchsorted(stamps, times - span, side='right'))
    return Counts(f'{judged.recording.event_types[suspect.id]} in {seconds(span)}; '
                  'blue band: what is usual; red: the alarm', times.tolist(), counts.tolist(),
                  (max(usual - spread, 0.0), usual + spread), begin, end)
