"""The delays of training from an event type to another: bins to be drawn, and their drawing."""
from __future__ import annotations

import math
from collections import Counter
from typing import List, Sequence, Tuple

from self_awareness import TrainedModel
from self_awareness.stamps import SECOND_NS

Bin = Tuple[float, float, int]
"""Begin, end [s] and count; an infinite end: all longer delays share the bin."""

_MOST_ROWS = 40
_OWN_ROWS = 0.99  # share of the delays that have rows of their own


def log_bins(counted: Sequence[Tuple[int, int]]) -> List[Bin]:
    """Return the bins of the evidence detector from the first delay to the last one.

    Args:
        counted: shortest delay [ns] and count of each.
    """
    begins = [shortest / SECOND_NS for shortest, _ in counted]
    bins = [(begin, end, count)
            for begin, end, (_, count) in zip(begins, [*begins[1:], math.inf], counted)]
    filled = [index for index, (_, _, count) in enumerate(bins) if count]
    return bins[filled[0]:filled[-1] + 1] if filled else []


def paper_bins(trained: TrainedModel, from_id: int, to_id: int) -> List[Bin]:
    """Return the bins of the paper's detector; neighbours are one where there are many."""
    counts = trained.histogram(from_id, to_id)
    if not counts:
        return []
    first, last = min(counts), trained.quantile(from_id, to_id, _OWN_ROWS)
    # As many bins to a row as make the drawing fit a screen: 1, 2, 5, 10, 20, 50 and so on.
    merged = next(step * 10 ** power for power in range(19) for step in (1, 2, 5)
                  if (last - first) // (step * 10 ** power) < _MOST_ROWS)
    start = first // merged * merged
    by_row: Counter = Counter()
    for index, count in counts.items():
        by_row[(min(index, last + merged) - start) // merged] += count
    unit, horizon = trained.bin_size / SECOND_NS, trained.horizon_bins or math.inf
    rows = []
    for row in range(max(by_row) + 1):
        low = start + row * merged
        is_open = low > last or low <= horizon < low + merged
        rows.append((low * unit, math.inf if is_open else (low + merged) * unit, by_row[row]))
    return rows


def drawn(bins: Sequence[Bin], width: int) -> List[str]:
    """Return a drawing with characters: a line for each bin.

    Args:
        bins: at least one.
        width: of the longest bar, in characters.
    """
    most = max(count for _, _, count in bins)
    total = sum(count for _, _, count in bins)
    lines = []
    for low, high, count in bins:
        end = '...' if high == math.inf else f'- {high:8.3f}'
        bar = '#' * max(1 if count else 0, round(count / most * width))
        line = f'{low:10.3f} {end:<10} {count:8d} {count / total:6.1%} {bar}'
        lines.append(line.rstrip())
    return lines
