"""A simulated robot: components whose outputs send messages, and a recorder that hears all."""
from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Callable, Dict, FrozenSet, Iterable, List, Optional, Set, Tuple

import numpy as np

from self_awareness import EventType, Waiting
from self_awareness.stamps import SECOND_NS, nanoseconds
from self_awareness_evaluation.families import messages
from self_awareness_evaluation.families.conditions import Activity, Conditions, in_order
from self_awareness_evaluation.families.emissions import (Emission, Feedback, Once,
                                                          Sporadic, stalled)
from self_awareness_evaluation.families.scene import Scene
from self_awareness_evaluation.windowed_events import WindowedEvents

CRASH, HALF_RATE, LATE, MISSES, RESTART = ('crash', 'half rate', 'late 60 ms', 'misses inputs',
                                           'restart')
"""The kinds of faults of one component."""

STALL, LOAD, STOP = 'stall after a crash', 'load after a crash', 'stop after a crash'
"""Crashes that something else follows, which must not hide them."""

AFTER_CRASH = (STALL, LOAD, STOP)

SLOWER = '0.7 of the rate'
"""A fault of one component that no gap alone shows."""

OLD, LOSSES, OTHER, FLOOD = 'old stamps', 'loses 30 %', 'new value', 'flood of log lines'
"""The kinds of faults of one component that what it says shows."""

STARVED, SILENT = 'starved CPU', 'everything silent'
"""The kinds of faults of the whole robot."""

SLOWER_RATE = 0.7

LATE_S = 0.06

LOG, WARNING = '/rosout', 'rosgraph_msgs/Log[level=4]'
"""Topic and datatype of log lines that a component writes without end with FLOOD."""

_OLD_S = 3.0  # of stamps
_LOST = 0.3
_FLOOD_HZ = 100.0

_MISSED_S = 1.0  # what asks in this time is not answered
_BETWEEN_MISSES_S = 5.0  # mean time until it happens again
_STARVED_S = 0.15  # mean time that a message waits when the CPU is starved fully
_GROWS_S = 20.0  # until it is
_LASTS_S = 2.0  # what follows a crash

LONGEST_START_S = 90_000.0
"""A start of the robot lasts no longer than this [s]."""

_FIRST_START_S = 1_600_000_000
_BETWEEN_STARTS_S = 100_000
_SHORT_PAUSE_S = 3.0  # who pauses for less on average is still regular
_RECORDER = ''


@dataclass(frozen=True)
class Fault:
    """A fault of one component, or of the whole robot.

    Args:
        kind: CRASH: it is silent. STALL: it is, and later the host stands still for 2 s. LOAD:
            instead, all messages wait for 2 s. STOP: instead, others that do not hear it or each
            other are silent, too. RESTART: it is silent, too; after the relief its timers have
            other phases. HALF_RATE: it leaves out every second message. SLOWER: its timers are
            slower, and it leaves out some answers. LATE: its answers to others come LATE_S later.
            MISSES: it answers nothing for a second, now and then. What answers to it suffers as
            it would. OLD: its stamps are 3 s older. LOSSES: 30 % of its messages never arrive.
            OTHER: its outputs say their other value. FLOOD: it logs 100 warnings a second.
            STARVED: all messages wait, longer and longer within 20 s. SILENT: nobody sends.
        source: the component; empty: the robot.
        onset_s: from the beginning of the recording [s].
        relief_s: from there on all is well again [s].
        follows_s: of STALL, LOAD and STOP, when what follows the crash begins [s].
        others: of STOP, the components that are silent then.
    """

    kind: str
    source: str
    onset_s: float
    relief_s: float = LONGEST_START_S
    follows_s: float = LONGEST_START_S
    others: Tuple[str, ...] = ()


@dataclass(frozen=True)
class Output:
    """A topic that a component publishes.

    Args:
        source: name of the component.
        topic: that it publishes.
        datatype: of the messages.
        emission: when it sends; answers are to outputs before it.
        other: datatype with another value, that it has with OTHER; empty: it has none.
    """

    source: str
    topic: str
    datatype: str
    emission: Emission
    other: str = ''


