"""Plots as files: PNG, PDF or SVG, by the name's ending.

matplotlib takes long to import: only a program that draws imports it.
"""
from __future__ import annotations

from typing import TYPE_CHECKING, Optional, Sequence, Tuple

import numpy as np

from self_awareness import Roc, RocPoint
from self_awareness.output_files import replacing
from self_awareness.reporting.report.judged import Judged
from self_awareness.reporting.report.timeline import SHOWN_LIMITS, timeline
from self_awareness.reporting.text import percent
from self_awareness.stamps import SECOND_NS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_DPI = 120
_NAMED = 3
_LEFT_EDGE = 0.05
_RED, _GREY = '#c62f35', '#7d8694'


def save_scores(path: str, recordings: Sequence[Judged]) -> None:
    """Draw the scores of recordings over time, one below the other.

    Raises:
        OSError: the file cannot be written.
    """
    from matplotlib.figure import Figure

    number = len(recordings)
    figure = Figure(figsize=(12, 0.6 + 3.6 * number), dpi=_DPI, constrained_layout=True)
    for axes, judged in zip(figure.subplots(number, squeeze=False)[:, 0], recordings):
        _draw_scores(axes, judged)
    _save(path, figure)


def save_roc(path: str, title: str, curves: Sequence[Tuple[str, Roc]], chosen: RocPoint) -> None:
    """Draw ROCs, and the chosen threshold; beside them, their left edge.

    Those of all faults together and of the worst few are named.

    Args:
        curves: name and ROC; at least one. The last one is that of all faults together.

    Raises:
        OSError: the file cannot be written.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(11, 6.4), dpi=_DPI)
    whole, edge = figure.subplots(1, 2, gridspec_kw={'left': 0.07, 'right': 0.97, 'top': 0.93,
                                                     'bottom': 0.25, 'wspace': 0.15})
    for axes in (whole, edge):
        _draw_rocs(axes, curves)
        axes.plot(chosen.false_positive_rate, chosen.true_positive_rate, 'o', color=_RED,
                  markersize=9, zorder=4, clip_on=axes is edge,
                  label=f's* = {chosen.cutoff:.4g}: found {chosen.true_positive_rate:.1%}, '
                        f'false {chosen.false_positive_rate:.2%}')
        axes.set(xlabel='false positive rate (normal windows called abnormal)',
                 ylim=(-0.01, 1.01))
        axes.grid(alpha=0.3)
    whole.plot([0, 1], [0, 1], color='0.6', linestyle=':', linewidth=1)
    whole.set(title=_plain(title), xlim=(-0.01, 1.01),
              ylabel='true positive rate (abnormal windows found)')
    edge.set(title=f'the same up to {_LEFT_EDGE:.0%} of false positives',
             xlim=(-0.01 * _LEFT_EDGE, 1.01 * _LEFT_EDGE))
    figure.legend(*whole.get_legend_handles_labels(), loc='lower center', frameon=False, ncol=2)
    _save(path, figure)


def _draw_rocs(axes: Axes, curves: Sequence[Tuple[str, Roc]]) -> None:
    *single, (all_name, all_roc) = curves
    ranked = sorted(single, key=lambda curve: curve[1].auc)
    named, others = ranked[:_NAMED], ranked[_NAMED:]
    for index, (_, roc) in enumerate(others):
        label = f'{len(others)} others: AUC {others[0][1].auc:.3f} and more'
        _draw_roc(axes, roc, '0.72', 0.9, label if index == 0 else None)
    for name, roc in named:
        _draw_roc(axes, roc, None, 1.3, f'{name}: AUC {roc.auc:.3f}')
    _draw_roc(axes, all_roc, 'black', 2.4, f'{all_name}: AUC {all_roc.auc:.3f}')


def _draw_roc(axes: Axes, roc: Roc, colour: Optional[str], width: float,
              label: Optional[str]) -> None:
    axes.plot([point.false_positive_rate for point in roc.points],
              [point.true_positive_rate for point in roc.points],
              color=colour, linewidth=width, label=label and _plain(label))


def _draw_scores(axes: Axes, judged: Judged) -> None:
    shown, alarms = timeline(judged), judged.verdicts.alarms
    limit = shown.limit
    of_evidence = limit is not None and limit < 0
    lowest = np.nan_to_num(shown.lowest)
    if of_evidence:
        lowest = np.maximum(lowest, -SHOWN_LIMITS)
    for label, colour, stretches in (
            ('settling: no alarm yet', '0.9', shown.settling),
            ('alarm', '#f6cfd0', [(judged.seconds(alarm.begin), judged.seconds(alarm.end))
                                  for alarm in alarms])):
        for index, (start, end) in enumerate(stretches):
            axes.axvspan(start, end, linewidth=0, color=colour,
                         label=label if index == 0 else None)
    axes.plot(shown.edges[:-1], lowest, color=_GREY, linewidth=0.7, label='lowest score')
    axes.plot(shown.edges[:-1][shown.abnormal], lowest[shown.abnormal], '.', color=_RED,
              markersize=3, label='abnormal window')
    if limit is not None:
        axes.axhline(limit, color=_RED, linestyle='--', linewidth=1.3,
                     label='limit' if of_evidence else f'threshold s* = {limit * shown.unit:.4g}')
    if limit is not None and of_evidence:
        axes.set_ylim(1.05 * min(1.5 * limit, float(lowest.min())), 0.05)
        axes.yaxis.set_major_formatter(lambda score, _: percent(abs(score)))
    title = (f'{judged.recording.part}: score of windows of '
             f'{judged.by.trained.window / SECOND_NS:g} s')
    axes.set(title=_plain(title), xlabel='time from the first message [s]',
             ylabel='of the limit' if of_evidence else 'score' if limit is None else
             'score in units of the threshold')
    for alarm in alarms:
        axes.annotate(_plain(alarm.culprit), (judged.seconds(alarm.begin), 1), xytext=(3, -3),
                      xycoords=('data', 'axes fraction'), textcoords='offset points', color=_RED,
                      fontsize='small', va='top', clip_on=True)
    axes.grid(alpha=0.3)
    axes.legend(loc='upper left', bbox_to_anchor=(1.0, 1.0), frameon=False)


def _save(path: str, figure: Figure) -> None:
    with replacing(path) as temporary:
        figure.savefig(temporary, format=path.lower().rpartition('.')[2])


def _plain(text: str) -> str:
    """Return a text that matplotlib shows as it is: between two $ it expects a formula."""
    return text.replace('$', r'\$')
