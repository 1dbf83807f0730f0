"""The faults that can befall the simulated follow-me robot: what they are called, what they do.

A fault is named by its kind, for some with the component that it befalls: `cc1`, `crash:slam`.
`effect_of` turns the name into its effect. The simulation and the live nodes apply effects; how
strong they are is in `config/follow_me.yaml`. Times of the file are seconds, others int ns.
"""
from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Callable, Dict, Optional, Tuple

from self_awareness.stamps import SECOND_NS, nanoseconds

if TYPE_CHECKING:
    from self_awareness.follow_me.scenario import ComponentSpec, Scenario, Task

INDUCED_FAULT = 'induced_fault'
"""Parameter of the running robot: KIND@ONSET (s since 1970) of the fault it has, empty if none."""


class Effect:
    """What a fault does."""

    @property
    def culprits(self) -> Tuple[str, ...]:
        """Names of the nodes that are to blame; empty where it is no single component's fault."""
        return ()


@dataclass(frozen=True)
class Crash(Effect):
    """A component dies."""

    component: str

    @property
    def culprits(self) -> Tuple[str, ...]:
        """The component."""
        return ('/' + self.component,)


class Silence(Effect):
    """All components die at once."""


@dataclass(frozen=True)
class Starvation(Effect):
    """Busy workers take the CPU away, more and more over `ramp` seconds."""

    ramp: float
    slowdown: float
    workers_per_core: int

    def factor(self, elapsed_ns: int) -> float:
        """Return by how much processing is stretched `elapsed_ns` after the onset, >= 1."""
        grown = min(1.0, max(0.0, elapsed_ns / nanoseconds(self.ramp)))
        return 1.0 + (self.slowdown - 1.0) * grown


@dataclass(frozen=True)
class ClockDrift(Effect):
    """The clock of one host drifts away and wobbles, so that stamps match only at times."""

    host: str
    drift: float
    settle: float
    wobble: float
    periods: Tuple[float, ...]

    def offset_ns(self, elapsed_ns: int) -> int:
        """Return what the clock is ahead (ns, signed) `elapsed_ns` after the onset; 0 before."""
        elapsed = elapsed_ns / SECOND_NS
        if elapsed <= 0.0:
            return 0
        sines = [math.sin(2.0 * math.pi * elapsed / period) for period in self.periods]
        drift = self.drift * (1.0 - math.exp(-elapsed / self.settle))
        return nanoseconds(drift + self.wobble * sum(sines) / len(sines))


@dataclass(frozen=True)
class Intruder(Effect):
    """A node that is none of the components publishes what one of them publishes."""

    spec: ComponentSpec

    @property
    def culprits(self) -> Tuple[str, ...]:
        """The intruder."""
        return ('/' + self.spec.name,)


@dataclass(frozen=True)
class Change(Effect):
    """Some components live on, but do something else than they should."""

    components: Tuple[str, ...]

    @property
    def culprits(self) -> Tuple[str, ...]:
        """The components that changed."""
        return tuple('/' + name for name in self.components)

    def changed(self, spec: ComponentSpec) -> ComponentSpec:
        """Return what a component does under the fault; tasks keep their index, new ones follow.

        Args:
            spec: what it does normally.
        """
        if spec.name not in self.components:
            return spec
        return self._changed(spec)

    def _changed(self, spec: ComponentSpec) -> ComponentSpec:
        raise NotImplementedError


@dataclass(frozen=True)
class Latency(Change):
    """All messages come `delay` seconds later, at an unchanged rate."""

    delay: float

    def _changed(self, spec: ComponentSpec) -> ComponentSpec:
        return replace(spec, delay=self.delay)


class HalfRate(Change):
    """Timers run at half their rate; of what triggers a task, every second one is ignored."""

    def _changed(self, spec: ComponentSpec) -> ComponentSpec:
        return replace(spec, tasks=tuple(_halved(task) for task in spec.tasks))


class DoubleRate(Change):
    """Timers run at twice their rate; what is done upon a topic is done twice as often.

    A task that starts on every Nth message starts on every N/2th one. If N is odd, each of its
    messages is published twice in a row instead.
    """

    def _changed(self, spec: ComponentSpec) -> ComponentSpec:
        return replace(spec, tasks=tuple(_doubled(task) for task in spec.tasks))


class Disorder(Change):
    """The messages of one piece of work come in reversed order, at the same times otherwise."""

    def _changed(self, spec: ComponentSpec) -> ComponentSpec:
        return replace(spec, tasks=tuple(_reversed(task) for task in spec.tasks))


@dataclass(frozen=True)
class Novelty(Change):
    """A component publishes, besides what it always does, messages that were never seen before."""

    task: Task

    def _changed(self, spec: ComponentSpec) -> ComponentSpec:
        return replace(spec, tasks=spec.tasks + (self.task,))


@dataclass(frozen=True)
class Faults:
    """The section `faults` of a scenario: what cannot be told from the name of a fault alone."""

    cc1: Crash
    cc2: Crash
    rs: Starvation
    ac: ClockDrift
    lat: Latency
    extra: Intruder
    order: Disorder
    unknown: Novelty


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


def _halved(task: Task) -> Task:
    if task.upon is None:
        return replace(task, every=task.every.times(2.0))
    return replace(task, each=2 * task.each)


def _doubled(task: Task) -> Task:
    if task.upon is None:
        return replace(task, every=task.every.times(0.5))
    if task.each % 2 == 0:
        return replace(task, each=task.each // 2)
    return replace(task, publish=tuple(replace(output, copies=2) for output in task.publish),
                   otherwise=tuple(replace(output, copies=2) for output in task.otherwise))


def _reversed(task: Task) -> Task:
    return replace(task, publish=tuple(
        replace(output, takes=slot.takes, waits=slot.waits)
        for slot, output in zip(task.publish, reversed(task.publish))))
