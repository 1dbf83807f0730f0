"""What one component of the simulated robot does, as immutable data (`scenario` reads it).

Times in the data are seconds, as in the file; whatever is drawn or computed from them is int
nanoseconds.
"""
from __future__ import annotations

import math
import random
from dataclasses import dataclass, replace
from typing import Dict, Optional, Tuple, Union

from self_awareness.stamps import nanoseconds

Value = Union[bool, int, str]
"""What a message says, as far as the scenario cares: command, action, on or off."""


@dataclass(frozen=True)
class Duration:
    """A span of time: log-normal around `median` (seconds), constant if `sigma` is 0.

    With probability `rare` it is `factor` times as long.
    """

    median: float
    sigma: float = 0.0
    rare: float = 0.0
    factor: float = 1.0

    def draw(self, rng: random.Random) -> int:
        """Draw one value in ns, >= 0."""
        seconds = self.median
        if self.sigma > 0.0:
            seconds *= math.exp(rng.gauss(0.0, self.sigma))
        if self.rare > 0.0 and rng.random() < self.rare:
            seconds *= self.factor
        return nanoseconds(seconds)

    def times(self, factor: float) -> Duration:
        """Return a duration that is `factor` times as long."""
        return replace(self, median=self.median * factor)


@dataclass(frozen=True)
class Output:
    """One message that a task publishes, after `takes` of processing and `waits` of waiting.

    Normally there is one; `copies` more than one follow each other at once.
    """

    topic: str
    datatype: str
    takes: Duration
    waits: Duration
    latch: bool = False
    values: Tuple[Value, ...] = ()
    value_of: Optional[str] = None
    copies: int = 1


@dataclass(frozen=True)
class Need:
    """A condition on the newest message of `topic`; exactly one of the others is set (seconds)."""

    topic: str
    within: Optional[float] = None
    stamps_within: Optional[float] = None
    one_of: Optional[Tuple[Value, ...]] = None


@dataclass(frozen=True)
class InView:
    """A person stays in view of the camera, leaves, comes back, and so on."""

    stays: Duration
    leaves: Duration


@dataclass(frozen=True)
class Hypothesis:
    """The life of a person hypothesis, and the values that announce its three actions."""

    confirm: int
    discard_after: float
    insert: int
    update: int
    delete: int


@dataclass(frozen=True)
class Task:
    """What starts a piece of work, on which conditions, and what it publishes."""

    publish: Tuple[Output, ...]
    otherwise: Tuple[Output, ...] = ()
    upon: Optional[str] = None
    each: int = 1
    every: Optional[Duration] = None
    jitter: float = 0.0
    needs: Tuple[Need, ...] = ()
    probability: float = 1.0
    in_view: Optional[InView] = None
    hypothesis: Optional[Hypothesis] = None

    def period(self) -> Duration:
        """Return the period of the task's timer.

        Raises:
            ValueError: it has none; a message starts it.
        """
        if self.every is None:
            raise ValueError('the task has no timer')
        return self.every

    def inputs(self) -> Tuple[str, ...]:
        """Return the topics that this task depends on."""
        topics = [self.upon] + [need.topic for need in self.needs]
        topics += [output.value_of for output in self.publish + self.otherwise]
        return tuple(topic for topic in topics if topic is not None)


@dataclass(frozen=True)
class ComponentSpec:
    """One component: a ROS node of that name on one of the hosts.

    Faults set the rest: what it publishes leaves it `delay` seconds late; a share of it, `lost`,
    never does, but is counted. Messages that are `stale` have the stamp of the one before, those
    that are `frozen` all else of it, and those that are `empty` have nothing but a header.
    """

    name: str
    host: str
    tasks: Tuple[Task, ...]
    hears: Tuple[str, ...] = ()
    delay: float = 0.0
    lost: float = 0.0
    stale: bool = False
    frozen: bool = False
    empty: bool = False

    def inputs(self) -> Tuple[str, ...]:
        """Return the topics that the component subscribes to, each once."""
        topics = [topic for task in self.tasks for topic in task.inputs()]
        return tuple(dict.fromkeys(topics + list(self.hears)))

    def outputs(self) -> Dict[str, Output]:
        """Return what the component publishes: one output for each topic."""
        return {o.topic: o for task in self.tasks for o in task.publish + task.otherwise}