@dataclass(frozen=True)
class Robot:
    """A robot as it was drawn.

    Args:
        seed: decides, with that of the start, everything that is random; at least 0.
        outputs: of all components.
        conditions: of all messages.
        activities: by name.
        subscriptions: further pairs of publisher and subscriber, of whom the second does not
            answer to the first.
        far: components on the other side of the wireless link; the recorder is on this one.
    """

    seed: int
    outputs: Tuple[Output, ...]
    conditions: Conditions = Conditions()
    activities: Dict[str, Activity] = field(default_factory=dict)
    subscriptions: FrozenSet[Tuple[str, str]] = frozenset()
    far: FrozenSet[str] = frozenset()

    @property
    def sources(self) -> Set[str]:
        """The components."""
        return {output.source for output in self.outputs}

    @property
    def graph(self) -> Set[Tuple[str, str, str]]:
        """Publisher, topic and subscriber of all that is heard by other components."""
        heard = {(output.source, output.topic, subscriber) for output in self.outputs
                 for publisher, subscriber in self.subscriptions if publisher == output.source}
        for output in self.outputs:
            if output.emission.trigger is not None:
                asking = self.outputs[output.emission.trigger]
                heard.add((asking.source, asking.topic, output.source))
        return {edge for edge in heard if edge[0] != edge[2]}

    @property
    def regular(self) -> List[str]:
        """The components that send all the time, or pause for some seconds at the most."""
        regular = [False] * len(self.outputs)
        for index, output in enumerate(self.outputs):
            emission = output.emission
            regular[index] = (not isinstance(emission, (Feedback, Sporadic, Once))
                              and self._goes_on(emission.activity)
                              and (emission.trigger is None or regular[emission.trigger]))
        return _distinct(output.source for output, is_so in zip(self.outputs, regular) if is_so)

    @property
    def seldom(self) -> List[str]:
        """The components that send when something happens, and answer to nobody."""
        others = {*self.regular, *self.answering, *self.latching}
        return [source for source in _distinct(output.source for output in self.outputs)
                if source not in others]

    def sending(self, has: Callable[[Output], bool]) -> List[str]:
        """Return the components with such an output."""
        return _distinct(output.source for output in self.outputs if has(output))

    @property
    def latching(self) -> List[str]:
        """The components that say something when they start, and nothing else."""
        goes_on = {output.source for output in self.outputs
                   if not isinstance(output.emission, Once)}
        return [source for source in _distinct(output.source for output in self.outputs)
                if source not in goes_on]

    @property
    def numbered(self) -> List[str]:
        """The regular components whose messages have headers, each on its first topic."""
        first: Dict[str, bool] = {}
        for index, output in enumerate(self.outputs):
            first.setdefault(output.source, messages.has_header(output.datatype, index))
        return [source for source in self.regular if first[source]]

    @property
    def answering(self) -> List[str]:
        """The components that answer to another one."""
        return self.sending(self._answers_others)

    def strangers_of(self, source: str, most: int) -> Tuple[str, ...]:
        """Return regular components that need neither a component nor each other, and which they
        do not need."""
        chosen = [source]
        for other in self.regular:
            reached = self.reached_by(other)
            if len(chosen) <= most and not any(
                    each in reached or other in self.reached_by(each) for each in chosen):
                chosen.append(other)
        return tuple(chosen[1:])

    def reached_by(self, source: str) -> Set[str]:
        """Return a component, and those that its messages reach, whoever passes them on."""
        graph, reached = self.graph, {source}
        while True:
            further = {edge[2] for edge in graph if edge[0] in reached} - reached
            if not further:
                return reached
            reached |= further

    def start(self, start_seed: int, seconds: float, fault: Optional[Fault] = None,
              begin_s: float = 0.0) -> WindowedEvents:
        """Return a recording of a start.

        A fault changes nothing before its onset.

        Args:
            start_seed: decides what is the same in a whole start, such as the phases of timers;
                from 0 to 20000.
            seconds: length of the recording, > 0.
            fault: None: normal operation.
            begin_s: of the recording in the start [s].

        Raises:
            ValueError: the recording is beyond LONGEST_START_S, nothing happens in it, or the
                fault is of a component or kind that there is not.
        """
        if not 0.0 <= begin_s < begin_s + seconds <= LONGEST_START_S:
            raise ValueError(f'a recording from {begin_s} s on, {seconds} s long: not in a start '
                             f'of {LONGEST_START_S:g} s')
        if fault is not None:
            self._check(fault)
        scene = Scene(self.seed, start_seed, begin_s, begin_s + seconds, self.conditions,
                      self.activities)
        if fault is not None and fault.kind == STALL:
            scene.stall(begin_s + fault.follows_s, _LASTS_S)
        for index in range(len(self.outputs)):
            scene.published.append(self._published(scene, index, fault, begin_s))
        recorded = [self._recorded(scene, index, fault, begin_s)
                    for index in range(len(self.outputs))]
        heard = [times for times, _ in recorded]
        attributes = [messages.attributes(
            output.datatype, scene, index, times, numbers, times - scene.published[index][numbers]
            + _OLD_S * _is_hit(fault, OLD, output, times, begin_s))
            for index, (output, (times, numbers)) in enumerate(zip(self.outputs, recorded))]
        origin = (_FIRST_START_S + start_seed * _BETWEEN_STARTS_S) * SECOND_NS
        return replace(self._merged(heard, attributes, fault, begin_s, begin_s + seconds, origin),
                       waiting=_waiting(scene, begin_s, origin))

    def _check(self, fault: Fault) -> None:
        of_robot = fault.kind in (STARVED, SILENT)
        if not of_robot and fault.kind not in (
                CRASH, HALF_RATE, SLOWER, LATE, MISSES, RESTART, OLD, LOSSES, OTHER, FLOOD,
                *AFTER_CRASH):
            raise ValueError(f'{fault.kind}: no such kind of fault')
        if fault.source not in ({''} if of_robot else {output.source for output in self.outputs}):
            raise ValueError(f'{fault.source}: no such component')

    def _goes_on(self, activity: str) -> bool:
        return not activity or self.activities[activity].off_s <= _SHORT_PAUSE_S

    def _answers_others(self, output: Output) -> bool:
        trigger = output.emission.trigger
        return trigger is not None and self.outputs[trigger].source != output.source

    def _published(self, scene: Scene, index: int, fault: Optional[Fault],
                   begin_s: float) -> np.ndarray:
        """Return when an output sends, with the fault."""
        output = self.outputs[index]
        times = output.emission.times(scene, index,
                                      lambda heard: self._heard(scene, heard, output.source)[0])
        times = stalled(self.conditions.hiccup(times, scene.of_recording(f'hiccup {index}')),
                        scene)
        if fault is None:
            return times
        if output.source in fault.others:
            return times[times < begin_s + fault.follows_s]
        if fault.kind == LOAD and fault.source != output.source:
            since = times - begin_s - fault.follows_s
            return _waited(times, (since >= 0) & (since < _LASTS_S), scene, index)
        if fault.source not in ('', output.source):
            return times
        hit = _during(fault, times, begin_s)
        if fault.kind in (CRASH, SILENT, *AFTER_CRASH):
            return times[~hit]
        if fault.kind == RESTART:
            shift = (_new_phase(times, scene, index) if output.emission.trigger is None else 0.0)
            return times[~hit] + shift * (times[~hit] >= begin_s + fault.relief_s)
        if fault.kind == STARVED:
            grown = np.clip((times - begin_s - fault.onset_s) / _GROWS_S, 0.0, 1.0) * hit
            return _waited(times, grown, scene, index)
        if fault.kind in (OLD, LOSSES, OTHER):
            return times
        if fault.kind == FLOOD:
            if output.datatype != WARNING:
                return times
            lines = np.arange(begin_s + fault.onset_s, scene.end, 1.0 / _FLOOD_HZ)
            return np.sort(np.concatenate([times, lines]))
        if fault.kind == MISSES:
            if not self._answers_others(output):
                return times
            return times[~(hit & _missed(times, scene, fault))]
        if fault.kind == LATE:
            return in_order(times + LATE_S * hit) if self._answers_others(output) else times
        if fault.kind == SLOWER and output.emission.trigger is None:
            onset = begin_s + fault.onset_s
            slow = onset + (times[hit] - onset) / SLOWER_RATE
            return np.sort(np.concatenate([times[~hit], slow[slow < begin_s + fault.relief_s]]))
        if output.emission.trigger is None or self._answers_others(output):
            left = 0.5 if fault.kind == HALF_RATE else SLOWER_RATE
            return times[~hit | (np.diff(np.floor(np.arange(-1, len(times)) * left)) > 0)]
        return times  # it answers to another output of the component, whose rate is halved

    def _recorded(self, scene: Scene, index: int, fault: Optional[Fault],
                  begin_s: float) -> Tuple[np.ndarray, np.ndarray]:
        """Return when the recorder hears an output, and the numbers of its messages."""
        times, numbers = self._heard(scene, index, _RECORDER)
        lost = _is_hit(fault, LOSSES, self.outputs[index], times, begin_s)
        lost &= scene.of_recording(f'losses {index}').uniform(size=len(times)) < _LOST
        return times[~lost], numbers[~lost]

    def _heard(self, scene: Scene, index: int, listener: str) -> Tuple[np.ndarray, np.ndarray]:
        """Return when the messages of an output reach a component, or the recorder, and their
        numbers."""
        source = self.outputs[index].source
        way = f'{index} to {listener}'
        over_link = source != listener and (source in self.far) != (listener in self.far)
        arrived = self.conditions.transport(scene.published[index], over_link,
                                            scene.of_recording(f'transport {way}'))
        received = self.conditions.received(arrived, scene.of_recording(f'lost {way}'))
        return arrived[received], np.flatnonzero(received)

    def _merged(self, recorded: List[np.ndarray], attributes: List[np.ndarray],
                fault: Optional[Fault], begin: float, end: float, origin: int) -> WindowedEvents:
        kept = [(times >= begin) & (times < end) for times in recorded]
        inside = [times[those] for times, those in zip(recorded, kept)]
        outputs = list(self.outputs)
        attributes = [each[those] for each, those in zip(attributes, kept)]
        for index, output in enumerate(self.outputs):
            says = _is_hit(fault, OTHER, output, inside[index], begin)
            if output.other and says.any():
                outputs.append(replace(output, datatype=output.other))
                for parts in (inside, attributes):
                    parts.append(parts[index][says])
                    parts[index] = parts[index][~says]
        stamps = origin + (np.concatenate(inside) * SECOND_NS).astype(np.int64)
        if not len(stamps):
            raise ValueError(f'nothing happens in the {end - begin:g} s of the recording')
        # As the bag reader does: types in the order in which they come first.
        present = sorted((index for index, times in enumerate(inside) if len(times)),
                         key=lambda index: inside[index][0])
        ids = np.zeros(len(inside), dtype=np.uint32)
        ids[present] = np.arange(len(present))
        order = np.argsort(stamps, kind='stable')
        return WindowedEvents(
            [EventType(outputs[index].source, outputs[index].topic, outputs[index].datatype)
             for index in present],
            stamps[order], np.repeat(ids, [len(times) for times in inside])[order],
            origin + nanoseconds(end), attributes=np.concatenate(attributes)[order])


