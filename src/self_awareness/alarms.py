"""Alarms as plain values: dictionaries, tables and JSON, for programs that do not want objects."""
from __future__ import annotations

import math
from typing import Any, Dict, Iterable, List, Optional, Sequence

from self_awareness import Alarm, EventType, Suspect, Verdicts
from self_awareness.stamps import SECOND_NS


def in_order(verdicts: Verdicts) -> List[Alarm]:
    """Return alarms and suspicions in the order of their begin."""
    return sorted([*verdicts.alarms, *verdicts.suspicions], key=lambda alarm: alarm.begin)


def as_values(alarm: Alarm, event_types: Sequence[EventType], origin: int) -> Dict[str, Any]:
    """Return all that an alarm says.

    Args:
        alarm: an alarm or a suspicion.
        event_types: of its recording, by id.
        origin: stamp of the recording's first message [ns]: keys that end in _s count from it.

    Returns:
        Strings, numbers, and None where something is not known.
    """
    def suspects(named: Iterable[Suspect]) -> List[Dict[str, Any]]:
        return [_suspect(suspect, str(event_types[suspect.id]), origin) for suspect in named]

    return {
        'id': alarm.id,
        'level': alarm.level,
        'kind': alarm.kind,
        'culprit': alarm.culprit or None,
        'reason': alarm.reason or None,
        'begin_s': _seconds(alarm.begin, origin),
        'end_s': _seconds(alarm.end, origin),
        'begin_ns': alarm.begin,
        'end_ns': alarm.end,
        'over': alarm.over,
        'evidence': alarm.evidence,
        'lowest_score': _known(alarm.lowest_score),
        'busy': alarm.busy,
        'silent': None if alarm.silent is None else {
            'hosts': alarm.silent.hosts, 'components': alarm.silent.components,
            'others_go_on': alarm.silent.others_go_on,
            'since_s': _seconds(alarm.silent.since, origin)},
        'suspects': suspects(alarm.suspects),
        'later': suspects(alarm.later),
    }


def _suspect(suspect: Suspect, event_type: str, origin: int) -> Dict[str, Any]:
    reason = suspect.reason
    return {
        'component': suspect.component or None,
        'event_type': event_type,
        'onset_s': _seconds(suspect.onset, origin) if suspect.onset else None,
        'since_s': _seconds(suspect.since, origin),
        'kind': reason.kind,
        'after': reason.after or None,
        'unit': reason.unit,
        'value': _known(reason.value),
        'usual': _known(reason.usual),
        'usual_shortest': _known(reason.usual_shortest),
        'usual_longest': _known(reason.usual_longest),
        'lasted_s': _known(reason.lasted),
        'reason': reason.words,
    }


def _seconds(stamp: int, origin: int) -> float:
    return (stamp - origin) / SECOND_NS


def _known(value: float) -> Optional[float]:
    return None if math.isnan(value) else value
