"""Figures of the report, as plotly.js takes them: plain values, without any logic of the method.

Colours of text, grid and the bottom of the heat map follow the page's theme (page.js).
"""
from __future__ import annotations

import html
import math
from typing import Any, Dict, List, Optional, Sequence, Tuple

import numpy as np

from self_awareness.reporting.report.incidents import Incident
from self_awareness.reporting.report.intervals import ALARM, Interval
from self_awareness.reporting.report.timeline import SHOWN_LIMITS, Lanes, Timeline
from self_awareness.reporting.text import delay, percent

Figure = Dict[str, Any]  # traces and layout of a plot (`data`, `layout`)

Bins = List[Tuple[float, float]]
"""Begin [s] of each bin of delays, and the share of the delays in it [%]."""

RED, AMBER, BLUE, GREY = '#e5484d', '#e08a00', '#4a8fdd', '#8b93a1'
_LANE_PX = 18
_HEIGHTS_PX = {'strip': 26, 'score': 190, 'gap': 26, 'bottom': 52}
_MOST_LABEL = 26


def over_time(timeline: Timeline, incidents: Sequence[Incident]) -> Figure:
    """Return alarms, score and lanes over the whole recording, one above the other."""
    lanes = timeline.lanes if timeline.lanes is not None and timeline.lanes.names else None
    heights = [_HEIGHTS_PX['strip'], _HEIGHTS_PX['score']]
    if lanes is not None:
        heights.append(_LANE_PX * len(lanes.names))
    total = sum(heights) + _HEIGHTS_PX['gap'] * (len(heights) - 1)
    domains, top = [], float(total)
    for height in heights:
        domains.append([max(top - height, 0.0) / total, top / total])
        top -= height + _HEIGHTS_PX['gap']
    stretches = [(incident.key, each) for incident in incidents for each in incident.intervals]
    traces = [_strip(stretches), *_score(timeline)]
    layout: Figure = {
        'height': total + _HEIGHTS_PX['bottom'] + 10,
        'margin': {'l': 10, 'r': 12, 't': 10, 'b': _HEIGHTS_PX['bottom']},
        'showlegend': False, 'hovermode': 'closest', 'dragmode': 'zoom',
        'xaxis': {'title': {'text': 'time from the first message [s]'}, 'anchor': 'free',
                  'position': 0, 'zeroline': False,
                  'range': [float(timeline.edges[0]), float(timeline.edges[-1])]},
        'yaxis': {'domain': domains[0], 'visible': False, 'range': [0, 1], 'fixedrange': True},
        'yaxis2': {**_score_axis(timeline), 'domain': domains[1], 'fixedrange': True,
                   'automargin': True},
        'shapes': _shapes(timeline, [each for _, each in stretches]),
    }
    if lanes is not None:
        traces.append(_heat(timeline, lanes))
        layout['yaxis3'] = {
            'domain': domains[2], 'autorange': 'reversed', 'fixedrange': True, 'showgrid': False,
            'type': 'category', 'tickvals': [escape(name) for name in lanes.names],
            'ticktext': [_shortened(name) for name in lanes.names], 'automargin': True}
    return {'data': traces, 'layout': layout}


def histogram(edges: Sequence[float], counts: Sequence[int], seen: Optional[float],
              seen_text: str, usual: Optional[Tuple[float, float]]) -> Figure:
    """Return delays in training, with what was seen marked in them.

    Args:
        edges: of the bins [s]; one more than bins. The last bin may have no end: it is drawn to
            twice its beginning.
        counts: by bin.
        seen: delay that was seen [s]; None: there is no single one.
        seen_text: what to write beside it.
        usual: range of most delays in training [s]; None: not known.
    """
    # Log bins of one width: a count stands for its bin, not for its seconds.
    drawn = [max(edge, edges[1] / 2 if edge <= 0 else edge) for edge in edges]
    total = sum(counts)
    low, high = drawn[0], drawn[-1]
    shapes = [] if usual is None else [_band(usual[0], usual[1], BLUE, 0.13)]
    if seen is not None and seen > 0:
        shapes.append({'type': 'line', 'xref': 'x', 'yref': 'paper', 'x0': seen, 'x1': seen,
                       'y0': 0, 'y1': 1, 'line': {'color': RED, 'width': 3}})
        low, high = min(low, seen / 1.3), max(high, seen * 1.3)
    axis: Figure = {'title': {'text': 'delay [s]'}, 'zeroline': False, 'range': [low, high]}
    if drawn[-1] > 3 * drawn[0]:
        axis.update({'type': 'log', 'range': [math.log10(low), math.log10(high)]})
    return {'data': [{
        'type': 'bar', 'x': _rounded(drawn[:-1]), 'width': _rounded(np.diff(drawn)), 'offset': 0,
        'y': [100.0 * count / total for count in counts],
        'marker': {'color': BLUE}, 'hoverinfo': 'text',
        'hovertext': [f'{delay(begin)} to {delay(end)}: {count} of {total}'
                      for begin, end, count in zip(edges, edges[1:], counts)]}], 'layout': {
        'height': 210, 'margin': {'l': 46, 'r': 10, 't': 32, 'b': 44}, 'showlegend': False,
        'xaxis': axis, 'yaxis': {'title': {'text': '% in training'}, 'fixedrange': True},
        'bargap': 0, 'shapes': shapes, 'annotations': [
            {'xref': 'paper', 'yref': 'paper', 'x': 1, 'y': 1.16, 'showarrow': False,
             'text': f'<b>{seen_text}</b>', 'font': {'color': RED, 'size': 13},
             'xanchor': 'right'}]}}


