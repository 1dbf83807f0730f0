"""The events that a model sees in recordings."""
from __future__ import annotations

import os
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Dict, Iterable, List, Mapping, NamedTuple, Optional, Sequence, Set, Tuple

import numpy as np

from self_awareness import (LATEST_EVENT, LEAST_KNOWN, LONGEST_SILENCE, BagError, EncodingRules,
                            EventType, ModelFileError, RecordedEvents, Recording, TrainedModel,
                            find_clock_steps, missing_subscriptions, progress, read_events,
                            summarise_bag)
from self_awareness.output_files import MODEL, RESULT_BAG
from self_awareness.parts import BagPart
from self_awareness.stamps import SECOND_NS
from self_awareness.training.robot_graph import RobotGraph

MOST_WINDOWS = 10_000_000
"""Of a recording: eleven days in windows of 0.1 s. Verdicts on them take some 100 MB."""

_MOST_STEPS = 3  # that are told


@dataclass(frozen=True)
class ClockStep:
    """The clock was set."""

    at_s: float  # when the next event came, from the recording's first message [s]
    by_s: float  # by how much, and the usual delay [s]; negative: back

    def __str__(self) -> str:
        way = 'forward' if self.by_s > 0 else 'back'
        return f'{way} by {abs(self.by_s):.1f} s before {self.at_s:.1f} s'


@dataclass(frozen=True)
class RecordingEvents:
    """The events of a recording, and what else is to be known of it to learn from it or judge it.

    Args:
        event_types: by id, those of the model first, those of players (senders) last. Alarms
            cannot name what training never saw without its type.
        stamps: int64 [ns], in order.
        ids: uint32, one for each stamp; those after the model's are unknown.
        end: stamp of the last message that was asked for, event or not [ns]; 0: of the last event.
        fingerprint: of the whole bag; it says which half of a training this is (half_of).
        bag: what the file is called, or the bag that an event log was made of.
        robot: its name; empty: not known.
        robot_start: when the robot was started [ns]; 0: not known.
        clock_steps: stamps of the first events after the clock was set [ns], where stamps do not
            say it.
        attributes: of the messages, uint32, one for each stamp (docs/method.md, section 3.10);
            None: not known.
        waiting: how the machine was, one stretch of time after the other: its begin and end, and
            how long processes waited for a processor in it [ns]; empty: not known.
        senders: what comes from two senders of one name, and what is played, from a time [ns] on.
        missing: which of the subscriptions that the model expects, from a time [ns] on each, as
            an event log says.
        hosts: computers of sources, as an event log says.
        before: stamps and ids of what came before, which only says when event types came first;
            ids from len(event_types) on are of no type of these.
        part: what was asked for.
        origin: stamp of the bag's first message [ns], where its time in seconds begins.
        one_sender_a_topic: the bag was written by a program that keeps only one (BagSummary).
        copied: so it is, and it is a copy of a recording.
        set_back: by how much the clock of a bag was set back, by such stamps as clock_steps [ns].
        left_out: why some connections of a bag are no events, whatever the encoding.
        files: path and stamp of the first message [ns] of each file, of a bag.
    """

    event_types: Sequence[EventType]
    stamps: np.ndarray
    ids: np.ndarray
    end: int = 0
    fingerprint: int = 0
    bag: str = ''
    robot: str = ''
    robot_start: int = 0
    clock_steps: Sequence[int] = ()
    attributes: Optional[np.ndarray] = None
    waiting: Sequence[Tuple[int, int, int]] = ()
    senders: Sequence[Tuple[int, Set[Tuple[str, str]], Set[EventType]]] = ()
    missing: Sequence[Tuple[int, Set[Tuple[str, str]]]] = ()
    hosts: Mapping[str, str] = field(default_factory=dict)
    before: Optional[Tuple[np.ndarray, np.ndarray]] = None
    part: BagPart = BagPart('')
    origin: int = 0
    one_sender_a_topic: bool = False
    copied: bool = False
    set_back: Mapping[int, int] = field(default_factory=dict)
    left_out: Tuple[str, ...] = ()
    files: Sequence[Tuple[str, int]] = ()

    @classmethod
    def of(cls, part: BagPart, events: RecordedEvents,
           encoding: EncodingRules) -> RecordingEvents:
        """Return the events that were read for a part, by an encoding."""
        summary, stamps = events.summary, events.stamps
        # By the events that come next, if there are some.
        set_back = {int(stamps[after]): by for stamp, by in summary.set_back
                    for after in [np.searchsorted(stamps, stamp)] if 0 < after < len(stamps)}
        steps = [] if summary.clock_watched else find_clock_steps(stamps, events.ids)
        _, end = part.span(summary.start, summary.end)
        return cls(
            events.event_types, stamps, events.ids, end, summary.fingerprint, summary.bag,
            summary.robot or part.robot, summary.robot_start, sorted({*steps, *set_back}),
            events.attributes, events.waiting, events.senders,
            hosts=RobotGraph(*summary.graph).hosts_of_sources(encoding), part=part,
            origin=summary.start, one_sender_a_topic=summary.one_sender_a_topic,
            copied=summary.copied, set_back=set_back, left_out=tuple(summary.left_out),
            files=summary.files)

    def place(self, stamp: int) -> str:
        """Return where a stamp [ns] lies, of a recording in several files; empty: it is in one."""
        begun = [(path, start) for path, start in self.files if start <= stamp] or self.files
        if len(self.files) < 2:
            return ''
        path, start = begun[-1]
        return f'{(stamp - start) / SECOND_NS:.1f} s of {os.path.basename(path)}'

    @cached_property
    def heard(self) -> np.ndarray:
        """Ids of the event types that occur, in order."""
        return np.flatnonzero(np.bincount(self.ids))

    @cached_property
    def steps_of_the_clock(self) -> List[ClockStep]:
        """Where the clock was set, in the order of the recording."""
        delays = np.diff(self.stamps)
        said = np.flatnonzero((delays < -LATEST_EVENT) | (delays > LONGEST_SILENCE))
        found = [int(np.argmax(self.stamps[1:] == stamp)) for stamp in self.clock_steps]
        return [ClockStep((after - self.origin) / SECOND_NS,
                          -self.set_back.get(after, -int(delays[i])) / SECOND_NS)
                for i in sorted({*said.tolist(), *found}) for after in [int(self.stamps[i + 1])]]

    @cached_property
    def recording(self) -> Recording:
        """What a model file says about the part."""
        start, end = self.part.span(self.origin, self.end)
        recording = Recording()
        recording.bag = self.bag
        recording.start = start
        recording.end = end
        recording.events = int(((self.stamps >= start) & (self.stamps <= end)).sum())
        recording.fingerprint = self.fingerprint
        recording.robot_start = self.robot_start
        recording.robot = self.robot
        return recording


