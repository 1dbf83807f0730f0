"""What is measured of a system on one record: a row of the results."""
from __future__ import annotations

from dataclasses import dataclass
from typing import List, Optional, Sequence, Tuple

import numpy as np

from self_awareness import DEFAULT_WINDOW, Roc
from self_awareness.stamps import SECOND_NS, nanoseconds
from self_awareness_evaluation.systems import Judged, SystemAlarm

NORMAL = 'normal'
"""Name of the record without a fault."""

AFTERMATH_S = 5.0
"""An alarm that is raised so soon after the fault is over belongs to it: a node that comes back is
no normal operation yet [s]."""


@dataclass(frozen=True)
class Row:
    """One system on one record of one seed. Counts of windows leave settling ones out.

    Args:
        system: its name.
        training_share: of the training recordings that was learned from.
        seed: of the evaluation.
        record: NORMAL or the fault's kind.
        normal_windows: those in normal operation: all, or those that end before the onset.
        false_windows: of these, those that are abnormal by the bare verdict.
        false_alarms: alarms raised in normal operation.
        false_suspicions: times that a suspicion or an alarm began in normal operation.
        windows: those that begin after the onset; this and all that follows: with a fault only.
        missed_raw: of these, those that are not abnormal by the bare verdict.
        missed: of these, those without standing alarm as well.
        windows_after_alarm: those after the window that raised the first alarm after the onset.
        missed_after_alarm: of these, those without standing alarm.
        auc: windows after the onset against those of the normal record of the same seed.
        stood_before: whether an alarm stood at the onset, a false one.
        latency_s: from the onset to the first alarm raised after it; None: none was.
        noticed_s: from the onset to the first suspicion or alarm; None: none was, or there was one
            at the onset.
        top1, top3: whether a guilty source is the first, or among the first three, at the moment
            of that alarm; None: no such alarm, no guilty source, or the system names no
            suspects.
        noticed_first: whether a guilty source is the first that is named by that suspicion or
            alarm, likewise.
        watched: of normal operation: components that the system watches; None: it judges all
            together.
        components: of normal operation: of the robot.
    """

    system: str
    training_share: float
    seed: int
    record: str
    normal_windows: int
    false_windows: int
    false_alarms: int
    false_suspicions: int
    windows: Optional[int] = None
    missed_raw: Optional[int] = None
    missed: Optional[int] = None
    windows_after_alarm: Optional[int] = None
    missed_after_alarm: Optional[int] = None
    auc: Optional[float] = None
    stood_before: Optional[bool] = None
    latency_s: Optional[float] = None
    noticed_s: Optional[float] = None
    top1: Optional[bool] = None
    top3: Optional[bool] = None
    noticed_first: Optional[bool] = None
    watched: Optional[int] = None
    components: Optional[int] = None


def normal_row(system: str, training_share: float, seed: int, judged: Judged,
               watched: Optional[int] = None, components: Optional[int] = None) -> Row:
    """Measure a record of normal operation; arguments as in Row."""
    counted = ~judged.settling
    return Row(system, training_share, seed, NORMAL, int(counted.sum()),
               int((judged.abnormal & counted).sum()), len(judged.alarms),
               beginnings(judged.noticed), watched=watched, components=components)


def fault_row(system: str, training_share: float, seed: int, kind: str, judged: Judged,
              onset: int, culprits: Sequence[str], normal: Judged) -> Row:
    """Measure a record with a fault.

    Args:
        system, training_share, seed: see Row.
        kind: of the fault.
        judged: the record.
        onset: of the fault [ns].
        culprits: sources to blame.
        normal: the normal record of the same seed and system.
    """
    before = ~judged.settling & (judged.start + DEFAULT_WINDOW <= onset)
    after = judged.start >= onset
    standing = judged.standing
    alarm = first_alarm(judged.alarms, onset)
    later = np.zeros_like(after) if alarm is None else judged.start >= alarm.start
    suspects = None if alarm is None or not culprits else alarm.suspects
    return Row(
        system, training_share, seed, kind,
        normal_windows=int(before.sum()),
        false_windows=int((judged.abnormal & before).sum()),
        false_alarms=sum(alarm.start <= onset for alarm in judged.alarms),
        false_suspicions=beginnings(judged.noticed & (judged.start + DEFAULT_WINDOW <= onset)),
        windows=int(after.sum()),
        missed_raw=int((after & ~judged.abnormal).sum()),
        missed=int((after & ~judged.abnormal & ~standing).sum()),
        windows_after_alarm=int(later.sum()),
        missed_after_alarm=int((later & ~standing).sum()),
        auc=Roc(normal.score[~normal.settling], judged.score[after]).auc,
        stood_before=any(alarm.start <= onset < alarm.end or
                         (alarm.start <= onset and not alarm.cleared) for alarm in judged.alarms),
        latency_s=None if alarm is None else (alarm.start - onset) / SECOND_NS,
        noticed_s=_noticed_s(judged, onset),
        top1=None if suspects is None else bool(set(suspects[:1]) & set(culprits)),
        top3=None if suspects is None else bool(set(suspects[:3]) & set(culprits)),
        noticed_first=_noticed_first(judged, onset, culprits))


def beginnings(noticed: np.ndarray) -> int:
    """Return how often something begins, by whether it is there in each window."""
    return int((np.diff(noticed.astype(np.int8), prepend=0) == 1).sum())


def _noticed_s(judged: Judged, onset: int) -> Optional[float]:
    ends = judged.start + DEFAULT_WINDOW
    noticed = judged.noticed
    if not noticed.any() or noticed[ends <= onset][-1:].any():
        return None
    first = ends[noticed & (ends > onset)][:1]
    return (int(first[0]) - onset) / SECOND_NS if len(first) else None


def _noticed_first(judged: Judged, onset: int, culprits: Sequence[str]) -> Optional[bool]:
    found = sorted([*judged.alarms, *judged.suspicions], key=lambda each: each.start)
    first = first_alarm(found, onset)
    if _noticed_s(judged, onset) is None or first is None or first.suspects is None:
        return None
    return bool(set(first.suspects[:1]) & set(culprits)) if culprits else None


def first_alarm(alarms: List[SystemAlarm], onset: int) -> Optional[SystemAlarm]:
    """Return the first alarm that is raised after the onset [ns]."""
    return next((alarm for alarm in alarms if alarm.start > onset), None)


def alarms_until_return(alarms: List[SystemAlarm],
                        back: Optional[int]) -> Tuple[List[SystemAlarm], Optional[int]]:
    """Return the alarms that may belong to a fault, until AFTERMATH_S after it is over, and the
    number of those that come later.

    Args:
        alarms: of the record.
        back: when the fault is over [ns]; None: it lasts, and all alarms may belong to it.
    """
    if back is None:
        return alarms, None
    end = back + nanoseconds(AFTERMATH_S)
    belong = [alarm for alarm in alarms if alarm.start <= end]
    return belong, len(alarms) - len(belong)
