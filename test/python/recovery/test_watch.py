"""What a recovery takes from the messages of a monitor."""
from __future__ import annotations

import math
from typing import Any, Dict, Iterable, List, Optional, Set

import pytest
import rospy

from self_awareness.msg import Incident, SelfAwareness, Suspect
from self_awareness.recovery.ladder import Fault
from self_awareness.recovery.watch import BESIDE_S, FRESH_S, Watch

RAISED = 100 * 10 ** 9  # [ns], the id of the alarm
NOW = 1000  # [s], the end of a window
Listeners = Dict[str, Set[str]]
NOBODY_LISTENS: Listeners = {'/player': set(), '/camera': set(), '/slam': set()}


def incident(component: str = '/player', kind: str = 'silent', **fields: Any) -> Incident:
    return Incident(**{'id': 7, 'last': RAISED, 'level': SelfAwareness.ERROR,
                       'component': component, 'kind': kind, **fields})


def suspect(component: str, kind: str = 'silent', since: int = 100, silence: float = math.nan
            ) -> Suspect:
    return Suspect(component=component, kind=kind, since=rospy.Time(since), silence=silence)


def status(*suspects: Any, **fields: Any) -> SelfAwareness:
    values = {'level': SelfAwareness.ERROR, 'abnormal': True, 'alarm': RAISED,
              'component': '/player', 'kind': 'silent', **fields}
    said = SelfAwareness(suspects=[suspect(each) if isinstance(each, str) else each
                                   for each in suspects], **values)
    said.header.stamp = rospy.Time(NOW)
    return said


def watch(incidents: Iterable[Incident] = (incident(),), said: Any = status('/player')) -> Watch:
    made = Watch()
    made.on_incidents(list(incidents))
    made.on_status(0.0, said)
    return made


def died(component: str, since: float = 0.0, incident: int = 7) -> Fault:
    return Fault(incident, component, 'silent', True, since)


def faults(tested: Watch, now: float, listeners: Optional[Listeners] = None) -> List[str]:
    return [f'{each.component} {each.kind}' for each in tested.faults(now, listeners) or []
            if each.stands]


@pytest.mark.parametrize('said', [
    status('/player', component=''), status('/player', level=SelfAwareness.WARN),
    status(level=SelfAwareness.OK, abnormal=False)])
def test_others_are_none(said: Any) -> None:
    """Also while an incident of an alarm before is open, which a suspicion has opened again."""
    assert watch(said=said).faults(0.0) == []


def test_an_alarm_whose_incident_is_not_known_yet_has_its_own_id() -> None:
    for others in ([], [incident(last=1)], [incident(over=True)]):
        assert watch(others).faults(0.0) == [died('/player', incident=RAISED)]


@pytest.mark.parametrize('said', [status('/slam'), status('/player', abnormal=False), status()])
def test_it_stands_while_a_window_is_abnormal_and_names_the_component(said: Any) -> None:
    fault, = watch(said=said).faults(0.0) or []
    assert not fault.stands


def test_nothing_is_known_from_a_monitor_that_is_gone_or_has_not_settled() -> None:
    tested = Watch()
    assert tested.faults(0.0) is None and 'not heard' in tested.why_blind(0.0)
    assert not tested.heard
    tested.on_status(0.0, status())
    assert tested.heard
    assert tested.faults(0.0) is None, 'its incidents are not known yet'
    tested = watch()
    assert tested.faults(FRESH_S) is not None
    assert tested.faults(FRESH_S + 0.1) is None, 'it may have died long ago'
    tested.on_status(10.0, status('/player', settling=True))
    assert tested.faults(10.0) is None and 'settled' in tested.why_blind(10.0)


def test_windows_may_be_too_long() -> None:
    tested = watch(said=status('/player', window=rospy.Duration(0.5)))
    assert tested.why_blind(0.0) == ''
    tested.on_status(1.0, status('/player', window=rospy.Duration(2)))
    assert tested.faults(1.0) is None
    assert tested.why_blind(1.0) == (
        'the monitor judges by windows of 2 s; a recovery takes 0.5 s at most')


@pytest.mark.parametrize('kind', [SelfAwareness.BUSY_MACHINE, SelfAwareness.ALL_SILENT])
def test_nobody_is_restarted_while_the_machine_is_to_blame(kind: str) -> None:
    tested = watch(said=status('/player', '/slam', component='', kind=kind))
    assert tested.faults(0.0) is None
    assert 'no component is to blame' in tested.why_blind(0.0)
    tested.on_status(1.0, status(component='', kind=kind, level=SelfAwareness.WARN))
    assert tested.faults(1.0) == []


