"""What a system says of one record: a row of the results, the same for all records and systems."""
from __future__ import annotations

from dataclasses import dataclass, replace
from typing import List, Optional, Sequence, Tuple

import numpy as np

from self_awareness import DEFAULT_WINDOW
from self_awareness.stamps import SECOND_NS, nanoseconds
from self_awareness_evaluation.records import NORMAL, REAL, FaultRecord
from self_awareness_evaluation.systems import ALARM, EXCUSES, Judged, SystemAlarm

AFTERMATH_S = 5.0
"""An alarm that is raised so soon after the fault is over belongs to it: a node that comes back is
no normal operation yet [s]."""

HOUR_S = 3600.0


@dataclass(frozen=True)
class Subject:
    """Who judges, and whom.

    Args:
        part: where the record comes from, as Robot has it.
        robot: with its seed; of a real one, what the recording is called.
        learning: what was learned from, in short.
        system: its name.
        change: what was changed of the method; empty: nothing.
        budget: false alarms an hour that its limits allow; None: the usual ones, or it has none.
    """

    part: str
    robot: str
    learning: str
    system: str
    change: str = ''
    budget: Optional[float] = None


@dataclass(frozen=True)
class Row:
    """A system on a record. Times are from the onset of the fault [s].

    Args:
        subject: see there.
        fault: NORMAL, or the kind of the fault.
        source: the guilty components; empty: no single one is guilty.
        hours: of normal operation, settled: all of it, or what was before the onset [h].
        alarms: raised in it, all of them false.
        standing_hours: for how long an alarm stood in it [h].
        warnings: times that a suspicion or an alarm began in it.
        evidence: what raised each alarm in it, in the system's words.
        suspicions: the same of what became no alarm, of a record without a fault.
        expected: false alarms an hour that the calibration told; None: it did not say.
        watched: how many components the system watches, of a record without a fault; of one with
            a fault, how many of the guilty ones. None: it judges all together, or is not known.
        components: how many there are; None: not known.
        stood_before: whether an alarm stood at the onset, a false one; only when it has cleared
            can another one be raised.
        latency_s: to the first alarm raised after the onset; None: none was.
        noticed_s: to the first suspicion or alarm; None: none, or one stood at the onset.
        first, among_three: whether that alarm names a guilty one first, or among the first three;
            None: no such alarm, nobody is guilty, or the system names nobody.
        bystanders: how many it names that have nothing to do with the fault; None: no such alarm,
            or who is involved is not known.
        level: of what stands when the fault ends, ALARM or SUSPICION; empty: nothing does.
        culprit, kind: who is to blame by then, and what is wrong; empty: nobody, or not known.
        excused: whether that is no node's fault (systems.EXCUSES).
        opened_s, closed_s: begin and end of the incident that it belongs to, or of the last one
            that began in the fault; None: there is none, or it is not over.
        after: alarms for who was back already, all of them false; None: the fault lasts.
        refused: why nothing could be judged; empty: it was.
    """

    subject: Subject
    fault: str
    source: str = ''
    hours: float = 0.0
    alarms: int = 0
    standing_hours: float = 0.0
    warnings: int = 0
    evidence: Tuple[str, ...] = ()
    suspicions: Tuple[str, ...] = ()
    expected: Optional[float] = None
    watched: Optional[int] = None
    components: Optional[int] = None
    stood_before: bool = False
    latency_s: Optional[float] = None
    noticed_s: Optional[float] = None
    first: Optional[bool] = None
    among_three: Optional[bool] = None
    bystanders: Optional[int] = None
    level: str = ''
    culprit: str = ''
    kind: str = ''
    excused: bool = False
    opened_s: Optional[float] = None
    closed_s: Optional[float] = None
    after: Optional[int] = None
    refused: str = ''

    @property
    def right_at_end(self) -> Optional[bool]:
        """Whether a guilty one is blamed when the fault ends, or nobody where nobody is guilty;
        None: nothing stands, or who is guilty is not known."""
        if not self.level or self.subject.part == REAL:
            return None
        return self.culprit in self.source.split('; ')


