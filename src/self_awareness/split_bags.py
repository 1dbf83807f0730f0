"""Which bags are one recording: those that `rosbag record --split` made, by name and time."""
from __future__ import annotations

import os
import re
from dataclasses import dataclass, field
from typing import Dict, Iterable, List, Mapping, Optional, Sequence, Set, Tuple

from self_awareness import BagError, bag_span, name_of_files
from self_awareness.stamps import SECOND_NS

Span = Optional[Tuple[int, int]]
"""Stamps of a bag's first and last message [ns]; None: it is empty."""

_NAME = re.compile(r'(?P<prefix>.*?)(?P<date>_?\d{4}(-\d\d){5})?_(?P<number>\d+)\.bag')
"""PREFIX_DATE_N.bag. The date is that of the file, so it may differ in one recording."""

_GAP_NS = SECOND_NS // 2
"""A split leaves no gap but the time to the next message. To end a recorder and to start another
one takes longer: people number recordings in this way, too."""
_GAP_OF_DATED_NS = 60 * SECOND_NS
"""Date and number are in names of split bags only: there the robot may also have been silent. With
more time between, the files that came between are gone."""
_OVERLAP_NS = SECOND_NS
"""The recorder receives in several threads, which may overtake each other at a split."""


@dataclass(frozen=True)
class Split:
    """What became of some bags."""

    # The files of each recording, in their order; of most, there is one.
    recordings: List[List[str]] = field(default_factory=list)
    # Files within a recording in which nothing came: the robot was silent.
    empty: Set[str] = field(default_factory=set)
    # Lines about what is one recording, and what is none although it looks like one.
    told: List[str] = field(default_factory=list)


@dataclass(frozen=True)
class _File:
    """A file of a series."""

    path: str
    number: int
    start: int
    end: int


def joined(spans: Mapping[str, Span]) -> Split:
    """Return which bags are one recording; each that is in no series is one by itself.

    Args:
        spans: of the bags, by their paths.
    """
    split = Split()
    for (_, _, dated), paths in _series(spans).items():
        _join([_File(path, number, *span) for path, number in paths.items()
               for span in [spans[path]] if span is not None],
              {number: path for path, number in paths.items() if spans[path] is None},
              _GAP_OF_DATED_NS if dated else _GAP_NS, split)
    known = {path for files in split.recordings for path in files}
    split.recordings.extend([path] for path, span in spans.items()
                            if span is not None and path not in known)
    return split


def files_up_to(path: str, number: int) -> List[str]:
    """Return the files of a recording from a first one up to that of a number.

    Raises:
        ValueError: they are not one recording.
    """
    spans: Dict[str, Span] = {}
    folder = os.path.dirname(path)
    for name in sorted(os.listdir(folder or '.')):
        if name.endswith('.bag'):
            try:
                spans[os.path.join(folder, name)] = bag_span(os.path.join(folder, name))
            except BagError:
                pass  # so it is no part of the recording
    for files in joined(spans).recordings:
        if path in files:
            found = files[files.index(path):]
            numbers = [_number(each) for each in found]
            if number in numbers:
                return found[:numbers.index(number) + 1]
    raise ValueError(f'{path}..{number}: there is no recording from this file to that of number '
                     f'{number}')


def _series(paths: Iterable[str]) -> Dict[Tuple[str, str, bool], Dict[str, int]]:
    """Return the paths, and their numbers, by folder, prefix and whether there is a date."""
    found: Dict[Tuple[str, str, bool], Dict[str, int]] = {}
    for path in paths:
        match = _NAME.fullmatch(os.path.basename(path))
        if match is not None:
            folder = os.path.dirname(os.path.abspath(path))
            found.setdefault((folder, match['prefix'], match['date'] is not None),
                             {})[path] = int(match['number'])
    return found


def _number(path: str) -> Optional[int]:
    match = _NAME.fullmatch(os.path.basename(path))
    return None if match is None else int(match['number'])


def _join(files: Sequence[_File], empty: Mapping[int, str], gap: int, split: Split) -> None:
    """Add the recordings of a series.

    Args:
        files: those with messages.
        empty: those without, by number.
        gap: the longest time from one file to the next [ns].
        split: to add to.
    """
    after: Dict[str, _File] = {}
    firsts: List[_File] = []
    for file in sorted(files, key=lambda each: each.start):
        least = file.number - 1
        while least in empty:
            least -= 1
        before = [each for each in files
                  if least <= each.number < file.number and each.path not in after
                  and -_OVERLAP_NS <= file.start - each.end <= gap * (file.number - each.number)]
        if before:
            after[max(before, key=lambda each: each.end).path] = file
        else:
            firsts.append(file)
    for file in firsts:
        found = [file]
        while found[-1].path in after:
            found.append(after[found[-1].path])
        split.recordings.append([each.path for each in found])
        within = [empty[number] for one, other in zip(found, found[1:])
                  for number in range(one.number + 1, other.number)]
        split.empty.update(within)
        if len(found) > 1:
            split.told.append(_is_one(split.recordings[-1], within))
        split.told.extend(_is_none(file, files))


def _is_one(paths: Sequence[str], empty: Sequence[str]) -> str:
    text = (f'{name_of_files(paths)}: {len(paths)} files of one recording, up to '
            f'{os.path.basename(paths[-1])}')
    if not empty:
        return text
    return f'{text}; nothing came in {", ".join(map(os.path.basename, empty))}'


def _is_none(first: _File, files: Sequence[_File]) -> List[str]:
    """Return why a recording does not go on from a file of a lower number before it."""
    before = [each for each in files if each.number < first.number and each.end <= first.start]
    if not before:
        return []
    last = max(before, key=lambda each: each.end)
    why = (f'begins {(first.start - last.end) / SECOND_NS:.1f} s after its end'
           if last.number == first.number - 1 else
           'what came between is missing' if last.number < first.number - 2 else
           f'number {first.number - 1} is missing')
    return [f'{first.path}: another recording than {os.path.basename(last.path)}: {why}']
