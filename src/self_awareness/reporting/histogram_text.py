"""Draws a histogram of delays with characters."""
from __future__ import annotations

import math
from collections import Counter
from typing import Dict, List, Optional, Sequence, Tuple

from self_awareness.stamps import SECOND_NS

_MOST_ROWS = 40


def draw(counts: Dict[int, int], bin_size: int, horizon_bins: int, last: int,
         width: int) -> List[str]:
    """Return the lines of a drawing.

    Args:
        counts: by bin; at least one.
        bin_size: [ns].
        horizon_bins: index of the bin that all longer delays share; 0: there is none.
        last: the last bin that has rows of its own; longer delays share one row.
        width: of the longest bar, in characters.
    """
    first = min(counts)
    # As many bins to a row as make the drawing fit a screen: 1, 2, 5, 10, 20, 50 and so on.
    merged = next(step * 10 ** power for power in range(19) for step in (1, 2, 5)
                  if (last - first) // (step * 10 ** power) < _MOST_ROWS)
    start = first // merged * merged
    by_row: Counter = Counter()
    for index, count in counts.items():
        by_row[(min(index, last + merged) - start) // merged] += count
    rows: List[Tuple[int, Optional[int], int]] = []  # first bin, the one after the last, count
    for row in range((last - start) // merged + 1):
        low = start + row * merged
        rows.append((low, low + merged, by_row.pop(row, 0)))
    if by_row:
        rows.append((start + len(rows) * merged, None, sum(by_row.values())))
    unit = bin_size / SECOND_NS

    def end_of(low: int, high: Optional[int]) -> float:
        if high is None or (horizon_bins and low <= horizon_bins < high):
            return math.inf
        return high * unit

    return _lines([(low * unit, end_of(low, high), count) for low, high, count in rows], width)


def draw_bins(bins: Sequence[Tuple[int, int]], width: int) -> List[str]:
    """Return the lines of a drawing of bins that are given by themselves; none without counts.

    Args:
        bins: shortest delay [ns] and count of each; the last one has no end.
        width: of the longest bar, in characters.
    """
    ends = [low / SECOND_NS for low, _ in bins[1:]] + [math.inf]
    rows = [(low / SECOND_NS, end, count) for (low, count), end in zip(bins, ends)]
    filled = [index for index, (_, _, count) in enumerate(rows) if count]
    return _lines(rows[filled[0]:filled[-1] + 1], width) if filled else []


def _lines(rows: Sequence[Tuple[float, float, int]], width: int) -> List[str]:
    """Return a line for each row: from and to [s], and count."""
    most = max(count for _, _, count in rows)
    total = sum(count for _, _, count in rows)
    lines = []
    for low, high, count in rows:
        end = '...' if high == math.inf else f'- {high:8.3f}'
        bar = '#' * max(1 if count else 0, round(count / most * width))
        line = f'{low:10.3f} {end:<10} {count:8d} {count / total:6.1%} {bar}'
        lines.append(line.rstrip())
    return lines
