"""The page of a comparison, in the style of the report."""
from __future__ import annotations

from typing import Dict, List, Optional

from self_awareness.comparison.changes import DELAY, GAP, Change, Comparison
from self_awareness.comparison.sides import Side
from self_awareness.reporting import diff_text
from self_awareness.reporting.report import figures
from self_awareness.reporting.report.page import save_page
from self_awareness.stamps import SECOND_NS

MOST_FIGURES = 12
"""Changes whose delays are drawn, at most so many."""


def save_diff(path: str, comparison: Comparison) -> None:
    """Write the page of a comparison.

    Raises:
        OSError: the file cannot be written.
    """
    drawn: Dict[str, figures.Figure] = {}
    keys: List[Optional[str]] = []
    for number, change in enumerate(comparison.changes):
        wanted = change.what in (GAP, DELAY) and len(drawn) < MOST_FIGURES
        keys.append(f'delays-{number}' if wanted else None)
        if wanted:
            drawn[f'delays-{number}'] = _delays(comparison, change)
    save_page(path, 'diff.html', {
        'sections': [],
        'figures': [dict(figure, id=key) for key, figure in drawn.items()],
    }, comparison=comparison, changes=list(zip(comparison.changes, keys)), text=diff_text)


def _delays(comparison: Comparison, change: Change) -> figures.Figure:
    first = change.other or change.kind
    return figures.two_histograms(*(
        _shares(side, side.ids[first], side.ids[change.kind])
        for side in (comparison.before, comparison.after)))


def _shares(side: Side, from_id: int, to_id: int) -> figures.Bins:
    """Return the beginning [s] of each bin, and the share of the delays in it [%]."""
    counted = side.all.delays(from_id, to_id)
    total = sum(count for _, count in counted)
    return [(begin / SECOND_NS, 100.0 * count / total) for begin, count in counted]