def beside(*others: Suspect, seconds: float = BESIDE_S, known: Incident = incident()) -> Watch:
    """The alarm of /player stands, and abnormal windows name others for a while."""
    tested = watch([known])
    for tenth in range(int(10.0 * seconds) + 1):
        tested.on_status(tenth / 10.0, status('/player', *others))
    return tested


LATER = suspect('/camera', since=200)


def test_who_fails_while_an_alarm_stands_is_a_fault_besides() -> None:
    tested = beside(LATER)
    assert tested.beside(BESIDE_S) == ['/camera']
    assert tested.faults(BESIDE_S, NOBODY_LISTENS) == [
        died('/player'), died('/camera')]
    assert faults(tested, BESIDE_S + 0.6, NOBODY_LISTENS) == [], 'neither is abnormal any more'


def test_it_is_none_if_it_is_not_known_who_hears_whom() -> None:
    assert faults(beside(LATER), BESIDE_S) == ['/player silent']
    without_player: Listeners = {'/camera': set(), '/slam': set()}
    assert faults(beside(LATER), BESIDE_S, without_player) == ['/player silent']
    assert faults(beside(LATER, known=incident(last=1)), BESIDE_S, NOBODY_LISTENS) == [
        '/player silent']


@pytest.mark.parametrize('since', [100, NOW])
def test_who_was_named_when_the_alarm_was_raised_or_anew_need_not_be_abnormal(since: int) -> None:
    assert faults(beside(suspect('/camera', since=since)), BESIDE_S, NOBODY_LISTENS) == [
        '/player silent']


def test_victims_are_no_faults() -> None:
    tested = beside(LATER, known=incident(victims=['/camera']))
    assert faults(tested, BESIDE_S, NOBODY_LISTENS) == ['/player silent']
    through_slam: Listeners = {'/player': {'/slam'}, '/slam': {'/camera', '/slam'},
                               '/camera': set()}
    assert faults(beside(LATER), BESIDE_S, through_slam) == ['/player silent']
    of_another: Listeners = {'/player': set(), '/slam': {'/camera'}, '/camera': set()}
    tested = beside(LATER, suspect('/slam', 'slow', since=150))
    assert faults(tested, BESIDE_S, of_another) == ['/player silent', '/slam slow']
    both_ways = {**of_another, '/camera': {'/slam'}}
    assert faults(tested, BESIDE_S, both_ways) == ['/player silent']


def test_another_alarm_begins_anew() -> None:
    tested = beside(LATER)
    tested.on_status(BESIDE_S, status('/player', LATER, alarm=RAISED + 1))
    assert tested.beside(BESIDE_S) == []


def at(now: float, *suspects: Suspect) -> SelfAwareness:
    said = status(*suspects)
    said.header.stamp = rospy.Time.from_sec(200.0 + now)
    return said


def test_who_has_died_and_comes_again_dies_anew() -> None:
    """At half its rate of 10 Hz, /player is silent for longer than usual in every second gap."""
    tested = watch(said=at(0.0, suspect('/player', silence=0.15)))
    assert tested.faults(0.0) == [died('/player')]
    for tenth in range(2, 20, 2):
        tested.on_status(tenth / 10.0, at(tenth / 10.0, suspect('/player', silence=0.15)))
        assert tested.faults(tenth / 10.0) == [died('/player', since=tenth / 10.0)]


def test_who_does_not_come_is_dead_since_it_was_named_also_with_pauses() -> None:
    tested = watch(said=at(0.0, suspect('/player', silence=0.15)))
    tested.on_status(0.1, status(abnormal=False))
    tested.on_status(2.0, at(2.0, suspect('/player', 'slow'), suspect('/player', silence=2.15)))
    assert tested.faults(2.0) == [died('/player')]


def test_where_a_silence_is_not_known_it_has_died_since_windows_name_it() -> None:
    tested = watch(said=at(0.0, suspect('/player')))
    tested.on_status(0.3, at(0.3, suspect('/player'), suspect('/player', silence=0.1)))
    assert tested.faults(0.3) == [died('/player')]
    tested.on_status(1.0, at(1.0, suspect('/player')))
    assert tested.faults(1.0) == [died('/player', since=1.0)], 'it was not named for 0.7 s'
