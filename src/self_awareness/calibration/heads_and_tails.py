"""Heads and tails: what a recording holds before a component's first message, and after its last.

Nobody knows how long such a silence would have been, so it is no pause (docs/method.md, section
5.2). What a recording begins with, until all have come, is the robot's start: it is left out of
what is normal. Who falls silent shortly before the end was most likely switched off by hand.
"""
from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Dict, Iterator, List, Mapping, Optional, Sequence, Tuple

import numpy as np

from self_awareness import Alarm, EventType
from self_awareness.recordings import BagPart, RecordingEvents
from self_awareness.reporting.text import first_lines, first_of
from self_awareness.stamps import SECOND_NS

START_UP_S = 30.0  # a start of the robot takes so long at most
LAST_S = 30.0
"""Who stops within the last seconds of a recording was most likely switched off before it."""

FEWEST_GAPS = 30  # what came less often says nothing

_SETTLE_S = 5.0  # the detector leaves it out, too
_TIMES, _LEAST_S = 3.0, 1.0
_MOST_NAMED, _MOST_LINES = 3, 10


def is_longer(silence_s: float, others_s: float) -> bool:
    """Return whether a silence is so much longer than others that it is of another kind."""
    return silence_s > max(_TIMES * others_s, others_s + _LEAST_S)


def often(recording: RecordingEvents) -> Iterator[Tuple[EventType, np.ndarray]]:
    """Return the event types with at least FEWEST_GAPS gaps, and their stamps [ns], in order."""
    # Few bits sort several times as fast, and no recording has so many event types.
    order = np.argsort(recording.ids.astype(np.uint16), kind='stable')
    ids, stamps = recording.ids[order], recording.stamps[order]
    firsts = np.flatnonzero(np.diff(ids, prepend=ids[:1] + 1)) if len(ids) else ids
    for begin, end in zip(firsts, [*firsts[1:], len(ids)]):
        if end - begin > FEWEST_GAPS:
            yield recording.event_types[ids[begin]], stamps[begin:end]


def without_start_up(recording: RecordingEvents) -> RecordingEvents:
    """Return what is left of a recording after the start of the robot: until all have come that
    come all the time.

    It is the same if it is a part with a begin of its own, or all came within the first seconds.
    Who comes later than START_UP_S, or pauses for as long later on, does not belong to the start.
    """
    heads_s = [(stamps[0] - recording.origin) / SECOND_NS for _, stamps in often(recording)
               if stamps[0] - recording.origin > np.diff(stamps).max()]
    head_s = max((head_s for head_s in heads_s if head_s <= START_UP_S), default=0.0)
    if recording.part.start is not None or head_s <= _SETTLE_S:
        return recording
    part = replace(recording.part, start=int(10.0 * head_s) / 10.0)
    first = int(np.argmax(recording.stamps >= part.span(recording.origin, recording.end)[0]))
    attributes = recording.attributes
    return replace(recording, part=part, stamps=recording.stamps[first:],
                   ids=recording.ids[first:],
                   attributes=None if attributes is None else attributes[first:])


@dataclass(frozen=True)
class Silence:
    """The longest time without an event of a type in a recording; all in s."""

    begin_s: float  # from the recording's first message
    length_s: float  # of it
    head_s: float = 0.0  # until the first event of the type, which is no such time
    tail_s: float = 0.0  # since the last one, neither


Silences = Mapping[EventType, Silence]  # those of a recording, of what came often in it


def silences(recording: RecordingEvents) -> Silences:
    """Return the longest silence of every event type that came often in a recording, or a part."""
    found: Dict[EventType, Silence] = {}
    for kind, stamps in often(recording):
        gaps = np.diff(stamps)
        longest = int(np.argmax(gaps))
        found[kind] = Silence(*(float(length) / SECOND_NS for length in (
            stamps[longest] - recording.origin, gaps[longest],
            stamps[0] - recording.stamps[0], recording.stamps[-1] - stamps[-1])))
    return found


def _of_components(found: Silences) -> Dict[str, Silence]:
    """Return the shortest of each component: who sends anything is no longer silent."""
    shortest: Dict[str, Silence] = {}
    for kind, each in found.items():
        other = shortest.get(kind.component, each)
        shortest[kind.component] = Silence(
            each.begin_s, min(each.length_s, other.length_s), min(each.head_s, other.head_s),
            min(each.tail_s, other.tail_s))
    return shortest


def lines(recordings: Sequence[Tuple[BagPart, Silences]], start: str, end: str) -> List[str]:
    """Return a line for everybody who starts after recordings do, or ends before them.

    Args:
        recordings: with their silences.
        start, end: what leaves a head or a tail out, on the command line.
    """
    found = []
    of_parts = [(part, _of_components(each)) for part, each in recordings]
    for component in sorted({name for _, of_part in of_parts for name in of_part}):
        heard = [(part, of_part[component]) for part, of_part in of_parts if component in of_part]
        longest_s = max(cut.length_s for _, cut in heard)
        for does, cut_s, option in (
                ('starts after the recording does', [cut.head_s for _, cut in heard], start),
                ('ends before the recording does', [cut.tail_s for _, cut in heard], end)):
            named = [f'{part} by {length_s:.1f} s' for length_s, (part, _) in zip(cut_s, heard)
                     if is_longer(length_s, longest_s)]
            if named:
                found.append(f'{component} {does} in {len(named)} of {len(heard)}: '
                             f'{first_of(named, _MOST_NAMED)}. That counts as no pause ({option} '
                             'leaves it out)')
    return first_lines(found, _MOST_LINES)


def stopped_before_end(recording: RecordingEvents, alarm: Alarm) -> Optional[float]:
    """Return by how many seconds all who stopped did so before the recording ended.

    None: nobody stopped for good, or somebody did more than LAST_S before.
    """
    if alarm.over:
        return None
    if alarm.silent is not None:
        since = [alarm.silent.since]
    else:
        last = {suspect: recording.stamps[recording.ids == suspect.id][-1]
                for suspect in [*alarm.suspects, *alarm.later]
                if suspect.reason.kind in ('silent', 'topic silent') and not suspect.reason.after}
        since = [int(stamp) for suspect, stamp in last.items() if stamp <= suspect.since]
    before = [(recording.end - stamp) / SECOND_NS for stamp in since]
    return max(before) if before and max(before) <= LAST_S else None
