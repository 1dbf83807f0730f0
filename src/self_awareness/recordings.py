"""Recordings as they are named on the command line, and the events a model sees in them."""
from __future__ import annotations

import math
import os
import re
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Dict, Iterable, Iterator, List, Mapping, Optional, Sequence, Set, Tuple

import numpy as np

from self_awareness import (LEAST_KNOWN, LONGEST_SILENCE, BagError, EncodingRules, EventType,
                            ModelFileError, RecordedEvents, Recording, ResultBag, TrainedModel,
                            Waiting, find_clock_steps, missing_subscriptions, printable, progress,
                            read_events, recordings_in_event_log, summarise_bag)
from self_awareness.stamps import SECOND_NS, nanoseconds
from self_awareness.training.robot_graph import RobotGraph

MOST_WINDOWS = 10_000_000
"""Of a recording: eleven days in windows of 0.1 s. Verdicts on them take some 100 MB."""

_PART = re.compile(r'(?P<path>.+?)(#(?P<number>\d+))?'
                   r'(@(?P<start>\d+(\.\d+)?)(-(?P<end>\d+(\.\d+)?))?)?')


@dataclass(frozen=True)
class BagPart:
    """A recording, or a part of it in seconds from its first message.

    Args:
        path: of a bag, or of an event log.
        start, end: of the part [s]; None: of the recording.
        recording: its number in an event log, from 0; None: the file is a bag, or expand() has not
            looked at it yet.
        alone: it is the only recording of its file.
        robot: of which it is a recording, where the file does not say it; empty: not known.
    """

    path: str
    start: Optional[float] = None
    end: Optional[float] = None
    recording: Optional[int] = None
    alone: bool = True
    robot: str = ''

    @classmethod
    def parse(cls, text: str) -> BagPart:
        """Read BAG, BAG@START or BAG@START-END; a file with this name comes first.

        BAG#N stands for the recording N, from 1, of an event log.
        """
        match = None if os.path.exists(text) else _PART.fullmatch(text)
        if match is None or (match['number'] is None and match['start'] is None):
            return cls(text)
        number, start, end = match['number'], match['start'], match['end']
        return cls(match['path'], None if start is None else float(start),
                   None if end is None else float(end),
                   None if number is None else int(number) - 1, number is None)

    def __str__(self) -> str:
        text = self.path if self.alone else f'{self.path}#{self.number}'
        if self.start is None and self.end is None:
            return text
        return f'{text}@{self.start or 0.0:g}' + ('' if self.end is None else f'-{self.end:g}')

    @property
    def number(self) -> int:
        """Which recording of its file it is, from 1."""
        return (self.recording or 0) + 1

    def whole(self) -> BagPart:
        """Return the recording that it is a part of."""
        return replace(self, start=None, end=None)

    def meets(self, other: BagPart) -> bool:
        """Return whether two parts of one file have more than a moment in common."""
        return (self.recording == other.recording
                and (self.start or 0.0) < _end(other) and (other.start or 0.0) < _end(self))

    def span(self, first: int, last: int) -> Tuple[int, int]:
        """Return start and end [ns] within a recording from `first` to `last` [ns]."""
        start = first + nanoseconds(self.start or 0.0)
        end = last if self.end is None else first + nanoseconds(self.end)
        return start, min(end, last)


def expand(parts: Iterable[BagPart]) -> List[BagPart]:
    """Return the recordings of files: a bag is one, and an event log may hold several.

    A folder stands for its bags and event logs.

    Raises:
        ValueError: a file does not hold the recording that is asked for, it is not said which
            one a part is of, or a folder has no bag.
    """
    return [recording for part in parts for path in files(part.path)
            for recording in _recordings_of(replace(part, path=path))]


def by_folder(parts: Iterable[BagPart]) -> List[BagPart]:
    """Return recordings as those of the robots that their folders are called after."""
    return [replace(part, robot=printable(os.path.basename(os.path.dirname(
        os.path.abspath(part.path))))) for part in parts]


