"""A simulated robot: components whose outputs send messages, and a recorder that hears all."""
from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Callable, Dict, FrozenSet, List, Set, Tuple

import numpy as np

from self_awareness import EventType
from self_awareness.stamps import SECOND_NS, nanoseconds
from self_awareness_evaluation.families.emissions import (Emission, Feedback, Once, Sporadic,
                                                          attributes_of, has_header, stalled)
from self_awareness_evaluation.families.scene import (AFTER_CRASH, CRASH, DOUBLE_RATE, FAILS,
                                                      FLOOD, HALF_RATE, LASTS_S, LATE, LOAD,
                                                      LONGEST_START_S, LOSSES, MISSES, NOTHING,
                                                      OLD, OTHER, RESTART, SILENT, SLOWER, STARVED,
                                                      Activity, Conditions, Fault, Scene, in_order)
from self_awareness_evaluation.records import WindowedEvents

# Topic and datatype of log lines that a component writes without end with FLOOD.
LOG, WARNING = '/rosout', 'rosgraph_msgs/Log[level=4]'

_SLOWER_RATE = 0.7
_LATE_S = 0.06
_OLD_S = 3.0  # of stamps
_LOST = 0.3
_FLOOD_HZ = 100.0
_FAILS = 0.8  # of the goals, with FAILS
_MISSED_S = 1.0  # what asks in this time is not answered
_BETWEEN_MISSES_S = 5.0  # mean time until it happens again
_STARVED_S = 0.15  # mean time that a message waits when the CPU is starved fully
_GROWS_S = 20.0  # until it is

_FIRST_START_S = 1_600_000_000
_BETWEEN_STARTS_S = 100_000
_SHORT_PAUSE_S = 3.0  # who pauses for less on average is still regular
_RECORDER = ''


@dataclass(frozen=True)
class Output:
    """A topic that a component publishes."""

    source: str  # name of the component
    topic: str
    datatype: str  # of the messages
    emission: Emission  # when it sends; answers are to outputs before it
    other: str = ''  # datatype with another value, that it has with OTHER; empty: it has none
    fails: float = 0.0  # share of the messages that have it anyhow; with FAILS, 0.8


