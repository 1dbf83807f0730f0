"""The plots of the evaluation: Figure 2 of the paper redrawn, false alarms and latencies."""
from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Dict, List, Sequence

import numpy as np

from self_awareness.output_files import replacing
from self_awareness_evaluation.simulated import summary
from self_awareness_evaluation.simulated.experiment import Trace
from self_awareness_evaluation.simulated.measures import Row
from self_awareness_evaluation.simulated.tradeoff import TradeOff

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_DPI = 120
_COLOURS = 10  # of matplotlib's cycle; who comes after them has a dashed line
_AROUND_S = 1.0  # the paper shows two seconds around the onset

_LATENCIES_S = np.geomspace(0.1, 50.0, 200)


def save_figure2(path: str, traces: Sequence[Trace]) -> None:
    """Draw the scores around every fault's onset, and below over the whole record.

    Raises:
        OSError: the file cannot be written.
    """
    from matplotlib.figure import Figure

    columns = max(1, len(traces))
    figure = Figure(figsize=(4.2 * columns, 6.4), dpi=_DPI, constrained_layout=True)
    axes = figure.subplots(2, columns, squeeze=False, sharey=True)
    for column, trace in enumerate(traces):
        near = np.abs(trace.times) <= _AROUND_S
        _draw_trace(axes[0, column], trace, trace.times[near], trace.scores[near])
        _draw_trace(axes[1, column], trace, trace.times, trace.scores)
        axes[0, column].set_title(trace.kind)
        axes[1, column].set_xlabel('time from the onset [s]')
    axes[0, 0].set_ylabel('score, 2 s around the onset')
    axes[1, 0].set_ylabel('score, whole record')
    axes[0, 0].legend(loc='lower left')
    with replacing(path) as temporary:
        figure.savefig(temporary, format='png')


def save_overview(path: str, rows: Dict[str, List[Row]],
                  trade_offs: Dict[str, List[TradeOff]]) -> None:
    """Draw false alarms against latency by threshold, and how fast crashes are found.

    Args:
        path: to write.
        rows: by system.
        trade_offs: by system; may be empty.

    Raises:
        OSError: the file cannot be written.
    """
    drawn = overview(rows, trade_offs)
    with replacing(path) as temporary:
        drawn.savefig(temporary, format='png')


def overview(rows: Dict[str, List[Row]], trade_offs: Dict[str, List[TradeOff]]) -> Figure:
    """Return the figure of save_overview().

    The first system is drawn last, and wider: others have the same values now and then.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(14, 5.6), dpi=_DPI, constrained_layout=True)
    left, right = figure.subplots(1, 2)
    for index, name in enumerate(rows):
        style: Dict[str, Any] = {'color': f'C{index}', 'label': name, 'zorder': 10 - 0.1 * index,
                                 'linewidth': 1.3 if index else 3.0,
                                 'linestyle': '-' if index < _COLOURS else '--'}
        points = [point for point in summary.operating_points(trade_offs.get(name, []))
                  if math.isfinite(point.latency_s)]
        left.plot([point.latency_s for point in points],
                  [point.false_alarms_per_hour for point in points], marker='o',
                  markersize=4 if index else 7, **style)
        crashes = summary.of_fault(rows[name], 'crash')
        if crashes:
            right.plot(_LATENCIES_S, [100.0 * summary.found(crashes, limit)
                                      for limit in _LATENCIES_S], **style)
    left.set(title='cc1, thresholds from lax to strict', xlabel='median latency [s]', xscale='log',
             ylabel='false alarms an hour', xlim=(_LATENCIES_S[0], _LATENCIES_S[-1]))
    left.set_yscale('symlog', linthresh=1.0)
    left.set_ylim(bottom=-0.1)
    right.set(title='every regular component crashed in turn', xlabel='time from the crash [s]',
              xscale='log', ylabel='found [%]', ylim=(-2.0, 102.0))
    for axes in (left, right):
        axes.grid(alpha=0.3)
    left.legend()
    return figure


def _draw_trace(axes: Axes, trace: Trace, times: np.ndarray, scores: np.ndarray) -> None:
    axes.plot(times, scores, color='tab:red', linewidth=1.0, label='score of a window')
    axes.axhline(trace.threshold, color='tab:blue', linewidth=1.3,
                 label=f'threshold s* = {trace.threshold:.3g}')
    axes.axvline(0.0, color='black', linewidth=1.0, label='onset')
    axes.grid(alpha=0.3)
    axes.margins(x=0.0)
