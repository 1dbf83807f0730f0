"""What is evaluated: a system learns from recordings, and judges the windows of others."""
from __future__ import annotations

from dataclasses import dataclass, replace
from typing import (List, Optional, Protocol, Sequence, Set, Tuple, TypeVar,
                    runtime_checkable)

import numpy as np

from self_awareness import DEFAULT_WINDOW, DetectorParameters, Persistence, Roc
from self_awareness_evaluation.windowed_events import WindowedEvents

_Value = TypeVar('_Value')

ALARM, SUSPICION = 'ERROR', 'WARN'
"""Levels, as diagnostics call them."""

EXCUSES = ('busy machine', 'all silent', 'new mode')
"""Kinds of alarms that are no node's fault."""

FALSE_POSITIVE_RATE = 0.001
"""The share of normal windows of the calibration that may score below the threshold."""


@dataclass(frozen=True)
class SystemAlarm:
    """A stretch of time in which the alarm stood.

    Args:
        start: end of the window that raised it [ns].
        end: end of the window that cleared it, or of the last one [ns].
        cleared: False if it stood to the end of the recording.
        suspects: sources that the alarm is blamed on when it is raised, best first, each once;
            None if the system names no suspects.
        evidence: what raised it, in words; empty if the system does not say.
        level: ALARM or SUSPICION.
        culprit: who is to blame when it ends; empty: nobody, or the system does not say.
        kind: what is wrong by then; empty if the system does not say.
        incident: begin and end [ns] of the incident that it belongs to, and whether that is over;
            None: it is one of its own.
    """

    start: int
    end: int
    cleared: bool
    suspects: Optional[List[str]]
    evidence: str = ''
    level: str = ALARM
    culprit: str = ''
    kind: str = ''
    incident: Optional[Tuple[int, int, bool]] = None

    def stands_at(self, time: int) -> bool:
        """Return whether it stands at a time [ns]."""
        return self.start <= time and (time < self.end or not self.cleared)

    def shifted(self, time: int) -> SystemAlarm:
        """Return the same that much later [ns]."""
        incident = self.incident and (self.incident[0] + time, self.incident[1] + time,
                                      self.incident[2])
        return replace(self, start=self.start + time, end=self.end + time, incident=incident)


@dataclass(frozen=True)
class Judged:
    """What a system says of a recording; arrays with one entry a window.

    Args:
        start: of the windows [ns].
        abnormal: the bare verdict, also while settling.
        score: finite, low is abnormal.
        settling: whether it is too early for an alarm.
        alarms: after persistence.
        threshold: a score below it is abnormal.
        suspicion: whether there is a suspicion, which is no alarm; None: the system knows none.
        suspicions: the same as stretches of time, with who is suspected.
    """

    start: np.ndarray
    abnormal: np.ndarray
    score: np.ndarray
    settling: np.ndarray
    alarms: List[SystemAlarm]
    threshold: float
    suspicion: Optional[np.ndarray] = None
    suspicions: Sequence[SystemAlarm] = ()

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
    """A detector of faults."""

    name: str

    def train(self, recordings: Sequence[WindowedEvents]) -> None:
        """Learn from normal operation."""

    def calibrate(self, recordings: Sequence[WindowedEvents]) -> None:
        """Choose the threshold by normal operation that was not trained on."""

    def judge(self, recording: WindowedEvents) -> Judged:
        """Judge a recording."""


class Scorer(Protocol):
    """The part of a peer that is its own: the score of a window."""

    def train(self, recordings: Sequence[WindowedEvents]) -> None:
        """Learn from normal operation."""

    def scores(self, recording: WindowedEvents) -> np.ndarray:
        """Return the finite scores of the windows, low is abnormal."""

    def suspects(self, recording: WindowedEvents, window: int) -> Optional[List[str]]:
        """Return the sources to blame for a window, best first; None: it cannot tell."""


@runtime_checkable
class Watching(Protocol):
    """What watches components one by one, and can say which."""

    @property
    def watched(self) -> Set[str]:
        """The sources whose death it would find, once it has learned and is calibrated."""


