"""The incidents that a monitor has kept: as lines, and as plain values."""
from __future__ import annotations

import os
import shlex
from typing import Any, Dict, List, Sequence

from self_awareness import KeptIncident
from self_awareness.recovery import words
from self_awareness.recovery.history import Action
from self_awareness.reporting.text import aligned, duration, first_of
from self_awareness.stamps import SECOND_NS, moment, to_the_second

_MOST_NAMED = 3


def table(incidents: Sequence[KeptIncident], actions: Sequence[Action]) -> List[str]:
    """Return a head, and a line for each incident; actions of the recovery may be about others."""
    head = ['opened', 'lasted', 'what', 'raised', 'near misses', 'named besides', 'id']
    rows = [head]
    for each in incidents:
        besides = [name for name in named(each) if name != each.component]
        done = len(of_incident(each, actions))
        rows.append([to_the_second(each.opened), _lasted(each),
                     what(each) + (f' (recovery: {done})' if done else ''), str(each.alarms),
                     str(each.near_misses), first_of(besides, _MOST_NAMED), str(each.id)])
    return aligned(rows)


def details(incident: KeptIncident, actions: Sequence[Action]) -> List[str]:
    """Return all that is known of an incident, and how to see more; actions as in table()."""
    rows = [('what', incident.reason or what(incident)),
            ('opened', moment(incident.opened)),
            ('grown', moment(incident.grown)),
            ('unknown since' if incident.unknown else 'over' if incident.over else 'open',
             moment(incident.ended) if incident.over else f'at {moment(incident.ended)}'),
            ('raised', f'{incident.alarms} times, and {incident.near_misses} near misses')]
    rows += [(title, ', '.join(names)) for title, names in (
        ('failed with it' if incident.component else 'stopped', incident.together),
        ('victims', incident.victims), ('named besides', incident.others)) if names]
    rows += [('recovery', f'{to_the_second(each.begin)}, {words.what(each)}')
             for each in of_incident(incident, actions)]
    return [f'incident {incident.id}',
            *aligned([(f'  {title}', text) for title, text in [*rows, *_ways_on(incident)]])]


def as_values(incident: KeptIncident, actions: Sequence[Action]) -> Dict[str, Any]:
    """Return an incident as plain values, None where not known; actions as in table()."""
    return {
        'id': incident.id,
        'level': incident.level,
        'kind': incident.kind,
        'component': incident.component or None,
        'reason': incident.reason or None,
        'together': incident.together,
        'victims': incident.victims,
        'others': incident.others,
        'hosts': incident.hosts,
        'opened_ns': incident.opened,
        'grown_ns': incident.grown,
        'ended_ns': incident.ended,
        'over': incident.over,
        'unknown': incident.unknown,
        'alarms': incident.alarms,
        'near_misses': incident.near_misses,
        'recording': incident.recording or None,
        'model': incident.model or None,
        'actions': [each.told() for each in of_incident(incident, actions)],
    }


def of_incident(incident: KeptIncident, actions: Sequence[Action]) -> List[Action]:
    """Return the actions about an incident."""
    return [each for each in actions if each.incident == incident.id]


def named(incident: KeptIncident) -> List[str]:
    """Return all components that an incident names, the one to blame first."""
    return [*filter(None, [incident.component]), *incident.together, *incident.victims,
            *incident.others]


def what(incident: KeptIncident) -> str:
    """Return what is wrong, and whose fault it is: '/player silent'."""
    return f'{incident.component} {incident.kind}' if incident.component else incident.kind


def _lasted(incident: KeptIncident) -> str:
    if not incident.over:
        return 'open'
    if incident.unknown:
        return f'unknown since {to_the_second(incident.ended)}'
    return duration((incident.ended - incident.opened) / SECOND_NS)


def _ways_on(incident: KeptIncident) -> List[Sequence[str]]:
    if not incident.recording:
        return [('events', 'none were recorded')]
    if not os.path.exists(incident.recording):
        return [('events', f'{incident.recording} (not there: it was not written yet, or made '
                 'room for newer ones)')]
    command = ('rosrun', 'self_awareness', 'score', incident.recording, '--model', incident.model,
               '--report', f'incident_{incident.id}.html')
    return [('events', incident.recording), ('its report', ' '.join(map(shlex.quote, command)))]
