"""What the report takes for one incident, and the sentence about it."""
from __future__ import annotations

import json
import re
from pathlib import Path
from types import SimpleNamespace
from typing import Any, Callable, List, Optional, Sequence

from judged_recordings import without_laser

from self_awareness.commands import convert, score
from self_awareness.reporting.report.headline import headline
from self_awareness.reporting.report.incidents import Incident, incidents
from self_awareness.reporting.report.intervals import (ALARM, SUSPICION, Interval, NamedSuspect,
                                                       Silence)
from self_awareness.training.robot_graph import RobotGraph, graph_file


def suspect(component: str, short: str = 'fell silent', silence: Optional[Silence] = None,
            kind: str = 'silent', **reason: Any) -> NamedSuspect:
    of: Any = SimpleNamespace(topic='/t', value='', onset=0, abnormal=True,
                              reason=SimpleNamespace(kind=kind, after='', topics=[], **reason))
    return NamedSuspect(component, f'{component} /t x/Y', short, 0.0, silence, of)


def interval(start: float, end: float, suspects: Sequence[NamedSuspect] = (), level: str = ALARM,
             cleared: bool = True, kind: str = 'silent', busy: Optional[str] = None,
             silence: Optional[Silence] = None, reason: str = '') -> Interval:
    of: Any = SimpleNamespace(culprit=suspects[0].component if suspects else '', kind=kind,
                              silent=None, reason=reason, waiting='', busy=busy,
                              is_told_once=False)
    return Interval(of, level, start, end, '', cleared, None, '200 % of the limit', 'overdue',
                    silence, list(suspects), [])


def found(*listed: Interval, graph: Any = (), path: str = 'x.bag') -> List[Incident]:
    of: Any = SimpleNamespace(by=SimpleNamespace(trained=SimpleNamespace(graph=set(graph))),
                              recording=SimpleNamespace(part=SimpleNamespace(path=path)))
    return incidents(of, listed, 'x')


def test_a_flight_record_begins_with_the_alarm_that_it_was_written_for() -> None:
    listed = [interval(1.0, 99.0, [suspect('/older')]), interval(290.0, 300.0, [suspect('/a')]),
              interval(299.0, 300.0, [suspect('/c')], SUSPICION)]
    assert [each.cause for each in found(
        *listed, path='recorder/alarm_2026-11-22-05-10-33.123.bag')] == ['/a', '/older', '/c']
    assert found(*listed, path='recorder/dump_2026-11-22-05-10-33.123.bag')[0].cause == '/older'


def test_several_that_fail_at_once_are_in_the_headline() -> None:
    silent = [suspect(name, silence=Silence(28.0 + 0.1 * i, 36.1))
              for i, name in enumerate(('/a', '/b', '/c'))]
    later = suspect('/d', silence=Silence(33.0, 36.0))
    incident, = found(interval(28.7, 40.0, [*silent, later]))
    assert incident.together == ['/b', '/c'] and incident.others == ['/d']
    assert incident.victims == [], 'nobody knows of whom'
    assert incident.headline == '/a, /b and /c fell silent at 28.0 s, and came back at 36.1 s.'
    # Who needs the messages of the cause is its victim.
    incident, = found(interval(28.7, 40.0, silent), graph=[('/a', '/t', '/b'), ('/b', '/u', '/c')])
    assert incident.together == [] and incident.others == []
    assert incident.victims == ['/b', '/c']
    assert incident.headline == '/a (/t) fell silent at 28.0 s, and came back at 36.1 s.'


def test_a_victim_that_stays_silent_is_told_beside_a_cause_that_is_back() -> None:
    graph = [('/a', '/t', '/b'), ('/b', '/u', '/c')]
    named = [suspect('/a', silence=Silence(28.0, 36.0)),
             suspect('/b', silence=Silence(28.1, 36.1)),
             suspect('/c', 'stopped sending', Silence(28.2, None))]
    incident, = found(interval(28.7, 60.0, named, cleared=False), graph=graph)
    assert incident.victims == ['/b', '/c']
    assert incident.further == ['/c (/t) stopped sending at 28.2 s.']
    named[0] = suspect('/a', 'stopped sending', Silence(28.0, None))
    incident, = found(interval(28.7, 60.0, named, cleared=False), graph=graph)
    assert incident.further == [], 'it waits'


def test_others_that_are_to_blame_for_a_suspicion_of_their_own_are_told() -> None:
    hang = suspect('/a', silence=Silence(28.0, 36.0))
    incident, = found(
        interval(28.7, 38.0, [hang, suspect('/b', kind='slow')]),
        interval(40.0, 52.0, [suspect('/b', 'sends too seldom', kind='slow')], SUSPICION),
        interval(53.0, 70.0, [suspect('/b', 'sends too seldom', kind='slow')], SUSPICION))
    assert incident.others == ['/b'] and incident.cause == '/a'
    assert incident.further == [
        '/b (/t) sends too seldom 2 times, the longest from 53.0 s to 70.0 s.']