class ScoringSystem:
    """A system of a scorer: threshold and persistence are those of all others.

    Args:
        name: in the tables.
        scorer: scores the windows.
        threshold: None: chosen by the common rule; else the scorer's own, which stays.
    """

    def __init__(self, name: str, scorer: Scorer, threshold: Optional[float] = None) -> None:
        self.name = name
        self._scorer = scorer
        self._own_threshold = threshold
        self._threshold = threshold

    @property
    def scorer(self) -> Scorer:
        """The part of it that is its own."""
        return self._scorer

    def train(self, recordings: Sequence[WindowedEvents]) -> None:
        """Learn from normal operation."""
        self._scorer.train(recordings)

    def calibrate(self, recordings: Sequence[WindowedEvents]) -> None:
        """Choose the threshold by the common rule, unless the system has its own."""
        if self._own_threshold is None:
            self._threshold = common_threshold(
                [self._scorer.scores(recording)[~settling(recording)] for recording in recordings])

    def judge(self, recording: WindowedEvents) -> Judged:
        """Judge a recording.

        Raises:
            ValueError: the system is not calibrated.
        """
        threshold = required(self._threshold, self.name, 'calibrate')
        start = recording.starts()
        score = self._scorer.scores(recording)
        abnormal = score < threshold
        unsettled = settling(recording)
        alarms = []
        for alarm in persistent(start, abnormal & ~unsettled):
            raised_in = int((alarm.start - start[0]) // DEFAULT_WINDOW) - 1
            suspects = self._scorer.suspects(recording, raised_in)
            alarms.append(replace(alarm, suspects=suspects, culprit=(suspects or [''])[0]))
        return Judged(start, abnormal, score, unsettled, alarms, threshold)


def watched_of(system: System) -> Optional[Set[str]]:
    """Return the components that a system watches; None: it judges all together."""
    of = system.scorer if isinstance(system, ScoringSystem) else system
    return of.watched if isinstance(of, Watching) else None


def watched_by(system: System, components: Set[str]) -> Optional[int]:
    """Return how many of the components a system watches, likewise."""
    watched = watched_of(system)
    return None if watched is None else len(watched & components)


def required(value: Optional[_Value], name: str, step: str) -> _Value:
    """Return what a step of a system has left.

    Args:
        value: that; None: the step was not taken.
        name: of the system.
        step: what the step is called.

    Raises:
        ValueError: the step was not taken.
    """
    if value is None:
        raise ValueError(f'{name}: {step} first')
    return value


def common_threshold(scores: Sequence[np.ndarray]) -> float:
    """Return the threshold that FALSE_POSITIVE_RATE of the normal windows fall below."""
    return Roc(np.concatenate(scores), []).level(FALSE_POSITIVE_RATE).cutoff


def settling(recording: WindowedEvents) -> np.ndarray:
    """Return for every window whether it is too early for an alarm, as the detector does."""
    settled = int(recording.stamps[0]) + DetectorParameters().settle_time
    return recording.starts() < settled


def persistent(start: np.ndarray, abnormal: np.ndarray) -> List[SystemAlarm]:
    """Return the alarms of windows by the detector's own persistence, without suspects.

    Args:
        start: of the windows [ns].
        abnormal: those that count, one a window.
    """
    persistence = Persistence(DetectorParameters())
    alarms: List[SystemAlarm] = []
    raised_at: Optional[int] = None
    end = 0
    for end, counts in zip((start + DEFAULT_WINDOW).tolist(), abnormal.tolist()):
        raised = persistence.add(counts, end)
        if raised and raised_at is None:
            raised_at = end
        elif not raised and raised_at is not None:
            alarms.append(SystemAlarm(raised_at, end, True, None))
            raised_at = None
    if raised_at is not None:
        alarms.append(SystemAlarm(raised_at, end, False, None))
    return alarms


def distinct(sources: Sequence[str]) -> List[str]:
    """Return the sources in their order, each once."""
    return list(dict.fromkeys(sources))
