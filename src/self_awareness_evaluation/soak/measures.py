"""What a soak found: every fault with its alarm, and every alarm with its fault. No ROS here."""
from __future__ import annotations

from dataclasses import dataclass
from typing import List, Optional, Sequence, Tuple

from self_awareness_evaluation.live.samples import ERROR, Status
from self_awareness_evaluation.rows import AFTERMATH_S

MUST_BE_FOUND_S = 2.0
"""A fault that lasts for longer is missed if there is no alarm [s]."""


@dataclass(frozen=True)
class Happened:
    """A fault that hit the robot.

    Args:
        fault: its name, like crash:slam.
        culprit: the source to blame.
        onset, end: when it began, and when the component was heard again [s since 1970].
    """

    fault: str
    culprit: str
    onset: float
    end: float


@dataclass(frozen=True)
class Found:
    """A fault and what the monitor said of it.

    Args:
        fault: its name.
        onset_s: since the soak began [s].
        lasted_s: [s].
        latency_s: from the onset to the end of the window that raised the alarm; None: none was.
        rank: of the culprit among the suspects of that alarm, 1 the first; None: not among them,
            or no alarm.
        cleared_s: from the end of the fault to when no alarm stood any more; None: no alarm.
        missed: it lasted long enough to be found, and was not.
    """

    fault: str
    onset_s: float
    lasted_s: float
    latency_s: Optional[float]
    rank: Optional[int]
    cleared_s: Optional[float]
    missed: bool


@dataclass(frozen=True)
class FalseAlarm:
    """An alarm without a fault.

    Args:
        at_s: since the soak began [s].
        message: what the monitor said.
    """

    at_s: float
    message: str


@dataclass(frozen=True)
class _Alarm:
    raised: Status
    cleared: float


def judge(happened: Sequence[Happened], statuses: Sequence[Status], begin: float
          ) -> Tuple[List[Found], List[FalseAlarm]]:
    """Compare the alarms with the faults.

    Args:
        happened: all faults, in their order; they do not overlap.
        statuses: of the monitor, in their order.
        begin: of the soak [s since 1970].
    """
    alarms = _alarms(statuses)
    found = [_found(fault, [alarm for alarm in alarms if _belongs(alarm, fault)], begin)
             for fault in happened]
    wrong = [FalseAlarm(alarm.raised.stamp - begin, alarm.raised.message) for alarm in alarms
             if not any(_belongs(alarm, fault) for fault in happened)]
    return found, wrong


def _alarms(statuses: Sequence[Status]) -> List[_Alarm]:
    alarms = []
    raised: Optional[Status] = None
    for status in statuses:
        if raised is None and status.level >= ERROR:
            raised = status
        elif raised is not None and status.level < ERROR:
            alarms.append(_Alarm(raised, status.stamp))
            raised = None
    if raised is not None:
        alarms.append(_Alarm(raised, statuses[-1].stamp))
    return alarms


def _belongs(alarm: _Alarm, fault: Happened) -> bool:
    return fault.onset < alarm.raised.stamp <= fault.end + AFTERMATH_S


def _found(fault: Happened, alarms: Sequence[_Alarm], begin: float) -> Found:
    lasted_s = fault.end - fault.onset
    in_time = [alarm for alarm in alarms if alarm.raised.stamp <= fault.end]
    first = in_time[0].raised if in_time else None
    rank = None
    if first is not None and fault.culprit in first.suspects:
        rank = first.suspects.index(fault.culprit) + 1
    return Found(fault.fault, fault.onset - begin, lasted_s,
                 None if first is None else first.stamp - fault.onset, rank,
                 max(0.0, alarms[-1].cleared - fault.end) if alarms else None,
                 missed=first is None and lasted_s > MUST_BE_FOUND_S)
