"""What faults do to the simulated robot: a class for each effect, which says who is to blame.

The simulation and the live nodes apply effects; how strong they are is in `config/follow_me.yaml`.
Times of the file are seconds, others int ns.
"""
from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import Any, Callable, Mapping, Optional, Tuple

from self_awareness.stamps import SECOND_NS, nanoseconds
from self_awareness_follow_me.component_spec import ComponentSpec, Task


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

    components: Tuple[str, ...]  # their names
    # Properties of ComponentSpec that they have instead: their messages come late, and so on.
    settings: Mapping[str, Any] = field(default_factory=dict)
    # How each task is done: halved, doubled or disordered; None: as ever.
    other: Optional[Callable[[Task], Task]] = None
    more: Tuple[Task, ...] = ()  # tasks besides, of messages that were never seen before

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
        tasks = spec.tasks if self.other is None else tuple(map(self.other, spec.tasks))
        return replace(spec, tasks=tasks + self.more, **self.settings)


@dataclass(frozen=True)
class Faults:
    """The section `faults` of a scenario: what cannot be told from the name of a fault alone."""

    cc1: Crash
    cc2: Crash
    rs: Starvation
    ac: ClockDrift
    lat: Change
    extra: Intruder
    order: Change
    unknown: Change
    lossy: Change


class Induced:
    """A fault that a robot has, by time (ns).

    Args:
        effect: what it does; None: there is no fault.
        onset: when it begins.
    """

    def __init__(self, effect: Optional[Effect] = None, onset: int = 0) -> None:
        self.effect = effect
        self.onset = onset

    def has_killed(self, name: str, now: int) -> bool:
        """Return whether the component of that name is dead."""
        kills = isinstance(self.effect, Silence) or (isinstance(self.effect, Crash)
                                                     and name == self.effect.component)
        return kills and now >= self.onset

    def slowdown(self, now: int) -> float:
        """Return by how much everything that needs a CPU is stretched, >= 1."""
        effect = self.effect
        return effect.factor(now - self.onset) if isinstance(effect, Starvation) else 1.0

    def clock(self, host: str) -> Callable[[int], int]:
        """Return what the clock of a host shows at a given time."""
        effect = self.effect
        if not isinstance(effect, ClockDrift) or effect.host != host:
            return lambda now: now
        offset_ns = effect.offset_ns
        return lambda now: now + offset_ns(now - self.onset)

    def spec_at(self, spec: ComponentSpec) -> Callable[[int], ComponentSpec]:
        """Return what a component does at a given time."""
        effect = self.effect
        changed = effect.changed(spec) if isinstance(effect, Change) else spec
        return lambda now: changed if now >= self.onset else spec


def halved(task: Task) -> Task:
    """Return a task whose timer runs at half its rate, or that ignores every second message."""
    if task.upon is None:
        return replace(task, every=task.period().times(2.0))
    return replace(task, each=2 * task.each)


def doubled(task: Task) -> Task:
    """Return a task that is done twice as often.

    One that starts on every Nth message starts on every N/2th one. If N is odd, each of its
    messages is published twice in a row instead.
    """
    if task.upon is None:
        return replace(task, every=task.period().times(0.5))
    if task.each % 2 == 0:
        return replace(task, each=task.each // 2)
    return replace(task, publish=tuple(replace(output, copies=2) for output in task.publish),
                   otherwise=tuple(replace(output, copies=2) for output in task.otherwise))


def disordered(task: Task) -> Task:
    """Return a task whose messages come in reversed order, at the same times otherwise."""
    return replace(task, publish=tuple(
        replace(output, takes=slot.takes, waits=slot.waits)
        for slot, output in zip(task.publish, reversed(task.publish))))
