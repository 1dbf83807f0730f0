"""What `top` shows, as lines of a width, each with a style."""
from __future__ import annotations

from typing import Any, List, Tuple

from self_awareness import printable
from self_awareness.live_view.said import LEVELS, STALE_S, Said, is_unknown, level_of

Line = Tuple[str, str]  # a style (one of LEVELS, head, faint, or none) and a text

_MOST_INCIDENTS = 5
_MOST_MUTES = 3
_NAME = 24
_WIDE = 100  # columns, for one column more
_PLAIN = ('heard', 'not heard yet', 'in the graph')  # states that the other columns show, too


def head(said: Said, width: int, paused: bool) -> List[Line]:
    """Return what is said of the whole."""
    if said.heard_at is None:
        return [('head', 'waiting for the monitor ...')]
    verdict = said.verdict
    if said.silent_for > STALE_S:
        lines = [('STALE', cut('STALE  the monitor has not been heard for '
                               f'{said.silent_for:.0f} s; it said: {said.message}', width))]
    elif said.level is None:
        lines = [('head', 'waiting for the monitor on /diagnostics ...')]
    else:
        level = LEVELS[said.level]
        lines = [(level, cut(f'{level}  {said.message}', width))]
    if verdict is not None:
        state = 'paused' if paused else 'settling' if verdict.settling else ''
        limit = 'threshold' if verdict.threshold > 0 else 'limit'
        lines.append(('', cut(f'{100 * said.score:4.0f} % of the {limit}  '
                              f'{said.curve(max(width - 40, 10))}  {state}', width)))
    if said.itself:
        style = LEVELS[said.level_of_itself] if said.level_of_itself else 'faint'
        lines.append((style, cut(f'monitor: {said.itself}', width)))
    if said.told_mode:
        lines.append(('', cut(f'mode: {said.told_mode}', width)))
    known = [each for each in said.listed('components') if not is_unknown(each)]
    heard = sum(each.age >= 0.0 for each in known)
    if heard < len(known):
        lines.append(('', cut(f'{heard} of {len(known)} heard so far', width)))
    for style, title, names in (
            ('faint', 'not watched',
             [f'{each.name} ({each.not_watched})' for each in known if each.not_watched]),
            ('faint', 'watched less now', said.listed('watched_less')),
            ('', 'off together, as is accepted', said.listed('off_together')),
            ('', 'new, not accepted', [' on '.join(filter(None, (each.component, each.topic)))
                                       for each in said.strangers])):
        if names:
            lines.append((style, cut(f'{title}: {", ".join(names)}', width)))
    mutes = said.listed('mutes')
    if len(mutes) > _MOST_MUTES:
        mutes[_MOST_MUTES:] = [f'{len(mutes) - _MOST_MUTES} more']
    return lines + [('WARN', cut(f'muted: {mute}', width)) for mute in mutes]


def incidents(said: Said, width: int) -> List[Line]:
    """Return the last incidents, the newest first; near misses are left out."""
    shown = [each for each in reversed(said.incidents) if each.alarms][:_MOST_INCIDENTS]
    lines = [('head', 'incidents' if shown else 'no incident')]
    return lines + [_incident(each, width) for each in shown]


def component_head(sort: str, pattern: str, width: int) -> Line:
    """Return the head of the table of components."""
    filtered = f', {printable(pattern)}' if pattern else ''
    name = f'component (by {sort}{filtered})'
    return 'head', cut(_row(name, 'events/s', 'age', 'limit', 'found in', 'state', width), width)


def component(of: Any, width: int) -> Line:
    """Return the line of a component (ComponentState): events/s are heard/usual ones."""
    name = of.name if len(of.name) <= _NAME else f'{of.name[:_NAME - 1]}…'
    rate = '-' if is_unknown(of) else f'{of.rate:.1f}'
    if of.usual_rate > 0.0:
        rate += f'/{of.usual_rate:.1f}'
    age = f'{of.age:.1f} s' if of.age >= 0.0 else '-'
    share = f'{100.0 * min(of.share, 9.99):.0f} %' if of.share >= 0.0 else '-'
    level = max(level_of(of), LEVELS.index('WARN') if _is_at_limit(of) else 0)
    style = LEVELS[level] if level else 'faint' if is_unknown(of) else ''
    return style, cut(_row(name, rate, age, share, _found(of), _state_of(of), width), width)


def cut(text: str, width: int) -> str:
    """Return a text that fits, without what controls a terminal: names come from strangers."""
    text = printable(text)
    return text if len(text) <= width else f'{text[:width - 1]}…'


def _row(name: str, rate: str, age: str, share: str, found: str, state: str, width: int) -> str:
    found = f' {found:>10}' if width >= _WIDE else ''
    return f'{name:<{_NAME}} {rate:>11} {age:>7} {share:>5}{found}  {state}'


def _incident(each: Any, width: int) -> Line:
    more = [*each.together, *each.victims, *each.others]
    besides = f'; and {", ".join(more[:2])}' + (' ...' if len(more) > 2 else '') if more else ''
    state = 'unknown' if each.unknown else 'over' if each.over else 'open'
    text = (f'{state}  {each.component or "nobody"} {each.kind}, '
            f'raised {each.alarms} times{besides}  ({each.id})')
    return 'faint' if each.over else 'ERROR', cut(f'  {text}', width)


def _is_at_limit(of: Any) -> bool:
    return bool(of.share >= 1.0)


def _state_of(of: Any) -> str:
    more = []
    if _is_at_limit(of) and level_of(of) < LEVELS.index('ERROR'):
        more.append(f'at {100.0 * of.share:.0f} % of its limit')
    if of.not_watched:
        more.append(f'not watched: {of.not_watched}')
    more = [each for each in more if each not in of.state]
    return '; '.join(more if more and of.state in _PLAIN else [of.state, *more])


def _found(of: Any) -> str:
    """Return by itself and while it is asked, as `9.5/0.6 s`; one where that says all."""
    times = [each for each in (of.found_after, of.found_when_asked) if each >= 0.0]
    if len(times) == 2 and times[1] >= times[0]:
        times.pop()
    return '/'.join(f'{each:.0f}' if each >= 100.0 else f'{each:.1f}' for each in times) + (
        ' s' if times else '-')
