"""Recordings as they are named on the command line: files, folders, and parts of recordings."""
from __future__ import annotations

import math
import os
import re
from dataclasses import dataclass, field, replace
from typing import Callable, Dict, Iterable, Iterator, List, Optional, Set, Tuple, TypeVar

from self_awareness import (BagError, bag_span, name_of_files, printable, recordings_in_event_log,
                            split_bags, summarise_bag)
from self_awareness.split_bags import Span
from self_awareness.stamps import nanoseconds

_Read = TypeVar('_Read')

_PART = re.compile(r'(?P<path>.+?)((?<=\.bag)\.\.(?P<last>\d+))?(#(?P<number>\d+))?'
                   r'(@(?P<start>\d+(\.\d+)?)(-(?P<end>\d+(\.\d+)?))?)?')

_BAG, _ACTIVE, _ORIGINAL = '.bag', '.bag.active', '.orig.bag'
_FOREIGN = ('.mcap', '.db3', *(f'{_BAG}.{packed}' for packed in
                               ('bz2', 'gz', 'lz4', 'xz', 'zip', 'zst')))
"""Endings of recordings that are no bags (yet)."""


@dataclass(frozen=True)
class BagPart:
    """A recording, or a part of it in seconds from its first message."""

    path: str  # of a bag, or of an event log
    # Of the part [s]; None: of the recording.
    start: Optional[float] = None
    end: Optional[float] = None
    # Its number in an event log, from 0; None: the file is a bag, or look() has not looked at it
    # yet.
    recording: Optional[int] = None
    alone: bool = True  # it is the only recording of its file
    robot: str = ''  # of which it is a recording, where the file does not say it; empty: not known
    # The files after the first one, of a recording in several bags (split_bags).
    more: Tuple[str, ...] = ()
    # Number of the last of them; None: there is none, or look() has found them.
    last: Optional[int] = None

    @classmethod
    def parse(cls, text: str) -> BagPart:
        """Read BAG, BAG@START or BAG@START-END; a file with this name comes first.

        BAG#N stands for the recording N, from 1, of an event log, and BAG..N for one in several
        bags, the last of which has the number N.
        """
        match = None if os.path.exists(text) else _PART.fullmatch(text)
        if match is None or all(match[name] is None for name in ('last', 'number', 'start')):
            return cls(text)
        last, number, start, end = match['last'], match['number'], match['start'], match['end']
        return cls(match['path'], None if start is None else float(start),
                   None if end is None else float(end),
                   None if number is None else int(number) - 1, number is None,
                   last=None if last is None else int(last))

    def __str__(self) -> str:
        text = name_of_files(self.files) if self.alone else f'{self.path}#{self.number}'
        if self.last is not None:
            text += f'..{self.last}'
        if self.start is None and self.end is None:
            return text
        return f'{text}@{self.start or 0.0:g}' + ('' if self.end is None else f'-{self.end:g}')

    @property
    def files(self) -> List[str]:
        """The files that it lies in, in their order."""
        return [self.path, *self.more]

    @property
    def number(self) -> int:
        """Which recording of its file it is, from 1."""
        return (self.recording or 0) + 1

    def whole(self) -> BagPart:
        """Return the recording that it is a part of."""
        return replace(self, start=None, end=None)

    def meets(self, other: BagPart) -> bool:
        """Return whether two parts that share a file have more than a moment in common."""
        if self.more != other.more:  # their seconds do not count from the same message
            return True
        return (self.recording == other.recording
                and (self.start or 0.0) < _end(other) and (other.start or 0.0) < _end(self))

    def span(self, first: int, last: int) -> Tuple[int, int]:
        """Return start and end [ns] within a recording from `first` to `last` [ns]."""
        start = first + nanoseconds(self.start or 0.0)
        end = last if self.end is None else first + nanoseconds(self.end)
        return start, min(end, last)


class BadRecordingsError(BagError):
    """Recordings that cannot be used.

    Args:
        lines: one for each: the file, what it is, and what mends it.
    """

    def __init__(self, lines: List[str]) -> None:
        super().__init__('; '.join(lines))
        self.lines = lines


@dataclass
class Named:
    """The recordings that were named."""

    # Those that can be used, as far as the ends of the files show it.
    parts: List[BagPart] = field(default_factory=list)
    # A line for each that cannot: the file, what it is, and what mends it.
    bad: List[str] = field(default_factory=list)
    told: List[str] = field(default_factory=list)  # lines about bags that are one recording

    def check(self, skip_bad: bool = False) -> None:
        """Check that none is bad; or, if these are left out, that there is another one.

        Raises:
            BadRecordingsError: it is not so.
        """
        if self.bad and not (skip_bad and self.parts):
            raise BadRecordingsError(self.bad)

    def each(self, read: Callable[[BagPart], _Read]) -> Iterator[_Read]:
        """Yield what is read of each part; what cannot be read is added to the bad ones."""
        for part in self.parts:
            try:
                found = read(part)
            except (BagError, ValueError) as error:
                self.bad.append(str(error))
            else:
                yield found