def read(model: TrainedModel, part: BagPart) -> RecordingEvents:
    """Return the events of a bag, or of a part of it, by the encoding of a model.

    Raises:
        BagError: the bag cannot be read.
        ValueError: the time range is empty, the bag does not name the senders that the model tells
            apart, no message of it is an event, or the model knows none of its event types; the
            message names the part.
    """
    try:
        return _read(model, part)
    except ValueError as error:
        raise ValueError(f'{part}: {error}') from error


def _read(model: TrainedModel, part: BagPart) -> RecordingEvents:
    with progress.messages(os.path.basename(part.path)) as update:
        events = read_events(part.files, model.encoding, model.event_types, part.start, part.end,
                             update, part.recording)
    played = {kind for _, _, kinds in events.senders for kind in kinds}
    recording = replace(
        RecordingEvents.of(part, events, model.encoding),
        event_types=[*events.event_types, *sorted(played, key=str)],
        missing=missing_subscriptions(events.summary, model.encoding, model.subscriptions))
    _check(model, recording, events.summary.has_sources)
    check_windows(events.stamps, model.window)
    return recording


def check_windows(stamps: np.ndarray, window: int) -> None:
    """Check that a recording has no more windows than can be looked at.

    Windows without an event count as well: a few events an hour apart may have any number of them.

    Args:
        stamps: of its events [ns].
        window: length of a window [ns].

    Raises:
        ValueError: it has more than MOST_WINDOWS.
    """
    delays = np.diff(stamps)
    windows = int(delays[(delays > 0) & (delays <= LONGEST_SILENCE)].sum()) // window
    if windows > MOST_WINDOWS:
        raise ValueError(f'{windows} windows of {window / SECOND_NS:g} s, more than '
                         f'{MOST_WINDOWS}; name a part of it (@START-END)')


def few_known(model: TrainedModel, recording: RecordingEvents) -> Optional[str]:
    """Return what to tell of a recording that the model knows little of."""
    known, heard = _known(model, recording)
    if known >= LEAST_KNOWN * heard:
        return None
    return (f'the model knows {known} of the {heard} event types of this recording, and says '
            'nothing of the others: is it of this robot?')


def clock_steps(recording: RecordingEvents) -> Optional[str]:
    """Return what to tell of a recording in which the clock was set."""
    steps = recording.steps_of_the_clock
    return None if not steps else (
        f'the clock was set {in_words(steps)}, but the nodes went on without a pause. The '
        'recording is cut there; nothing counts as late')


def in_words(steps: Sequence[ClockStep]) -> str:
    """Return by how much and when the clock was set; of many steps, the first ones."""
    rest = len(steps) - _MOST_STEPS
    return ', '.join(map(str, steps[:_MOST_STEPS])) + (f', and {rest} more times' if rest > 0
                                                       else '')


