"""The follow-me robot in simulated time: its components exchange messages, a recorder listens.

A discrete-event simulation of the scenario: timers fire a little late, work takes its time,
messages travel, and what arrives at the recorder is a recording of normal operation or of a fault
(`faults`). Nothing waits: 100 s of robot take some seconds to write. The same seed gives the same
recording.
"""
from __future__ import annotations

import heapq
import random
from collections import defaultdict
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, Callable, Dict, Iterator, List, NamedTuple, Optional, Set, Tuple, Union

import genpy
import rosbag

from self_awareness.output_files import replacing
from self_awareness.stamps import SECOND_NS, nanoseconds
from self_awareness_follow_me.component import Component, Message, Publish, Request, Wake
from self_awareness_follow_me.component_spec import ComponentSpec
from self_awareness_follow_me.effects import Induced, Intruder
from self_awareness_follow_me.faults import check_form, effect_of
from self_awareness_follow_me.messages import MessageType
from self_awareness_follow_me.scenario import Scenario, load_scenario

START_S = 1_600_000_000.0  # start of a recording if none is given (s since 1970)

_DAY_S = 86_400.0
_DAYS = 10_000  # that a recording may be of; bags end in 2106

# A recording starts on a robot that has been running: every component has had its inputs by then.
_WARM_UP_NS = 15 * SECOND_NS

# A component, and what it will do at some time.
_Act = Tuple[str, Callable[[int], List[Request]]]


class Event(NamedTuple):
    """A message as the recorder sees it."""

    stamp_ns: int  # arrival (ns since 1970)
    source: str  # node
    topic: str  # with the slash
    datatype: str  # of the message
    message: Message  # what it says
    number: int  # that its publisher gave it (header.seq)


@dataclass(frozen=True)
class InducedFault:
    """A fault to induce.

    Args:
        kind: its name as in `faults`: `cc1`, `crash:slam` and so on.
        onset_s: seconds after the start of the recording, >= 0; the fault then stays.

    Raises:
        ValueError: a name of another form, or an onset before the start.
    """

    kind: str
    onset_s: float

    def __post_init__(self) -> None:
        check_form(self.kind)
        if not 0.0 <= self.onset_s < float('inf'):
            raise ValueError(f'fault {self.kind}: the onset must be at least 0 s, '
                             f'not {self.onset_s}')


def start_of(seed: int) -> float:
    """Return when the recording of a seed starts (s since 1970): each on a day of its own."""
    return START_S + _DAY_S * (seed % _DAYS)


def events(duration_s: float, seed: int, fault: Optional[InducedFault] = None,
           scenario: Optional[Scenario] = None, start_s: float = START_S) -> Iterator[Event]:
    """Return what a recorder would see, in the order of arrival; arguments as for `simulate`."""
    if not 0.0 < duration_s < float('inf'):
        raise ValueError(f'the duration must be more than 0 s, not {duration_s}')
    if not _WARM_UP_NS / SECOND_NS <= start_s < 2 ** 32 - duration_s:
        raise ValueError('the start must be a time in s since 1970, at least '
                         f'{_WARM_UP_NS // SECOND_NS}, that fits into a bag, not {start_s}')
    scenario = load_scenario() if scenario is None else scenario
    start = nanoseconds(start_s)
    induced = (Induced() if fault is None else
               Induced(effect_of(scenario, fault.kind), start + nanoseconds(fault.onset_s)))
    robot = _Robot(scenario, seed, start - _WARM_UP_NS, induced)
    return _attach_recorder(robot.run(start + nanoseconds(duration_s)), scenario, start)


def simulate(path: Union[str, Path], duration_s: float, seed: int,
             fault: Optional[InducedFault] = None, scenario: Optional[Scenario] = None,
             start_s: float = START_S,
             progress: Callable[[int], Any] = lambda seconds: None) -> None:
    """Write a recording of the robot to a bag, as `rosbag record` would.

    The bag appears under its name only when it is complete.

    Args:
        path: the bag; one that exists is replaced.
        duration_s: length of the recording (s), > 0.
        seed: any int; decides everything that is random.
        fault: the fault to induce, if any.
        scenario: the robot, by default the one that comes with the package.
        start_s: start of the recording (s since 1970), at least 15.
        progress: called now and then with the number of simulated seconds since the last call.

    Raises:
        ValueError: an argument out of range.
        SectionError: the default scenario cannot be used, or a message type is unknown.
        OSError: the file cannot be written.
    """
    scenario = load_scenario() if scenario is None else scenario
    recording = events(duration_s, seed, fault, scenario, start_s)
    types = {topic: MessageType(datatype) for topic, datatype in scenario.datatypes.items()}
    told = 0
    with replacing(str(path)) as temporary, rosbag.Bag(temporary, 'w') as bag:
        connections: Dict[Tuple[str, str], Any] = {}  # by source and topic
        latched = _latched(scenario)
        for event in recording:
            message = types[event.message.topic].to_ros(event.message, event.number)
            _write(bag, connections, event, message, event.topic in latched)
            elapsed = (event.stamp_ns - nanoseconds(start_s)) // SECOND_NS
            if elapsed > told:
                progress(elapsed - told)
                told = elapsed
    progress(int(duration_s) - told)


