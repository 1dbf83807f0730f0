"""What `top` shows, as lines of a width, each with a style."""
from __future__ import annotations

from typing import Any, List, Optional, Tuple

from self_awareness import printable
from self_awareness.live_view.said import LEVELS, STALE_S, Component, Said

Line = Tuple[str, str]
"""A style (one of LEVELS, head, faint, or none) and a text."""

_MOST_INCIDENTS = 5
_MOST_MUTES = 3
_NAME = 24
_WIDE = 100  # columns, for one column more


def head(said: Said, width: int, paused: bool) -> List[Line]:
    """Return what is said of the whole."""
    if not said.heard:
        return [('head', 'waiting for the monitor ...')]
    verdict = said.verdict
    level = LEVELS[said.level]
    lines = [(level, cut(f'{level}  {said.message}', width)) if said.told
             else ('head', 'waiting for the monitor on /diagnostics ...')]
    if said.silent_for > STALE_S:
        lines = [('STALE', cut('STALE  the monitor has not been heard for '
                               f'{said.silent_for:.0f} s; it said: {said.message}', width))]
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
    if said.not_watched:
        lines.append(('faint', cut(f'not watched: {said.not_watched}', width)))
    if said.disarmed:
        lines.append(('faint', cut(f'delays not watched now: {said.disarmed}', width)))
    if said.mode:
        lines.append(('', cut(f'off together, as is accepted: {said.mode}', width)))
    if said.strangers:
        new = ', '.join(f'{source} on {topic}' for source, topic in said.strangers)
        lines.append(('', cut(f'new, not accepted: {new}', width)))
    shown = said.mutes[:_MOST_MUTES]
    lines += [('WARN', cut(f'muted: {mute}', width)) for mute in shown]
    if said.number_of_mutes > len(shown):
        lines.append(('WARN', f'muted: {said.number_of_mutes - len(shown)} more'))
    return lines


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


def component(of: Component, width: int) -> Line:
    """Return the line of a component: events/s are those heard of those expected."""
    name = of.name if len(of.name) <= _NAME else f'{of.name[:_NAME - 1]}…'
    rate = _shown(of.rate) + ('' if of.expected is None else f'/{_shown(of.expected)}')
    share = '-' if of.share is None else f'{100 * min(of.share, 9.99):.0f} %'
    state = of.message
    if of.not_watched:
        state = f'not watched: {of.not_watched}' if of.level == 0 else (
            f'{of.message}; not watched: {of.not_watched}')
    return (LEVELS[of.level] if of.level else '', cut(_row(
        name, rate, _shown(of.age, ' s'), share, _found(of.found_after), state, width), width))


def cut(text: str, width: int) -> str:
    """Return a text that fits, without what controls a terminal: names come from strangers."""
    text = printable(text)
    return text if len(text) <= width else f'{text[:width - 1]}…'


def _row(name: str, rate: str, age: str, share: str, found: str, state: str, width: int) -> str:
    found = f' {found:>10}' if width >= _WIDE else ''
    return f'{name:<{_NAME}} {rate:>11} {age:>7} {share:>5}{found}  {state}'


def _state(incident: Any) -> str:
    return 'unknown' if incident.unknown else 'over' if incident.over else 'open'


def _incident(each: Any, width: int) -> Line:
    more = [*each.together, *each.victims, *each.others]
    besides = f'; and {", ".join(more[:2])}' + (' ...' if len(more) > 2 else '') if more else ''
    text = (f'{_state(each)}  {each.component or "nobody"} {each.kind}, '
            f'raised {each.alarms} times{besides}  ({each.id})')
    return 'faint' if each.over else 'ERROR', cut(f'  {text}', width)


def _shown(value: Optional[float], unit: str = '') -> str:
    return '-' if value is None else f'{value:.1f}{unit}'


def _found(text: str) -> str:
    """Return by itself and while it is needed, as `9.5/0.6 s`; one if only that is known."""
    try:
        times = [float(each.partition(' ')[0]) for each in text.split(', ')]
    except ValueError:
        return text[:10] or '-'
    return '/'.join(f'{each:.0f}' if each >= 100.0 else f'{each:.1f}' for each in times) + ' s'