def test_who_is_slow_did_not_only_fall_silent_for_a_moment() -> None:
    slow = [suspect('/a', 'sends too seldom', Silence(20.0, 20.5), kind='slow')]
    assert headline(interval(8.5, 30.0, slow), [], 1) == (
        '/a (/t) sends too seldom from 8.5 s to 30.0 s.')
    dies = [suspect('/a', 'stopped sending', Silence(20.0, None), kind='slow')]
    assert headline(interval(8.5, 30.0, dies), [], 1) == '/a (/t) stopped sending at 20.0 s.'


def test_only_who_did_not_come_back_has_stopped() -> None:
    gone = [suspect(name, 'stopped sending', Silence(8.0, None)) for name in ('/a', '/b')]
    assert headline(interval(8.5, 20.0, gone, cleared=False), [], 1) == (
        '/a (/t) stopped sending at 8.0 s.')
    assert headline(interval(8.5, 20.0, gone), ['/b'], 1) == (
        '/a and /b stopped sending at 8.0 s.')
    four = [suspect(f'/{name}', silence=Silence(8.0, 10.0 + 2 * i))
            for i, name in enumerate('abcd')]
    assert headline(interval(8.5, 20.0, four), ['/b', '/c', '/d'], 1) == (
        '4 nodes at once (/a, /b, /c and others) fell silent at 8.0 s; the last came back at '
        '16.0 s.')


def test_where_nobody_is_to_blame_the_kind_of_the_verdict_is_told() -> None:
    """The first suspect of a busy machine is not its cause."""
    busy = interval(3.0, 9.0, kind='busy machine',
                    busy='the machine may be busy: 12 of 26 are late')
    assert found(busy)[0].headline == (
        'The machine may be busy: 12 of 26 are late, from 3.0 s to 9.0 s.')
    silent = interval(3.0, 9.0, kind='all silent', silence=Silence(2.8, 7.0))
    assert found(silent)[0].headline == 'All nodes fell silent at 2.8 s, and came back at 7.0 s.'
    mode = interval(3.0, 9.0, level=SUSPICION, kind='new mode', reason=(
        '/a, /b, /c and 2 more stopped together, and others go on: a mode'))
    assert found(mode)[0].headline == (
        '/a, /b, /c and 2 more stopped together, and others go on: a mode, from 3.0 s to 9.0 s.')
    assert 'no suspect stands out' in found(interval(3.0, 9.0))[0].headline
    assert len(found(busy, interval(300.0, 310.0, kind='busy machine', busy='x'), silent)) == 2


def test_a_computer_that_fell_silent_is_the_finding(evidence_model: str, tmp_path: Path,
                                                    make_bag: Callable[..., str],
                                                    capsys) -> None:
    """An event log says on which computers nodes ran; the model need not know them."""
    bag, values = make_bag('base.bag', without_laser(3000.0, 40.0)), tmp_path / 'v.json'
    RobotGraph({'/scan': {'/laser'}}, {'/scan': {'/slam'}}, {
        '/laser': 'base', '/slam': 'base', '/battery': 'laptop'}).save(graph_file(bag))
    log, report = str(tmp_path / 'log.bag'), tmp_path / 'r.html'
    assert convert.main([bag, '-o', log]) == 0
    assert score.main([log, '--model', evidence_model, '--json', str(values),
                       '--report', str(report)]) == 0
    recording, = json.loads(values.read_text())['recordings']
    alarm = next(each for each in recording['alarms'] if each['level'] == 'ERROR')
    assert (alarm['kind'], alarm['culprit']) == ('all silent', None)
    assert alarm['reason'] == 'everything on host base fell silent: 2 nodes'
    assert alarm['silent']['hosts'] == ['base']
    assert alarm['silent']['components'] == ['/laser', '/slam']
    assert {each['component'] for each in alarm['suspects']} == {'/laser', '/slam'}
    told = re.escape('Everything on host base fell silent at 12.0 s: 2 nodes; they came back at '
                     '20.0 s.')
    assert re.fullmatch(told, recording['incidents'][0]['headline'])
    assert re.search(told, report.read_text())
    assert re.search(told, capsys.readouterr().out)
    assert score.main([bag, '--model', evidence_model, '--json', str(values)]) == 0
    recording, = json.loads(values.read_text())['recordings']
    assert 'base' not in recording['incidents'][0]['headline'], 'a bag does not say it'
