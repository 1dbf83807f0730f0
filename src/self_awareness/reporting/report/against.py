"""What speaks against a suspect: its delays or its rate, beside those of training."""
from __future__ import annotations

import math
from dataclasses import dataclass
from typing import List, Optional, Sequence, Tuple

import numpy as np

from self_awareness import Alarm, Reason, Suspect, TrainedModel
from self_awareness.reporting.report import figures
from self_awareness.reporting.report.figures import Figure
from self_awareness.reporting.report.judged import Judged
from self_awareness.reporting.text import delay
from self_awareness.stamps import SECOND_NS

_Bins = Tuple[List[float], List[int]]  # edges [s], one more than bins, and counts; empty: none

_LAST_OF_OPEN_BIN = 2
_MOST_ROWS = 40
_OWN_ROWS = 0.99  # share of the delays that have rows of their own
_STEPS_OF_SPAN = 4
_LEAST_SPAN_S = 1.0
_BEFORE_S, _AFTER_S, _LONGEST_S = 20.0, 10.0, 120.0


@dataclass(frozen=True)
class Evidence:
    """A figure of delays or of numbers of messages, and in words what it shows."""

    caption: str
    figure: Figure


def against(judged: Judged, alarm: Alarm, suspect: Suspect) -> Optional[Evidence]:
    """Return what speaks against a suspect; None: its reason is neither a delay nor a rate."""
    return _delays(judged, suspect) or _rate(judged, alarm, suspect)


def _delays(judged: Judged, suspect: Suspect) -> Optional[Evidence]:
    trained = judged.by.trained
    names = [str(kind) for kind in trained.event_types]
    seen = _seen(suspect.reason)
    after = suspect.reason.after
    if seen is None or suspect.id >= len(names) or after not in ('', *names):
        return None
    other = names.index(after) if after else suspect.id
    edges, counts = (_paper_bins(trained, other, suspect.id) if judged.by.evidence is None
                     else _log_bins(judged.by.evidence.delays(other, suspect.id)))
    if not counts:
        return None
    caption = (f'gaps between two {names[suspect.id]}' if other == suspect.id
               else f'delays from {names[other]} to {names[suspect.id]}')
    usual = (suspect.reason.usual_shortest, suspect.reason.usual_longest)
    known = suspect.reason.unit == 's' and not math.isnan(sum(usual))
    return Evidence(f'{caption}; shaded: what is usual' if known else caption,
                    figures.histogram(edges, counts, *seen, usual if known else None))


def _log_bins(counted: Sequence[Tuple[int, int]]) -> _Bins:
    """Return the bins of the evidence detector from the first delay to the last one.

    Args:
        counted: shortest delay [ns] and count of each.
    """
    filled = [index for index, (_, count) in enumerate(counted) if count]
    if not filled:
        return [], []
    begins = [shortest / SECOND_NS for shortest, _ in counted]
    edges = [*begins, _LAST_OF_OPEN_BIN * begins[-1]]
    return (edges[filled[0]:filled[-1] + 2],
            [count for _, count in counted[filled[0]:filled[-1] + 1]])


def _paper_bins(trained: TrainedModel, from_id: int, to_id: int) -> _Bins:
    """Return the bins of the paper's detector, as many to a row as leave few rows; the last row
    has all the longer delays, too."""
    counts = trained.histogram(from_id, to_id)
    if not counts:
        return [], []
    first, last = min(counts), trained.quantile(from_id, to_id, _OWN_ROWS)
    step = max(1, -(-(last + 1 - first) // _MOST_ROWS))
    edges = np.arange(first, last + step + 1, step)
    rows, _ = np.histogram(np.minimum(list(counts), last), edges, weights=list(counts.values()))
    if max(counts) > last:
        edges[-1] = max(_LAST_OF_OPEN_BIN * edges[-2], edges[-1])
    return (edges * (trained.bin_size / SECOND_NS)).tolist(), rows.tolist()


def _seen(reason: Reason) -> Optional[Tuple[Optional[float], str]]:
    """Return the delay that was seen [s], if it is one, and its words."""
    if reason.unit == 's' and reason.value > 0 and reason.kind not in ('never came', 'stranger'):
        return reason.value, f'now: {delay(reason.value)}'
    if reason.unit == 'requests':
        return None, f'now: none after the last {reason.value:.0f}'
    return None


def _rate(judged: Judged, alarm: Alarm, suspect: Suspect) -> Optional[Evidence]:
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
    return Evidence(f'{judged.recording.event_types[suspect.id]} in {delay(span)}; '
                    'blue band: what is usual; red: the alarm',
                    figures.counts(times.tolist(), counts.tolist(),
                                   (max(usual - spread, 0.0), usual + spread), begin, end))
