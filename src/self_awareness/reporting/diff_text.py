"""A comparison in words, and as plain values for JSON."""
from __future__ import annotations

import math
from typing import Any, Dict, List

from self_awareness.comparison.changes import (DELAY, ENDED, GAP, GONE, NEW, RATE, Change,
                                               Comparison)
from self_awareness.comparison.sides import Kind, Side
from self_awareness.reporting.text import delay, first_of, number_of, rounded

_MOST_UNSURE = 10


def name(kind: Kind) -> str:
    """Return an event type as it is written everywhere: SOURCE SCOPE TYPE."""
    return ' '.join(part for part in kind if part)


def numbers(change: Change) -> str:
    """Return what it was and what it is."""
    before, after = change.before, change.after
    whole = ', as all of its source' if change.whole else ''
    if change.end is not None:
        return (f'last heard at {change.end.last:.1f} s, {change.end.silent:.1f} s before the '
                f'end{whole}')
    if before is None or after is None:
        rate, = (each for each in (before, after) if each is not None)
        return f'{rounded(rate, 3)} Hz{whole}'
    if change.what == RATE:
        return (f'{rounded(before, 3)} Hz, now {rounded(after, 3)} Hz '
                f'({after / before:.2f} times)')
    difference = 1000.0 * (after - before)
    usual = 'usually up to ' if change.what == GAP else ''
    return f'{usual}{delay(before)}, now {usual and "up to "}{delay(after)} ' \
           f'({difference:+.3g} ms)'


def subject(change: Change) -> str:
    """Return what it is about."""
    if change.other is None:
        return name(change.kind)
    return f'{name(change.other)} -> {name(change.kind)}'


def lines(comparison: Comparison) -> List[str]:
    """Return the comparison as text."""
    text = [f'before  {side_line(comparison.before)}', f'after   {side_line(comparison.after)}']
    text += [f'{change.what:<6}  {subject(change)}: {numbers(change)}'
             for change in comparison.changes]
    if not comparison.changes:
        text.append(('' if comparison.is_complete else 'of what was compared, ')
                    + 'nothing changed by more than chance and the least effect')
    return text + [f'  {note}' for note in notes(comparison)]


def side_line(side: Side) -> str:
    """Return a side in a line."""
    number = len(side.model.recordings)
    what = number_of(number, 'recording')
    if not side.is_recording:
        what = f'a model of {what}'
    elif number == 1:
        what = 'a recording'
    return f'{side.name}: {what}, {side.duration:.1f} s, {len(side.ids)} event types'


def notes(comparison: Comparison) -> List[str]:
    """Return what was not compared, and why."""
    found = []
    if comparison.unsure:
        found.append('on one side only, but too rare to say that it is not chance: '
                     + first_of([name(kind) for kind in comparison.unsure], _MOST_UNSURE, ', '))
    if comparison.compared_delays is None:
        found.append('delays between event types were not compared: no model is calibrated, so '
                     'nobody knows which of them have to do with each other; calibrate one')
    elif comparison.compared_delays == 0:
        found.append('delays between event types were not compared: the model watches no late '
                     'answers, or there are too few of them on a side; record several starts of '
                     'the robot with who subscribes to what (record.launch), and train on them')
    elif not comparison.changes:
        found.append(f'delays were compared of {comparison.compared_delays} pairs of event types: '
                     'of those that the model watches, with enough delays on both sides')
    return found


def as_values(comparison: Comparison) -> Dict[str, Any]:
    """Return the comparison as plain values; times in seconds, rates in Hz."""
    return {
        'before': _side(comparison.before),
        'after': _side(comparison.after),
        'changes': [_change(change) for change in comparison.changes],
        'too_rare': [_kind(kind) for kind in comparison.unsure],
        'delays_compared': comparison.compared_delays is not None,
    }


def headline(comparison: Comparison) -> str:
    """Return the most important in a line."""
    if not comparison.changes:
        return ('Nothing changed by more than chance.' if comparison.is_complete else
                'Rates and gaps are as before; delays were not compared.')
    first, more = comparison.changes[0], len(comparison.changes) - 1
    who = first.kind[0] or first.kind[1]
    verbs = {GONE: 'is gone', ENDED: 'ended', NEW: 'is new', RATE: 'sends at another rate',
             GAP: 'sends at another pace', DELAY: 'answers after another delay'}
    whole = who if first.whole else f'{who} ({first.kind[1]})' if first.kind[0] else who
    text = f'{whole} {verbs[first.what]}'
    return text + (f'; {number_of(more, "more change")}.' if more else '.')


def _change(change: Change) -> Dict[str, Any]:
    values: Dict[str, Any] = {'change': change.what, **_kind(change.kind),
                              'before': change.before, 'after': change.after,
                              'effect': change.effect if math.isfinite(change.effect) else None,
                              'whole_source': change.whole}
    if change.end is not None:
        values['last_heard_s'] = change.end.last
    if change.other is not None:
        values['from'] = _kind(change.other)
    return values


def _kind(kind: Kind) -> Dict[str, str]:
    return dict(zip(('source', 'scope', 'type'), kind))


def _side(side: Side) -> Dict[str, Any]:
    return {'file': side.name, 'is_recording': side.is_recording, 'duration': side.duration,
            'event_types': len(side.ids)}
