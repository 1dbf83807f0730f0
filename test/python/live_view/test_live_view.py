"""What `top` shows, without a robot and a terminal."""
from __future__ import annotations

import math
import re
from typing import Any, Dict, List, Tuple

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from told import of_component, stands, stranger

from self_awareness.live_view import lines
from self_awareness.live_view.said import SORTS, Said
from self_awareness.msg import ComponentState, Components, Incident, Incidents, SelfAwareness


def status(name: str, level: int = 0, message: str = 'heard', **values: str) -> DiagnosticStatus:
    return DiagnosticStatus(name=name, level=level, message=message, values=[
        KeyValue(key, value) for key, value in values.items()])


def in_graph(name: str, why: str) -> ComponentState:
    return of_component(name, state='in the graph', rate=0.0, usual_rate=0.0, age=-1.0, share=-1.0,
                        found_after=-1.0, not_watched=why)


def components(*of: ComponentState, **lists: Any) -> Components:
    return Components(components=of, **lists)


def row(of: Any, width: int = 200) -> Tuple[str, str]:
    style, text = lines.component(of, width)
    return style, re.sub(' +', ' ', text)


def heads(*of: Any, **lists: Any) -> List[Tuple[str, str]]:
    said = Said('/watch')
    said.on_components(components(*of, **lists))
    return lines.head(said, 80, False)[1:]


def diagnostics(*statuses: DiagnosticStatus) -> DiagnosticArray:
    return DiagnosticArray(status=statuses)


def verdict(score: float, threshold: float = -1.0) -> SelfAwareness:
    return SelfAwareness(score=score, threshold=threshold)


def incident(component: str, alarms: int = 1, **fields: Any) -> Incident:
    return Incident(id=7, component=component, kind='silent', alarms=alarms, **fields)


@pytest.fixture()
def said() -> Said:
    of = Said('/watch')
    of.on_status(verdict(-0.5))
    of.on_diagnostics(diagnostics(
        status('watch: communication', 2, 'abnormal communication'),
        status('watch: monitor', 0, 'listening', **{
            'events a second': '120', 'share of a core spent': '0.02'}),
        status('another: monitor', 2, 'of another monitor')))
    of.on_components(components(
        of_component('/base', rate=15.0, age=0.05),
        of_component('/camera', 1, '/t: silent for 1.2 s', rate=34.5, age=0.4),
        in_graph('/a_tool', 'it publishes nothing'),
        of_component('/player', 2, '/t: died', rate=0.0, age=3.1, share=2.3),
        of_component('/rare', rate=0.0, usual_rate=0.0, age=90.0, share=-1.0, found_after=-1.0,
                     not_watched='too few messages in training: 7 gaps'),
        strangers=[stranger('/rostopic', '/cmd_vel'), stranger('', '/joy')],
        mutes=['/noisy until 2026-11-23 15:00:00 UTC, by /rqt']))
    of.on_incidents(Incidents(incidents=[
        incident('/old', over=True), incident('/quiet', alarms=0),
        incident('/player', 7, victims=['/slam', '/navigation', '/speech'])]))
    return of


def test_components_are_sorted_and_filtered(said: Said) -> None:
    def names(sort: str, pattern: str = '') -> List[str]:
        return [each.name for each in said.components(sort, pattern)]

    assert names('level') == ['/player', '/camera', '/base', '/rare', '/a_tool'], 'the worst first'
    assert names('name') == ['/base', '/camera', '/player', '/rare', '/a_tool']
    assert names('rate') == ['/camera', '/base', '/player', '/rare', '/a_tool']
    assert names('age') == ['/rare', '/player', '/camera', '/base', '/a_tool']
    assert names('limit') == ['/player', '/base', '/camera', '/rare', '/a_tool']
    assert names('name', 'a*r') == [] and names('name', '/c*a') == ['/camera']
    assert names('name', 'as') == ['/base']
    assert {each for sort in SORTS for each in names(sort)} == {
        '/base', '/camera', '/player', '/rare', '/a_tool'}


