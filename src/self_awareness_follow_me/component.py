"""How one component of the simulated robot behaves, as a state machine without ROS and clock.

The caller of a `Component` passes in the time (int ns) and gets back a list of requests: publish
this now, wake me at that time, or let my worker be busy for so long. The live node and the
discrete-event simulation drive the same code; they differ only in how time passes.
"""
from __future__ import annotations

import random
from collections import defaultdict, deque
from dataclasses import dataclass, replace
from typing import Callable, Deque, Dict, List, Optional, Union

from self_awareness.stamps import nanoseconds
from self_awareness_follow_me.component_spec import (ComponentSpec, Hypothesis, InView, Need,
                                                     Output, Value)


@dataclass(frozen=True)
class Message:
    """What is exchanged."""

    topic: str  # where
    stamp: int  # of the header (ns, by the clock of the host it is from)
    value: Optional[Value] = None  # what it says, as far as the scenario cares
    # When it was made (ns): what the scenario does not care for follows from it. The same: the
    # same bytes. None: it is empty.
    content: Optional[int] = 0


@dataclass(frozen=True)
class Publish:
    """Request: publish the message `delay` ns from now; if it is `lost`, only count it."""

    message: Message
    delay: int = 0
    lost: bool = False


@dataclass(frozen=True)
class Wake:
    """Request: call `wake(timer)` at the time `at` (ns)."""

    at: int
    timer: int


@dataclass(frozen=True)
class Work:
    """Request: call `work_done` after `takes` of processing and `waits` of waiting (ns)."""

    takes: int
    waits: int


Request = Union[Publish, Wake, Work]


@dataclass(frozen=True)
class _Step:
    """One message of a piece of work that has begun."""

    output: Output
    stamp: int
    action: Optional[int]


