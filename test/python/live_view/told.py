"""What a monitor tells, made up."""
from __future__ import annotations

from typing import Any, Tuple

from self_awareness.msg import Acceptance, ComponentState, SelfAwareness, Suspect


def of_component(name: str, level: int = 0, state: str = 'heard', **values: Any) -> ComponentState:
    return ComponentState(**{**dict(
        name=name, level=level, state=state, rate=10.0, usual_rate=12.5, age=0.1, share=0.07,
        found_after=0.4, found_when_asked=-1.0), **values})


def stranger(component: str, topic: str) -> Acceptance:
    return Acceptance(component=component, topic=topic, kind='stranger')


def stands(alarm: int, component: str, kind: str, *suspects: Tuple[str, str],
           level: int = 2) -> SelfAwareness:
    return SelfAwareness(
        score=-2.0, threshold=-1.0, level=level, alarm=alarm, component=component, kind=kind,
        suspects=[Suspect(component=name, kind=what) for name, what in suspects])
