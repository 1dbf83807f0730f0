"""One component of the simulated robot as a ROS node.

Drives a `component.Component` in real time: `takes` of its work is partly spent
computing, so that a busy CPU slows the node down as it would a real one, `waits` is slept.

Publishes and subscribes to the component's topics (relative names). Reads the parameter
`induced_fault`, relative to the node's namespace: `KIND@ONSET` of the fault that the robot has (s
since 1970), empty if it has none. Only faults that a component has to know of work by it.
"""
from __future__ import annotations

import heapq
import queue
import random
import time
from functools import partial
from typing import Any, Callable, Dict, List, Optional, Tuple

import rospy

from self_awareness.stamps import SECOND_NS, nanoseconds
from self_awareness_follow_me.component import Component, Message, Publish, Request, Wake, Work
from self_awareness_follow_me.component_spec import ComponentSpec
from self_awareness_follow_me.effects import Induced
from self_awareness_follow_me.faults import INDUCED_FAULT, effect_of
from self_awareness_follow_me.messages import MessageType
from self_awareness_follow_me.scenario import Scenario

# How long a shutdown may go unnoticed while nothing else happens.
_PATIENCE_S = 0.5
_QUEUE_SIZE = 10
# A look at a cached parameter costs little, but not nothing.
_LOOK_EVERY_NS = 50_000_000


class ComponentNode:
    """Runs one component until ROS shuts down; `rospy.init_node` has been called.

    Args:
        scenario: the robot.
        spec: the component of it to run.
        seed: decides what is random in its behaviour.
    """

    def __init__(self, scenario: Scenario, spec: ComponentSpec, seed: int) -> None:
        # One clock for everything: its steps must not disturb the timers.
        self._epoch = time.time_ns() - time.monotonic_ns()
        self._cpu_share = scenario.cpu_share
        self._fault = _FaultWatch(scenario, spec)
        self._component = Component(spec, random.Random(f'{seed}/{spec.name}'), self._fault.clock,
                                    self._fault.spec_at)
        self._inbox: queue.Queue[Message] = queue.Queue()
        self._due: List[Tuple[int, int, Callable[[int], List[Request]]]] = []
        self._pushed = 0
        self._types = {topic: MessageType(scenario.datatypes[topic])
                       for topic in {*spec.inputs(), *spec.outputs()}}
        self._publishers = {
            topic: rospy.Publisher(topic, self._types[topic].message_class, latch=output.latch,
                                   queue_size=_QUEUE_SIZE, tcp_nodelay=True)
            for topic, output in spec.outputs().items()}
        self._spec: Optional[ComponentSpec] = None
        self._subscribers: Dict[str, rospy.Subscriber] = {}
        self._subscribe(spec)

    def spin(self) -> None:
        """Run until ROS shuts down."""
        self._handle(self._component.start(self._now()))
        while not rospy.is_shutdown():
            self._subscribe(self._fault.spec_at(self._now()))
            wait_s = _PATIENCE_S
            if self._due:
                wait_s = min(wait_s, (self._due[0][0] - self._now()) / SECOND_NS)
            if wait_s <= 0.0:
                _, _, act = heapq.heappop(self._due)
                self._handle(act(self._now()))
                continue
            try:
                message = self._inbox.get(timeout=wait_s)
            except queue.Empty:
                continue
            self._handle(self._component.receive(self._now(), message))

    def _subscribe(self, spec: ComponentSpec) -> None:
        """Subscribe to the topics that a component which does this needs, and to no others."""
        if spec is self._spec:
            return
        self._spec = spec
        topics = spec.inputs()
        for topic in set(self._subscribers) - set(topics):
            self._subscribers.pop(topic).unregister()
        for topic in topics:
            if topic not in self._subscribers:
                self._subscribers[topic] = rospy.Subscriber(
                    topic, self._types[topic].message_class, self._received, topic,
                    queue_size=_QUEUE_SIZE, tcp_nodelay=True)

    def _handle(self, requests: List[Request]) -> None:
        for request in requests:
            if isinstance(request, Publish):
                send = partial(self._send, request=request)
                if request.delay > 0:
                    self._push(self._now() + request.delay, send)
                else:
                    send(0)
            elif isinstance(request, Wake):
                self._push(request.at, partial(self._component.wake, timer=request.timer))
            else:
                self._push(self._begin(request), self._component.work_done)

    def _begin(self, work: Work) -> int:
        """Compute for the share of the work that needs the CPU; return when the work is done."""
        done = self._now() + work.takes + work.waits
        enough = time.thread_time_ns() + round(work.takes * self._cpu_share)
        while time.thread_time_ns() < enough:
            pass
        return done

    def _send(self, _: int, request: Publish) -> List[Request]:
        message = request.message
        publisher = self._publishers[message.topic]
        if request.lost:
            # As where a queue is full: the header's number goes on.
            publisher.impl.seq += 1
            return []
        try:
            publisher.publish(self._types[message.topic].to_ros(message))
        except rospy.ROSException:
            # The publishers close first when ROS shuts down.
            if not rospy.is_shutdown():
                raise
        return []

    def _received(self, ros_message: Any, topic: str) -> None:
        self._inbox.put(self._types[topic].from_ros(topic, ros_message,
                                                    self._fault.clock(self._now())))

    def _push(self, at: int, act: Callable[[int], List[Request]]) -> None:
        self._pushed += 1
        heapq.heappush(self._due, (at, self._pushed, act))

    def _now(self) -> int:
        return self._epoch + time.monotonic_ns()


class _FaultWatch:
    """The fault that the parameter INDUCED_FAULT tells of, as far as it concerns one component."""

    def __init__(self, scenario: Scenario, spec: ComponentSpec) -> None:
        self._scenario = scenario
        self._spec = spec
        self._parameter = ''
        self._take(Induced())
        self._look_at = 0
        # A parameter that is not set cannot be cached: every look at it would ask the master.
        if not rospy.has_param(INDUCED_FAULT):
            rospy.set_param(INDUCED_FAULT, '')

    def clock(self, now: int) -> int:
        """Return what the clock of the component's host shows (ns) at a given time (ns)."""
        self._look(now)
        return self._clock(now)

    def spec_at(self, now: int) -> ComponentSpec:
        """Return what the component does at a given time (ns)."""
        self._look(now)
        return self._spec_at(now)

    def _look(self, now: int) -> None:
        if now >= self._look_at:
            self._look_at = now + _LOOK_EVERY_NS
            parameter = rospy.get_param_cached(INDUCED_FAULT, '')
            if parameter != self._parameter:
                self._parameter = parameter
                self._take(self._read(parameter))

    def _take(self, fault: Induced) -> None:
        self._clock, self._spec_at = fault.clock(self._spec.host), fault.spec_at(self._spec)

    def _read(self, parameter: str) -> Induced:
        kind, _, onset = parameter.partition('@')
        try:
            return (Induced(effect_of(self._scenario, kind), nanoseconds(float(onset)))
                    if parameter else Induced())
        except ValueError as error:
            rospy.logerr(f'parameter {rospy.resolve_name(INDUCED_FAULT)}: {parameter!r} is not '
                         f'KIND@ONSET: {error}; ignored')
            return Induced()