@pytest.mark.parametrize('by_itself, asked, shown', [
    (0.4, -1.0, '0.4 s'), (9.5, 0.6, '9.5/0.6 s'), (1200.0, 0.6, '1200/0.6 s'),
    (-1.0, 0.61, '0.6 s'), (0.4, 2.0, '0.4 s'), (-1.0, -1.0, '-')])
def test_it_shows_how_soon_a_death_is_found_also_when_it_is_asked(
        by_itself: float, asked: float, shown: str) -> None:
    found = of_component('/a', found_after=by_itself, found_when_asked=asked)
    assert row(found) == ('', f'/a 10.0/12.5 0.1 s 7 % {shown} heard')
    assert row(found, 99) == ('', '/a 10.0/12.5 0.1 s 7 % heard'), 'it needs 100 columns'


@pytest.mark.parametrize('key, lists', [
    ('off together, as is accepted', {'off_together': ['/arm', '/base']}),
    ('watched less now', {'watched_less': ['/arm', '/base']}),
    ('new, not accepted', {'strangers': [stranger('', '/arm'), stranger('/base', '')]}),
    ('muted', {'mutes': ['/arm, /base']})])
def test_it_shows_who_is_not_judged_as_usual(key: str, lists: Dict[str, Any]) -> None:
    assert [text for _, text in heads(**lists)] == [f'{key}: /arm, /base']
    assert heads() == []


@pytest.mark.parametrize('level, share, state, style, shown', [
    (0, 0.99, 'heard', '', 'heard'),
    (0, 1.0, 'heard', 'WARN', 'at 100 % of its limit'),
    (0, 2.3, 'muted: died', 'WARN', 'muted: died; at 230 % of its limit'),
    (1, 12.0, '/t: late', 'WARN', '/t: late; at 1200 % of its limit'),
    (2, 2.3, '/t: died', 'ERROR', '/t: died'),
    (2, 0.1, '/t: died', 'ERROR', '/t: died')])
def test_who_is_at_its_limit_is_not_heard_as_ever(level: int, share: float, state: str,
                                                  style: str, shown: str) -> None:
    of = of_component('/a', level, state, share=share)
    percent = f'{100 * min(share, 9.99):.0f} %'
    assert row(of) == (style, f'/a 10.0/12.5 0.1 s {percent} 0.4 s {shown}')


def test_it_counts_who_is_heard_so_far_until_all_are() -> None:
    first, tool = of_component('/a'), in_graph('/tool', 'it publishes nothing')
    late = of_component('/late', state='not heard yet', age=-1.0)
    rare = of_component('/rare', state='not heard yet', age=-1.0, usual_rate=0.0,
                        not_watched='too few')
    assert heads(first, late, rare, tool)[0] == ('', '1 of 3 heard so far')
    assert heads(first, tool) == [], 'a node that the model does not know is not waited for'


def test_who_is_not_watched_comes_with_the_reason() -> None:
    rare = of_component('/rare', not_watched='too few')
    assert row(rare)[1].endswith(' 0.4 s not watched: too few')
    accepted = of_component('/a', state='heard; not watched: accepted', not_watched='accepted')
    assert row(accepted)[1].endswith(' 0.4 s heard; not watched: accepted')
    tool = in_graph('/a_tool', 'it publishes nothing')
    assert row(tool) == ('faint', '/a_tool - - - - not watched: it publishes nothing')
    assert heads(rare, tool) == [('faint', 'not watched: /rare (too few)')], 'of the model'


@pytest.mark.parametrize('values, shown', [
    ({'mode': 'DRIVING (/state), for 42 s'}, ['mode: DRIVING (/state), for 42 s']),
    ({'mode': 'LO\x1bST (/state), for 42 s, not seen in training'}, [
        'mode: LO\ufffdST (/state), for 42 s, not see…']),
    ({}, [])])
