"""Plots as PNG files. matplotlib takes long to import: only a program that draws imports it."""
from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, List, Optional, Sequence, Tuple

import numpy as np

from self_awareness import Roc, RocPoint
from self_awareness.output_files import replacing

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_DPI = 120


@dataclass(frozen=True)
class ScorePlot:
    """What is drawn of one recording; times in seconds from its first message.

    Args:
        title: above the plot.
        times: of the windows' starts.
        scores: one a window, NaN where it had no events.
        threshold: s*; None: not calibrated.
        settling: start and end of the stretches in which no alarm is raised.
        alarms: start and end of the stretches in which the alarm stood.
    """

    title: str
    times: np.ndarray
    scores: np.ndarray
    threshold: Optional[float]
    settling: List[Tuple[float, float]]
    alarms: List[Tuple[float, float]]


def save_scores(path: str, plots: Sequence[ScorePlot]) -> None:
    """Draw the scores of recordings over time, one below the other.

    Raises:
        OSError: the file cannot be written.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(12, 0.6 + 3.6 * len(plots)), dpi=_DPI, constrained_layout=True)
    for axes, plot in zip(figure.subplots(len(plots), squeeze=False)[:, 0], plots):
        _draw_scores(axes, plot)
    with replacing(path) as temporary:
        figure.savefig(temporary, format='png')


def save_roc(path: str, title: str, curves: Sequence[Tuple[str, Roc]], chosen: RocPoint) -> None:
    """Draw ROCs, and the chosen threshold. The last one is that of all faults together.

    Args:
        curves: name and ROC; at least one.

    Raises:
        OSError: the file cannot be written.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.5, 7), dpi=_DPI, constrained_layout=True)
    axes = figure.subplots()
    axes.plot([0, 1], [0, 1], color='0.6', linestyle=':', linewidth=1, label='chance')
    for index, (name, roc) in enumerate(curves):
        last = index == len(curves) - 1
        axes.plot([point.false_positive_rate for point in roc.points],
                  [point.true_positive_rate for point in roc.points],
                  color='black' if last else None, linewidth=2.2 if last else 1.3,
                  label=f'{name}: AUC {roc.auc:.3f}')
    axes.plot(chosen.false_positive_rate, chosen.true_positive_rate, 'o', color='tab:red',
              markersize=9, zorder=3, clip_on=False,
              label=f's* = {chosen.cutoff:.4g}: found {chosen.true_positive_rate:.1%}, '
                    f'false {chosen.false_positive_rate:.2%}')
    axes.set(title=title, xlabel='false positive rate (normal windows called abnormal)',
             ylabel='true positive rate (abnormal windows found)', xlim=(-0.01, 1.01),
             ylim=(-0.01, 1.01), aspect='equal')
    axes.grid(alpha=0.3)
    axes.legend(loc='lower right')
    with replacing(path) as temporary:
        figure.savefig(temporary, format='png')


def _draw_scores(axes: Axes, plot: ScorePlot) -> None:
    _shade(axes, plot.settling, 'settling: no alarm yet', color='0.88')
    _shade(axes, plot.alarms, 'alarm', color='tab:red', alpha=0.22)
    axes.plot(plot.times, plot.scores, color='tab:blue', linewidth=0.8, label='score of a window')
    silent = np.isnan(plot.scores)
    if silent.any():
        axes.plot(plot.times[silent], np.zeros(silent.sum()), '|', color='tab:purple',
                  markersize=8, label='no event in the window')
    if plot.threshold is not None:
        axes.axhline(plot.threshold, color='tab:red', linestyle='--', linewidth=1.3,
                     label=f'threshold s* = {plot.threshold:.4g}')
    axes.set(title=plot.title, xlabel='time from the first message [s]',
             ylabel='score (low is abnormal)')
    axes.margins(x=0.005)
    axes.set_ylim(bottom=min(0.0, axes.get_ylim()[0]))
    axes.grid(alpha=0.3)
    axes.legend(loc='upper left', bbox_to_anchor=(1.0, 1.0), frameon=False)


def _shade(axes: Axes, stretches: Sequence[Tuple[float, float]], label: str,
           **style: object) -> None:
    for index, (start, end) in enumerate(stretches):
        axes.axvspan(start, end, linewidth=0, label=label if index == 0 else None, **style)
