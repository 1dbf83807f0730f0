"""What `top` shows, without a robot and a terminal."""
from __future__ import annotations

import math
import re
from types import SimpleNamespace
from typing import Any, Dict, List, Tuple

import pytest

from self_awareness.live_view import lines
from self_awareness.live_view.said import SORTS, Said


def status(name: str, level: int = 0, message: str = 'heard', **values: str) -> Any:
    return SimpleNamespace(name=name, level=level, message=message, values=[
        SimpleNamespace(key=key, value=value) for key, value in values.items()])


def of_component(name: str, level: int, rate: str, age: str) -> Any:
    return status(f'watch: {name}', level, 'heard' if level == 0 else '/t: silent for 1.2 s', **{
        'events a second': rate, 'last heard [s ago]': age, 'death found after [s]': '0.4',
        'share of limit': '7 %', '/t': f'{rate} of 10 Hz', '/u': '5 of 2.5 Hz'})


class Clock:
    """A steady clock that a test sets."""

    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        return self.now


def diagnostics(*statuses: Any) -> Any:
    return SimpleNamespace(status=list(statuses))


def verdict(score: float, threshold: float = -1.0, settling: bool = False) -> Any:
    return SimpleNamespace(score=score, threshold=threshold, settling=settling, level=0, alarm=0,
                           component='', kind='', suspects=[])


def stands(alarm: int, component: str, kind: str, *suspects: Tuple[str, str]) -> Any:
    of = verdict(-2.0)
    of.level, of.alarm, of.component, of.kind = 2, alarm, component, kind
    of.suspects = [SimpleNamespace(component=name, kind=what) for name, what in suspects]
    return of


def incident(component: str, alarms: int = 1, over: bool = False, **lists: List[str]) -> Any:
    return SimpleNamespace(**{**dict(
        id=7, component=component, kind='died', alarms=alarms, over=over, unknown=False,
        together=[], victims=[], others=[]), **lists})


@pytest.fixture()
def said() -> Said:
    of = Said('/watch')
    of.on_status(verdict(-0.5))
    of.on_diagnostics(SimpleNamespace(status=[
        status('watch: communication', 2, 'abnormal communication', **{
            'not watched': '/rare',
            'not accepted, events so far': '/rostopic on /cmd_vel: 12, /joystick on /joy: 3'}),
        status('watch: monitor', 0, 'listening', **{
            'events a second': '120', 'share of a core spent': '0.02',
            'mute 1': '/noisy until 2026-11-23 15:00:00 UTC, by /rqt'}),
        of_component('/base', 0, '10.02', '0.05'), of_component('/player', 2, '0', '3.1'),
        of_component('/camera', 1, '29.5', '0.4'),
        status('watch: /rare', 0, 'heard', **{
            'events a second': '0', 'last heard [s ago]': '90', 'death found after [s]':
            'not watched', 'why not watched': 'too few messages in training: 7 gaps'}),
        status('another: /laser', 2, 'of another monitor')]))
    of.on_incidents(SimpleNamespace(incidents=[
        incident('/old', over=True), incident('/quiet', alarms=0),
        incident('/player', 7, victims=['/slam', '/navigation', '/speech'])]))
    return of


def test_components_are_sorted_and_filtered(said: Said) -> None:
    def names(sort: str, pattern: str = '') -> List[str]:
        return [each.name for each in said.components(sort, pattern)]

    assert names('level') == ['/player', '/camera', '/base', '/rare'], 'the worst first'
    assert names('name') == ['/base', '/camera', '/player', '/rare']
    assert names('rate') == ['/camera', '/base', '/player', '/rare']
    assert names('age') == ['/rare', '/player', '/camera', '/base']
    assert names('limit') == ['/base', '/camera', '/player', '/rare']
    assert names('name', 'a*r') == [] and names('name', '/c*a') == ['/camera']
    assert names('name', 'as') == ['/base']
    assert {each for sort in SORTS for each in names(sort)} == {
        '/base', '/camera', '/player', '/rare'}


def test_it_shows_how_soon_a_death_is_found_also_while_it_is_needed() -> None:
    def found(text: str) -> str:
        of = Said('/watch')
        of.on_diagnostics(diagnostics(status('watch: /a', 0, 'heard', **{
            'death found after [s]': text})))
        row = lines.component(of.components('name', '')[0], 120)[1]
        return row.rpartition('  heard')[0][-10:]

    assert found('0.4').strip() == '0.4 s'
    assert found('9.5, 0.6 while it is needed').strip() == '9.5/0.6 s'
    assert found('1200, 0.6 while it is needed') == '1200/0.6 s'
    assert found('0.61 while it is needed').strip() == '0.6 s'
    assert found('not watched: accepted') == 'not watche'


