"""What happened, in a sentence: who did what, from when to when."""
from __future__ import annotations

from typing import Sequence

from self_awareness import sentence
from self_awareness.reporting.report.intervals import SILENCES, Interval, NamedSuspect

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
    first = main.first
    silence, back = main.silence, ''
    if silence is None and first is not None and _is_its_silence(first):
        silence = first.silence
        back = '' if silence is None else _back(main, together)
    elif silence is not None and silence.back is not None:
        of_hosts = main.of.silent is not None and main.of.silent.hosts
        back = (f'; they came back at {clock(silence.back)}' if of_hosts
                else f', and came back at {clock(silence.back)}')
    begin = silence.begin if silence is not None else (
        main.start if main.began is None else max(main.began, 0.0))
    text = sentence(
        kind=main.of.kind if first is None else first.of.reason.kind,
        components=[] if first is None else [first.component, *together],
        topic='' if first is None else first.what,
        wrong='' if first is None else first.short, reason=_reason(main),
        is_silence=silence is not None, begin=clock(begin) if begin > 0 else '',
        end=clock(main.end) if main.cleared and not main.of.is_told_once else '',
        goes_on='' if main.of.is_told_once else 'the end of the recording',
        back=back, times=times, hosts=[] if main.of.silent is None else main.of.silent.hosts,
        silent=0 if main.of.silent is None else len(main.of.silent.components))
    if main.before_end is not None:
        text = f'{text}, {main.before_end:.1f} s before the recording ended'
    return _as_sentence(text)


def _is_its_silence(first: NamedSuspect) -> bool:
    """Return whether a silence is what happened: not if an answer is missing, nor if it was a
    short one of who is unusual otherwise."""
    is_over = first.silence is not None and first.silence.back is not None
    return not first.of.reason.after and (first.of.reason.kind in SILENCES or not is_over)


def of_another(suspect: NamedSuspect) -> str:
    """Return the sentence on one that fell silent in the alarm of somebody else, whom it does not
    need."""
    silence = suspect.silence
    assert silence is not None
    back = '' if silence.back is None else f', and came back at {clock(silence.back)}'
    return _as_sentence(sentence(
        kind=suspect.of.reason.kind, components=[suspect.component],
        topic=suspect.what, wrong=suspect.short, is_silence=True,
        begin=clock(silence.begin) if silence.begin > 0 else '', back=back))


def _as_sentence(text: str) -> str:
    return f'{text[0].upper()}{text[1:]}.'


def _reason(main: Interval) -> str:
    """Return what is wrong where nobody is to blame, or somebody is there who should not be."""
    if main.of.kind == 'busy machine':
        return main.of.busy or 'the machine was busy'
    is_there = main.first is not None and main.first.of.reason.topics
    shared = main.of.kind in ('new mode', 'two senders', 'slower clock')
    return main.of.reason if shared or is_there else ''


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