def expand(parts: Iterable[BagPart]) -> List[BagPart]:
    """Return the recordings of what is named, all of which can be used.

    Raises:
        BadRecordingsError: one cannot.
        ValueError: as look().
    """
    named = look(parts)
    named.check()
    return named.parts


def look(parts: Iterable[BagPart]) -> Named:
    """Look at what is named: which recordings it is, and what cannot be used.

    A folder stands for its recordings, a bag for one, and an event log may hold several. Bags that
    `rosbag record --split` made of one recording are one, unless a part of a bag is named.

    Raises:
        ValueError: a file does not hold the recording that is asked for, it is not said which
            one a part is of, or files are not one recording.
    """
    named = Named()
    found: List[Tuple[BagPart, bool]] = []  # whether it may be a file of a recording
    spans: Dict[str, Span] = {}
    for part in parts:
        is_folder = os.path.isdir(part.path)
        paths = _in_folder(part.path) if is_folder else [part.path]
        if not paths:
            named.bad.append(f'{part.path}: a folder without bags (*.bag)')
        for path in paths:
            each = replace(part, path=path)
            may_join = is_folder or each == BagPart(path)
            try:
                recordings, span = _recordings_of(each, may_join)
            except BagError as error:
                named.bad.append(_with_mend(path, error))
                continue
            may_join &= recordings == [each] and path not in spans
            found += [(recording, may_join) for recording in recordings]
            if may_join:
                spans[path] = span
    split = split_bags.joined(spans)
    named.told += split.told
    recording_of = {path: files for files in split.recordings for path in files}
    joined: Set[str] = set()
    for each, may_join in found:
        if not may_join:
            named.parts.append(each)
        elif each.path in recording_of:
            first, *more = recording_of[each.path]
            if first not in joined:
                named.parts.append(replace(each, path=first, more=tuple(more)))
                joined.add(first)
        elif each.path not in split.empty:
            named.bad.append(_what_is_wrong(each.path))
    return named


def by_folder(parts: Iterable[BagPart]) -> List[BagPart]:
    """Return recordings as those of the robots that their folders are called after."""
    return [replace(part, robot=printable(os.path.basename(os.path.dirname(
        os.path.abspath(part.path))))) for part in parts]


def _in_folder(folder: str) -> List[str]:
    """Return the recordings of a folder, by name, as far as their names tell."""
    # What begins with a dot is still being written, or was when somebody ended.
    names = sorted(name for name in os.listdir(folder) if not name.startswith('.'))
    found = [name for name in names if name.endswith((_BAG, _ACTIVE)) or (
        name.endswith(_FOREIGN) and f'{name.split(".")[0]}{_BAG}' not in names)]
    return [os.path.join(folder, name) for name in found]


def _recordings_of(part: BagPart, may_be_empty: bool) -> Tuple[List[BagPart], Span]:
    """Return the recordings of a file, and of a bag when it was.

    Raises:
        BagError: it cannot be used.
        ValueError: as look().
    """
    number = recordings_in_event_log(part.path)
    if number is not None:
        return _in_event_log(part, number), None
    if part.recording is not None:
        raise ValueError(f'{part}: {part.path} is no event log with numbered recordings; name '
                         'it without a number')
    if part.last is not None:
        _, *more = split_bags.files_up_to(part.path, part.last)
        return [replace(part, more=tuple(more), last=None)], None
    span = bag_span(part.path)
    if span is None and not may_be_empty:
        raise BagError(_what_is_wrong(part.path))
    return [part], span


def _in_event_log(part: BagPart, number: int) -> List[BagPart]:
    if part.recording is not None:
        if not 0 <= part.recording < number:
            raise ValueError(f'{part}: the event log holds recordings 1 to {number}')
        return [replace(part, alone=number == 1)]
    if number > 1 and (part.start is not None or part.end is not None):
        raise ValueError(f'{part}: the event log holds {number} recordings; name the one that the '
                         f'time is of: {part.path}#1@...')
    return [replace(part, recording=recording, alone=number == 1)
            for recording in range(max(number, 1))]


def _what_is_wrong(path: str) -> str:
    """Return what reading a bag says of it."""
    try:
        summarise_bag(path)
    except BagError as error:
        return str(error)
    return f'{path}: cannot be used'


def _with_mend(path: str, error: BagError) -> str:
    """Return what is wrong with a file, and what mends it, where its name says more."""
    if path.endswith(_ACTIVE) and os.path.isfile(path):
        return (f"{path}: is still being written, or its recorder was killed; in that case mend "
                f"it with: rosbag reindex '{path}', and call it {path[:-len('.active')]}")
    mended = f'{path[:-len(_ORIGINAL)]}{_BAG}'
    if path.endswith(_ORIGINAL) and os.path.exists(mended):
        return f'{path}: is what {mended} was before rosbag reindex; remove it'
    return str(error)


def _end(part: BagPart) -> float:
    return math.inf if part.end is None else part.end
