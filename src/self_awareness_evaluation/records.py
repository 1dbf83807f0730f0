"""What is judged: recordings of robots, without a fault and with one, whoever made them.

They are events in memory, cut into the windows that all systems judge: those are DEFAULT_WINDOW
long and lie on the absolute time grid.
"""
from __future__ import annotations

import zlib
from dataclasses import dataclass, replace
from typing import (Callable, Dict, FrozenSet, Hashable, Iterable, Optional, Sequence, Set, Tuple,
                    TypeVar)

import numpy as np

from self_awareness import DEFAULT_WINDOW, EventType, Waiting

_Key = TypeVar('_Key', bound=Hashable)

Subscriptions = FrozenSet[Tuple[str, str]]  # node and topic of all that nodes subscribe to

NORMAL = 'normal'  # what a record without a fault is called, in place of the kind of the fault

FAMILIES, OWN, REAL = 'families', 'own robot', 'recordings'
"""Where records come from: robots drawn by seed, the simulated follow-me robot, real robots."""


@dataclass(frozen=True)
class WindowedEvents:
    """The events of a recording, in their order."""

    event_types: Sequence[EventType]  # by id
    stamps: np.ndarray  # int64 [ns], at least one
    ids: np.ndarray  # uint32, one for each stamp
    end: int  # the recording lasts until then [ns], exclusive, whether something comes or not
    # Of the messages, uint32, one for each stamp; None: not known.
    attributes: Optional[np.ndarray] = None
    # What there was from a time [ns] on, in the order of time; empty: not known.
    subscriptions: Sequence[Tuple[int, Subscriptions]] = ()
    # How the recorder's machine was, one stretch of time after the other; empty: not known.
    waiting: Sequence[Waiting] = ()

    def encoded(self, vocabulary: Sequence[EventType]) -> WindowedEvents:
        """Return the same recording with the types of a vocabulary first, as the bag reader does.

        The ids after those stand for the types that are not in the vocabulary.
        """
        ids = {event_type: index for index, event_type in enumerate(vocabulary)}
        translation = np.array([ids.setdefault(event_type, len(ids))
                                for event_type in self.event_types], dtype=np.uint32)
        return replace(self, event_types=list(ids), ids=translation[self.ids])

    @property
    def fingerprint(self) -> int:
        """Return a number of its own, like that of a bag."""
        return zlib.crc32(self.stamps.tobytes())

    def stamps_of(self, source: str) -> np.ndarray:
        """Return when a component sends [ns]."""
        ours = np.array([kind.source == source for kind in self.event_types])
        return self.stamps[ours[self.ids]]

    def starts(self) -> np.ndarray:
        """Return the starts of the windows [ns], from the one with the first event on."""
        first = int(self.stamps[0]) // DEFAULT_WINDOW * DEFAULT_WINDOW
        return np.arange(first, self.end, DEFAULT_WINDOW, dtype=np.int64)


def stamps_by(recording: WindowedEvents, key: Callable[[EventType], _Key]
              ) -> Dict[_Key, np.ndarray]:
    """Return the stamps of the events by something of their types, such as the topic [ns].

    What no event has is not in it.
    """
    keys: Dict[_Key, int] = {}
    numbers = [keys.setdefault(key(event_type), len(keys))
               for event_type in recording.event_types]
    # Few bits: these are sorted by radix, which is five times as fast.
    of_events = np.array(numbers, dtype=np.min_scalar_type(len(keys)))[recording.ids]
    order = np.argsort(of_events, kind='stable')
    edges = np.searchsorted(of_events[order], np.arange(len(keys) + 1))
    return {known: recording.stamps[order[begin:end]]
            for known, begin, end in zip(keys, edges, edges[1:]) if end > begin}


@dataclass(frozen=True)
class FaultRecord:
    """A recording with a fault."""

    kind: str  # of the fault
    culprits: Tuple[str, ...]  # the sources to blame; empty if no single one is
    recording: WindowedEvents  # the events
    onset: int  # of the fault [ns]
    back: Optional[int] = None  # when it is over [ns]; None: it lasts to the end of the recording
    # The culprits, and who may suffer from them; None: nobody is guilty, or it is not known.
    involved: Optional[FrozenSet[str]] = None

    @property
    def ends(self) -> int:
        """When the fault ends, at the latest with the recording [ns]."""
        return self.recording.end if self.back is None else self.back

    @property
    def source(self) -> str:
        """The culprits in one text; empty if no single one is."""
        return '; '.join(self.culprits)


@dataclass(frozen=True)
class Learning:
    """What a system learns from."""

    starts: int  # of the robot to train on, a recording of each
    training_s: float  # length of each [s]
    calibrations: int  # further starts to calibrate on, a recording of each
    calibration_s: float  # length of each [s]

    @classmethod
    def of(cls, starts: int, training_s: float, calibration_s: float) -> Learning:
        """Return what is recorded by default: half as many starts to calibrate, at least one."""
        return cls(starts, training_s, max(1, starts // 2), calibration_s)

    def __str__(self) -> str:
        return (f'{self.starts} x {self.training_s:g} s + '
                f'{self.calibrations} x {self.calibration_s:g} s')


@dataclass(frozen=True)
class Robot:
    """A robot of which there are records. They are simulated when they are asked for."""

    components: Set[str]  # of the robot
    # Publisher, topic and subscriber, as a training while the robot runs finds it.
    graph: Set[Tuple[str, str, str]]
    # Return the recordings that are learned from.
    training: Callable[[Learning], Sequence[WindowedEvents]]
    calibration: Callable[[Learning], Sequence[WindowedEvents]]
    # Returns normal operation, recording by recording.
    normal: Callable[[], Iterable[WindowedEvents]]
    faults: Callable[[], Iterable[FaultRecord]]  # returns the recordings with a fault
