"""The faults that can hit the simulated follow-me robot: what they are called.

A fault is named by its kind, for some with the component that it hits: `cc1`, `crash:slam`.
`effect_of` turns the name into what it does (`effects`).
"""
from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Callable, Dict, Optional, Tuple

from self_awareness.follow_me.component_spec import ComponentSpec
from self_awareness.follow_me.effects import Crash, DoubleRate, Effect, HalfRate, Latency, Silence
from self_awareness.follow_me.scenario import Scenario

INDUCED_FAULT = 'induced_fault'
"""Parameter of the running robot: KIND@ONSET (s since 1970) of the fault it has, empty if none."""


def effect_of(scenario: Scenario, kind: str) -> Effect:
    """Return what the fault of that name does to a robot.

    Raises:
        ValueError: there is no such fault, or it cannot befall that component.
    """
    name, component = _split(kind)
    if component is None:
        return _KINDS[name].effect(scenario, None)
    try:
        return _KINDS[name].effect(scenario, scenario.component(component))
    except ValueError as error:
        raise ValueError(f'fault {kind}: {error}') from error


def check_form(kind: str) -> None:
    """Check what can be checked without a robot: that the name has one of the forms there are.

    Raises:
        ValueError: it has not; the message lists the forms.
    """
    _split(kind)


def described() -> str:
    """Return the table of all faults, a line each, for the help of a program."""
    return '\n'.join(f'  {form:19}{kind.text}' for form, kind in zip(forms(), _KINDS.values()))


def forms() -> Tuple[str, ...]:
    """Return how faults are named: `cc1`, `lat[:COMPONENT]`, `crash:COMPONENT` and so on."""
    return tuple(name + kind.component for name, kind in _KINDS.items())


_NONE, _OPTIONAL, _REQUIRED = '', '[:COMPONENT]', ':COMPONENT'


@dataclass(frozen=True)
class _Kind:
    component: str
    text: str
    effect: Callable[[Scenario, Optional[ComponentSpec]], Effect]


def _latency(scenario: Scenario, spec: Optional[ComponentSpec]) -> Latency:
    lat = scenario.faults.lat
    return lat if spec is None else replace(lat, components=(spec.name,))


def _double_rate(_: Scenario, spec: ComponentSpec) -> DoubleRate:
    for task in spec.tasks:
        if task.upon is not None:
            continue
        busy = sum(output.takes.median + output.waits.median for output in task.publish)
        if busy > task.every.median / 2.0:
            raise ValueError(f'{spec.name!r} is busy for {busy:g} s every {task.every.median:g} s '
                             'and cannot do that twice as often; choose another component')
    return DoubleRate((spec.name,))


_KINDS: Dict[str, _Kind] = {
    'cc1': _Kind(_NONE, "the laser's driver dies (paper)", lambda robot, _: robot.faults.cc1),
    'cc2': _Kind(_NONE, 'slam dies (paper)', lambda robot, _: robot.faults.cc2),
    'rs': _Kind(_NONE, 'busy workers starve the CPU (paper)', lambda robot, _: robot.faults.rs),
    'ac': _Kind(_NONE, 'the clock of one host drifts away (paper)',
                lambda robot, _: robot.faults.ac),
    'crash': _Kind(_REQUIRED, 'a component dies', lambda _, spec: Crash(spec.name)),
    'silence': _Kind(_NONE, 'all components die at once', lambda *_: Silence()),
    'lat': _Kind(_OPTIONAL, 'components answer later, at an unchanged rate', _latency),
    'half': _Kind(_REQUIRED, 'a component works at half its rate',
                  lambda _, spec: HalfRate((spec.name,))),
    'double': _Kind(_REQUIRED, 'a component publishes twice as often', _double_rate),
    'extra': _Kind(_NONE, "a foreign node publishes on a component's topic",
                   lambda robot, _: robot.faults.extra),
    'order': _Kind(_NONE, 'a component publishes in reversed order',
                   lambda robot, _: robot.faults.order),
    'unknown': _Kind(_NONE, 'a component publishes what was never seen before',
                     lambda robot, _: robot.faults.unknown),
}


def _split(kind: str) -> Tuple[str, Optional[str]]:
    name, colon, component = kind.partition(':')
    if name not in _KINDS:
        raise ValueError(f'fault {kind!r}: choose one of {", ".join(forms())}')
    form = _KINDS[name].component
    if bool(component) != bool(colon) or (colon and form == _NONE) or (
            not colon and form == _REQUIRED):
        raise ValueError(f'fault {kind!r}: expected {name}{form}')
    return name, component or None
