"""What happened, in a sentence: who did what, from when to when."""
from __future__ import annotations

from typing import Sequence

from self_awareness.reporting.report.intervals import Interval, NamedSuspect

_MOST_NAMED = 3
_SOON_S = 1.0


def clock(seconds: float) -> str:
    """Return a time from the recording's first message as people read it: 75.3 s, 1 h 02 min."""
    if seconds < 600:
        return f'{seconds:.1f} s'
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f'{hours} h {minutes:02d} min {rest:02d} s' if hours else f'{minutes} min {rest:02d} s'


def headline(main: Interval, together: Sequence[str], times: int) -> str:
    """Return an incident in a sentence.

    Args:
        main: the interval that it is about.
        together: who failed at once with the cause.
        times: number of its alarms.
    """
    text = _what(main, together, times)
    if main.before_end is not None:
        text = f'{text[:-1]}, {main.before_end:.1f} s before the recording ended.'
    return text[0].upper() + text[1:]


def _what(main: Interval, together: Sequence[str], times: int) -> str:
    span = _span(main)
    if main.silence is not None:
        return _of_all(main, times)
    if main.of.kind == 'busy machine':
        return f'{main.busy or "the machine was busy"}, {_often(times, span)}.'
    first = main.first
    if main.of.kind in ('new mode', 'two senders'):
        return f'{main.of.reason}, {_often(times, span)}.'
    if first is None:
        return f'something is abnormal, {_often(times, span)}; no suspect stands out.'
    subject = _names([first.component, *together]) if together else _with_topic(first)
    short = _plural(first.short) if together else first.short
    if first.of.reason.kind == 'never came':
        return f'{subject} {short} since the start.'
    if first.of.reason.kind == 'stranger' and first.of.reason.topics:
        return f'{main.of.reason}, {_often(times, span)}.'
    if first.of.reason.kind == 'stranger':
        it, was = ('them', 'they were') if together else ('it', 'it was')
        return f'{subject} {short}: training never heard {it}, {was} heard {_often(times, span)}.'
    if first.silence is None or first.of.reason.after:
        return f'{subject} {short} {_often(times, span)}.'
    begin = f'at {clock(first.silence.begin)}' if first.silence.begin > 0 else 'since the start'
    if times > 1:
        return f'{subject} {short} {times} times, the longest {begin}{_back(main, together)}.'
    return f'{subject} {short} {begin}{_back(main, together)}.'


def _of_all(main: Interval, times: int) -> str:
    assert main.silence is not None
    back = main.silence.back
    often = f' {times} times, the longest' if times > 1 else ''
    silent = main.of.silent
    if silent is not None and silent.hosts:
        hosts = (silent.hosts[0] if len(silent.hosts) == 1
                 else _names(silent.hosts))
        return (f'everything on host{"s" if len(silent.hosts) > 1 else ""} {hosts} fell silent'
                f'{often} at {clock(main.silence.begin)}: {len(silent.components)} nodes'
                + ('.' if back is None else f'; they came back at {clock(back)}.'))
    return (f'all nodes stopped sending{often} at {clock(main.silence.begin)}.' if back is None
            else f'all nodes fell silent{often} at {clock(main.silence.begin)}, and came back at '
                 f'{clock(back)}.')


def _span(main: Interval) -> str:
    """Return from when to when it was, the time of doubt before the alarm included."""
    begin = main.start if main.began is None else max(main.began, 0.0)
    since = f'from {clock(begin)}' if begin > 0 else 'from the start'
    return f'{since} to {clock(main.end)}' if main.cleared else (
        f'{since} to the end of the recording')


def _often(times: int, span: str) -> str:
    return f'{times} times, the longest {span}' if times > 1 else span


def _back(main: Interval, together: Sequence[str]) -> str:
    first = main.first
    assert first is not None
    backs = [suspect.silence.back for suspect in main.named if suspect.silence is not None
             and suspect.component in (first.component, *together)]
    if not together:
        back = first.silence.back if first.silence is not None else None
        return '' if back is None else f', and came back at {clock(back)}'
    known = [back for back in backs if back is not None]
    if len(known) < len(backs):
        return '' if not known else f'; {len(known)} of {len(backs)} topics came back'
    last = max(known)
    same = last - min(known) <= _SOON_S
    return f', and came back at {clock(last)}' if same else (
        f'; the last came back at {clock(last)}')


def _with_topic(suspect: NamedSuspect) -> str:
    topic = suspect.event_type.split(' ')[-2]
    return (f'{suspect.component} ({topic})' if topic != suspect.component
            else suspect.component)


def _names(names: Sequence[str]) -> str:
    if len(names) > _MOST_NAMED:
        return f'{len(names)} nodes at once ({", ".join(names[:_MOST_NAMED])} and others)'
    return f'{", ".join(names[:-1])} and {names[-1]}'


def _plural(short: str) -> str:
    """Return the words for several: 'sends too often' becomes 'send too often'."""
    verb, _, rest = short.partition(' ')
    plurals = {'sends': 'send', 'answers': 'answer', 'comes': 'come', 'does': 'do', 'is': 'are',
               'was': 'were'}
    return f'{plurals.get(verb, verb)} {rest}'
