"""The faults that can hit the simulated follow-me robot: what they are called.

A fault is named by its kind, for some with the component that it hits: `cc1`, `crash:slam`.
`effect_of` turns the name into what it does (`effects`).
"""
from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Callable, Dict, Optional, Tuple

from self_awareness_follow_me.component_spec import ComponentSpec
from self_awareness_follow_me.effects import Change, Crash, Effect, Silence, doubled, halved
from self_awareness_follow_me.messages import MessageType
from self_awareness_follow_me.scenario import Scenario

INDUCED_FAULT = 'induced_fault'
"""Parameter of the running robot: KIND@ONSET (s since 1970) of the fault it has, empty if none."""


def effect_of(scenario: Scenario, kind: str) -> Effect:
    """Return what the fault of that name does to a robot.

    Raises:
        ValueError: there is no such fault, or it cannot hit that component.
    """
    found, component = _split(kind)
    if found.of is None or not component:
        return found.alone(scenario)
    try:
        return found.of(scenario, scenario.component(component))
    except ValueError as error:
        raise ValueError(f'fault {kind}: {error}') from error


def check_form(kind: str) -> None:
    """Check what can be checked without a robot: that the name has one of the forms there are.

    Raises:
        ValueError: it has not; the message lists the forms.
    """
    _split(kind)


def in_short(kind: str) -> str:
    """Return the name of a fault with the component's, where it has its node's: `crash:/slam`."""
    return kind.replace(':/', ':')


def described() -> str:
    """Return the table of all faults, a line each, for the help of a program."""
    return '\n'.join(f'  {form:23}{kind.text}' for form, kind in zip(forms(), _KINDS.values()))


def forms() -> Tuple[str, ...]:
    """Return how faults are named: `cc1`, `lat[:COMPONENT]`, `crash:COMPONENT` and so on."""
    return tuple(name + kind.form for name, kind in _KINDS.items())


def _needs_component(_: Scenario) -> Effect:
    raise ValueError('name the component that the fault hits')


@dataclass(frozen=True)
class _Kind:
    """What a kind of fault does."""

    text: str  # for people
    alone: Callable[[Scenario], Effect] = _needs_component  # named without a component
    # Named with one; None: it cannot be.
    of: Optional[Callable[[Scenario, ComponentSpec], Effect]] = None

    @property
    def form(self) -> str:
        """What follows the name."""
        if self.of is None:
            return ''
        return ':COMPONENT' if self.alone is _needs_component else '[:COMPONENT]'


def _double_rate(_: Scenario, spec: ComponentSpec) -> Effect:
    for task in spec.tasks:
        if task.upon is not None:
            continue
        busy = sum(output.takes.median + output.waits.median for output in task.publish)
        period = task.period().median
        if busy > period / 2.0:
            raise ValueError(f'{spec.name!r} is busy for {busy:g} s every {period:g} s '
                             'and cannot do that twice as often; choose another component')
    return Change((spec.name,), other=doubled)


def _of_messages(setting: str, is_one: Callable[[MessageType], bool], what: str
                 ) -> Callable[[Scenario, ComponentSpec], Effect]:
    def effect(_: Scenario, spec: ComponentSpec) -> Effect:
        if not any(is_one(MessageType(output.datatype)) for output in spec.outputs().values()):
            raise ValueError(f'no message of {spec.name!r} has {what}; choose another component')
        return Change((spec.name,), {setting: True})
    return effect


def _deafness(_: Scenario, spec: ComponentSpec) -> Effect:
    if not spec.hears:
        raise ValueError(f'{spec.name!r} hears nothing that it could miss and go on; choose '
                         'another component')
    return Change((spec.name,), {'hears': spec.hears[1:]})


_KINDS: Dict[str, _Kind] = {
    'cc1': _Kind("the laser's driver dies (paper)", lambda robot: robot.faults.cc1),
    'cc2': _Kind('slam dies (paper)', lambda robot: robot.faults.cc2),
    'rs': _Kind('busy workers starve the CPU (paper)', lambda robot: robot.faults.rs),
    'ac': _Kind('the clock of one host drifts away (paper)', lambda robot: robot.faults.ac),
    'crash': _Kind('a component dies', of=lambda _, spec: Crash(spec.name)),
    'silence': _Kind('all components die at once', lambda _: Silence()),
    'lat': _Kind('components answer later, at an unchanged rate', lambda robot: robot.faults.lat,
                 lambda robot, spec: replace(robot.faults.lat, components=(spec.name,))),
    'half': _Kind('a component works at half its rate',
                  of=lambda _, spec: Change((spec.name,), other=halved)),
    'double': _Kind('a component publishes twice as often', of=_double_rate),
    'extra': _Kind("a foreign node publishes on a component's topic",
                   lambda robot: robot.faults.extra),
    'order': _Kind('a component publishes in reversed order', lambda robot: robot.faults.order),
    'unknown': _Kind('a component publishes what was never seen before',
                     lambda robot: robot.faults.unknown),
    'stale': _Kind('a component repeats a stamp for ever, at an unchanged rate',
                   of=_of_messages('stale', lambda kind: kind.has_stamp, 'a stamp')),
    'lossy': _Kind('a share of what a component publishes gets lost',
                   of=lambda robot, spec: replace(robot.faults.lossy, components=(spec.name,))),
    'empty': _Kind('scans, images and lists of a component are empty', of=_of_messages(
        'empty', lambda kind: kind.has_list, 'a list that can be empty')),
    'freeze': _Kind('a component says the same for ever, with new stamps',
                    of=lambda _, spec: Change((spec.name,), {'frozen': True})),
    'unsubscribed': _Kind('a component does not subscribe to one of its topics', of=_deafness),
}


def _split(kind: str) -> Tuple[_Kind, str]:
    name, colon, component = kind.partition(':')
    if name not in _KINDS:
        raise ValueError(f'fault {kind!r}: choose one of {", ".join(forms())}')
    found = _KINDS[name]
    named = found.of is not None if colon else found.alone is not _needs_component
    if not named or bool(component) != bool(colon):
        raise ValueError(f'fault {kind!r}: expected {name}{found.form}')
    return found, component
