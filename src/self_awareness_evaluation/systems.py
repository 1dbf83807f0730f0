"""What is evaluated: a system learns from recordings, and judges the windows of others."""
from __future__ import annotations

from dataclasses import dataclass
from typing import List, Optional, Protocol, Sequence, Set, Tuple, TypeVar

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

    @property
    def watched(self) -> Optional[Set[str]]:
        """The components whose death it would find, once it has learned and is calibrated; None:
        it judges all together."""


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


def common_threshold(scores: Sequence[np.ndarray], rate: float) -> float:
    """Return the threshold that this share of the normal windows falls below."""
    return Roc(np.concatenate(scores), []).level(rate).cutoff


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