def two_histograms(before: Bins, after: Bins) -> Figure:
    """Return the delays of two sides, one over the other: begin [s] and % of each bin."""
    filled = [begin for bins in (before, after) for begin, share in bins if share > 0]
    edges = [begin for begin, _ in before if min(filled) <= begin <= max(filled)]
    first = edges[0] or edges[min(1, len(edges) - 1)] / 2
    traces = []
    for name, colour, bins in (('before', GREY, before), ('after', RED, after)):
        shares = dict(bins)
        # The last edge holds the line up to the end of its bin.
        traces.append({
            'type': 'scatter', 'mode': 'lines', 'name': name, 'fill': 'tozeroy',
            'line': {'shape': 'hv', 'color': colour, 'width': 1.5},
            'x': _rounded([edge or first for edge in edges] + [edges[-1] * 1.19]),
            'y': _rounded([shares[edge] for edge in edges] + [shares[edges[-1]]], 3)})
    return {'data': traces, 'layout': {
        'height': 190, 'margin': {'l': 46, 'r': 10, 't': 10, 'b': 44}, 'showlegend': True,
        'legend': {'x': 1, 'xanchor': 'right', 'y': 1},
        'xaxis': {'type': 'log', 'title': {'text': 'delay [s]'}},
        'yaxis': {'title': {'text': '%'}, 'fixedrange': True}}}


def counts(times: Sequence[float], messages: Sequence[int], usual: Tuple[float, float],
           begin: float, end: float) -> Figure:
    """Return the messages by time, with what is usual as a band, and the alarm.

    Args:
        times: ends of the spans that are counted [s] from the recording's first message.
        messages: in the span that ends then.
        usual: range of most numbers in training.
        begin, end: of the alarm [s].
    """
    return {'data': [{
        'type': 'scatter', 'mode': 'lines', 'line': {'shape': 'hv', 'color': BLUE, 'width': 1.5},
        'x': _rounded(times, 3), 'y': messages,
        'hovertemplate': 'until %{x:.1f} s: %{y}<extra></extra>'}], 'layout': {
            'height': 210, 'margin': {'l': 46, 'r': 10, 't': 10, 'b': 44}, 'showlegend': False,
            'xaxis': {'title': {'text': 'time [s]'}, 'zeroline': False},
            'yaxis': {'title': {'text': 'messages'}, 'rangemode': 'tozero', 'fixedrange': True},
            'shapes': [{**_band(0, 1, BLUE, 0.13), 'xref': 'paper', 'yref': 'y', 'y0': usual[0],
                        'y1': usual[1]}, _band(begin, end, RED, 0.12)]}}


def _strip(stretches: Sequence[Tuple[str, Interval]]) -> Figure:
    """Return a bar for each alarm and suspicion, which can be clicked to see its incident."""
    intervals = [each for _, each in stretches]
    colours = [RED if each.level == ALARM else AMBER for each in intervals]
    return {
        'type': 'bar', 'orientation': 'h', 'y': [0.5] * len(intervals),
        'base': [round(each.start, 3) for each in intervals],
        'x': [round(each.end - each.start, 3) for each in intervals],
        'width': [0.9 if each.level == ALARM else 0.5 for each in intervals],
        'marker': {'color': colours, 'line': {'color': colours, 'width': 1.5}},
        'customdata': [key for key, _ in stretches], 'hoverinfo': 'text',
        'hovertext': [escape(f'{each.level} {each.start:.1f} to {each.end:.1f} s: '
                             + (each.of.culprit or each.of.kind)) for each in intervals]}


