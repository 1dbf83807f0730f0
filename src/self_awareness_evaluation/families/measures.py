"""What is measured of a system on a robot: rows of the results."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Optional, Tuple

import numpy as np

from self_awareness import DEFAULT_WINDOW
from self_awareness.stamps import SECOND_NS
from self_awareness_evaluation.families.protocol import FaultRecord
from self_awareness_evaluation.simulated.measures import (alarms_until_return, beginnings,
                                                          first_alarm)
from self_awareness_evaluation.systems import Judged

_HOUR_S = 3600.0


@dataclass(frozen=True)
class Subject:
    """Who is measured: a system that learned about a robot.

    Args:
        family: of the robot.
        seed: of the robot.
        learning: what the system learned from, in short.
        system: its name.
        budget: false alarms an hour that its limits allow; None: it has no budget.
    """

    family: str
    seed: int
    learning: str
    system: str
    budget: Optional[float]


@dataclass(frozen=True)
class NormalRow:
    """A recording of normal operation. Windows that settle are no part of the time.

    Args:
        subject: who judged it.
        hours: its length [h].
        alarms: raised in it, all of them false.
        standing_hours: for how long an alarm stood [h].
        warnings: times that a suspicion or an alarm began.
        evidence: what raised each alarm, in the system's words.
        expected: false alarms an hour that the calibration told; None: it did not say.
        watched: components of the robot that the system watches; None: it judges all together.
        components: of the robot; None: not noted.
        suspicions: what raised each suspicion that was no alarm, in the system's words.
    """

    subject: Subject
    hours: float
    alarms: int
    standing_hours: float
    warnings: int
    evidence: Tuple[str, ...]
    expected: Optional[float]
    watched: Optional[int] = None
    components: Optional[int] = None
    suspicions: Tuple[str, ...] = ()


@dataclass(frozen=True)
class FaultRow:
    """A recording with a fault.

    Args:
        subject: who judged it.
        kind: of the fault, one of protocol.KINDS.
        source: the guilty component; empty: the robot.
        stood_before: whether an alarm stood at the onset, a false one; only when it has cleared
            can another one be raised.
        latency_s: from the onset to the first alarm raised after it; None: none was.
        first: whether that alarm names the guilty component first; None: no such alarm, no
            guilty component, or the system names nobody.
        among_three: the same of the first three.
        after: alarms for a component that was back already, all of them false; None: it is not
            back.
    """

    subject: Subject
    kind: str
    source: str
    stood_before: bool
    latency_s: Optional[float]
    first: Optional[bool]
    among_three: Optional[bool]
    after: Optional[int] = None


def normal_row(subject: Subject, judged: Judged, expected: Optional[float],
               watched: Optional[int] = None, components: Optional[int] = None) -> NormalRow:
    """Measure a recording of normal operation."""
    counted = ~judged.settling
    return NormalRow(subject, _hours(counted), len(judged.alarms),
                     _hours(judged.standing & counted), beginnings(judged.noticed),
                     tuple(alarm.evidence for alarm in judged.alarms), expected, watched,
                     components, tuple(each.evidence for each in judged.suspicions))


def fault_row(subject: Subject, record: FaultRecord, judged: Judged) -> FaultRow:
    """Measure a recording with a fault."""
    alarms, after = alarms_until_return(judged.alarms, record.back)
    alarm = first_alarm(alarms, record.onset)
    suspects = alarm.suspects if alarm is not None and record.source else None
    return FaultRow(
        subject, record.kind, record.source,
        any(alarm.start <= record.onset and not (alarm.cleared and alarm.end <= record.onset)
            for alarm in judged.alarms),
        None if alarm is None else (alarm.start - record.onset) / SECOND_NS,
        None if suspects is None else suspects[:1] == [record.source],
        None if suspects is None else record.source in suspects[:3],
        after)


def _hours(windows: np.ndarray) -> float:
    return int(windows.sum()) * DEFAULT_WINDOW / SECOND_NS / _HOUR_S
