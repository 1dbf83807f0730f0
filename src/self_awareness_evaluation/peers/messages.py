"""What the peers share that look at messages, not at their times: ages and sizes of events.

Events have classes of them (docs/attributes.md), eight an octave: a bound may lie off by 9 %.
"""
from __future__ import annotations

from typing import Dict, List, Sequence, Set, Tuple

import numpy as np

from self_awareness import EventType, pack_attributes
from self_awareness.stamps import SECOND_NS
from self_awareness_evaluation.peers.deviations import DeviationScorer
from self_awareness_evaluation.windowed_events import WindowedEvents, stamps_by, values_by

CLASSES_AN_OCTAVE = 8.0
"""Of sizes, and of ages above 1 ms."""

NO_HEADER = 0
"""The class of the age of a message without a header."""

ZERO_STAMP = 1
"""And of one whose stamp is 0; all others are larger, the larger the older the stamp is."""

_AGE, _SIZE = 0, 8  # the first bits of both in the attributes
_BYTE = 0xff
_NOT_KNOWN = 0  # the attributes of a message of which nothing is known

Messages = Tuple[np.ndarray, np.ndarray]
"""Stamps [ns] and a number of each message of a topic, in their order."""


class MessageMonitor(DeviationScorer):
    """Watches topics by a bound of each, and blames all who publish there."""

    def __init__(self) -> None:
        super().__init__()
        self._sources: Dict[str, List[str]] = {}

    @property
    def topics(self) -> List[str]:
        """The topics that have bounds."""
        raise NotImplementedError

    @property
    def watched(self) -> Set[str]:
        """Nobody: who is silent sends no wrong message."""
        return set()

    def _learn_sources(self, recordings: Sequence[WindowedEvents]) -> None:
        self._sources, self._last = {}, None
        for recording in recordings:
            for event_type in recording.event_types:
                sources = self._sources.setdefault(event_type.scope, [])
                if event_type.source not in sources:
                    sources.append(event_type.source)

    def _blamed(self, row: int) -> List[str]:
        return self._sources[self.topics[row]]


def ages(recording: WindowedEvents) -> Dict[str, Messages]:
    """Return the classes of ages by topic; topics of whose messages nothing is known are left out.
    """
    return _classes(recording, _AGE)


def sizes(recording: WindowedEvents) -> Dict[str, Messages]:
    """Return the classes of sizes by topic, likewise."""
    return _classes(recording, _SIZE)


def age_class(age_s: float) -> int:
    """Return the class of an age [s]."""
    packed = pack_attributes(np.array([age_s]), np.array([1], dtype=np.uint64), np.array([-1]),
                             np.array([False]))
    return int(packed[0]) & _BYTE


def newest(messages: Messages, ends: np.ndarray) -> np.ndarray:
    """Return the number of the newest message before some ends [ns]; NaN before the first one."""
    stamps, numbers = messages
    before = np.searchsorted(stamps, ends)
    return np.where(before > 0, numbers[before - 1], np.nan)


def largest(messages: Messages, ends: np.ndarray, span_s: float) -> np.ndarray:
    """Return the largest number of the messages within a span [s] before some ends [ns]; 0: none.

    The numbers are 0 or more.
    """
    stamps, numbers = messages
    found = np.zeros(len(ends))
    # A message is seen at all ends from the next one on, for so long as the span.
    first = np.searchsorted(ends, stamps, side='right')
    last = np.searchsorted(ends, stamps + round(span_s * SECOND_NS), side='right')
    for step in range(int((last - first).max(initial=0))):
        within = first + step < last
        np.maximum.at(found, first[within] + step, numbers[within])
    return found


def _classes(recording: WindowedEvents, first_bit: int) -> Dict[str, Messages]:
    if recording.attributes is None:
        return {}
    stamps = stamps_by(recording, _topic)
    found = {}
    for topic, attributes in values_by(recording, _topic, recording.attributes).items():
        known = attributes != _NOT_KNOWN
        if known.any():
            classes = (attributes[known] >> first_bit) & _BYTE
            found[topic] = (stamps[topic][known], classes.astype(np.int64))
    return found


def _topic(event_type: EventType) -> str:
    return event_type.scope
