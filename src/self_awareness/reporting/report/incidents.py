"""What happened: the alarms and suspicions of one cause are one incident."""
from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any, Collection, Dict, List, Sequence

from self_awareness.reporting.report.headline import headline
from self_awareness.reporting.report.intervals import ALARM, Interval, NamedSuspect
from self_awareness.reporting.report.judged import Judged
from self_awareness.reporting.report.neighbours import Edge, downstream

MOST_DETAILS = 40
"""Incidents with details, at most so many; the worst come first."""

_JOINED_S = 5.0
_AT_ONCE_S = 1.0


@dataclass(frozen=True)
class Incident:
    """All that one cause has done.

    Args:
        key: unique in the page.
        intervals: alarms and suspicions, in the order of time.
        main: the longest one, alarms first, that blames the cause.
        together: components that failed at once with the cause, and do not depend on it.
        victims: components that are named, and need the messages of these, as far as the graph
            tells; empty: there is no graph.
        others: further components that are named.
        headline: in words.
    """

    key: str
    intervals: List[Interval]
    main: Interval
    together: List[str]
    victims: List[str]
    others: List[str]
    headline: str

    @property
    def level(self) -> str:
        """ALARM or SUSPICION."""
        return self.main.level

    @property
    def cause(self) -> str:
        """The component that is to blame; empty: there is none."""
        return self.main.of.culprit

    @property
    def alarms(self) -> List[Interval]:
        """Its intervals of its level."""
        return [each for each in self.intervals if each.level == self.level]

    @property
    def silent(self) -> List[NamedSuspect]:
        """Who was silent in the main interval; who did not come back is last."""
        return sorted((each for each in self.main.named if each.silence is not None),
                      key=lambda each: math.inf if each.silence is None
                      or each.silence.back is None else each.silence.back)

    @property
    def standing(self) -> float:
        """How long it stood, all in all [s]."""
        return sum(each.end - each.start for each in self.alarms)


def incidents(judged: Judged, listed: Sequence[Interval], prefix: str) -> List[Incident]:
    """Return what happened: alarms before suspicions, and what stood longest first.

    Args:
        listed: all alarms and suspicions, in the order of time.
        prefix: of their keys.
    """
    by_cause: Dict[str, List[Interval]] = {}
    for episode in _episodes(listed):
        by_cause.setdefault(_cause(_first(episode)), []).extend(episode)
    made = [_incident(judged, cause, each) for cause, each in by_cause.items()]
    made.sort(key=lambda each: (each.level != ALARM, -each.standing, each.main.start))
    return [replace(each, key=f'{prefix}-{number}') for number, each in enumerate(made)]


def as_values(incident: Incident) -> Dict[str, Any]:
    """Return an incident as plain values; keys that end in _s count from the first message."""
    return {
        'headline': incident.headline,
        'level': incident.main.of.level,
        'kind': incident.main.of.kind,
        'cause': incident.cause or None,
        'together': incident.together,
        'victims': incident.victims,
        'others': incident.others,
        'standing': incident.standing,
        'alarms': [each.of.id for each in incident.intervals],
        'silent': [{'component': each.component, 'event_type': each.event_type,
                    'from_s': each.silence.begin, 'back_s': each.silence.back}
                   for each in incident.silent if each.silence is not None],
    }


def _episodes(listed: Sequence[Interval]) -> List[List[Interval]]:
    """Return intervals that follow each other soon and name somebody in common."""
    found: List[List[Interval]] = []
    for interval in listed:
        if found and _goes_on(found[-1], interval):
            found[-1].append(interval)
        else:
            found.append([interval])
    return found


def _goes_on(episode: Sequence[Interval], interval: Interval) -> bool:
    names = {suspect.component for suspect in interval.named}
    soon = interval.start - max(each.end for each in episode) <= _JOINED_S
    return soon and any(suspect.component in names for each in episode for suspect in each.named)


def _first(episode: Sequence[Interval]) -> Interval:
    """Return the interval that tells the cause: a suspicion may know less than its alarm."""
    return next((each for each in episode if each.level == ALARM), episode[0])


def _cause(interval: Interval) -> str:
    # Names of components are no kinds: they begin with a slash where nodes are known.
    silent = interval.of.silent
    hosts = [] if silent is None else silent.hosts
    return interval.of.culprit or f'({" ".join([interval.of.kind, *hosts])})'


def _incident(judged: Judged, cause: str, intervals: List[Interval]) -> Incident:
    main = max((each for each in intervals if _cause(each) == cause),
               key=lambda each: (each.level == ALARM, each.end - each.start))
    together = _together(main, judged.by.trained.graph)
    causes = [main.of.culprit, *together]
    reached = set().union(*(downstream(judged.by.trained.graph, name) for name in causes))
    alarms = [each for each in intervals if each.level == main.level]
    # What a suspicion names before its alarm is less sure: some of it is only quiet.
    named = list(dict.fromkeys(suspect.component for each in alarms for suspect in each.named
                               if suspect.component not in causes))
    return Incident('', intervals, main, together, [name for name in named if name in reached],
                    [name for name in named if name not in reached],
                    headline(main, together, len(alarms)))


def _together(main: Interval, graph: Collection[Edge]) -> List[str]:
    """Return who failed at once with the cause, and does not need its messages."""
    first = main.first
    if first is None:
        return []
    dependent = downstream(graph, first.component)
    return list(dict.fromkeys(
        suspect.component for suspect in main.named
        if suspect.component not in (first.component, *dependent)
        and _at_once(first, suspect, bool(graph))))


def _at_once(first: NamedSuspect, suspect: NamedSuspect, graph_is_known: bool) -> bool:
    if first.of.reason.kind == 'stranger':
        return suspect.of.reason.kind == 'stranger'
    if first.silence is None:  # then, only the graph tells victims
        return graph_is_known and suspect.abnormal
    return (suspect.silence is not None
            and abs(suspect.silence.begin - first.silence.begin) <= _AT_ONCE_S)
