"""Alarms and suspicions of a recording: when, whom they name, and why."""
from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Dict, List, Optional, Sequence

import numpy as np

from self_awareness import Alarm, Suspect
from self_awareness.reporting.report import delays
from self_awareness.reporting.report.delays import Histogram
from self_awareness.reporting.report.judged import Judged
from self_awareness.reporting.report.neighbours import Neighbourhood, neighbourhood
from self_awareness.reporting.report.timeline import Overview, strongest_track
from self_awareness.stamps import moment

ALARM, SUSPICION = 'alarm', 'suspicion'
"""The levels of an interval."""

MOST_DETAILS = 40
"""Alarms and suspicions with details, at most so many; those of alarms come first."""
MOST_LISTED = 400
"""Alarms and suspicions that are listed, at most so many; alarms come first."""

_SHORT = {'died': 'stopped sending', 'slow': 'sends too seldom', 'fast': 'sends too often',
          'late': 'paused for too long', 'out of order': 'sends at an irregular pace',
          'never came': 'was not heard', 'stranger': 'is new'}
_SHORT_OF_ANSWERS = {'died': 'does not answer', 'late': 'answers late', 'early': 'answers early',
                     'out of order': 'comes at unusual delays'}


@dataclass(frozen=True)
class NamedSuspect:
    """A suspect in words.

    Args:
        component: whose event type it is: a node, or a topic where nodes are not known.
        event_type: its name.
        short: what it does wrong, in a few words.
        why: the numbers, seen and usual.
        named: when it was named [s] from the recording's first message.
        back: when it was heard again after that [s]; None: it was not, or was not silent.
        histogram: of the delays that speak against it; None: it is not about a delay.
    """

    component: str
    event_type: str
    short: str
    why: str
    named: float
    back: Optional[float]
    histogram: Optional[Histogram]


@dataclass(frozen=True)
class Interval:
    """An alarm or a suspicion; times in seconds from the recording's first message.

    Args:
        key: unique in the page.
        level: ALARM or SUSPICION.
        start: of it.
        end: of it, or of the recording.
        moment: date and time of the start, with the time zone.
        cleared: False: it stood until the recording's end.
        began: when the trouble began, as far as the first suspect tells; None: it does not.
        lowest: score.
        evidence: channels that speak, in words.
        decided: which track was strongest when it was raised, in words; empty: not known.
        busy: that the machine had too much to do, in words; None: it had not.
        suspects: best first.
        later: suspects that were named later.
        graph: who publishes to whom near them; None: not known.
    """

    key: str
    level: str
    start: float
    end: float
    moment: str
    cleared: bool
    began: Optional[float]
    lowest: float
    evidence: str
    decided: str
    busy: Optional[str]
    suspects: List[NamedSuspect]
    later: List[NamedSuspect]
    graph: Optional[Neighbourhood]
    detailed: bool


def components(judged: Judged) -> List[str]:
    """Return the components that alarms and suspicions name, the most important ones first."""
    named: Dict[str, None] = {}
    for alarm in [*judged.verdicts.alarms, *judged.verdicts.suspicions]:
        for suspect in [*alarm.suspects, *alarm.later]:
            named[suspect.component] = None
    return list(named)


def intervals(judged: Judged, found: Overview, prefix: str) -> List[Interval]:
    """Return alarms and suspicions in the order of their start, at most MOST_LISTED.

    Args:
        prefix: of their keys.
    """
    verdicts = judged.verdicts
    ranked = [*verdicts.alarms, *verdicts.suspicions][:MOST_LISTED]
    made = [_interval(judged, found, f'{prefix}-{number}', alarm, number < MOST_DETAILS)
            for number, alarm in enumerate(ranked)]
    return sorted(made, key=lambda each: each.start)


def _interval(judged: Judged, found: Overview, key: str, alarm: Alarm,
              detailed: bool) -> Interval:
    suspects = [_named(judged, suspect, alarm.over, detailed) for suspect in alarm.suspects]
    later = [_named(judged, suspect, alarm.over, detailed) for suspect in alarm.later]
    start = judged.seconds(alarm.begin)
    first = alarm.suspects[0] if alarm.suspects else None
    return Interval(
        key, ALARM if alarm.level == 'ERROR' else SUSPICION, start, judged.seconds(alarm.end),
        moment(alarm.begin), alarm.over,
        None if first is None else _began(first, start), alarm.lowest_score,
        alarm.evidence or 'what is left of the alarm',
        _decided(judged, found, start - judged.by.trained.window / 2e9), alarm.busy, suspects,
        later, _graph(judged, [each.component for each in [*suspects, *later]], detailed),
        detailed)


def _named(judged: Judged, suspect: Suspect, over: bool, detailed: bool) -> NamedSuspect:
    silent = suspect.reason.kind == 'died' and over  # it has come back since
    return NamedSuspect(
        suspect.component, str(judged.recording.event_types[suspect.id]),
        'fell silent' if silent else _short(suspect), suspect.reason.words,
        judged.seconds(suspect.since), _back(judged, suspect) if silent else None,
        delays.histogram_of(judged, suspect) if detailed else None)


def _back(judged: Judged, suspect: Suspect) -> Optional[float]:
    """Return when a suspect was heard again after it was named [s]; None: it was not."""
    stamps, ids = judged.recording.stamps, judged.recording.ids
    first = int(np.searchsorted(stamps, suspect.since))
    again = np.flatnonzero(ids[first:] == suspect.id)
    return judged.seconds(int(stamps[first + again[0]])) if len(again) else None


def _short(suspect: Suspect) -> str:
    reason = suspect.reason
    if reason.unit == 'score':
        return 'came at unusual times'
    if reason.after or (reason.of > 0 and reason.times == 0):
        return _SHORT_OF_ANSWERS.get(reason.kind, reason.kind)
    return _SHORT.get(reason.kind, reason.kind)


def _began(suspect: Suspect, start: float) -> Optional[float]:
    """Return when the trouble began [s]: what the suspect's numbers look back to."""
    return None if math.isnan(suspect.reason.lasted) else start - suspect.reason.lasted


def _decided(judged: Judged, found: Overview, time: float) -> str:
    if found.evidence is None:
        return ''
    strongest = strongest_track(found, judged, time)
    if strongest is None:
        return ''
    track, share = strongest
    kinds = judged.by.trained.event_types
    name = str(kinds[track.to_id])
    if track.from_id != track.to_id:
        name = f'{kinds[track.from_id]} → {name}'
    return f'{track.channel} of {name}: {share:.2f} of its limit'


def _graph(judged: Judged, named: Sequence[str], detailed: bool) -> Optional[Neighbourhood]:
    if not detailed or not named:
        return None
    found = neighbourhood(judged.by.trained.graph, named)
    return found if found.nodes else None
