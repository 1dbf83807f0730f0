"""All that the report says of one recording, without any drawing."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Dict, List, Optional, Tuple

import numpy as np

from self_awareness.recordings import in_words
from self_awareness.reporting import coverage_text
from self_awareness.reporting.report import intervals
from self_awareness.reporting.report.against import Evidence, against
from self_awareness.reporting.report.headline import clock
from self_awareness.reporting.report.incidents import (MOST_DETAILS, Incident, incidents,
                                                       place_of)
from self_awareness.reporting.report.intervals import ALARM, SUSPICION, Interval
from self_awareness.reporting.report.judged import Judged
from self_awareness.reporting.report.neighbours import Neighbourhood, neighbourhood
from self_awareness.reporting.report.next_steps import NextSteps, next_steps
from self_awareness.reporting.report.timeline import Timeline, timeline
from self_awareness.reporting.report.unjudged import Unjudged, unjudged
from self_awareness.reporting.text import duration, number_of, percent, seconds_of
from self_awareness.stamps import SECOND_NS, moment

QUIET, SUSPICIOUS, ALARMED, NOT_JUDGED = 'quiet', 'suspicious', 'alarmed', 'not judged'
"""How a recording was."""


@dataclass(frozen=True)
class Summary:
    """The recording in words."""

    state: str  # QUIET, SUSPICIOUS, ALARMED or NOT_JUDGED
    headline: str  # who did what when; or that nothing happened
    answers: List[Tuple[str, str]]  # question (when, who, why, ...) and answer
    first: Optional[str]  # key of the incident that it is about; None: there is none


@dataclass(frozen=True)
class Details:
    """What is shown of an incident when it is opened."""

    # Which track was strongest when the main interval was raised, in words; empty: not known.
    decided: str
    # Against each suspect that the main interval names; None: it cannot be drawn.
    evidence: List[Optional[Evidence]]
    graph: Neighbourhood  # who publishes to whom near the cause; without roles: not known
    next: NextSteps  # what to look at


@dataclass(frozen=True)
class Section:
    """All that the report says of one recording."""

    key: str  # unique in the page
    title: str  # the recording
    facts: List[Tuple[str, str]]  # name and value: how long it is and what judged it
    summary: Summary  # in words
    timeline: Timeline  # the score and the evidence over time
    incidents: List[Incident]  # what happened, the worst first
    details: Dict[str, Details]  # of the first MOST_DETAILS incidents, by their keys
    not_listed: int  # number of further alarms and suspicions
    unjudged: List[Unjudged]  # what was not judged
    # How soon the death of each component is found: a table, its head first; empty: not known of
    # this detector.
    watched: List[Tuple[str, ...]]
    unheard: List[str]  # what nobody subscribed to in training


def section(judged: Judged, key: str) -> Section:
    """Return what the report says of a recording.

    Raises:
        BagError: the bag cannot be read any more.
    """
    found = timeline(judged, intervals.components(judged))
    listed = intervals.intervals(judged)
    happened = incidents(judged, listed, key)
    detailed = happened[:MOST_DETAILS]
    trained = judged.by.trained
    shown = {each.key: Details(_decided(judged, found, each.main),
                               [against(judged, each.main.of, suspect.of)
                                for suspect in each.main.named],
                               neighbourhood(trained.graph, _named(each)), steps)
             for each, steps in zip(detailed, next_steps(judged, detailed))}
    total = len(judged.verdicts.alarms) + len(judged.verdicts.suspicions)
    coverage = [] if judged.by.evidence is None else trained.coverage()
    return Section(key, str(judged.recording.part), _facts(judged),
                   _summary(judged, happened), found, happened, shown,
                   total - len(listed), unjudged(judged),
                   coverage_text.table(coverage_text.summarise(coverage), trained.fewest_gaps),
                   coverage_text.unheard_lines(coverage_text.unheard(trained.unheard)))


def _named(incident: Incident) -> List[str]:
    """Return whom an incident names, the cause first, if there is one."""
    return [name for name in (incident.cause, *(suspect.component
                                                for suspect in incident.main.named)) if name]


def _decided(judged: Judged, found: Timeline, main: Interval) -> str:
    if found.lanes is None or judged.by.evidence is None:
        return ''
    time = main.start - judged.by.trained.window / 2e9  # in the window that raised it
    at = int(np.searchsorted(found.edges[1:-1], time, side='right'))
    index = found.lanes.of.tracks[at]
    if index is None:
        return ''
    track, kinds = judged.by.evidence.tracks[index], judged.by.trained.event_types
    name = str(kinds[track.to_id])
    if track.from_id != track.to_id:
        name = f'{kinds[track.from_id]} → {name}'
    share = percent(float(found.lanes.of.strongest[at]))
    return f'{track.channel} of {name}: {share} of its limit'


def _facts(judged: Judged) -> List[Tuple[str, str]]:
    recording, by = judged.recording, judged.by
    types = int(np.count_nonzero(np.bincount(recording.ids)))
    facts = [('recorded', f'{moment(recording.recording.start)}, '
                          f'{duration(seconds_of([recording.recording]))}'),
             ('events', f'{len(recording.stamps):,} of {types:,} event types'),
             ('windows', f'{len(judged.verdicts.start):,} of {by.trained.window / SECOND_NS:g} s'),
             ('model', by.model_name),
             ('detector', 'paper' if by.evidence is None else 'evidence')]
    if recording.steps_of_the_clock:
        facts.append(('clock', f'set {in_words(recording.steps_of_the_clock)}'))
    return facts


def _summary(judged: Judged, happened: List[Incident]) -> Summary:
    if judged.by.threshold is None:
        return Summary(NOT_JUDGED, 'Not judged: the model is not calibrated.',
                       [('Way out', 'calibrate the model on recordings of normal operation: '
                         'rosrun self_awareness calibrate')], None)
    missing = judged.by.not_watched
    if not happened:
        return Summary(QUIET, f'Nothing abnormal, but {missing}.' if missing
                       else 'Nothing abnormal.', [], None)
    worst = happened[0]
    others = ', '.join(worst.others)
    if others and not judged.by.trained.graph:
        others += ' (the model has no graph: nobody knows who is a victim of whom)'
    answers = [('When', _when(worst)),
               ('File', place_of(judged, worst)),
               *_blamed(worst),
               ('At once', ', '.join(worst.together)),
               ('But', worst.main.of.busy or ''),
               ('Who waits', f'{worst.waiting}.' if worst.waiting else ''),
               *(('And', further) for further in worst.further),
               ('Victims', ', '.join(worst.victims)),
               ('Also named', others),
               ('What else', _others(happened[1:])),
               ('Blind', missing)]
    return Summary(ALARMED if worst.level == ALARM else SUSPICIOUS, worst.headline,
                   [each for each in answers if each[1]], worst.key)


def _blamed(worst: Incident) -> List[Tuple[str, str]]:
    main, first = worst.main, worst.main.first
    if first is None:
        return [('Who', 'no suspect stands out')]
    who = (f'{first.component}, by its {first.event_type}'
           if first.component not in first.event_type.split(' ') else first.event_type)
    answers = [('Who', who), ('Why', first.of.reason.words)]
    if main.began is not None:
        answers.append(('Since', f'{clock(max(main.began, 0.0))}, '
                        f'{main.start - main.began:.2f} s before the {worst.level}'))
    return answers


def _when(worst: Incident) -> str:
    main = worst.main
    end = 'cleared' if main.cleared else 'stood until the end of the recording'
    times = len(worst.alarms)
    often = f'; {times} {worst.level}s in all, for {duration(worst.standing)}' if times > 1 else ''
    return (f'{worst.level} from {clock(main.start)} to {clock(main.end)} ({end}); '
            f'{main.moment}{often}')


def _others(rest: List[Incident]) -> str:
    texts = []
    for level in (ALARM, SUSPICION):
        of_level = [each for each in rest if each.level == level]
        if of_level:
            causes = ', '.join(dict.fromkeys(each.cause for each in of_level if each.cause))
            texts.append(f'{number_of(sum(len(each.alarms) for each in of_level), level)} of '
                         f'{number_of(len(of_level), "other cause")}{causes and f": {causes}"}')
    return '; '.join(texts)
