"""Holes: silences that one recording shows and no other one.

A death is found once a silence is longer than what most starts agree on (docs/method.md, section
5.2). Where they are too few to agree, or a component pauses, one that hung for some seconds in one
of the recordings of normal operation is missed for longer than that ever after. Who trains is told
by name, and may leave it out.
"""
from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Dict, Iterable, List, Mapping, Optional, Sequence, Tuple

from self_awareness import Coverage, EventType, TrainedModel
from self_awareness.calibration import heads_and_tails
from self_awareness.calibration.heads_and_tails import Silence, Silences
from self_awareness.parts import BagPart
from self_awareness.reporting.text import duration
from self_awareness.stamps import SECOND_NS

_FEWEST_OTHERS = 2
_SHORTEST_PART_S = 5.0


@dataclass(frozen=True)
class Hole:
    """A silence that one recording alone shows."""

    part: BagPart  # the recording
    kind: EventType  # the event type
    silence: Silence  # of the event type, the longest of the recording
    others_s: float  # the longest silence of all other recordings [s]

    @property
    def component(self) -> str:
        """The component that was silent."""
        return self.kind.component


def known_silences(trained: TrainedModel) -> Dict[EventType, float]:
    """Return the longest gap that the training showed of every event type that is judged [s]."""
    return {each: trained.longest_gap(index) / SECOND_NS
            for index, each in enumerate(trained.event_types)
            if trained.gaps(index) >= trained.fewest_gaps}


def find(recordings: Sequence[Tuple[BagPart, Silences]],
         known_s: Optional[Mapping[EventType, float]] = None) -> List[Hole]:
    """Return the holes of some recordings.

    Args:
        recordings: with their silences.
        known_s: see known_silences(): they are worth as much as enough other recordings. None:
            the recordings are all that there is.
    """
    shown: Dict[EventType, List[Tuple[Silence, BagPart]]] = {}
    for part, silences in recordings:
        for kind, silence in silences.items():
            shown.setdefault(kind, []).append((silence, part))
    found = []
    for kind, of_type in shown.items():
        # Only the longest can be longer than all others.
        *others, (longest, part) = sorted(of_type, key=lambda each: each[0].length_s)
        lengths_s = [silence.length_s for silence, _ in others]
        if known_s is not None and kind in known_s:
            lengths_s += [known_s[kind]] * _FEWEST_OTHERS
        most_s = max(lengths_s, default=0.0)
        if (len(lengths_s) >= _FEWEST_OTHERS
                and heads_and_tails.is_longer(longest.length_s, most_s)):
            found.append(Hole(part, kind, longest, most_s))
    return found


def without(parts: Iterable[BagPart], holes: Sequence[Hole]) -> List[BagPart]:
    """Return what is left of recordings without the holes: the parts before, between and after."""
    return [piece for part in parts
            for piece in _pieces(part, [hole.silence for hole in holes if hole.part == part])]


def lines(holes: Sequence[Hole], coverage: Sequence[Coverage], details: bool,
          mend: str) -> List[str]:
    """Return a line for every hole that makes a death be found later: who was silent when and
    where, and what that does; and what to do about it.

    Args:
        holes: what find() returned.
        coverage: of the model with limits that know the holes.
        details: also of the others.
        mend: what to do, in words.
    """
    found_s = {each.component: each.death_found_after for each in coverage}
    deciding = [hole for hole in holes if _decides(hole, found_s.get(hole.component))]
    return [*(_line(hole, found_s.get(hole.component)) for hole in (holes if details
                                                                    else deciding)),
            *([f'if that was a fault, {mend}'] if deciding else [])]


def _decides(hole: Hole, found_s: Optional[float]) -> bool:
    return found_s is not None and found_s > hole.silence.length_s


def _line(hole: Hole, found_s: Optional[float]) -> str:
    silence = hole.silence
    text = (f'{hole.part}: {hole.component} ({hole.kind.scope}) is silent for '
            f'{silence.length_s:.1f} s from {silence.begin_s:.1f} s on, '
            f'{duration(hole.others_s)} at most in the other recordings')
    if found_s is None:
        return text
    if _decides(hole, found_s):
        return (f'{text}; because of that its death is found after {duration(found_s)} instead of '
                f'about {duration(found_s * hole.others_s / silence.length_s)}')
    return (f'{text}; its death is found after {duration(found_s)} all the same, as most starts '
            'agree')


def _pieces(part: BagPart, silences: Sequence[Silence]) -> List[BagPart]:
    pieces = []
    for silence in sorted(silences, key=lambda each: each.begin_s):
        if silence.begin_s - (part.start or 0.0) >= _SHORTEST_PART_S:
            pieces.append(replace(part, end=silence.begin_s))
        end_s = silence.begin_s + silence.length_s
        part = replace(part, start=max(part.start or 0.0, end_s))
    if not silences or part.end is None or part.end - (part.start or 0.0) >= _SHORTEST_PART_S:
        pieces.append(part)
    return pieces
