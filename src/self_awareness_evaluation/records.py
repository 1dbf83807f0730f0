"""What is judged: recordings of robots, whoever made them; and what judges: systems.

Recordings are events in memory, cut into the windows that all systems judge: those are
DEFAULT_WINDOW long and lie on the absolute time grid. A system learns from some, and judges
others.
"""
from __future__ import annotations

import zlib
from dataclasses import dataclass, replace
from typing import (Callable, Dict, FrozenSet, Hashable, Iterable, List, Optional, Protocol,
                    Sequence, Set, Tuple, TypeVar)

import numpy as np

from self_awareness import DEFAULT_WINDOW, DetectorParameters, EventType, Persistence, Roc
from self_awareness.recordings import RecordingEvents

_Key = TypeVar('_Key', bound=Hashable)

Subscriptions = FrozenSet[Tuple[str, str]]  # node and topic of all that nodes subscribe to

NORMAL = 'normal'  # what a record without a fault is called, in place of the kind of the fault

# Where records come from: robots drawn by seed, the simulated follow-me robot, real robots.
FAMILIES, OWN, REAL = 'families', 'own robot', 'recordings'
ALARM, SUSPICION = 'ERROR', 'WARN'  # levels, as diagnostics call them

# The share of normal windows of the calibration that may score below the threshold.
FALSE_POSITIVE_RATE = 0.001


@dataclass(frozen=True)
class WindowedEvents:
    """The events of a recording, in their order."""

    event_types: Sequence[EventType]  # by id
    stamps: np.ndarray  # int64 [ns], at least one
    ids: np.ndarray  # uint32, one for each stamp
    end: int  # the recording lasts until then [ns], exclusive, whether something comes or not
    attributes: Optional[np.ndarray] = None  # of messages, uint32, as many; None: not known
    # What there was from a time [ns] on, in the order of time; empty: not known.
    subscriptions: Sequence[Tuple[int, Subscriptions]] = ()
    # How the recorder's machine was, as in RecordingEvents; empty: not known.
    waiting: Sequence[Tuple[int, int, int]] = ()

    def encoded(self, vocabulary: Sequence[EventType]) -> WindowedEvents:
        """Return the same recording with the types of a vocabulary first, as the bag reader does;
        the ids after those stand for types that are not in it."""
        ids = {event_type: index for index, event_type in enumerate(vocabulary)}
        translation = np.array([ids.setdefault(event_type, len(ids))
                                for event_type in self.event_types], dtype=np.uint32)
        return replace(self, event_types=list(ids), ids=translation[self.ids])

    @property
    def events(self) -> RecordingEvents:
        """Return what is learned from and judged, with a number of its own, like that of a bag."""
        # - 1, because the window in which the recording ends is the last one.
        return RecordingEvents(self.event_types, self.stamps, self.ids, self.end - 1,
                               zlib.crc32(self.stamps.tobytes()), attributes=self.attributes,
                               waiting=self.waiting)

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
    """Return the stamps [ns] of the events by something of their types, such as the topic, but
    what no event has."""
    keys: Dict[_Key, int] = {}
    numbers = [keys.setdefault(key(each), len(keys)) for each in recording.event_types]
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
    # Return recordings: those that are learned from, normal operation, and those with a fault.
    training: Callable[[Learning], Sequence[WindowedEvents]]
    calibration: Callable[[Learning], Sequence[WindowedEvents]]
    normal: Callable[[], Iterable[WindowedEvents]]
    faults: Callable[[], Iterable[FaultRecord]]


@dataclass(frozen=True)
class SystemAlarm:
    """A stretch of time in which the alarm stood."""

    start: int  # end of the window that raised it [ns]
    end: int  # end of the window that cleared it, or of the last one [ns]
    cleared: bool  # False if it stood to the end of the recording
    # Sources that the alarm is blamed on when it is raised, best first, each once; None if the
    # system names no suspects.
    suspects: Optional[List[str]]
    evidence: str = ''  # what raised it, in words; empty if the system does not say
    level: str = ALARM  # ALARM or SUSPICION
    culprit: str = ''  # who is to blame when it ends; empty: nobody, or the system does not say
    kind: str = ''  # what is wrong by then; empty if the system does not say

    def stands_at(self, time: int) -> bool:
        """Return whether it stands at a time [ns]."""
        return self.start <= time and (time < self.end or not self.cleared)


@dataclass(frozen=True)
class Judged:
    """What a system says of a recording; arrays with one entry a window."""

    start: np.ndarray  # of the windows [ns]
    settling: np.ndarray  # whether it is too early for an alarm
    alarms: List[SystemAlarm]  # after persistence
    # Whether there is a suspicion, which is no alarm; None: the system knows none.
    suspicion: Optional[np.ndarray] = None
    suspicions: Sequence[SystemAlarm] = ()  # the same as stretches of time, with who is suspected

    @property
    def noticed(self) -> np.ndarray:
        """Whether there is a suspicion or an alarm when the window is over."""
        return self.standing if self.suspicion is None else self.standing | self.suspicion

    @property
    def standing(self) -> np.ndarray:
        """Whether the alarm stands when the window is over."""
        ends = self.start + DEFAULT_WINDOW
        stands = np.zeros(len(ends), dtype=bool)
        for alarm in self.alarms:
            stands |= (ends >= alarm.start) & ((ends < alarm.end) | (not alarm.cleared))
        return stands


class System(Protocol):
    """A detector of faults; it learns from normal operation, is calibrated by some that was not
    trained on, and then judges."""

    def train(self, recordings: Sequence[WindowedEvents]) -> None: ...
    def calibrate(self, recordings: Sequence[WindowedEvents]) -> None: ...
    def judge(self, recording: WindowedEvents) -> Judged: ...

    @property
    def watched(self) -> Optional[Set[str]]:
        """The components whose death it would find; None: it judges all together."""

    @property
    def expected_per_hour(self) -> Optional[float]:
        """The false alarms an hour that the calibration expects; None: it does not say."""


def common_threshold(scores: Sequence[np.ndarray], rate: float) -> float:
    """Return the threshold that this share of the normal windows falls below."""
    return Roc(np.concatenate(scores), []).level(rate).cutoff


def settling(recording: WindowedEvents) -> np.ndarray:
    """Return for every window whether it is too early for an alarm, as the detector does."""
    settled = int(recording.stamps[0]) + DetectorParameters().settle_time
    return recording.starts() < settled


def persistent(start: np.ndarray, abnormal: np.ndarray) -> List[SystemAlarm]:
    """Return the alarms of windows by the detector's own persistence, without suspects; abnormal:
    those that count."""
    persistence = Persistence(DetectorParameters())
    ends = (start + DEFAULT_WINDOW).tolist()
    raised = [persistence.add(counts, end) for counts, end in zip(abnormal.tolist(), ends)]
    edges = np.flatnonzero(np.diff(raised, prepend=False, append=False)).tolist()
    return [SystemAlarm(ends[begin], ends[min(end, len(ends) - 1)], end < len(ends), None)
            for begin, end in zip(edges[::2], edges[1::2])]