def files(path: str) -> List[str]:
    """Return the bags of a folder, by name, or the path of a file as it is.

    Raises:
        ValueError: the folder has no bag.
    """
    if not os.path.isdir(path):
        return [path]
    # What begins with a dot is still being written, or was when somebody ended.
    found = sorted(name for name in os.listdir(path)
                   if name.endswith('.bag') and not name.startswith('.'))
    if not found:
        raise ValueError(f'{path}: a folder without bags (*.bag)')
    return [os.path.join(path, name) for name in found]


def _recordings_of(part: BagPart) -> Iterator[BagPart]:
    number = recordings_in_event_log(part.path)
    if number is None:
        if part.recording is not None:
            raise ValueError(f'{part}: {part.path} is no event log with numbered recordings; name '
                             'it without a number')
        yield part
    elif part.recording is not None:
        if not 0 <= part.recording < number:
            raise ValueError(f'{part}: the event log holds recordings 1 to {number}')
        yield replace(part, alone=number == 1)
    elif number > 1 and (part.start is not None or part.end is not None):
        raise ValueError(f'{part}: the event log holds {number} recordings; name the one that the '
                         f'time is of: {part.path}#1@...')
    else:
        for recording in range(max(number, 1)):
            yield replace(part, recording=recording, alone=number == 1)


def _end(part: BagPart) -> float:
    return math.inf if part.end is None else part.end


