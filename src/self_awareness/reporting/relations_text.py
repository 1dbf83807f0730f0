"""Says why relations between event types are watched, or what is missing (docs/method.md)."""
from __future__ import annotations

import math
from typing import Any, Dict, List

from self_awareness import Coverage, EvidenceModel, TrainedModel
from self_awareness.reporting.text import first_lines

RELATIONS = ('pairs', 'deadlines')
"""The channels that look at two event types."""

_MOST_LINES = 10


def relations(model: TrainedModel, evidence: EvidenceModel) -> List[Dict[str, Any]]:
    """Return what speaks for each relation that might be watched; of a calibrated model.

    The own history of an event type is no relation.
    """
    calibration = model.calibration
    if calibration is None:
        return []
    found: List[Dict[str, Any]] = []
    for track, limit, relation in zip(evidence.tracks, calibration.limits, calibration.relations):
        if track.channel not in RELATIONS or track.from_id == track.to_id:
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


def reasons(relation: Dict[str, Any]) -> str:
    """Return in words why a relation is watched."""
    words = []
    if relation['reaches']:
        words.append('its messages get there')
    if relation['irregular']:
        words.append('it says more than its own rhythm')
    if relation['channel'] == 'pairs' and relation['starts'] > 1:
        words.append(f'chance {relation["chance"]:.1g} in {relation["starts"]} starts')
    return ', '.join(words)


def lines(found: List[Dict[str, Any]]) -> List[str]:
    """Return lines for people: what is watched and why, and what more starts would add."""
    watched = [f'{relation["channel"]}: {relation["from"]} -> {relation["to"]}: '
               f'{reasons(relation)}' for relation in found if relation['judged']]
    return first_lines(watched, _MOST_LINES, ' (info --json lists all)') + to_record(found)


def to_record(found: List[Dict[str, Any]]) -> List[str]:
    """Return lines for people: what more starts of the robot would add."""
    text = []
    waiting = [relation for relation in found if not relation['watched']
               and relation['starts'] < relation['starts_needed'] <= Coverage.MOST_STARTS]
    if found and max(relation['starts'] for relation in found) == 1:
        text.append('all recordings count as one start of the robot: record event logs, which say '
                    'when it was started, or leave a minute or more between bags of different '
                    'starts')
    if waiting:
        fewest = min(waiting, key=lambda each: each['starts_needed'] - each['starts'])
        more = fewest['starts_needed'] - fewest['starts']
        late = list(dict.fromkeys(each['to'] for each in waiting))
        others = f' and {len(late) - 1} others' if len(late) > 1 else ''
        text.append(f'record after {more} more start{"s" if more > 1 else ""} of the robot to '
                    f'watch late answers of {fewest["to"]}{others}: there were too few starts to '
                    'tell an answer from chance'
                    + ('' if fewest['graph'] else '; fewer are enough if you train with --graph'))
    return text