def _score(timeline: Timeline) -> List[Figure]:
    x = _rounded((timeline.edges[:-1] + timeline.edges[1:]) / 2, 3)
    low, high = _clipped(timeline, timeline.lowest), _clipped(timeline, timeline.highest)
    reached, words = timeline.lowest, 'lowest score %{customdata}'
    if timeline.limit is not None and timeline.limit < 0:
        reached, words = np.rint(100 * reached / timeline.limit), '%{customdata} % of the limit'
    abnormal = np.flatnonzero(timeline.abnormal)
    return [
        {'type': 'scatter', 'mode': 'lines', 'x': x, 'y': high, 'yaxis': 'y2',
         'line': {'color': GREY, 'width': 0}, 'hoverinfo': 'skip'},
        {'type': 'scatter', 'mode': 'lines', 'x': x, 'y': low, 'yaxis': 'y2',
         'line': {'color': GREY, 'width': 1}, 'fill': 'tonexty',
         'fillcolor': 'rgba(139,147,161,0.25)', 'customdata': _numbers(reached),
         'hovertemplate': f'%{{x:.1f}} s: {words}<extra></extra>'},
        {'type': 'scatter', 'mode': 'markers', 'x': [x[index] for index in abnormal],
         'y': [low[index] for index in abnormal], 'yaxis': 'y2',
         'marker': {'color': RED, 'size': 4}, 'hoverinfo': 'skip'}]


def _score_axis(timeline: Timeline) -> Figure:
    if timeline.limit is None:
        return {'title': {'text': 'score'}, 'zeroline': False}
    if timeline.limit < 0:
        low = max(-SHOWN_LIMITS, float(np.nanmin(np.append(timeline.lowest, timeline.limit))))
        ticks = list(range(-int(SHOWN_LIMITS), 0))
        return {'title': {'text': 'of the limit'}, 'zeroline': False,
                'range': [min(low, -1.5) * 1.05, timeline.limit + 0.1],
                'tickvals': ticks, 'ticktext': [percent(-each) for each in ticks]}
    return {'title': {'text': 'score [thresholds]'}, 'zeroline': False, 'rangemode': 'tozero'}


def _shapes(timeline: Timeline, intervals: Sequence[Interval]) -> List[Figure]:
    shapes = [_band(start, end, GREY, 0.16) for start, end in timeline.settling]
    shapes += [_band(each.start, each.end, RED, 0.12) for each in intervals
               if each.level == ALARM]
    if timeline.limit is not None:
        shapes.append({'type': 'line', 'xref': 'paper', 'yref': 'y2', 'x0': 0, 'x1': 1,
                       'y0': timeline.limit, 'y1': timeline.limit,
                       'line': {'color': RED, 'width': 1.3, 'dash': 'dash'}})
    return shapes


def _band(start: float, end: float, colour: str, opacity: float) -> Figure:
    return {'type': 'rect', 'xref': 'x', 'yref': 'paper', 'x0': start, 'x1': end, 'y0': 0,
            'y1': 1, 'fillcolor': colour, 'opacity': opacity, 'line': {'width': 0},
            'layer': 'below'}


def _heat(timeline: Timeline, lanes: Lanes) -> Figure:
    percent = np.rint(100 * lanes.shares).astype(int)
    return {
        'type': 'heatmap', 'meta': 'evidence', 'yaxis': 'y3', 'x': _rounded(timeline.edges, 3),
        'y': [escape(name) for name in lanes.names], 'z': percent.tolist(), 'zmin': 0,
        'zmax': 200, 'showscale': False, 'ygap': 1, 'zsmooth': False,
        'hovertemplate': '%{y}: %{z} % of its limit<extra></extra>'}


def _clipped(timeline: Timeline, scores: np.ndarray) -> List[Optional[float]]:
    if timeline.limit is not None and timeline.limit < 0:
        # The evidence of a topic that comes every few seconds grows to nearly its limit again and
        # again: of normal operation, that drew walls.
        scores = np.clip(scores, -SHOWN_LIMITS, timeline.limit)
    return _numbers(scores)


def _numbers(values: np.ndarray) -> List[Optional[float]]:
    """Return values as JSON knows them: None for NaN."""
    return [None if math.isnan(value) else float(f'{value:.4g}') for value in values.tolist()]


def _rounded(values: Sequence[float], digits: int = 6) -> List[float]:
    return [round(float(value), digits) for value in values]


def _shortened(name: str) -> str:
    """Return at most _MOST_LABEL characters of a name; its end tells more than its beginning."""
    return escape(name if len(name) <= _MOST_LABEL else '…' + name[1 - _MOST_LABEL:])


def escape(text: str) -> str:
    """Return a text that plotly shows as it is: it takes tags for formatting."""
    return html.escape(text, quote=False)