def _write(bag: rosbag.Bag, connections: Dict[Tuple[str, str], Any], event: Event, message: Any,
           latched: bool) -> None:
    """Write a message with a connection for each publisher, as `rosbag record` does."""
    source, topic = event.source, event.topic
    header = None
    # rosbag itself has one connection for each topic, however many nodes publish there.
    if (source, topic) in connections:
        bag._topic_connections[topic] = connections[source, topic]
    else:
        bag._topic_connections.pop(topic, None)
        header = {'topic': topic, 'type': message._type, 'md5sum': message._md5sum,
                  'message_definition': message._full_text, 'callerid': source,
                  'latching': '1' if latched else '0'}
    bag.write(topic, message, genpy.Time(*divmod(event.stamp_ns, SECOND_NS)),
              connection_header=header)
    connections[source, topic] = bag._topic_connections[topic]


def _attach_recorder(recording: Iterator[Event], scenario: Scenario,
                     start: int) -> Iterator[Event]:
    """Leave out what came before the start, except what latched publishers repeat then."""
    repeated: Dict[str, Event] = {}
    latched = _latched(scenario)
    for event in recording:
        if event.stamp_ns >= start:
            yield from (each._replace(stamp_ns=start) for each in repeated.values())
            repeated.clear()
            yield event
        elif event.topic in latched:
            repeated[event.topic] = event


def _latched(scenario: Scenario) -> Set[str]:
    return {f'/{topic}' for spec in scenario.components
            for topic, output in spec.outputs().items() if output.latch}


class _Robot:
    """All components, the messages between them, and the queue of what happens next."""

    def __init__(self, scenario: Scenario, seed: int, begin: int, fault: Induced) -> None:
        self._scenario = scenario
        self._fault = fault
        # One random stream each: what one component draws does not change the others.
        self._rng = random.Random(f'{seed}/transport')
        self._components: Dict[str, Component] = {}
        self._subscribers: Dict[str, List[str]] = {topic: [] for topic in scenario.datatypes}
        self._sequences: Dict[Tuple[str, str], int] = defaultdict(int)
        self._arrivals: Dict[Tuple[str, str, str], int] = {}
        self._queue: List[Tuple[int, int, Union[Event, _Act]]] = []
        self._pushed = 0
        for spec in scenario.components:
            self._add(spec, seed, begin)
        if isinstance(fault.effect, Intruder):
            self._add(fault.effect.spec, seed, fault.onset)

    def run(self, end: int) -> Iterator[Event]:
        """Yield what arrives at the recorder before `end` (ns), in order."""
        while self._queue and self._queue[0][0] < end:
            now, _, item = heapq.heappop(self._queue)
            if isinstance(item, Event):
                yield item
                continue
            name, act = item
            if not self._fault.has_killed(name, now):
                for request in act(now):
                    self._schedule(name, request, now)

    def _add(self, spec: ComponentSpec, seed: int, begin: int) -> None:
        component = Component(spec, random.Random(f'{seed}/{spec.name}'),
                              self._fault.clock(spec.host), self._fault.spec_at(spec))
        self._components[spec.name] = component
        for topic in spec.inputs():
            self._subscribers[topic].append(spec.name)
        self._push(begin, (spec.name, component.start))

    def _schedule(self, name: str, request: Request, now: int) -> None:
        component = self._components[name]
        slowdown = self._fault.slowdown(now)
        if isinstance(request, Publish):
            self._transmit(name, request, now + request.delay)
        elif isinstance(request, Wake):
            late = round(self._scenario.lateness.draw(self._rng) * slowdown)
            self._push(request.at + late, (name, partial(component.wake, timer=request.timer)))
        else:
            done = now + round(request.takes * slowdown) + request.waits
            self._push(done, (name, component.work_done))

    def _transmit(self, name: str, request: Publish, now: int) -> None:
        message = request.message
        topic = message.topic
        self._sequences[name, topic] += 1
        if request.lost:
            return
        arrival = self._arrival(name, topic, '', now)
        self._push(arrival, Event(arrival, f'/{name}', f'/{topic}',
                                  self._scenario.datatypes[topic], message,
                                  self._sequences[name, topic]))
        for subscriber in self._subscribers[topic]:
            receive = self._components[subscriber].receive
            self._push(self._arrival(name, topic, subscriber, now),
                       (subscriber, partial(receive, message=message)))

    def _arrival(self, publisher: str, topic: str, subscriber: str, now: int) -> int:
        # Messages do not overtake each other on one connection.
        connection = (publisher, topic, subscriber)
        arrival = max(now + self._scenario.transport.draw(self._rng),
                      self._arrivals.get(connection, 0) + 1)
        self._arrivals[connection] = arrival
        return arrival

    def _push(self, at: int, item: Union[Event, _Act]) -> None:
        self._pushed += 1
        heapq.heappush(self._queue, (at, self._pushed, item))
