"""What is in a model: as plain values for JSON, and in words, as `--details` prints it."""
from __future__ import annotations

import math
from collections import Counter
from typing import Any, Dict, List, Mapping, Optional, Sequence, Tuple

from self_awareness import (USUAL_SHARES, Calibration, EvidenceModel, PaperCalibration,
                            Recording, TrainedModel, Tuning, encoding_file)
from self_awareness.judging import EVIDENCE, PAPER
from self_awareness.reporting import coverage_text
from self_awareness.reporting.file_summary import describe_version, summarise_version
from self_awareness.reporting.text import duration, or_dash, rounded, seconds_of
from self_awareness.stamps import SECOND_NS, moment

_RELATIONS = ('pairs', 'deadlines')  # the channels that look at two event types
_LIMITS_OF = {'held-out': 'of recordings that were not trained on',
              'cross-fit': 'preliminary, of the training alone'}


def summarise(model: TrainedModel) -> Dict[str, Any]:
    """Return all of a model but its counts.

    Times are in seconds and rates in Hz, unless a key says otherwise. What is missing, or not a
    number, is None.
    """
    seconds = seconds_of(model.recordings)
    evidence = None if model.detectors == PAPER else EvidenceModel(model)
    types = [_event_type(model, evidence, index, seconds)
             for index in range(len(model.event_types))]
    rates = [entry['rate'] for entry in types if entry['rate'] is not None]
    return {
        'version': summarise_version(model.version),
        'trained_ns': model.stamp,
        'detectors': model.detectors,
        'window': model.window / SECOND_NS,
        'bin_size': model.bin_size / SECOND_NS,
        'horizon': (model.horizon_bins * model.bin_size / SECOND_NS if model.horizon_bins
                    else None),
        'encoding': encoding_file.values(model.encoding),
        'recordings': list(map(_recording, model.recordings)),
        'duration': seconds,
        'events': model.events,
        'lowest_rate': min(rates, default=None),
        'highest_rate': max(rates, default=None),
        'sources': sorted({kind.source for kind in model.event_types} - {''}),
        'fewest_gaps': model.fewest_gaps,
        'event_types': types,
        'pairs': model.pairs,
        'graph': [dict(zip(('publisher', 'topic', 'subscriber'), edge))
                  for edge in sorted(model.graph)],
        'hosts': model.hosts,
        'subscriptions': [dict(zip(('node', 'topic'), each))
                          for each in sorted(model.subscriptions)],
        'evidence': None if evidence is None else _evidence(model, evidence),
        'calibration': (None if model.paper_calibration is None
                        else _paper_calibration(model.paper_calibration)),
    }


def tuning_lines(tuning: Tuning) -> List[str]:
    """Return a line for each number: name, value, unit, range, and what it means.

    A number that is not the default is marked, with the default.
    """
    text = []
    for number in Tuning.numbers():
        value = tuning.get(number.name)
        changed = '' if value == number.default else f' (default: {number.default:g})'
        unit = f' {number.unit}' if number.unit else ''
        span = f'{number.least:g} to {number.most:g}'
        text.append(f'{number.name:<26} {f"{value:g}{unit}":<18} {span:<16} '
                    f'{number.meaning}{changed}')
    for channel in tuning.without:
        text.append(f'without the channel {channel}')
    return text


def _evidence(model: TrainedModel, evidence: EvidenceModel) -> Dict[str, Any]:
    """Return what the evidence detector watches; tracks are counted by channel."""
    tracks = evidence.tracks
    summary: Dict[str, Any] = {
        'tracks': dict(Counter(track.channel for track in tracks)),
        'not_judged': [str(kind) for index, kind in enumerate(model.event_types)
                       if model.gaps(index) < model.fewest_gaps and kind.is_message],
        'tuning': {number.name: model.tuning.get(number.name) for number in Tuning.numbers()},
        'without': model.tuning.without,
        'unheard': coverage_text.unheard(model.unheard),
        **coverage_text.of_some_robots(model),
        'left_out': sorted(model.left_out),
        'calibration': None,
    }
    if model.calibration is not None:
        judged = [track for track, limit in zip(tracks, model.calibration.limits)
                  if not math.isnan(limit)]
        summary['calibration'] = _calibration(model.calibration)
        summary['calibration']['judged_tracks'] = dict(Counter(each.channel for each in judged))
        summary['calibration']['relations'] = _relations(model, evidence, model.calibration)
        summary['calibration']['coverage'] = coverage_text.summarise(model.coverage())
    return summary