@dataclass(frozen=True)
class RecordingEvents:
    """The events of a recording as a model encodes them; ids after the model's are unknown.

    Args:
        part: what was asked for.
        event_types: by id, those of the model first.
        stamps: int64 [ns], in order.
        ids: uint32, one for each stamp.
        origin: stamp of the bag's first message [ns], where its time in seconds begins.
        end: stamp of the last message that was asked for, event or not [ns].
        fingerprint: of the whole bag.
        one_sender_a_topic: the bag was written by a program that keeps only one (BagSummary).
        copied: so it is, and it is a copy of a recording.
        bag: what the file is called, or the bag that an event log was made of.
        robot_start: when the robot was started [ns]; 0: not known.
        robot: its name; empty: not known.
        clock_steps: stamps of the first events after the clock was set forward [ns].
        waiting: how the machine was, one stretch of time after the other; empty: not known.
        left_out: why some connections of a bag are no events, whatever the encoding.
        hosts: computers of sources, as an event log says.
        missing: which of the subscriptions that the model expects, from a time [ns] on each, as
            an event log says.
        attributes: of the messages, uint32, one for each stamp (docs/attributes.md); None: not
            known.
    """

    part: BagPart
    event_types: List[EventType]
    stamps: np.ndarray
    ids: np.ndarray
    origin: int
    end: int
    fingerprint: int
    one_sender_a_topic: bool = False
    copied: bool = False
    bag: str = ''
    robot_start: int = 0
    robot: str = ''
    clock_steps: Sequence[int] = ()
    waiting: Sequence[Waiting] = ()
    left_out: Tuple[str, ...] = ()
    hosts: Mapping[str, str] = field(default_factory=dict)
    missing: Sequence[Tuple[int, Set[Tuple[str, str]]]] = ()
    attributes: Optional[np.ndarray] = None

    @classmethod
    def of(cls, part: BagPart, events: RecordedEvents,
           encoding: EncodingRules) -> RecordingEvents:
        """Return the events that were read for a part, by an encoding."""
        summary = events.summary
        _, end = part.span(summary.start, summary.end)
        return cls(part, events.event_types, events.stamps, events.ids, summary.start, end,
                   summary.fingerprint, summary.one_sender_a_topic, summary.copied, summary.bag,
                   summary.robot_start, summary.robot or part.robot,
                   () if summary.clock_watched else find_clock_steps(events.stamps, events.ids),
                   events.waiting, tuple(summary.left_out),
                   RobotGraph(*summary.graph).hosts_of_sources(encoding),
                   attributes=events.attributes)

    @cached_property
    def heard(self) -> np.ndarray:
        """Ids of the event types that occur, in order."""
        return np.flatnonzero(np.bincount(self.ids))

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
            apart, no message of it is an event, or the model knows none of its event types.
    """
    with progress.messages(os.path.basename(part.path)) as update:
        try:
            events = read_events(part.path, model.encoding, model.event_types, part.start,
                                 part.end, update, part.recording)
        except ValueError as error:
            raise ValueError(f'{part}: {error}') from error
    recording = replace(
        RecordingEvents.of(part, events, model.encoding), missing=missing_subscriptions(
            events.summary, model.encoding, model.subscriptions))
    _check(model, recording, events.summary.has_sources)
    try:
        check_windows(events.stamps, model.window)
    except ValueError as error:
        raise ValueError(f'{part}: {error}') from error
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
    return (f'{recording.part}: the model knows {known} of the {heard} event types of this '
            'recording, and says nothing of the others: is it of this robot?')


def clock_steps(recording: RecordingEvents) -> Optional[str]:
    """Return what to tell of a recording in which the clock was set forward."""
    if len(recording.clock_steps) == 0:
        return None
    after = np.searchsorted(recording.stamps, np.asarray(recording.clock_steps))
    steps = ', '.join(
        f'{(recording.stamps[i] - recording.stamps[i - 1]) / SECOND_NS:.1f} s before '
        f'{(recording.stamps[i] - recording.origin) / SECOND_NS:.1f} s' for i in after)
    return (f'{recording.part}: the clock was set forward by {steps}, but the nodes went on '
            'without a pause. The recording is cut there; nothing counts as late')


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
    if not merged:
        return None
    return (f'{recording.part}: this bag names only one sender for each topic, as copies do that '
            f'rosbag filter, compress or decompress made: '
            f'{", ".join(merged)}; use the bag as it was recorded')


def _senders(event_types: Iterable[EventType]) -> Dict[str, Set[str]]:
    senders: Dict[str, Set[str]] = {}
    for kind in event_types:
        senders.setdefault(kind.scope, set()).add(kind.source)
    return senders


def overlap(a: Recording, b: Recording) -> bool:
    """Return whether two recordings are the same, at least in part; names do not matter."""
    return a.fingerprint == b.fingerprint and a.start <= b.end and b.start <= a.end


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
    if ResultBag.is_one(path):
        raise ValueError('is a result bag (score --result-bag), and no recording')
    try:
        TrainedModel.load(path, watched_only=True)
    except ModelFileError:
        return
    raise ValueError('is a model, and no recording')


def _check(model: TrainedModel, recording: RecordingEvents, has_sources: bool) -> None:
    part = recording.part
    if not has_sources or len(recording.stamps) == 0:
        try:
            check_kind(part.path)
        except ValueError as error:
            raise ValueError(f'{part}: {error}') from error
    if model.encoding.source == 'callerid' and not has_sources:
        raise ValueError(f'{part}: the model was trained with another encoding: it tells sources '
                         'apart, and no connection of this bag names its sender; train a model '
                         'with "source: none" (train --encoding)')
    if len(recording.stamps) == 0:
        raise ValueError(f'{part}: no message is an event by the encoding of the model (info '
                         'shows it); a recording of "rosbag play" needs a model with '
                         '"source: none"')
    known, heard = _known(model, recording)
    if known == 0:
        raise ValueError(f'{part}: the model knows none of the {heard} event types of this '
                         'recording: it was trained with another encoding or on another robot')


def unknown_types(model: TrainedModel, recording: RecordingEvents) -> List[int]:
    """Return the ids of event types that training knows in no way: nobody published them.

    A mode that it never saw is none of them.
    """
    unheard = model.unheard
    return [index for index in recording.heard.tolist() if index >= len(model.event_types)
            and not recording.event_types[index].tells_mode
            and (recording.event_types[index].source,
                 recording.event_types[index].scope) not in unheard]


def unknown_modes(model: TrainedModel, recording: RecordingEvents) -> List[int]:
    """Return the ids of modes of the robot that training never saw."""
    return [index for index in recording.heard.tolist() if index >= len(model.event_types)
            and recording.event_types[index].tells_mode]


def _known(model: TrainedModel, recording: RecordingEvents) -> Tuple[int, int]:
    """Return how many of the event types of a recording a model knows, and how many there are."""
    unknown = set(unknown_types(model, recording))
    known = int((recording.heard < len(model.event_types)).sum())
    return known, known + len(unknown)
