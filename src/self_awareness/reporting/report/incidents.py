"""What happened: the alarms and suspicions of one cause are one incident."""
from __future__ import annotations

import math
import os
import re
from dataclasses import dataclass, field, replace
from typing import Any, Dict, List, Sequence

from self_awareness import Occurrence, fold_incidents
from self_awareness.reporting.report.headline import headline, of_another
from self_awareness.reporting.report.intervals import ALARM, Interval, NamedSuspect
from self_awareness.reporting.report.judged import Judged
from self_awareness.stamps import nanoseconds

_OF_AN_ALARM = re.compile(r'alarm_\d{4}-\d\d-\d\d-')  # RecorderFolder::pathOf()

MOST_DETAILS = 40  # incidents with details, at most so many; the worst come first


@dataclass(frozen=True)
class Incident:
    """All that one cause has done."""

    key: str  # unique in the page
    intervals: List[Interval]  # alarms and suspicions, in the order of time
    main: Interval  # the longest one, alarms first, that blames the cause
    together: List[str]  # components that failed at once with the cause, and do not depend on it
    # Components that are named, and need the messages of these, as far as the graph tells; empty:
    # there is no graph.
    victims: List[str]
    others: List[str]  # further components that are named
    headline: str  # in words
    # The same of each of the others that fell silent.
    further: List[str] = field(default_factory=list)
    waiting: str = ''  # who waits for the cause, who for them, and so on; empty: not known

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
    """Return what happened: alarms before suspicions, and what stood longest first; in a file of
    the flight recorder, the alarm that it was written for, which is the last one.

    Args:
        listed: all alarms and suspicions, in the order of time.
        prefix: of their keys.
    """
    occurrences = [_occurrence(number, each) for number, each in enumerate(listed)]
    made = [_incident([listed[number] for number in each.ids], listed[each.main], each.together,
                      each.victims, each.others)
            for each in fold_incidents(occurrences, judged.by.trained.graph)]
    written_for = None
    if _OF_AN_ALARM.match(os.path.basename(judged.recording.part.path)):
        written_for = max((each.start for each in listed if each.level == ALARM), default=None)
    made.sort(key=lambda each: (
        each.level != ALARM, all(alarm.start != written_for for alarm in each.alarms),
        -each.standing, each.main.start))
    return [replace(each, key=f'{prefix}-{number}') for number, each in enumerate(made)]


def place_of(judged: Judged, incident: Incident) -> str:
    """Return in which file it began, and when there, of a recording in several; empty: in one."""
    main = incident.main
    silence = main.silence or (None if main.first is None else main.first.silence)
    began = main.start if main.began is None else main.began
    return judged.recording.place(judged.recording.origin + nanoseconds(
        max(began if silence is None else silence.begin, 0.0)))


def as_values(incident: Incident) -> Dict[str, Any]:
    """Return an incident as plain values; keys that end in _s count from the first message."""
    return {
        'headline': incident.headline,
        'further': incident.further,
        'waiting': incident.waiting or None,
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


def _occurrence(number: int, interval: Interval) -> Occurrence:
    """Return an interval as the core folds it; what the recording shows of silences is known."""
    silent = interval.of.silent
    return Occurrence(
        number, interval.level == ALARM, nanoseconds(interval.start), nanoseconds(interval.end),
        interval.of.kind, interval.of.culprit,
        [(each.component, each.of.abnormal,
          None if each.silence is None else nanoseconds(each.silence.begin),
          each.of.reason.kind, each.of.onset)
         for each in interval.named],
        [] if silent is None else silent.hosts)


def _incident(intervals: List[Interval], main: Interval, together: List[str],
              victims: List[str], others: List[str]) -> Incident:
    alarms = [each for each in intervals if each.level == main.level]
    return Incident('', intervals, main, together, victims, others,
                    headline(main, together, len(alarms)),
                    _further(intervals, main, victims, others),
                    max((each.of.waiting for each in alarms
                         if each.of.culprit == main.of.culprit), key=len, default=''))


def _further(intervals: Sequence[Interval], main: Interval, victims: Sequence[str],
             others: Sequence[str]) -> List[str]:
    """Return the sentences on those that the cause does not explain: others that are to blame for
    an alarm or a suspicion of their own, or fell silent in its alarm, and victims that stayed
    silent when it was back."""
    further: Dict[str, str] = {}
    is_back = (main.first is not None and main.first.silence is not None
               and main.first.silence.back is not None)
    for each in main.named:
        stays = each.silence is not None and each.silence.back is None and not main.cleared
        if each.of.abnormal and (each.component in others and each.silence is not None
                                 or each.component in victims and stays and is_back):
            further.setdefault(each.component, of_another(each))
    by_culprit: Dict[str, List[Interval]] = {}
    for interval in intervals:
        if interval.of.culprit in others:
            by_culprit.setdefault(interval.of.culprit, []).append(interval)
    for culprit, of_culprit in by_culprit.items():
        longest = max(of_culprit, key=lambda each: (each.level == ALARM, each.end - each.start))
        times = sum(each.level == longest.level for each in of_culprit)
        further.setdefault(culprit, headline(longest, [], times))
    return list(further.values())