def _relations(model: TrainedModel, evidence: EvidenceModel,
               calibration: Calibration) -> List[Dict[str, Any]]:
    """Return what speaks for each relation that might be watched.

    The own history of an event type is no relation.
    """
    found: List[Dict[str, Any]] = []
    for track, limit, relation in zip(evidence.tracks, calibration.limits, calibration.relations):
        if track.channel not in _RELATIONS or track.from_id == track.to_id:
            continue
        found.append({
            'channel': track.channel,
            'from': str(model.event_types[track.from_id]),
            'to': str(model.event_types[track.to_id]),
            'judged': not math.isnan(limit),
            'watched': relation.watched,
            'reaches': relation.reaches,
            'irregular': relation.irregular,
            'chance': relation.spread ** max(relation.starts - 1, 0),
            'starts': relation.starts,
            'starts_needed': relation.starts_needed,
            'graph': bool(model.graph),
        })
    return found


def _event_type(model: TrainedModel, evidence: Optional[EvidenceModel], index: int,
                seconds: float) -> Dict[str, Any]:
    kind = model.event_types[index]
    count = model.event_count(index)
    gaps = model.gaps(index)
    shortest, longest = _usual_gap(model, evidence, index) if gaps else (None, None)
    return {
        'source': kind.source,
        'scope': kind.scope,
        'type': kind.type,
        'count': count,
        'rate': count / seconds if seconds > 0 else None,
        'gaps': gaps,
        'judged': gaps >= model.fewest_gaps,
        'usual_shortest': shortest,
        'usual_longest': longest,
    }


def _usual_gap(model: TrainedModel, evidence: Optional[EvidenceModel],
               index: int) -> Tuple[float, float]:
    """Return the usual shortest and longest gap [s]; by the paper's finer bins, if there are."""
    if evidence is not None and model.detectors == EVIDENCE:
        shortest, longest = (evidence.usual_delay(index, index, share) for share in USUAL_SHARES)
        return shortest, longest
    first, last = (model.quantile(index, index, share) for share in USUAL_SHARES)
    return first * model.bin_size / SECOND_NS, (last + 1) * model.bin_size / SECOND_NS


def _recording(recording: Recording) -> Dict[str, Any]:
    return {
        'bag': recording.bag,
        'start_ns': recording.start,
        'end_ns': recording.end,
        'duration': seconds_of([recording]),
        'robot': recording.robot or None,
        'events': recording.events,
        # As text: a JSON reader that knows only floats would round it.
        'fingerprint': f'{recording.fingerprint:016x}',
    }


def _paper_calibration(calibration: PaperCalibration) -> Dict[str, Any]:
    return {
        'calibrated_ns': calibration.stamp,
        'threshold': calibration.threshold,
        'method': calibration.method,
        'auc': _number(calibration.auc),
        'true_positive_rate': _number(calibration.true_positive_rate),
        'false_positive_rate': _number(calibration.false_positive_rate),
        'normal_windows': calibration.normal_windows,
        'faulty_windows': calibration.faulty_windows,
        'false_alarms_per_hour': _number(calibration.false_alarms_per_hour),
        'normal': list(map(_recording, calibration.normal)),
        'faulty': list(map(_recording, calibration.faulty)),
        'injected': list(calibration.injected),
    }


def _calibration(calibration: Calibration) -> Dict[str, Any]:
    return {
        'calibrated_ns': calibration.stamp,
        'method': calibration.method,
        'budget': calibration.budget,
        'windows': calibration.windows,
        'false_alarms_per_hour': _number(calibration.false_alarms_per_hour),
        'normal': list(map(_recording, calibration.recordings)),
    }


def _number(value: float) -> Optional[float]:
    return value if math.isfinite(value) else None


def lines(summary: Mapping[str, Any]) -> List[str]:
    """Return a model in words; summary: as summarise() returned it."""
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
        *(f'  {_type_line(kind, summary["fewest_gaps"])}' for kind in summary['event_types']),
        f'pairs        {summary["pairs"]} of {len(summary["event_types"]) ** 2} with delays',
        f'graph        {graph(summary)}']
    if summary['evidence'] is not None:
        text += _evidence_lines(summary['evidence'], summary['fewest_gaps'])
    if summary['detectors'] != EVIDENCE:
        text += _threshold_lines(summary['calibration'])
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


def _type_line(kind: Mapping[str, Any], fewest_gaps: int) -> str:
    usual = f'{kind["usual_shortest"]:.3f} - {kind["usual_longest"]:.3f}' if kind['gaps'] else '-'
    rare = '' if kind['judged'] else f'  (too rare to judge: fewer than {fewest_gaps} gaps)'
    return (f'{kind["count"]:8d} {or_dash(kind["rate"]):>10}  {usual:<16} '
            f'{kind["source"] or "-"} {kind["scope"]} {kind["type"]}{rare}')


def _evidence_lines(evidence: Mapping[str, Any], fewest_gaps: int) -> List[str]:
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


def _threshold_lines(calibration: Optional[Mapping[str, Any]]) -> List[str]:
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
