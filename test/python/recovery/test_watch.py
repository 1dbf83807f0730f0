"""What a recovery takes from the messages of a monitor."""
from __future__ import annotations

from typing import Any, Iterable

import pytest

from self_awareness.msg import Incident, SelfAwareness, Suspect
from self_awareness.recovery.ladder import Fault
from self_awareness.recovery.watch import FRESH_S, Watch


def incident(component: str = '/player', kind: str = 'died', **fields: Any) -> Incident:
    return Incident(id=7, level=SelfAwareness.ERROR, component=component, kind=kind, **fields)


def status(*components: str, **fields: Any) -> SelfAwareness:
    values = {'level': SelfAwareness.ERROR, 'abnormal': True, **fields}
    return SelfAwareness(suspects=[Suspect(component=each) for each in components], **values)


def watch(incidents: Iterable[Incident] = (incident(),), said: Any = status('/player')) -> Watch:
    made = Watch()
    made.on_incidents(list(incidents))
    made.on_status(0.0, said)
    return made


def test_an_open_incident_is_a_fault() -> None:
    assert watch().faults(0.0) == [Fault(7, '/player', 'died', True)]


@pytest.mark.parametrize('changed', [{'over': True}, {'component': ''}])
def test_others_are_none(changed: Any) -> None:
    assert watch([incident(**changed)]).faults(0.0) == []
    near_miss = incident()
    near_miss.level = SelfAwareness.WARN
    assert watch([near_miss]).faults(0.0) == []


@pytest.mark.parametrize('said', [
    status('/slam'), status('/player', abnormal=False),
    status('/player', level=SelfAwareness.WARN), status()])
def test_it_stands_while_a_window_is_abnormal_and_names_the_component(said: Any) -> None:
    fault, = watch(said=said).faults(0.0) or []
    assert not fault.stands


def test_it_does_not_stand_for_long_after_the_last_abnormal_window() -> None:
    tested = watch()
    tested.on_status(0.4, status('/player', abnormal=False))
    fault, = tested.faults(0.4) or []
    assert fault.stands
    tested.on_status(0.6, status('/player', abnormal=False))
    fault, = tested.faults(0.6) or []
    assert not fault.stands


def test_nothing_is_known_from_a_monitor_that_is_gone_or_has_not_settled() -> None:
    tested = Watch()
    assert tested.faults(0.0) is None and 'not heard' in tested.why_blind(0.0)
    tested.on_status(0.0, status())
    assert tested.faults(0.0) is None, 'its incidents are not known yet'
    tested = watch()
    assert tested.faults(FRESH_S) is not None
    assert tested.faults(FRESH_S + 0.1) is None, 'it may have died long ago'
    tested.on_status(10.0, status('/player', settling=True))
    assert tested.faults(10.0) is None and 'settled' in tested.why_blind(10.0)


@pytest.mark.parametrize('kind', [SelfAwareness.BUSY_MACHINE, SelfAwareness.ALL_SILENT])
def test_nobody_is_restarted_while_the_machine_is_to_blame(kind: str) -> None:
    whole = incident('', kind)
    assert watch([incident(), whole]).faults(0.0) is None
    assert watch([incident(), whole]).why_blind(0.0)
    over = incident('', kind, over=True)
    assert watch([incident(), over]).faults(0.0)