def merged_senders(model: TrainedModel, recording: RecordingEvents) -> Optional[str]:
    """Return what to tell of a bag that has one sender of topics where the model knows several."""
    if not recording.one_sender_a_topic or model.encoding.source == 'none':
        return None
    known = _senders(model.event_types)
    heard = _senders([recording.event_types[i] for i in recording.heard])
    sources = set().union(*heard.values())

    def are_merged(topic: str) -> bool:
        others = known.get(topic, set()) - heard[topic]
        # In a bag that is no copy, who is not heard on any topic may as well have been off.
        return len(heard[topic]) == 1 and bool(others if recording.copied else others & sources)

    merged = [f'{topic} (here {min(heard[topic])} only, in the model {len(known[topic])} senders)'
              for topic in sorted(heard) if are_merged(topic)]
    return None if not merged else (
        'this bag names only one sender for each topic, as copies do that rosbag filter, compress '
        f'or decompress made: {", ".join(merged)}; use the bag as it was recorded')


def _senders(event_types: Iterable[EventType]) -> Dict[str, Set[str]]:
    senders: Dict[str, Set[str]] = {}
    for kind in event_types:
        senders.setdefault(kind.scope, set()).add(kind.source)
    return senders


def overlap(a: Recording, b: Recording) -> bool:
    """Return whether two recordings are the same, at least in part; names do not matter."""
    return a.fingerprint == b.fingerprint and a.start <= b.end and b.start <= a.end


class DistinctRecordings:
    """Recordings that are not the same, even in part."""

    def __init__(self) -> None:
        self._known: Dict[int, List[Tuple[str, Recording]]] = {}

    def same_as(self, name: str, recording: Recording) -> str:
        """Add a recording, or return the name of one that is the same, at least in part."""
        same = self._known.setdefault(recording.fingerprint, [])
        for other_name, other in same:
            if overlap(other, recording):
                return other_name
        same.append((name, recording))
        return ''

    def add(self, name: str, recording: Recording) -> None:
        """Add a recording.

        Raises:
            ValueError: one is the same, at least in part.
        """
        same = self.same_as(name, recording)
        if same:
            raise ValueError(f'{name}: the same recording as {same}; name it once')


def is_bag(path: str) -> bool:
    """Return whether a file is a bag that holds no model, which is a bag itself."""
    try:
        summarise_bag(path)
    except BagError:
        return False
    try:
        TrainedModel.load(path, watched_only=True)
    except ModelFileError as error:
        return 'holds no model' in str(error)
    return False


def check_kind(path: str) -> None:
    """Check that a bag with nothing to learn or to judge is at least a recording of a robot.

    Raises:
        ValueError: it is what the programs write.
    """
    if RESULT_BAG.is_one(path):
        raise ValueError('is a result bag (score --result-bag), and no recording')
    if MODEL.is_one(path):
        raise ValueError('is a model, and no recording')


def _check(model: TrainedModel, recording: RecordingEvents, has_sources: bool) -> None:
    if not has_sources or len(recording.stamps) == 0:
        check_kind(recording.part.path)
    if model.encoding.source == 'callerid' and not has_sources:
        raise ValueError('the model was trained with another encoding: it tells sources apart, '
                         'and no connection of this bag names its sender; train a model with '
                         '"source: none" (train --encoding)')
    if len(recording.stamps) == 0:
        raise ValueError('no message is an event by the encoding of the model (info shows it); a '
                         'recording of "rosbag play" needs a model with "source: none"')
    known, heard = _known(model, recording)
    if known == 0:
        raise ValueError(f'the model knows none of the {heard} event types of this recording: it '
                         'was trained with another encoding or on another robot')


class Unknown(NamedTuple):
    """Event types that a model does not know: the number of their events and the name of each."""

    new: List[Tuple[int, str]]  # training knows them in no way: nobody published them
    modes: List[Tuple[int, str]]  # of the robot, that training never saw
    # They were published in training, and nobody subscribed to them.
    unheard: List[Tuple[int, str]]


def unknown(model: TrainedModel, recording: RecordingEvents) -> Unknown:
    """Return what a model does not know of a recording, what came most often first."""
    found = Unknown([], [], [])
    counts, unheard = np.bincount(recording.ids), model.unheard
    for index in recording.heard[recording.heard >= len(model.event_types)].tolist():
        kind = recording.event_types[index]
        if not (kind.is_message or kind.tells_mode):
            continue
        (found.modes if kind.tells_mode else found.unheard if (kind.source, kind.scope) in unheard
         else found.new).append((int(counts[index]), str(kind)))
    for each in found:
        each.sort(key=lambda counted: (-counted[0], counted[1]))
    return found


def _known(model: TrainedModel, recording: RecordingEvents) -> Tuple[int, int]:
    """Return how many of the event types of a recording a model knows, and how many there are."""
    known = int((recording.heard < len(model.event_types)).sum())
    return known, known + len(unknown(model, recording).new)
