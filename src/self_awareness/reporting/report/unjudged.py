"""What was not judged in a recording, and why."""
from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass
from typing import List, Sequence

from self_awareness.recordings import unknown
from self_awareness.reporting.report.judged import Judged
from self_awareness.reporting.text import number_of
from self_awareness.stamps import SECOND_NS

MOST_NAMES = 30  # names that are listed of one kind, at most so many


@dataclass(frozen=True)
class Unjudged:
    """Something that was not judged."""

    what: str  # it is
    why: str  # it was not judged
    names: List[str]  # of event types, at most MOST_NAMES; empty: it is none of them
    more: int = 0  # number of further ones


def unjudged(judged: Judged) -> List[Unjudged]:
    """Return what was not judged, the most important first."""
    found = []
    by = judged.by
    if by.threshold is None:
        found.append(Unjudged('everything', 'the model has no limits: calibrate it (rosrun '
                              'self_awareness calibrate)', []))
    found += [*_unknown(judged), *_silent(judged), *_too_rare(judged), *_without_limit(judged)]
    settling = int(judged.verdicts.settling.sum()) * by.trained.window / SECOND_NS
    if settling > 0 and by.threshold is not None:
        found.append(Unjudged(f'{settling:.1f} s of settling', 'too little is known in the first '
                              f'{by.parameters.settle_time / SECOND_NS:g} s after a start', []))
    if by.evidence is None:
        found.append(Unjudged('single components', "the paper's detector has one score for all: "
                              'there are no lanes', []))
    if not by.trained.graph:
        found.append(Unjudged('who hears whom', 'the model has no graph of publishers and '
                              'subscribers (record.launch writes it beside the bags, or train '
                              '--graph)', []))
    return found


def _listed(what: str, why: str, names: Sequence[str]) -> List[Unjudged]:
    if not names:
        return []
    return [Unjudged(f'{number_of(len(names), "event type")} {what}', why,
                     list(names[:MOST_NAMES]), max(len(names) - MOST_NAMES, 0))]


def _unknown(judged: Judged) -> List[Unjudged]:
    new, modes, unheard = ([f'{name}: {count}' for count, name in found]
                           for found in unknown(judged.by.trained, judged.recording))
    return (_listed('that training never saw',
                    'nothing is known of them; with each their number of events', new)
            + _listed('of modes that training never saw',
                      'such a mode says nothing; with each how often it was told', modes)
            + _listed('that nobody subscribed to in training',
                      'they were published then, and not recorded; with each their number of '
                      'events', unheard))


def _silent(judged: Judged) -> List[Unjudged]:
    heard = set(judged.recording.heard.tolist())
    return _listed('of the model without any event',
                   'not heard in this recording; those that came after every start in training '
                   'are a suspicion after a while',
                   [str(kind) for index, kind in enumerate(judged.by.trained.event_types)
                    if index not in heard])


def _too_rare(judged: Judged) -> List[Unjudged]:
    trained = judged.by.trained
    return _listed('too rare in training',
                   f'fewer than {trained.fewest_gaps} gaps between two of a kind',
                   [str(kind) for index, kind in enumerate(trained.event_types)
                    if trained.gaps(index) < trained.fewest_gaps and kind.is_message])


def _without_limit(judged: Judged) -> List[Unjudged]:
    calibration = judged.by.trained.calibration
    if judged.by.evidence is None or calibration is None:
        return []
    left_out = Counter(track.channel
                       for track, limit in zip(judged.by.evidence.tracks, calibration.limits)
                       if math.isnan(limit))
    if not left_out:
        return []
    text = ', '.join(f'{channel} {count}' for channel, count in sorted(left_out.items()))
    return [Unjudged(f'{sum(left_out.values())} kinds of evidence ({text})',
                     'they say nothing or too little, or there were too few starts of the robot '
                     '(info tells more)', [])]