@pytest.mark.parametrize('key, told', [
    ('off together, as is accepted', '/arm, /base'),
    ('delays not watched now', '/b on /y after /a on /x')])
def test_it_shows_who_is_not_judged_as_usual(key: str, told: str) -> None:
    def shown(values: Dict[str, str]) -> List[str]:
        of = Said('/watch')
        of.on_diagnostics(diagnostics(status('watch: communication', 0, 'normal', **values)))
        return [line for _, line in lines.head(of, 80, False) if key in line]

    assert shown({key: told}) == [f'{key}: {told}']
    assert shown({}) == []


def test_it_shows_the_mode_that_the_robot_tells() -> None:
    def shown(values: Dict[str, str]) -> List[str]:
        of = Said('/watch')
        of.on_diagnostics(diagnostics(status('watch: monitor', 0, 'listening', **values)))
        return [line for _, line in lines.head(of, 40, False) if line.startswith('mode: ')]

    assert shown({'mode': 'DRIVING (/state), for 42 s'}) == ['mode: DRIVING (/state), for 42 s']
    assert shown({'mode': 'LO\x1bST (/state), for 42 s, not seen in training'}) == [
        'mode: LO\ufffdST (/state), for 42 s, not see…']
    assert shown({}) == []


def test_nothing_is_green_that_nobody_has_said() -> None:
    of = Said('/watch')
    of.on_status(verdict(-0.5))
    assert lines.head(of, 80, False)[0] == ('head', 'waiting for the monitor on /diagnostics ...')
    of.on_diagnostics(diagnostics(status('watch: communication', 0, 'normal')))
    assert lines.head(of, 80, False)[0] == ('OK', 'OK  normal')


@pytest.mark.parametrize('level, style', [(0, 'faint'), (1, 'WARN'), (2, 'ERROR')])
def test_what_the_monitor_says_of_itself_has_its_level(level: int, style: str) -> None:
    of = Said('/watch')
    of.on_diagnostics(diagnostics(status('watch: monitor', level, 'messages dropped')))
    assert [each for each, text in lines.head(of, 80, False)
            if text.startswith('monitor: messages dropped')] == [style]


def test_no_name_is_a_pattern() -> None:
    of = Said('/watch')
    of.on_diagnostics(diagnostics(status('watch: communication', 1, '', **{
        'not accepted, events so far': '/a on /b: 1, /x: 1, /* on /*: 1, /y on /z: 3, ...'})))
    assert of.strangers == [('/a', '/b'), ('', '/x'), ('/y', '/z')]


def test_whatever_a_stranger_publishes_it_goes_on() -> None:
    of = Said('/watch')
    of.on_diagnostics(diagnostics(
        status('watch: communication', 7), status('watch: monitor', 9, **{'further mute': 'inf'}),
        status('watch: /a', -56, **{'/t': '- of - Hz'})))
    found, = of.components('level', '')
    assert found.rate is None and lines.component(found, 80)[0] == 'STALE'
    assert lines.head(of, 80, False)[0][0] == 'STALE'


def test_who_was_never_heard_comes_first_by_age() -> None:
    of = Said('/watch')
    of.on_diagnostics(SimpleNamespace(status=[of_component('/a', 0, '1', '9'),
                                              status('watch: /b', message='not heard yet')]))
    first, second = of.components('age', '')
    assert (first.name, first.age, second.age) == ('/b', None, 9.0)


def test_the_curve_is_in_units_of_the_limit(said: Said) -> None:
    of = Said('/watch')
    for score in (0.0, -0.5, -1.0, -7.0, math.nan):
        of.on_status(verdict(score))
    of.on_status(verdict(math.nan, math.nan))
    assert of.curve(10) == '▁▄██▁▁' and of.curve(2) == '▁▁'
    assert said.score == pytest.approx(0.5)
    assert any(text.startswith('  50 % of the limit  ')
               for _, text in lines.head(said, 80, False))


def test_all_is_in_80_columns(said: Said) -> None:
    shown = [*lines.head(said, 80, False), *lines.incidents(said, 80),
             lines.component_head('level', '', 80),
             *(lines.component(each, 80) for each in said.components('level', ''))]
    texts = [text for _, text in shown]
    assert max(map(len, texts)) <= 80
    page = '\n'.join(texts)
    assert said.strangers == [('/rostopic', '/cmd_vel'), ('/joystick', '/joy')]
    for text in ('ERROR  abnormal communication',
                 'not watched: /rare (too few messages in training: 7 gaps)',
                 'new, not accepted: /rostopic on /cmd_vel, /joystick on /joy',
                 'muted: /noisy until',
                 'open  /player died, raised 7 times; and /slam, /navigation ...',
                 'over  /old died', 'listening; 120 events/s, 0.02 cores'):
        assert text in page
    assert '/quiet' not in page and '/laser' not in page
    rows = [re.sub(' +', ' ', text) for text in texts]
    assert '/base 15.0/12.5 0.1 s 7 % heard' in rows
    assert [each for each in rows if each.startswith('/rare 0.0 90.0 s - not watched: too few')]
    assert ('ERROR', 'WARN') == tuple(style for style, text in shown
                                      if text.startswith(('/player ', '/camera ')))