def normal_row(subject: Subject, judged: Judged, expected: Optional[float] = None,
               watched: Optional[int] = None, components: Optional[int] = None) -> Row:
    """Measure a record of normal operation."""
    row = Row(subject, NORMAL, expected=expected, watched=watched, components=components,
              suspicions=tuple(each.evidence for each in judged.suspicions))
    return _quiet(row, judged, np.ones(len(judged.start), dtype=bool), judged.alarms)


def fault_row(subject: Subject, record: FaultRecord, judged: Judged,
              watched: Optional[int] = None) -> Row:
    """Measure a record with a fault; watched: how many of the culprits the system watches."""
    onset = record.onset
    row = _quiet(Row(subject, record.kind, record.source, watched=watched), judged,
                 judged.start + DEFAULT_WINDOW <= onset,
                 [alarm for alarm in judged.alarms if alarm.start <= onset])
    alarms, after = alarms_until_return(judged.alarms, record.back)
    alarm = first_alarm(alarms, onset)
    row = replace(
        row, after=after,
        stood_before=any(each.stands_at(onset) for each in judged.alarms),
        latency_s=None if alarm is None else (alarm.start - onset) / SECOND_NS,
        noticed_s=_noticed_s(judged, onset), first=_names(alarm, record, 1),
        among_three=_names(alarm, record, 3), bystanders=_bystanders(alarm, record))
    return at_end(row, [*judged.alarms, *judged.suspicions], onset, record.ends)


def beginnings(noticed: np.ndarray) -> int:
    """Return how often something begins, by whether it is there in each window."""
    return int((np.diff(noticed.astype(np.int8), prepend=0) == 1).sum())


def first_alarm(alarms: Sequence[SystemAlarm], onset: int) -> Optional[SystemAlarm]:
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


def _quiet(row: Row, judged: Judged, early: np.ndarray, alarms: Sequence[SystemAlarm]) -> Row:
    """Return the row with what was judged in some windows of normal operation."""
    counted = early & ~judged.settling
    return replace(row, hours=_hours(counted), alarms=len(alarms),
                   standing_hours=_hours(judged.standing & counted),
                   warnings=beginnings(judged.noticed & early),
                   evidence=tuple(alarm.evidence for alarm in alarms))


def at_end(row: Row, found: Sequence[SystemAlarm], onset: int, end: int) -> Row:
    """Return the row with what is said when the fault ends; an alarm goes before a suspicion.

    Args:
        row: of a fault.
        found: alarms, and then suspicions.
        onset, end: of the fault [ns].
    """
    standing = [each for each in found if each.stands_at(end)]
    if standing:
        last = standing[0]
        row = replace(row, level=last.level, culprit=last.culprit, kind=last.kind,
                      excused=last.kind in EXCUSES)
    else:
        began = [each for each in found if onset < each.start <= end]
        if not began:
            return row
        last = max(began, key=lambda each: (each.level == ALARM, each.start))
    opened, closed, is_over = last.incident or (last.start, last.end, last.cleared)
    return replace(row, opened_s=(opened - onset) / SECOND_NS,
                   closed_s=(closed - onset) / SECOND_NS if is_over else None)


def _noticed_s(judged: Judged, onset: int) -> Optional[float]:
    """Return when the first suspicion or alarm came after the onset [s]; None: see Row."""
    ends = judged.start + DEFAULT_WINDOW
    noticed = judged.noticed
    if not noticed.any() or noticed[ends <= onset][-1:].any():
        return None
    first = ends[noticed & (ends > onset)][:1]
    return (int(first[0]) - onset) / SECOND_NS if len(first) else None


def _names(alarm: Optional[SystemAlarm], record: FaultRecord, among: int) -> Optional[bool]:
    """Return whether an alarm names a culprit among the first so many; None: see Row."""
    if alarm is None or alarm.suspects is None or not record.culprits:
        return None
    return bool(set(alarm.suspects[:among]) & set(record.culprits))


def _bystanders(alarm: Optional[SystemAlarm], record: FaultRecord) -> Optional[int]:
    if alarm is None or alarm.suspects is None or record.involved is None:
        return None
    return len(set(alarm.suspects) - record.involved)


def _hours(windows: np.ndarray) -> float:
    return int(windows.sum()) * DEFAULT_WINDOW / SECOND_NS / HOUR_S
