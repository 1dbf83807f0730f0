"""The delays of training beside what was seen: the histogram that explains a suspect."""
from __future__ import annotations

import math
from dataclasses import dataclass
from typing import List, Optional, Sequence, Tuple

from self_awareness import Reason, Suspect, TrainedModel
from self_awareness.reporting.report.judged import Judged
from self_awareness.stamps import SECOND_NS

_LAST_OF_OPEN_BIN = 2.0
_MOST_BINS = 120


@dataclass(frozen=True)
class Histogram:
    """Delays in training, and what was seen.

    Args:
        title: what is counted.
        edges: of the bins [s]; one more than bins. The last bin may have no end: it is drawn to
            twice its beginning.
        counts: by bin.
        seen: delay that was seen [s]; None: there is no single one.
        seen_text: what to write beside it.
        usual: range of most delays in training [s]; None: not known.
    """

    title: str
    edges: List[float]
    counts: List[int]
    seen: Optional[float]
    seen_text: str
    usual: Optional[Tuple[float, float]]


def histogram_of(judged: Judged, suspect: Suspect) -> Optional[Histogram]:
    """Return the delays that speak against a suspect; None: its reason is no delay."""
    kinds = judged.recording.event_types
    if suspect.id >= len(judged.by.trained.event_types):
        return None
    other = suspect.id
    if suspect.reason.after:
        others = [str(kind) for kind in judged.by.trained.event_types]
        if suspect.reason.after not in others:
            return None
        other = others.index(suspect.reason.after)
    seen = _seen(suspect.reason)
    if seen is None:
        return None
    bins = _bins(judged, other, suspect.id)
    if not bins:
        return None
    edges, counts = _finite(bins)
    value, text = seen
    own = other == suspect.id
    title = (f'gaps between two {kinds[suspect.id]}' if own
             else f'delays from {kinds[other]} to {kinds[suspect.id]}')
    usual = (suspect.reason.usual_shortest, suspect.reason.usual_longest)
    known = suspect.reason.unit == 's' and not math.isnan(usual[0] + usual[1])
    return Histogram(title, edges, counts, value, text, usual if known else None)


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


def _bins(judged: Judged, from_id: int, to_id: int) -> List[Tuple[float, float, int]]:
    """Return begin, end [s] and count of the bins; the end of the last one may be infinite."""
    if judged.by.evidence is not None:
        counted = judged.by.evidence.delays(from_id, to_id)
        begins = [shortest / SECOND_NS for shortest, _ in counted]
        bins = [(begin, end, count)
                for begin, end, (_, count) in zip(begins, [*begins[1:], math.inf], counted)]
    else:
        bins = _paper_bins(judged.by.trained, from_id, to_id)
    filled = [index for index, (_, _, count) in enumerate(bins) if count > 0]
    return bins[filled[0]:filled[-1] + 1] if filled else []


def _paper_bins(trained: TrainedModel, from_id: int,
                to_id: int) -> List[Tuple[float, float, int]]:
    """Return the bins of the paper's detector; neighbours are one where there are many."""
    counts = trained.histogram(from_id, to_id)
    if not counts:
        return []
    first, last = min(counts), max(counts)
    step = -(-(last - first + 1) // _MOST_BINS)
    merged = [0] * ((last - first) // step + 1)
    for index, count in counts.items():
        merged[(index - first) // step] += count
    unit = trained.bin_size / SECOND_NS
    return [((first + place * step) * unit, (first + (place + 1) * step) * unit, count)
            for place, count in enumerate(merged)]


def _finite(bins: Sequence[Tuple[float, float, int]]) -> Tuple[List[float], List[int]]:
    begin, end, _ = bins[-1]
    last = end if math.isfinite(end) else _LAST_OF_OPEN_BIN * begin
    return [each[0] for each in bins] + [last], [each[2] for each in bins]