class Component:
    """One component: its timers, its one worker, and what it remembers of its inputs.

    Args:
        spec: what the component does.
        rng: the only source of randomness; the same seed and inputs give the same behaviour.
        clock: what the clock of the component's host shows (ns) at a given time (ns).
        spec_at: what the component does instead of `spec` at a given time (ns), where a fault
            changes that; tasks keep their index, and new ones follow.
    """

    def __init__(self, spec: ComponentSpec, rng: random.Random,
                 clock: Callable[[int], int] = lambda now: now,
                 spec_at: Optional[Callable[[int], ComponentSpec]] = None) -> None:
        self._spec = spec
        self._rng = rng
        self._clock = clock
        self._spec_at = spec_at or (lambda _: spec)
        self._steps: Deque[_Step] = deque()
        # The newest waiting message of each task, in the order in which the tasks were asked for.
        self._waiting: Dict[int, Optional[Message]] = {}
        self._received: Dict[str, Message] = {}
        self._received_at: Dict[str, int] = {}
        self._counts: Dict[int, int] = defaultdict(int)
        self._ticks: Dict[int, int] = {}
        self._published: Dict[str, Message] = {}
        self._views = {i: _View(task.in_view, rng) for i, task in enumerate(spec.tasks)
                       if task.in_view}
        self._tracks = {i: _Track(task.hypothesis) for i, task in enumerate(spec.tasks)
                        if task.hypothesis}

    def start(self, now: int) -> List[Request]:
        """Begin at the time `now`; every timer gets a phase of its own."""
        requests: List[Request] = []
        for index, task in enumerate(self._spec.tasks):
            if task.every is not None and index not in self._ticks:
                self._ticks[index] = now + round(self._rng.random() * task.every.draw(self._rng))
                requests.append(Wake(self._ticks[index], index))
        return requests

    def wake(self, now: int, timer: int) -> List[Request]:
        """Handle a timer that fires, possibly late; ticks that were missed are left out."""
        requests = self._adapt(now)
        if timer >= len(self._spec.tasks):
            del self._ticks[timer]
            return requests
        task = self._spec.tasks[timer]
        # Once at least: jitter may let a tick come before its time.
        tick = self._ticks[timer] + task.period().draw(self._rng)
        while tick <= now:
            tick += task.period().draw(self._rng)
        self._ticks[timer] = tick
        noise = nanoseconds(self._rng.gauss(0.0, task.jitter)) if task.jitter else 0
        requests.append(Wake(max(now + 1, tick + noise), timer))
        return requests + self._ask(timer, None, now)

    def receive(self, now: int, message: Message) -> List[Request]:
        """Handle a message that arrives."""
        self._received[message.topic] = message
        self._received_at[message.topic] = now
        requests = self._adapt(now)
        for index, task in enumerate(self._spec.tasks):
            if task.upon == message.topic:
                self._counts[index] += 1
                if self._counts[index] % task.each == 0:
                    requests += self._ask(index, message, now)
        return requests

    def work_done(self, now: int) -> List[Request]:
        """Handle the end of the work that was asked for last."""
        requests = self._adapt(now)
        step = self._steps.popleft()
        message = self._message(step, now)
        lost = self._spec.lost
        requests += [Publish(message, nanoseconds(self._spec.delay),
                             lost > 0.0 and self._rng.random() < lost)
                     for _ in range(step.output.copies)]
        return requests + (self._work() if self._steps else self._next(now))

    def _adapt(self, now: int) -> List[Request]:
        """Go over to what is to be done at the time `now`; start the timers of what is new."""
        spec = self._spec_at(now)
        if spec is self._spec:
            return []
        self._spec = spec
        self._waiting = {index: message for index, message in self._waiting.items()
                         if index < len(spec.tasks)}
        return self.start(now)

    def _ask(self, index: int, message: Optional[Message], now: int) -> List[Request]:
        # A timer must not replace a message that still waits: it would be lost.
        if message is not None or index not in self._waiting:
            self._waiting[index] = message
        return [] if self._steps else self._next(now)

    def _next(self, now: int) -> List[Request]:
        while self._waiting and not self._steps:
            index = next(iter(self._waiting))
            self._begin(index, self._waiting.pop(index), now)
        return self._work() if self._steps else []

    def _begin(self, index: int, message: Optional[Message], now: int) -> None:
        task = self._spec.tasks[index]
        stamp = self._clock(now) if message is None else message.stamp
        if not all(self._holds(need, stamp, now) for need in task.needs):
            return
        if index in self._views and not self._views[index].holds(now):
            return
        action = None
        if index in self._tracks:
            action = self._tracks[index].action(now, seen=message is not None)
            if action is None:
                return
        sure = task.probability >= 1.0 or self._rng.random() < task.probability
        self._steps.extend(_Step(output, stamp, action)
                           for output in (task.publish if sure else task.otherwise))

    def _work(self) -> List[Request]:
        output = self._steps[0].output
        return [Work(output.takes.draw(self._rng), output.waits.draw(self._rng))]

    def _holds(self, need: Need, stamp: int, now: int) -> bool:
        newest = self._received.get(need.topic)
        if newest is None:
            return False
        if need.within is not None:
            return now - self._received_at[need.topic] <= nanoseconds(need.within)
        if need.stamps_within is not None:
            return abs(newest.stamp - stamp) <= nanoseconds(need.stamps_within)
        return newest.value in (need.one_of or ())

    def _message(self, step: _Step, now: int) -> Message:
        message = Message(step.output.topic, step.stamp, self._value(step),
                          None if self._spec.empty else now)
        before = self._published.get(message.topic, message)
        if self._spec.stale:
            message = replace(message, stamp=before.stamp)
        if self._spec.frozen:
            message = replace(message, value=before.value, content=before.content)
        self._published[message.topic] = message
        return message

    def _value(self, step: _Step) -> Optional[Value]:
        if step.action is not None:
            return step.action
        if step.output.value_of is not None:
            newest = self._received.get(step.output.value_of)
            return None if newest is None else newest.value
        values = step.output.values
        if len(values) > 1:
            return self._rng.choice(values)
        return values[0] if values else None


class _View:
    """Whether a person is before the camera."""

    def __init__(self, spec: InView, rng: random.Random) -> None:
        self._spec = spec
        self._rng = rng
        self._inside = False
        self._until: Optional[int] = None

    def holds(self, now: int) -> bool:
        """Return whether the person is in view at the time `now` (ns, never decreasing)."""
        if self._until is None:
            self._until = now
        while self._until <= now:
            self._inside = not self._inside
            span = self._spec.stays if self._inside else self._spec.leaves
            self._until += span.draw(self._rng)
        return self._inside


class _Track:
    """One person hypothesis: made of some tracks in a row, updated, and discarded when too old."""

    def __init__(self, spec: Hypothesis) -> None:
        self._spec = spec
        self._tracks = 0
        self._seen_at = 0

    def action(self, now: int, seen: bool) -> Optional[int]:
        """Return the value of what happens to the hypothesis at the time `now`, if anything."""
        spec = self._spec
        exists = self._tracks >= spec.confirm
        if self._tracks and now - self._seen_at > nanoseconds(spec.discard_after):
            self._tracks = 0
            if exists:
                return spec.delete
        if not seen:
            return None
        self._tracks += 1
        self._seen_at = now
        if self._tracks < spec.confirm:
            return None
        return spec.update if exists else spec.insert