@dataclass(frozen=True)
class Robot:
    """A robot as it was drawn."""

    seed: int  # decides, with that of the start, everything that is random; at least 0
    outputs: Tuple[Output, ...]  # of all components
    conditions: Conditions = Conditions()  # of all messages
    activities: Dict[str, Activity] = field(default_factory=dict)  # by name
    # Further pairs of publisher and subscriber, of whom the second does not answer to the first.
    subscriptions: FrozenSet[Tuple[str, str]] = frozenset()
    # Components on the other side of the wireless link; the recorder is on this one.
    far: FrozenSet[str] = frozenset()

    @property
    def sources(self) -> Set[str]:
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
        regular: List[bool] = []
        brief = {name for name, each in self.activities.items() if each.off_s <= _SHORT_PAUSE_S}
        for emission in (output.emission for output in self.outputs):
            regular.append(not isinstance(emission, (Feedback, Sporadic, Once))
                           and emission.activity in {'', *brief}
                           and (emission.trigger is None or regular[emission.trigger]))
        return list(dict.fromkeys(output.source for output, is_so in zip(self.outputs, regular)
                                  if is_so))

    @property
    def seldom(self) -> List[str]:
        """The components that send when something happens, and are asked by nobody."""
        others = {*self.regular, *self.answering, *self.latching}
        return self.sending(lambda output: output.source not in others)

    def sending(self, has: Callable[[Output], bool]) -> List[str]:
        """Return the components with such an output."""
        return list(dict.fromkeys(output.source for output in self.outputs if has(output)))

    @property
    def latching(self) -> List[str]:
        """The components that say something when they start, and nothing else."""
        goes_on = {output.source for output in self.outputs
                   if not isinstance(output.emission, Once)}
        return self.sending(lambda output: output.source not in goes_on)

    @property
    def numbered(self) -> List[str]:
        """The regular components whose messages have headers, each on its first topic."""
        first: Dict[str, bool] = {}
        for index, output in enumerate(self.outputs):
            first.setdefault(output.source, has_header(output.datatype, index))
        return [source for source in self.regular if first[source]]

    @property
    def answering(self) -> List[str]:
        """The components that answer to another one, and not only to what they began."""
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

    def start(self, start_seed: int, seconds: float, fault: Fault = NOTHING,
              begin_s: float = 0.0) -> WindowedEvents:
        """Return a recording of a start, some seconds from `begin_s` on. A fault changes nothing
        before its onset. Raise ValueError if it is beyond LONGEST_START_S, or nothing happens.
        The seed of the start, from 0 to 20000, decides what is the same in a whole one, such as
        the phases of timers."""
        assert fault.source in {'', *self.sources}, fault
        if not 0.0 <= begin_s < begin_s + seconds <= LONGEST_START_S:
            raise ValueError(f'a recording from {begin_s} s on, {seconds} s long: not in a start '
                             f'of {LONGEST_START_S:g} s')
        scene = Scene(self.seed, start_seed, begin_s, begin_s + seconds, self.conditions,
                      self.activities, fault)
        for index in range(len(self.outputs)):
            scene.published.append(self._published(scene, index))
        origin = (_FIRST_START_S + start_seed * _BETWEEN_STARTS_S) * SECOND_NS
        return replace(self._recording(scene, origin), waiting=_waiting(scene, origin))

    def _answers_others(self, output: Output) -> bool:
        asked_by, trigger = set(), output.emission.trigger
        while trigger is not None:
            asked_by.add(self.outputs[trigger].source)
            trigger = self.outputs[trigger].emission.trigger
        return bool(asked_by) and output.source not in asked_by

    def _published(self, scene: Scene, index: int) -> np.ndarray:
        """Return when an output sends, with the fault."""
        output, fault = self.outputs[index], scene.fault
        times = output.emission.times(scene, index,
                                      lambda heard: self._heard(scene, heard, output.source)[0])
        times = stalled(self.conditions.hiccup(times, scene.of_recording(f'hiccup {index}')),
                        scene)
        if output.source in fault.others:
            return times[times < scene.recorded_from + fault.follows_s]
        if fault.kind == LOAD and fault.source != output.source:
            since = times - scene.recorded_from - fault.follows_s
            return _waited(times, (since >= 0) & (since < LASTS_S), scene, index)
        if fault == NOTHING or fault.source not in ('', output.source):
            return times
        hit, onset = scene.in_fault(times), scene.recorded_from + fault.onset_s
        relief = scene.recorded_from + fault.relief_s
        is_timed = output.emission.trigger is None
        if fault.kind in (CRASH, SILENT, *AFTER_CRASH):
            return times[~hit]
        if fault.kind == RESTART:
            shift = 0.0
            if is_timed and len(times) > 1:  # the phase of its timer is another one
                shift = float(np.median(np.diff(times))) * float(
                    scene.of_recording(f'restart {index}').uniform())
            return times[~hit] + shift * (times[~hit] >= relief)
        if fault.kind == STARVED:
            grown = np.clip((times - scene.recorded_from - fault.onset_s) / _GROWS_S, 0.0, 1.0)
            return _waited(times, grown * hit, scene, index)
        if fault.kind == FLOOD and output.datatype == WARNING:
            lines = np.arange(onset, scene.end, 1.0 / _FLOOD_HZ)
            return np.sort(np.concatenate([times, lines]))
        answers = self._answers_others(output)
        if fault.kind == MISSES and answers:
            return times[~(hit & _missed(times, scene))]
        if fault.kind == LATE and answers:
            return in_order(times + _LATE_S * hit)
        if fault.kind == SLOWER and is_timed:
            slow = onset + (times[hit] - onset) / _SLOWER_RATE
            return np.sort(np.concatenate([times[~hit], slow[slow < relief]]))
        # What answers to another output of the component has the rate of that.
        if fault.kind in (HALF_RATE, SLOWER) and (is_timed or answers):
            left = 0.5 if fault.kind == HALF_RATE else _SLOWER_RATE
            return times[~hit | (np.diff(np.floor(np.arange(-1, len(times)) * left)) > 0)]
        if fault.kind == DOUBLE_RATE and (is_timed or answers):
            return np.sort(np.concatenate([times, (times[1:] + times[:-1])[hit[:-1]] / 2.0]))
        return times

    def _recorded(self, scene: Scene, index: int) -> Tuple[np.ndarray, np.ndarray]:
        """Return when the recorder hears an output, and the attributes of the messages."""
        output = self.outputs[index]
        times, numbers = self._heard(scene, index, _RECORDER)
        lost = scene.has(LOSSES, output.source, times)
        lost &= scene.of_recording(f'losses {index}').uniform(size=len(times)) < _LOST
        times, numbers = times[~lost], numbers[~lost]
        return times, attributes_of(
            output.datatype, scene, index, times, numbers, times - scene.published[index][numbers]
            + _OLD_S * scene.has(OLD, output.source, times))

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

    def _recording(self, scene: Scene, origin: int) -> WindowedEvents:
        """Return what the recorder hears in its time; origin: of the start [ns]."""
        outputs = list(self.outputs)
        heard: List[Tuple[np.ndarray, np.ndarray]] = []
        others: List[Tuple[np.ndarray, np.ndarray]] = []
        for index, output in enumerate(self.outputs):
            times, attributes = self._recorded(scene, index)
            inside = (times >= scene.recorded_from) & (times < scene.end)
            times, attributes = times[inside], attributes[inside]
            says = scene.has(OTHER, output.source, times)
            if output.fails:
                draws = scene.of_recording(f'fails {index}').random(len(times))
                says = draws < np.where(scene.has(FAILS, output.source, times), _FAILS,
                                        output.fails)
            if output.other and says.any():
                outputs.append(replace(output, datatype=output.other))
                others.append((times[says], attributes[says]))
                times, attributes = times[~says], attributes[~says]
            heard.append((times, attributes))
        heard += others
        all_times, all_attributes = (np.concatenate(parts) for parts in zip(*heard))
        stamps = origin + (all_times * SECOND_NS).astype(np.int64)
        if not len(stamps):
            raise ValueError(f'nothing happens in the {scene.end - scene.recorded_from:g} s of '
                             'the recording')
        # As the bag reader does: types in the order in which they come first.
        present = sorted((index for index, (times, _) in enumerate(heard) if len(times)),
                         key=lambda index: heard[index][0][0])
        ids = np.zeros(len(heard), dtype=np.uint32)
        ids[present] = np.arange(len(present))
        order = np.argsort(stamps, kind='stable')
        return WindowedEvents(
            [EventType(outputs[index].source, outputs[index].topic, outputs[index].datatype)
             for index in present],
            stamps[order], np.repeat(ids, [len(times) for times, _ in heard])[order],
            origin + nanoseconds(scene.end), attributes=all_attributes[order])


