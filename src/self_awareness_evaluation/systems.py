"""What is evaluated: a system learns from recordings, and judges the windows of others."""
from __future__ import annotations

from dataclasses import dataclass
from typing import List, Optional, Protocol, Sequence, Set, Tuple

import numpy as np

from self_awareness import DEFAULT_WINDOW, DetectorParameters, Persistence, Roc
from self_awareness_evaluation.records import WindowedEvents

ALARM, SUSPICION = 'ERROR', 'WARN'  # levels, as diagnostics call them
EXCUSES = ('busy machine', 'all silent', 'new mode')  # kinds of alarms that are no node's fault

FALSE_POSITIVE_RATE = 0.001
"""The share of normal windows of the calibration that may score below the threshold."""


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
    # Begin and end [ns] of the incident that it belongs to, and whether that is over; None: it is
    # one of its own.
    incident: Optional[Tuple[int, int, bool]] = None

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
    """A detector of faults; it learns, is calibrated, and then judges."""

    def train(self, recordings: Sequence[WindowedEvents]) -> None:
        """Learn from normal operation."""

    def calibrate(self, recordings: Sequence[WindowedEvents]) -> None:
        """Choose the threshold by normal operation that was not trained on."""

    def judge(self, recording: WindowedEvents) -> Judged:
        """Judge a recording."""

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
