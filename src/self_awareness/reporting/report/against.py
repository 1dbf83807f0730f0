"""What speaks against a suspect: its delays or its rate, beside those of training."""
from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass
from typing import List, Optional, Sequence, Tuple, Union

import numpy as np

from self_awareness import Alarm, Reason, Suspect, TrainedModel
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
    edges, counts = (_paper_bins(trained, other, suspect.id) if judged.by.evidence is None
                     else _log_bins(judged.by.evidence.delays(other, suspect.id)))
    if not counts:
        return None
    caption = (f'gaps between two {names[suspect.id]}' if other == suspect.id
               else f'delays from {names[other]} to {names[suspect.id]}')
    usual = (suspect.reason.usual_shortest, suspect.reason.usual_longest)
    known = suspect.reason.unit == 's' and not math.isnan(sum(usual))
    return Histogram(f'{caption}; shaded: what is usual' if known else caption,
                     edges, counts, *seen, usual if known else None)


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
    """Return the bins of the paper's detector; neighbours are one where there are many."""
    counts = trained.histogram(from_id, to_id)
    if not counts:
        return [], []
    first, last = min(counts), trained.quantile(from_id, to_id, _OWN_ROWS)
    # As many bins to a row as leave few rows: 1, 2, 5, 10, 20, 50 and so on.
    merged = next(step * 10 ** power for power in range(19) for step in (1, 2, 5)
                  if (last - first) // (step * 10 ** power) < _MOST_ROWS)
    start = first // merged * merged
    by_row: Counter = Counter()
    for index, count in counts.items():
        by_row[(min(index, last + merged) - start) // merged] += count
    rows = range(max(by_row) + 1)
    begins = [start + row * merged for row in rows]
    is_open = begins[-1] > last or begins[-1] <= (trained.horizon_bins or math.inf) < (
        begins[-1] + merged)
    begins.append(_LAST_OF_OPEN_BIN * begins[-1] if is_open else begins[-1] + merged)
    unit = trained.bin_size / SECOND_NS
    return [begin * unit for begin in begins], [by_row[row] for row in rows]


def _seen(reason: Reason) -> Optional[Tuple[Optional[float], str]]:
    """Return the delay that was seen [s], if it is one, and its words."""
    if reason.unit == 's' and reason.value > 0 and reason.kind not in ('never came', 'stranger'):
        return reason.value, f'now: {delay(reason.value)}'
    if reason.unit == 'requests':
        return None, f'now: none after the last {reason.value:.0f}'
    return None


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
    return Counts(f'{judged.recording.event_types[suspect.id]} in {delay(span)}; '
                  'blue band: what is usual; red: the alarm', times.tolist(), counts.tolist(),
                  (max(usual - spread, 0.0), usual + spread), begin, end)