def _missed(times: np.ndarray, scene: Scene) -> np.ndarray:
    """Return which times lie in those in which a component misses its inputs."""
    rng = scene.of_recording(f'missed {scene.fault.source}')
    number = int((scene.end - scene.begin) / _BETWEEN_MISSES_S * 2.0) + 20
    edges = scene.begin + np.cumsum(np.column_stack(
        [rng.exponential(_BETWEEN_MISSES_S, number), np.full(number, _MISSED_S)]).ravel())
    return np.searchsorted(edges, times, side='right') % 2 == 1


def _waited(times: np.ndarray, load: np.ndarray, scene: Scene, index: int) -> np.ndarray:
    """Return when an output sends on a CPU that is starved, by the load at its times, 0 to 1."""
    waits = scene.of_recording(f'starved {index}').exponential(_STARVED_S, len(times))
    return in_order(times + waits * load)


def _waiting(scene: Scene, origin: int) -> List[Tuple[int, int, int]]:
    """Return what a recorder on the host measures: it stalls with all others."""
    stretches: List[Tuple[int, int, int]] = []
    until = origin + nanoseconds(scene.recorded_from)
    for start, length in zip(*scene.stalls):
        end = origin + nanoseconds(start + length)
        begin = max(origin + nanoseconds(start), until)
        if end > begin:
            stretches += [(until, begin, 0), (begin, end, end - begin)]
            until = end
    return stretches
