"""What is measured of a fault that was induced in the running robot; no ROS here."""
from __future__ import annotations

from dataclasses import dataclass, replace
from typing import List, Optional, Sequence, Tuple

from self_awareness.stamps import SECOND_NS, nanoseconds
from self_awareness_evaluation.records import NORMAL
from self_awareness_evaluation.systems import SystemAlarm

ERROR, WARN = 2, 1
"""Levels of the monitor's status that are an alarm, and a suspicion."""

CLOCK_STEP_S = 0.05
"""A clock that moved by more than this during a stretch was set [s]."""


@dataclass(frozen=True)
class Status:
    """What the monitor says of a window.

    Args:
        stamp: end of the window [s since 1970].
        received: when it was heard [s since 1970].
        level: that of the message SelfAwareness.
        settling: whether it is too early for an alarm.
        evidence: what is abnormal.
        suspects: sources, the most likely first, each once.
        message: the same in words.
        component: that is to blame; empty: none.
    """

    stamp: float
    received: float
    level: int
    settling: bool
    evidence: str = ''
    suspects: Tuple[str, ...] = ()
    message: str = ''
    component: str = ''


@dataclass(frozen=True)
class Stretch:
    """A time in which something, or nothing, was wrong with the robot.

    Args:
        round: number, from 1 on.
        kind: of the fault, or NORMAL.
        onset, end: [s since 1970].
        culprits: sources to blame.
        clock_set_s: by how much the machine's clock was set in this time [s].
        note: what did not go as planned.
        load: the machine's load average of the last minute at the onset.
    """

    round: int
    kind: str
    onset: float
    end: float
    culprits: Tuple[str, ...] = ()
    clock_set_s: float = 0.0
    note: str = ''
    load: float = 0.0


@dataclass(frozen=True)
class Sample:
    """One system on one stretch; the columns of the CSV file.

    Args:
        system: its name.
        round, fault: of the stretch.
        onset: [s since 1970].
        lasted_s: time that the fault lasted; of normal operation: time that was judged.
        void: why the sample does not count; empty: it does.
        suspicion_s: from the onset to the first WARN or ERROR; None: none, or unknown.
        latency_s: from the onset to the end of the window that raised the alarm; None: none was
            while the fault lasted.
        received_s: the same to when the status was heard.
        top1, top3: whether a guilty source is the first, or among the first three, at that alarm;
            None: no alarm, no guilty source, or the system names no suspects.
        suspects: at that alarm, the most likely first.
        evidence: at that alarm, in the monitor's words.
        false_alarms: of normal operation: alarms raised.
        note, load: of the stretch.
    """

    system: str
    round: int
    fault: str
    onset: float
    lasted_s: float
    void: str = ''
    suspicion_s: Optional[float] = None
    latency_s: Optional[float] = None
    received_s: Optional[float] = None
    top1: Optional[bool] = None
    top3: Optional[bool] = None
    suspects: str = ''
    evidence: str = ''
    false_alarms: Optional[int] = None
    note: str = ''
    load: float = 0.0


def measure(system: str, stretch: Stretch, statuses: Sequence[Status]) -> Sample:
    """Measure what the monitor said of a stretch.

    Args:
        system: name of the monitor's detector.
        stretch: what was wrong, and when.
        statuses: of the whole session, in their order.
    """
    before = [status for status in statuses if status.stamp <= stretch.onset]
    inside = [status for status in statuses if stretch.onset < status.stamp <= stretch.end]
    stood = bool(before) and before[-1].level >= ERROR
    if stretch.kind == NORMAL:
        judged = [status for status in inside if not status.settling]
        levels = [ERROR if stood else 0, *(status.level for status in inside)]
        return _normal(system, stretch, judged_share=len(judged) / max(1, len(inside)),
                       alarms=sum(a < ERROR <= b for a, b in zip(levels, levels[1:])))
    void = _void(stretch, stood)
    if not before or not inside:
        void = void or 'no status of the monitor'
    elif before[-1].settling:
        void = void or 'the monitor settled at the onset'
    if void:
        return _sample(system, stretch, void)
    suspicion = next((status for status in inside if status.level >= WARN), None)
    alarm = next((status for status in inside if status.level >= ERROR), None)
    sample = _sample(system, stretch)
    if suspicion is not None:
        sample = replace(sample, suspicion_s=suspicion.stamp - stretch.onset)
    if alarm is None:
        return sample
    return replace(_blamed(sample, stretch, alarm.stamp, alarm.suspects),
                   received_s=alarm.received - stretch.onset, evidence=alarm.evidence)


def measure_alarms(system: str, stretch: Stretch, alarms: Sequence[SystemAlarm]) -> Sample:
    """Measure what a system says of a stretch in the recording of the session.

    Args:
        system: its name.
        stretch: what was wrong, and when.
        alarms: of the whole session.
    """
    onset, end = nanoseconds(stretch.onset), nanoseconds(stretch.end)
    raised = [alarm for alarm in alarms if onset < alarm.start <= end]
    if stretch.kind == NORMAL:
        return _normal(system, stretch, judged_share=1.0, alarms=len(raised))
    stood = any(alarm.start <= onset and (onset < alarm.end or not alarm.cleared)
                for alarm in alarms)
    void = _void(stretch, stood)
    sample = _sample(system, stretch, void)
    if void or not raised:
        return sample
    return _blamed(sample, stretch, raised[0].start / SECOND_NS, raised[0].suspects)


def of_system(samples: Sequence[Sample], system: str, fault: str) -> List[Sample]:
    """Return the samples of a system on a fault that count."""
    return [sample for sample in samples
            if (sample.system, sample.fault) == (system, fault) and not sample.void]


def _void(stretch: Stretch, stood: bool) -> str:
    if abs(stretch.clock_set_s) > CLOCK_STEP_S:
        return f"the machine's clock was set by {stretch.clock_set_s:.2f} s"
    return 'the alarm stood at the onset' if stood else ''


def _normal(system: str, stretch: Stretch, judged_share: float, alarms: int) -> Sample:
    return Sample(system, stretch.round, NORMAL, stretch.onset,
                  (stretch.end - stretch.onset) * judged_share, false_alarms=alarms,
                  note=stretch.note,
                  load=stretch.load)


def _sample(system: str, stretch: Stretch, void: str = '') -> Sample:
    return Sample(system, stretch.round, stretch.kind, stretch.onset,
                  stretch.end - stretch.onset, void, note=stretch.note,
                  load=stretch.load)


def _blamed(sample: Sample, stretch: Stretch, raised_at: float,
            suspects: Optional[Sequence[str]]) -> Sample:
    """Return the sample with its alarm."""
    sample = replace(sample, latency_s=raised_at - stretch.onset)
    if suspects is None:
        return sample
    sample = replace(sample, suspects=' '.join(suspects))
    if not stretch.culprits:
        return sample
    return replace(sample, top1=bool(set(suspects[:1]) & set(stretch.culprits)),
                   top3=bool(set(suspects[:3]) & set(stretch.culprits)))
