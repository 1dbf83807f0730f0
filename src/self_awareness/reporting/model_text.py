"""All that is in a model but its counts, in words: what `--details` prints."""
from __future__ import annotations

from collections import Counter
from typing import Any, Dict, List, Mapping, Optional, Sequence

from self_awareness.judging import EVIDENCE
from self_awareness.reporting import coverage_text
from self_awareness.reporting.file_summary import describe_version
from self_awareness.reporting.text import duration, or_dash, rounded
from self_awareness.stamps import moment

_LIMITS_OF = {'held-out': 'of recordings that were not trained on',
              'cross-fit': 'preliminary, of the training alone'}


def lines(summary: Mapping[str, Any]) -> List[str]:
    """Return a model in words.

    Args:
        summary: as model_summary.summarise() returned it.
    """
    horizon = summary['horizon']
    sources = summary['sources']
    text = [
        f'trained      {moment(summary["trained_ns"])}',
        f'written by   {describe_version(summary["version"])}',
        f'detector     {summary["detectors"]}',
        f'recordings   {len(summary["recordings"])}, {duration(summary["duration"])}',
        *_recordings(summary['recordings']),
        f'window       {summary["window"]:g} s',
        f'bin size     {summary["bin_size"]:g} s, '
        + ('no horizon' if horizon is None else f'horizon {horizon:g} s'),
        *encoding(summary['encoding']),
        f'sources      {len(sources) if sources else "not told apart"}',
        *(f'  {source}' for source in sources),
        f'events       {summary["events"]}',
        f'event types  {len(summary["event_types"])}{_rates(summary)}',
        '     count  rate [Hz]  usual delay [s]',
        *(f'  {_event_type(kind, summary["fewest_gaps"])}' for kind in summary['event_types']),
        f'pairs        {summary["pairs"]} of {len(summary["event_types"]) ** 2} with delays',
        f'graph        {graph(summary)}']
    if summary['evidence'] is not None:
        text += _evidence(summary['evidence'], summary['fewest_gaps'])
    if summary['detectors'] != EVIDENCE:
        text += _calibration(summary['calibration'])
    return text


def encoding(rules: Mapping[str, Any]) -> List[str]:
    """Return how messages become events, as encoding_file.values() has it, in words."""
    text = ['encoding']
    for key, value in rules.items():
        if key == 'rename':
            value = [f'{pattern} to {name}' for pattern, name in value]
        if isinstance(value, dict):
            value = [f'{datatype}: {field}' for datatype, field in value.items()]
        text.append(f'  {key:<16}{", ".join(value) if isinstance(value, list) else value}'
                    .rstrip())
    return text


def graph(summary: Mapping[str, Any]) -> str:
    """Return who subscribes to what, of a model or an event log, in words."""
    edges = summary['graph']
    if not edges:
        return ('none: roots are told from victims by the training alone (record.launch writes '
                'it down, or train --graph)')
    publishers = {edge['publisher'] for edge in edges}
    silent = sorted({edge['subscriber'] for edge in edges}
                    - {kind['source'] for kind in summary['event_types']})
    nodes = Counter(summary['hosts'].values())
    del nodes['']  # who runs on several
    hosts = ', '.join(f'{host} ({number})' for host, number in sorted(nodes.items()))
    return (f'sources that somebody listens to: {len(publishers)}, connections: {len(edges)}'
            + (f'; hosts and their nodes: {hosts}' if hosts else '')
            + (f'; not watched, since they publish nothing: {", ".join(silent)}'
               if silent else ''))


def recording(summary: Mapping[str, Any]) -> str:
    """Return a recording of a model or an event log in words."""
    return (f'{summary["bag"]}: {summary["duration"]:.1f} s, {summary["events"]} events, '
            f'from {moment(summary["start_ns"])}'
            + ('' if summary['robot'] is None else f', of {summary["robot"]}'))


def _recordings(recordings: Sequence[Mapping[str, Any]]) -> List[str]:
    return [f'    {recording(each)}' for each in recordings]


def _rates(summary: Mapping[str, Any]) -> str:
    if summary['lowest_rate'] is None:
        return ''
    return (f', {rounded(summary["lowest_rate"], 3)} to '
            f'{rounded(summary["highest_rate"], 3)} Hz')


def _event_type(kind: Mapping[str, Any], fewest_gaps: int) -> str:
    usual = f'{kind["usual_shortest"]:.3f} - {kind["usual_longest"]:.3f}' if kind['gaps'] else '-'
    rare = '' if kind['judged'] else f'  (too rare to judge: fewer than {fewest_gaps} gaps)'
    return (f'{kind["count"]:8d} {or_dash(kind["rate"]):>10}  {usual:<16} '
            f'{kind["source"] or "-"} {kind["scope"]} {kind["type"]}{rare}')


def _evidence(evidence: Mapping[str, Any], fewest_gaps: int) -> List[str]:
    text = [f'evidence     watches: {_counts(evidence["tracks"])}']
    if evidence['not_judged']:
        text.append(f'  not judged: {"; ".join(evidence["not_judged"])}')
    if evidence['left_out']:
        text.append(f'  left out: {", ".join(evidence["left_out"])}: this version does not judge '
                    'them')
    text += [f'  {line}' for line in [*coverage_text.unheard_lines(evidence['unheard']),
                                      *coverage_text.optional_lines(evidence)]]
    calibration = evidence['calibration']
    if calibration is None:
        return [*text, 'limits       not calibrated (rosrun self_awareness calibrate)']
    return [
        *text,
        f'limits       {_LIMITS_OF.get(calibration["method"], calibration["method"])}, for '
        f'{calibration["budget"]:g} false alarms an hour, calibrated '
        f'{moment(calibration["calibrated_ns"])}',
        f'  of {_counts(calibration["judged_tracks"])}',
        f'  {calibration["windows"]} windows; at most '
        f'{_or_none(calibration["false_alarms_per_hour"])} false alarms an hour (95 %)',
        '  normal recordings', *_recordings(calibration['normal']),
        *(f'  {line}' for line in coverage_text.lines(calibration['coverage'], fewest_gaps))]


def _counts(tracks: Dict[str, int]) -> str:
    """Return numbers of tracks by channel, as text."""
    return ', '.join(f'{channel} {count}' for channel, count in tracks.items() if count) or 'none'


def _calibration(calibration: Optional[Mapping[str, Any]]) -> List[str]:
    if calibration is None:
        return ['threshold    not calibrated (rosrun self_awareness calibrate --detector paper)']
    text = [f'threshold    {calibration["threshold"]!r} ({calibration["method"]}), calibrated '
            f'{moment(calibration["calibrated_ns"])}',
            f'  AUC {_or_none(calibration["auc"])}, TPR '
            f'{_or_none(calibration["true_positive_rate"])} of {calibration["faulty_windows"]} '
            f'abnormal windows, FPR {_or_none(calibration["false_positive_rate"])} of '
            f'{calibration["normal_windows"]} normal windows',
            f'  false alarms {_or_none(calibration["false_alarms_per_hour"])} an hour, after '
            'persistence',
            '  normal recordings', *_recordings(calibration['normal'])]
    if calibration['faulty']:
        text += ['  faulty recordings', *_recordings(calibration['faulty'])]
    if calibration['injected']:
        text.append(f'  injected {", ".join(calibration["injected"])}')
    return text


def _or_none(value: Optional[float]) -> str:
    return 'none' if value is None else f'{value:.4g}'
