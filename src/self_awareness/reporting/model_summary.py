"""What is in a model, as plain values: for reading, and for JSON."""
from __future__ import annotations

import math
from collections import Counter
from typing import Any, Dict, List, Optional, Tuple

from self_awareness import (USUAL_SHARES, Calibration, EvidenceModel, PaperCalibration,
                            Recording, TrainedModel, Tuning, encoding_file)
from self_awareness.judging import EVIDENCE, PAPER
from self_awareness.reporting import coverage_text
from self_awareness.reporting.file_summary import summarise_version
from self_awareness.reporting.text import seconds_of
from self_awareness.stamps import SECOND_NS

_RELATIONS = ('pairs', 'deadlines')  # the channels that look at two event types


def summarise(model: TrainedModel) -> Dict[str, Any]:
    """Return all of a model but its counts.

    Times are in seconds and rates in Hz, unless a key says otherwise. What is missing, or not a
    number, is None.
    """
    duration = seconds_of(model.recordings)
    evidence = None if model.detectors == PAPER else EvidenceModel(model)
    types = [_event_type(model, evidence, index, duration)
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
        'duration': duration,
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
                duration: float) -> Dict[str, Any]:
    kind = model.event_types[index]
    count = model.event_count(index)
    gaps = model.gaps(index)
    shortest, longest = _usual_gap(model, evidence, index) if gaps else (None, None)
    return {
        'source': kind.source,
        'scope': kind.scope,
        'type': kind.type,
        'count': count,
        'rate': count / duration if duration > 0 else None,
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