def test_it_shows_the_mode_that_the_robot_tells(values: Dict[str, str],
                                                shown: List[str]) -> None:
    of = Said('/watch')
    of.on_diagnostics(diagnostics(status('watch: monitor', 0, 'listening', **values)))
    assert [line for _, line in lines.head(of, 40, False) if line.startswith('mode: ')] == shown


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
    of.on_components(components(strangers=[
        stranger('/a', '/b'), stranger('', '/x'), stranger('/*', '/*'), stranger('/y', '/z*')]))
    assert of.strangers == [stranger('/a', '/b'), stranger('', '/x')]


def test_whatever_a_stranger_publishes_it_goes_on() -> None:
    of = Said('/watch')
    of.on_diagnostics(diagnostics(
        status('watch: communication', 7), status('watch: monitor', -56)))
    of.on_components(components(of_component('/a', 200, share=math.nan, rate=math.inf,
                                             age=math.nan)))
    found, = of.components('limit', '')
    assert lines.component(found, 80)[0] == 'STALE'
    assert lines.head(of, 80, False)[0][0] == 'STALE'


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
    for text in ('ERROR  abnormal communication',
                 'not watched: /rare (too few messages in training: 7 gaps)',
                 'new, not accepted: /rostopic on /cmd_vel, /joy',
                 'muted: /noisy until',
                 'open  /player silent, raised 7 times; and /slam, /navigation ...',
                 'over  /old silent', 'listening; 120 events/s, 0.02 cores'):
        assert text in page
    assert '/quiet' not in page and 'another' not in page
    rows = [re.sub(' +', ' ', text) for text in texts]
    assert '/base 15.0/12.5 0.1 s 7 % heard' in rows
    assert rows[-1] == '/a_tool - - - not watched: it publishes n…'
    assert [each for each in rows if each.startswith('/rare 0.0 90.0 s - not watched: too few')]
    assert ('ERROR', 'WARN') == tuple(style for style, text in shown
                                      if text.startswith(('/player ', '/camera ')))


def test_what_stands_is_what_the_verdict_says(said: Said) -> None:
    assert said.level == 2 and said.standing == 0 and said.deaths == []
    said.on_status(stands(7, '/player', 'silent', ('/player', 'silent'), ('/base', 'late'),
                          ('/slam', 'never came')))
    assert said.standing == 7 and said.deaths == ['/player', '/slam']
    said.on_status(stands(8, '/player', 'slow', ('/player', 'slow')))
    assert said.standing == 8 and said.deaths == []
    said.on_status(stands(8, '/player', 'silent', level=0))
    assert said.standing == 0 and said.deaths == [], 'it ended with this window'


def test_names_do_not_control_the_terminal(said: Said) -> None:
    said.on_components(components(of_component('/\x1b[2J', state='\x1b[2J'), mutes=['\x1b[2J']))
    assert not [text for _, text in lines.head(said, 80, False) if '\x1b' in text]
    assert not [each for each in said.components('name', '')
                if '\x1b' in lines.component(each, 80)[1]]


def test_a_monitor_that_is_silent_is_stale() -> None:
    now = 100.0
    of = Said('/watch', lambda: now)
    assert lines.head(of, 80, False) == [('head', 'waiting for the monitor ...')]
    assert lines.incidents(of, 80) == [('head', 'no incident')]
    now += 60
    assert of.silent_for == 0.0, 'it was never heard'
    of.on_diagnostics(diagnostics(status('watch: communication', message='normal communication')))
    now += 4.9
    assert lines.head(of, 80, False)[0] == ('OK', 'OK  normal communication')
    of.on_diagnostics(diagnostics(status('another: communication')))
    now += 1.1
    style, text = lines.head(of, 80, False)[0]
    assert style == 'STALE'
    assert text.startswith('STALE  the monitor has not been heard for 6 s; it said: normal')
    of.on_status(verdict(-0.5))
    assert lines.head(of, 80, False)[0][0] == 'OK'


def test_of_many_mutes_the_first_are_shown() -> None:
    assert heads(mutes=list('abc'))[-1] == ('WARN', 'muted: c')
    assert heads(mutes=list('abcde'))[-2:] == [('WARN', 'muted: c'), ('WARN', 'muted: 2 more')]
