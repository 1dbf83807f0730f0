"""All that the report says of one recording, without any drawing."""
from __future__ import annotations

from dataclasses import dataclass
from typing import List, Optional, Tuple

import numpy as np

from self_awareness.reporting.report import intervals
from self_awareness.reporting.report.intervals import ALARM, Interval
from self_awareness.reporting.report.judged import Judged
from self_awareness.reporting.report.timeline import Overview, overview
from self_awareness.reporting.report.unjudged import Unjudged, unjudged
from self_awareness.stamps import SECOND_NS, moment

QUIET, SUSPICIOUS, ALARMED, NOT_JUDGED = 'quiet', 'suspicious', 'alarmed', 'not judged'
"""How a recording was."""


@dataclass(frozen=True)
class Summary:
    """The recording in words.

    Args:
        state: QUIET, SUSPICIOUS, ALARMED or NOT_JUDGED.
        headline: who did what when; or that nothing happened.
        answers: question (when, who, why, ...) and answer.
        first: key of the interval that it is about; None: there is none.
    """

    state: str
    headline: str
    answers: List[Tuple[str, str]]
    first: Optional[str]


@dataclass(frozen=True)
class Section:
    """All that the report says of one recording.

    Args:
        key: unique in the page.
        title: the recording.
        facts: name and value: how long it is and what judged it.
        summary: in words.
        overview: the score and the evidence over time.
        intervals: alarms and suspicions.
        not_listed: number of further ones.
        unjudged: what was not judged.
    """

    key: str
    title: str
    facts: List[Tuple[str, str]]
    summary: Summary
    overview: Overview
    intervals: List[Interval]
    not_listed: int
    unjudged: List[Unjudged]


def section(judged: Judged, key: str) -> Section:
    """Return what the report says of a recording."""
    found = overview(judged, intervals.components(judged))
    listed = intervals.intervals(judged, found, key)
    total = len(judged.verdicts.alarms) + len(judged.verdicts.suspicions)
    return Section(key, str(judged.recording.part), _facts(judged), _summary(judged, listed),
                   found, listed, total - len(listed), unjudged(judged))


def clock(seconds: float) -> str:
    """Return a time from the recording's first message as people read it: 75.3 s, 1 h 02 min."""
    if seconds < 600:
        return f'{seconds:.1f} s'
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f'{hours} h {minutes:02d} min {rest:02d} s' if hours else f'{minutes} min {rest:02d} s'


def _facts(judged: Judged) -> List[Tuple[str, str]]:
    recording, by = judged.recording, judged.by
    start, end = recording.part.span(recording.origin, recording.end)
    types = int(np.count_nonzero(np.bincount(recording.ids)))
    return [('recorded', f'{moment(start)}, {clock((end - start) / SECOND_NS)}'),
            ('events', f'{len(recording.stamps):,} of {types:,} event types'),
            ('windows', f'{len(judged.verdicts.start):,} of {by.trained.window / SECOND_NS:g} s'),
            ('model', by.model_name),
            ('detector', 'paper' if by.evidence is None else 'evidence')]


def _summary(judged: Judged, listed: List[Interval]) -> Summary:
    if judged.by.threshold is None:
        return Summary(NOT_JUDGED, 'Not judged: the model is not calibrated.',
                       [('Way out', 'calibrate the model on recordings of normal operation: '
                         'rosrun self_awareness calibrate')], None)
    alarms = [each for each in listed if each.level == ALARM]
    missing = judged.by.not_watched
    if not listed:
        return Summary(QUIET, f'Nothing abnormal, but {missing}.' if missing
                       else 'Nothing abnormal.', [], None)
    first = (alarms or listed)[0]
    answers = [('When', _when(first))]
    if first.suspects:
        culprit = first.suspects[0]
        answers.append(('Who', f'{culprit.component}, by its {culprit.event_type}'
                        if culprit.component not in culprit.event_type.split(' ')
                        else culprit.event_type))
        answers.append(('Why', culprit.why))
        if first.began is not None:
            answers.append(('Since', f'{clock(max(first.began, 0.0))}, '
                            f'{first.start - first.began:.2f} s before the {first.level}'))
    else:
        answers.append(('Who', 'no suspect stands out'))
    if first.busy is not None:
        answers.append(('But', first.busy))
    answers.append(('Evidence', first.evidence + (f' ({first.decided})' if first.decided else '')))
    others = _others(first, listed, len(judged.verdicts.alarms), len(judged.verdicts.suspicions))
    if others:
        answers.append(('What else', others))
    if missing:
        answers.append(('Blind', missing))
    return Summary(ALARMED if alarms else SUSPICIOUS, _headline(first), answers, first.key)


def _headline(first: Interval) -> str:
    if first.busy is not None:
        return f'At {clock(first.start)} the machine may have been busy: many are late at once.'
    if not first.suspects:
        return f'Something is abnormal at {clock(first.start)}; no suspect stands out.'
    culprit = first.suspects[0]
    topic = culprit.event_type.split(' ')[-2]
    subject = (f'{culprit.component} ({topic})' if topic != culprit.component
               else culprit.component)
    began = first.start if first.began is None else max(first.began, 0.0)
    since = f'at {clock(began)}' if began else 'since the start'
    back = '' if culprit.back is None else f', and came back at {clock(culprit.back)}'
    return f'{subject} {culprit.short} {since}{back}.'


def _when(first: Interval) -> str:
    end = 'cleared' if first.cleared else 'stood until the end of the recording'
    return (f'{first.level} from {clock(first.start)} to {clock(first.end)} ({end}); '
            f'{first.moment}')


def _others(first: Interval, listed: List[Interval], alarms: int, suspicions: int) -> str:
    named = list(dict.fromkeys(
        suspect.component for suspect in [*first.suspects[1:], *first.later]
        if suspect.component != first.suspects[0].component)) if first.suspects else []
    texts = []
    if named:
        texts.append(f'also named: {", ".join(named)}')
    elsewhere = list(dict.fromkeys(
        each.suspects[0].component for each in listed
        if each is not first and each.level == ALARM and each.suspects))
    more = alarms - (1 if first.level == ALARM else 0)
    if more > 0:
        text = f'{more} more alarm{"" if more == 1 else "s"}'
        texts.append(text + (f', first suspects: {", ".join(elsewhere)}' if elsewhere else ''))
    more = suspicions - (0 if first.level == ALARM else 1)
    if more > 0:
        texts.append(f'{more} {"" if first.level == ALARM else "more "}'
                     f'suspicion{"" if more == 1 else "s"}')
    return '; '.join(texts)
