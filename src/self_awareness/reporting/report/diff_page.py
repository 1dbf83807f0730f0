"""The page of a comparison, in the style of the report."""
from __future__ import annotations

from self_awareness.comparison.changes import DELAY, GAP, Change, Comparison
from self_awareness.comparison.sides import Side
from self_awareness.reporting import diff_text
from self_awareness.reporting.report import figures
from self_awareness.reporting.report.page import save_page
from self_awareness.stamps import SECOND_NS

MOST_FIGURES = 12  # changes whose delays are drawn, at most so many


def save_diff(path: str, comparison: Comparison) -> None:
    """Write the page of a comparison.

    Raises:
        OSError: the file cannot be written.
    """
    drawn = [number for number, change in enumerate(comparison.changes)
             if change.what in (GAP, DELAY)][:MOST_FIGURES]
    save_page(path, 'diff.html', {
        'sections': [],
        'figures': [{**_delays(comparison, comparison.changes[number]), 'id': f'delays-{number}'}
                    for number in drawn],
    }, comparison=comparison, drawn=drawn, text=diff_text)


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
