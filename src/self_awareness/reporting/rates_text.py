"""How often each topic came in a recording, beside how often it came in training."""
from __future__ import annotations

import math
from collections import Counter
from typing import Any, Dict, Iterable, List, Mapping, Sequence, Tuple

import numpy as np

from self_awareness import EventType, TrainedModel
from self_awareness.recordings import RecordingEvents
from self_awareness.reporting.text import aligned, or_dash, seconds_of

_Who = Tuple[str, str]  # component and topic


def summarise(model: TrainedModel, recording: RecordingEvents) -> Dict[str, Any]:
    """Return the rates of a recording as plain values, what is most off first.

    What is off is how many times more or fewer messages came than usual. One message is added to
    both numbers, so that a topic that comes once an hour is not the first one of each short
    recording.
    """
    named = recording.recording
    seconds, trained_s = seconds_of([named]), seconds_of(model.recordings)
    inside = recording.ids[(recording.stamps >= named.start) & (recording.stamps <= named.end)]
    now = _by_topic(recording.event_types, np.bincount(inside).tolist())
    usual = _by_topic(model.event_types, map(model.event_count, range(len(model.event_types))))
    unheard = model.unheard
    rows = []
    for who in {*now, *usual}:
        count, trained = now.get(who, 0), usual.get(who, 0)
        expected = trained / trained_s * seconds if trained_s > 0.0 else 0.0
        rows.append((-abs(math.log((count + 1.0) / (expected + 1.0))), who, {
            'component': who[0], 'topic': who[1],
            'rate': count / seconds if seconds > 0.0 else None,
            'usual_rate': trained / trained_s if trained and trained_s > 0.0 else None,
            'ratio': count / expected if expected > 0.0 else None,
            'note': ('missing' if not count else '' if trained
                     else 'nobody subscribed in training' if who in unheard else 'unknown')}))
    return {'recording': str(recording.part), 'duration': seconds,
            'topics': [row for _, _, row in sorted(rows, key=lambda row: row[:2])]}


def lines(summary: Mapping[str, Any]) -> List[str]:
    """Return the rates of a recording as text."""
    rows = [[each['component'], each['topic'] if each['topic'] != each['component'] else '',
             *(or_dash(each[key]) for key in ('rate', 'usual_rate', 'ratio')), each['note']]
            for each in summary['topics']]
    head = ['component', 'topic', 'now [Hz]', 'usual [Hz]', 'ratio', '']
    return [f'{summary["recording"]}: {summary["duration"]:.1f} s, what is most off first',
            *(f'  {line}' for line in aligned([head, *rows]))]


def _by_topic(event_types: Sequence[EventType], counts: Iterable[int]) -> Dict[_Who, int]:
    """Return the messages of each component on each topic, of which there are some."""
    found: Counter = Counter()
    for kind, count in zip(event_types, counts):
        if count and kind.is_message:
            found[kind.component, kind.scope] += count
    return dict(found)