def test_what_stands_is_what_the_verdict_says(said: Said) -> None:
    assert said.level == 2 and said.standing == 0 and said.deaths == []
    said.on_status(stands(7, '/player', 'died', ('/player', 'died'), ('/base', 'late'),
                          ('/slam', 'never came')))
    assert said.standing == 7 and said.deaths == ['/player', '/slam']
    said.on_status(stands(8, '/player', 'slow', ('/player', 'slow')))
    assert said.standing == 8 and said.deaths == []
    over = stands(8, '/player', 'died')
    over.level = 0
    said.on_status(over)
    assert said.standing == 0 and said.deaths == [], 'it ended with this window'


def test_names_do_not_control_the_terminal(said: Said) -> None:
    said.on_diagnostics(SimpleNamespace(status=[of_component('/\x1b[2J', 0, '1', '1')]))
    assert not [each for each in said.components('name', '')
                if '\x1b' in lines.component(each, 80)[1]]


def test_before_the_first_word() -> None:
    (style, text), = lines.head(Said('/watch'), 80, False)
    assert text.startswith('waiting for the monitor')
    assert lines.incidents(Said('/watch'), 80) == [('head', 'no incident')]


def test_a_monitor_that_is_silent_is_stale() -> None:
    clock = Clock()
    of = Said('/watch', clock)
    assert lines.head(of, 80, False) == [('head', 'waiting for the monitor ...')]
    clock.now += 60
    assert of.silent_for == 0.0, 'it was never heard'
    of.on_diagnostics(diagnostics(status('watch: communication', message='normal communication')))
    clock.now += 4.9
    assert lines.head(of, 80, False)[0] == ('OK', 'OK  normal communication')
    of.on_diagnostics(diagnostics(status('another: communication')))
    clock.now += 1.1
    style, text = lines.head(of, 80, False)[0]
    assert style == 'STALE'
    assert text.startswith('STALE  the monitor has not been heard for 6 s; it said: normal')
    of.on_status(verdict(-0.5))
    assert lines.head(of, 80, False)[0][0] == 'OK'


def test_components_of_a_model_that_was_replaced_go() -> None:
    clock = Clock()
    of = Said('/watch', clock)

    def names() -> List[str]:
        return [each.name for each in of.components('name', '')]

    def whole(model: str) -> Any:
        return status('watch: communication', model=model)

    of.on_diagnostics(diagnostics(whole('a'), of_component('/a', 0, '1', '1'),
                                  of_component('/b', 0, '1', '1')))
    of.on_diagnostics(diagnostics(whole('a'), of_component('/b', 0, '1', '1')))
    assert names() == ['/a', '/b'], 'they take turns'
    of.on_diagnostics(diagnostics(whole('b'), of_component('/b', 0, '1', '1'),
                                  of_component('/c', 0, '1', '1')))
    assert names() == ['/b', '/c']
    clock.now += 61
    of.on_diagnostics(diagnostics(whole('b'), of_component('/c', 0, '1', '1')))
    shown = lines.component(of.components('name', '')[0], 80)
    assert shown[0] == 'STALE' and 'not told for 61 s' in shown[1]
    clock.now += 60
    of.on_diagnostics(diagnostics(whole('b'), of_component('/c', 0, '1', '1')))
    assert names() == ['/c']


def test_lists_that_are_only_counted_for_some_seconds_stay() -> None:
    of = Said('/watch')

    def say(strangers: str, *mutes: str, further: int = 0) -> None:
        told: Dict[str, Any] = {f'mute {i + 1}': mute for i, mute in enumerate(mutes)}
        new: Dict[str, Any] = {'not accepted, events so far': strangers}
        if further:
            told['further mute'] = str(further)
        of.on_diagnostics(diagnostics(
            status('watch: communication', **new), status('watch: monitor', **told)))

    say('2, listed every 20 s', '/a', further=1)
    assert of.strangers == [] and of.mutes == ['/a'] and of.number_of_mutes == 2
    say('/x on /y: 3, /z on /u: 4', '/a', '/b')
    say('2, listed every 20 s', '/a', further=1)
    assert of.strangers == [('/x', '/y'), ('/z', '/u')]
    assert of.mutes == ['/a', '/b']
    assert ('WARN', 'muted: /b') in lines.head(of, 80, False)
    say('', '/a')
    assert of.strangers == [] and of.mutes == ['/a']
    say('', *'abcde', further=10)
    assert lines.head(of, 80, False)[-1] == ('WARN', 'muted: 12 more')