def _is_hit(fault: Optional[Fault], kind: str, output: Output, times: np.ndarray,
            begin_s: float) -> np.ndarray:
    """Return which times [s] of an output a fault of a kind concerns."""
    if fault is None or (fault.kind, fault.source) != (kind, output.source):
        return np.zeros(len(times), dtype=bool)
    return _during(fault, times, begin_s)


def _during(fault: Fault, times: np.ndarray, begin_s: float) -> np.ndarray:
    """Return which times [s] lie in a fault."""
    return (times >= begin_s + fault.onset_s) & (times < begin_s + fault.relief_s)


def _missed(times: np.ndarray, scene: Scene, fault: Fault) -> np.ndarray:
    """Return which times lie in those in which a component misses its inputs."""
    rng = scene.of_recording(f'missed {fault.source}')
    number = int((scene.end - scene.begin) / _BETWEEN_MISSES_S * 2.0) + 20
    edges = scene.begin + np.cumsum(np.column_stack(
        [rng.exponential(_BETWEEN_MISSES_S, number), np.full(number, _MISSED_S)]).ravel())
    return np.searchsorted(edges, times, side='right') % 2 == 1


def _waited(times: np.ndarray, load: np.ndarray, scene: Scene, index: int) -> np.ndarray:
    """Return when an output sends on a CPU that is starved, by the load at its times, 0 to 1."""
    waits = scene.of_recording(f'starved {index}').exponential(_STARVED_S, len(times))
    return in_order(times + waits * load)


def _new_phase(times: np.ndarray, scene: Scene, index: int) -> float:
    """Return by how much later a timer sends that was started again [s]."""
    period = float(np.median(np.diff(times))) if len(times) > 1 else 0.0
    return period * float(scene.of_recording(f'restart {index}').uniform())


def _waiting(scene: Scene, begin: float, origin: int) -> List[Waiting]:
    """Return what a recorder on the host measures, from `begin` on: it stalls with all others."""
    stretches = []
    until = origin + nanoseconds(begin)
    for start, length in zip(*scene.stalls()):
        end = origin + nanoseconds(start + length)
        stalled_at = max(origin + nanoseconds(start), until)
        if end > stalled_at:
            stretches += [Waiting(until, stalled_at, 0),
                          Waiting(stalled_at, end, end - stalled_at)]
            until = end
    return stretches


def _distinct(sources: Iterable[str]) -> List[str]:
    return list(dict.fromkeys(sources))
