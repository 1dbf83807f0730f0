"""Alarms and suspicions of a recording: when, whom they name, why, and who was silent then."""
from __future__ import annotations

import math
from dataclasses import dataclass
from typing import List, Optional

import numpy as np

from self_awareness import Alarm, Suspect
from self_awareness.calibration.heads_and_tails import stopped_before_end
from self_awareness.reporting.report.judged import Judged
from self_awareness.reporting.text import of_limit
from self_awareness.stamps import SECOND_NS, moment

ALARM, SUSPICION = 'alarm', 'suspicion'  # the levels of an interval
MOST_LISTED = 400  # alarms and suspicions that are listed, at most so many; alarms come first

_CLEARLY_LONGER = 3
"""A pause is a silence if it is so many times as long as the longest one in training."""

SILENCES = ('silent', 'topic silent', 'unanswered')


@dataclass(frozen=True)
class Silence:
    """Times in seconds from the recording's first message."""

    begin: float  # its last message, or the recording's first one
    back: Optional[float]  # its next message; None: there is none until the recording's end


@dataclass(frozen=True)
class NamedSuspect:
    """A suspect in words."""

    component: str  # whose event type it is: a node, or a topic where nodes are not known
    event_type: str  # its name
    short: str  # what it does wrong, in a few words
    named: float  # when it was named [s] from the recording's first message
    silence: Optional[Silence]  # its longest one meanwhile; None: it was not silent
    of: Suspect  # the suspect itself

    @property
    def what(self) -> str:
        """Its topic, with the value that its messages have."""
        return f'{self.of.topic} with {self.of.value}' if self.of.value else self.of.topic


@dataclass(frozen=True)
class Interval:
    """An alarm or a suspicion; times in seconds from the recording's first message."""

    of: Alarm  # the alarm or suspicion itself
    level: str  # ALARM or SUSPICION
    start: float  # of it
    end: float  # of it, or of the recording
    moment: str  # date and time of the start, with the time zone
    cleared: bool  # false: it stood until the recording's end
    # When the trouble began, as far as the first suspect tells; None: it does not.
    began: Optional[float]
    reached: str  # how far the score went, in words
    evidence: str  # channels that speak, in words
    # Of all, or of all on some computers, where nobody was heard; None: somebody was.
    silence: Optional[Silence]
    suspects: List[NamedSuspect]  # best first
    later: List[NamedSuspect]  # suspects that were named later
    # By how many seconds all who stopped did so before the recording ended; None: nobody did, or
    # some time before.
    before_end: Optional[float] = None

    @property
    def named(self) -> List[NamedSuspect]:
        """All suspects, the most likely first."""
        return [*self.suspects, *self.later]

    @property
    def first(self) -> Optional[NamedSuspect]:
        """The suspect that is the culprit; None: nobody is to blame."""
        return next((suspect for suspect in self.named
                     if suspect.component == self.of.culprit), None)


def components(judged: Judged) -> List[str]:
    """Return the components that alarms and suspicions name, the most important ones first."""
    return list(dict.fromkeys(
        suspect.component for alarm in [*judged.verdicts.alarms, *judged.verdicts.suspicions]
        for suspect in [*alarm.suspects, *alarm.later]))


def intervals(judged: Judged) -> List[Interval]:
    """Return alarms and suspicions in the order of their start, at most MOST_LISTED."""
    verdicts = judged.verdicts
    ranked = [*verdicts.alarms, *verdicts.suspicions][:MOST_LISTED]
    return sorted((_interval(judged, alarm) for alarm in ranked),
                  key=lambda each: each.start)


def _interval(judged: Judged, alarm: Alarm) -> Interval:
    suspects = [_named(judged, suspect, alarm) for suspect in alarm.suspects]
    later = [_named(judged, suspect, alarm) for suspect in alarm.later]
    start = judged.seconds(alarm.begin)
    # When the trouble began is what the first suspect's numbers look back to.
    lasted = alarm.suspects[0].reason.lasted if alarm.suspects else math.nan
    return Interval(
        alarm, ALARM if alarm.level == 'ERROR' else SUSPICION, start,
        judged.seconds(alarm.end), moment(alarm.begin), alarm.over,
        None if math.isnan(lasted) else start - lasted,
        of_limit(alarm.lowest_score, judged.by.threshold),
        alarm.evidence or 'what is left of the alarm',
        _silence_of_all(judged, alarm) if alarm.kind == 'all silent' else None, suspects, later,
        stopped_before_end(judged.recording, alarm))


def _named(judged: Judged, suspect: Suspect, alarm: Alarm) -> NamedSuspect:
    silence = _silence_of(judged, alarm, suspect)
    return NamedSuspect(
        suspect.component, str(judged.recording.event_types[suspect.id]),
        suspect.reason.shortly(silence is not None,
                               silence is not None and silence.back is not None),
        judged.seconds(suspect.since), silence, suspect)


def _silence_of(judged: Judged, alarm: Alarm, suspect: Suspect) -> Optional[Silence]:
    """Return the longest silence of a suspect's event type while an alarm stood.

    None: it was not silent, or it is not about its own messages: an answer that does not come may
    come without its question.
    """
    reason = suspect.reason
    is_silence = reason.kind in SILENCES
    if reason.kind in ('never came', 'stranger') or (reason.after and not is_silence):
        return None
    looks_back = 0.0 if math.isnan(reason.lasted) else reason.lasted
    silence = _longest(judged, judged.edges_of(suspect.id),
                       suspect.since - int(looks_back * SECOND_NS), alarm.end)
    if is_silence and not reason.after:
        return silence
    if reason.kind == 'lossy' and silence.back is not None:
        return None  # some lost in a row are no silence
    usual = judged.by.trained.longest_gap(suspect.id) / SECOND_NS
    end = judged.seconds(judged.recording.end) if silence.back is None else silence.back
    return silence if usual > 0 and end - silence.begin > _CLEARLY_LONGER * usual else None


def _silence_of_all(judged: Judged, alarm: Alarm) -> Silence:
    """Return the longest time without any event, or any of some computers, as an alarm stood."""
    silent = alarm.silent if alarm.silent is not None and alarm.silent.hosts else None
    kinds = [number for number, kind in enumerate(judged.recording.event_types)
             if silent is None or kind.component in silent.components]
    return _longest(judged, judged.edges_of(*kinds), alarm.begin, alarm.end)


def _longest(judged: Judged, edges: np.ndarray, begin: int, end: int) -> Silence:
    """Return the longest of the gaps between edges that a stretch of time meets."""
    first = min(max(int(np.searchsorted(edges, begin, side='right')) - 1, 0), len(edges) - 2)
    last = int(np.searchsorted(edges, end, side='right')) + 1
    longest = first + int(np.argmax(np.diff(edges[first:max(last, first + 2)])))
    at_end = longest == len(edges) - 2
    return Silence(judged.seconds(int(edges[longest])),
                   None if at_end else judged.seconds(int(edges[longest + 1])))
