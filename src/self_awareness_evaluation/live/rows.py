"""The row of a live session: one for each stretch of time, by what the monitor said. No ROS here.
"""
from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import List, NamedTuple, Optional, Sequence, Tuple

RESTARTED = 'restarted by the recovery'
"""The fault of a row that tells of a node that the recovery has restarted."""

HANGS, AT_RANDOM = 1, 2  # rounds of a recovery: a node hangs again and again; faults at random

ERROR, WARN = 2, 1  # levels of a status that are an alarm, and a suspicion
_SEPARATOR = '; '  # between what was said of one alarm or suspicion, and of the next one
_RECORDED = '; events in '  # before the file of the flight recorder, which only this machine has


@dataclass(frozen=True)
class Status:
    """What the monitor says of a window."""

    stamp: float  # end of the window [s since 1970]
    level: int  # that of the message SelfAwareness
    settling: bool  # whether it is too early for an alarm
    suspects: Tuple[str, ...] = ()  # sources, the most likely first, each once
    message: str = ''  # what is abnormal, in words
    component: str = ''  # that is to blame; empty: none
    kind: str = ''  # what is wrong with it
    alarm: int = 0  # id of the alarm or suspicion
    events: int = 0  # in the window

    @property
    def words(self) -> str:
        """What is said, without the file."""
        return self.message.split(_RECORDED)[0]


class Incident(NamedTuple):
    """What one cause has done: ids of its first and last alarm, and its times [s since 1970]."""

    id: int
    last: int
    opened: float
    ended: float


@dataclass(frozen=True)
class Row:
    """A stretch of time; the columns of the CSV files.

    All after `load` may be None: where that does not apply, never came, or was not measured.
    """

    fault: str  # its name; of normal operation: what that is called; or RESTARTED
    node: str  # that is broken, several with a space between; empty: none, or the whole machine
    round: int = 1  # number, from 1 on
    onset: float = 0.0  # [s since 1970]
    lasted_s: float = 0.0  # time until it was undone; of normal operation: time that was judged
    void: str = ''  # why a fault does not count; empty: it does
    # Of the alarm of a fault, in the monitor's words; of normal operation: each alarm and
    # suspicion as it began.
    said: str = ''
    note: str = ''  # what did not go as planned
    load: float = 0.0  # the machine's load average of the last minute at the onset
    alarms: Optional[int] = None  # of normal operation: how often an alarm (ERROR) was raised
    # Of normal operation: how often there was a suspicion (WARN) that did not become an alarm.
    suspicions: Optional[int] = None
    # Of normal operation: how many the model watches, and knows.
    watched: Optional[int] = None
    components: Optional[int] = None
    # From the onset to the first WARN or ERROR, and to the first ERROR.
    suspicion_s: Optional[float] = None
    latency_s: Optional[float] = None
    blamed_s: Optional[float] = None  # from the onset to the first ERROR that blames the node
    first: Optional[bool] = None  # whether the node is the first suspect of the first ERROR
    # What was said when the fault was undone.
    end_level: Optional[int] = None
    end_kind: Optional[str] = None
    end_component: Optional[str] = None
    recovered_s: Optional[float] = None  # from the onset to when the node was as before
    # From then to the end of the alarm; 0: there was none then; inf: it stood to the end of the
    # wait.
    cleared_s: Optional[float] = None
    # From the onset to when the alarm's incident was opened, and to its last alarm so far;
    # negative: it is one with an earlier fault.
    incident_began_s: Optional[float] = None
    incident_ended_s: Optional[float] = None
    # From blamed_s to when a new process of the node was heard, by the recovery.
    back_s: Optional[float] = None
    events: Optional[int] = None  # that the monitor judged
    # Resident memory of the monitor [MB], its threads, and its open files and connections, at the
    # end.
    memory_mb: Optional[float] = None
    threads: Optional[int] = None
    files: Optional[int] = None

    @property
    def is_normal(self) -> bool:
        """Whether nothing was wrong."""
        return self.alarms is not None

    @property
    def is_fault(self) -> bool:
        """Whether something was wrong with the robot."""
        return not self.is_normal and self.fault != RESTARTED

    @property
    def end(self) -> float:
        """When all was as before [s since 1970]."""
        return self.onset + (self.lasted_s if self.recovered_s is None else self.recovered_s)


def measure(row: Row, statuses: Sequence[Status], incidents: Sequence[Incident] = ()) -> Row:
    """Measure what the monitor said of a stretch of time.

    Args:
        row: what is known without it: of normal operation, with 0 alarms; of a fault, with
            recovered_s, if the statuses go on after that. Its onset and lasted_s are the stretch.
        statuses: of the whole session, in their order.
        incidents: so far, in their order.
    """
    before = [status for status in statuses if status.stamp <= row.onset][-1:]
    inside = [status for status in statuses
              if row.onset < status.stamp <= row.onset + row.lasted_s]
    row = replace(row, events=sum(status.events for status in inside) or None)
    if row.is_normal:
        begun = _begun(before, inside)
        return replace(
            row, lasted_s=row.lasted_s
            * (sum(not status.settling for status in inside) / max(1, len(inside))),
            alarms=sum(status.level >= ERROR for status in begun),
            suspicions=sum(status.level == WARN for status in begun),
            said=_SEPARATOR.join(f'{"ERROR" if status.level >= ERROR else "WARN"}: {status.words}'
                                 for status in begun))
    row = replace(row, void=row.void or _void(before, inside))
    if row.recovered_s is not None:
        row = replace(row, cleared_s=_cleared(row.end, statuses))
    return row if row.void else _of_fault(row, inside, incidents)


def _of_fault(row: Row, inside: Sequence[Status], incidents: Sequence[Incident]) -> Row:
    guilty = {f'/{name}' for name in row.node.split()}
    alarms = [status for status in inside if status.level >= ERROR]

    def first_s(found: Sequence[Status]) -> Optional[float]:
        return found[0].stamp - row.onset if found else None

    row = replace(
        row, end_level=inside[-1].level, end_kind=inside[-1].kind,
        end_component=inside[-1].component, latency_s=first_s(alarms),
        suspicion_s=first_s([status for status in inside if status.level >= WARN]),
        blamed_s=first_s([status for status in alarms if status.component in guilty]))
    if not alarms:
        return row
    alarm = alarms[0]
    row = replace(row, said=alarm.words,
                  first=bool(set(alarm.suspects[:1]) & guilty) if guilty else None)
    for each in reversed(incidents):
        if each.id <= alarm.alarm <= each.last:
            return replace(row, incident_began_s=each.opened - row.onset,
                           incident_ended_s=each.ended - row.onset)
    return row


def _void(before: Sequence[Status], inside: Sequence[Status]) -> str:
    if not before or not inside:
        return 'nothing was said'
    if before[0].level >= ERROR:
        return 'the alarm stood at the onset'
    return 'the monitor settled at the onset' if before[0].settling else ''


def _begun(before: Sequence[Status], inside: Sequence[Status]) -> List[Status]:
    """Return the first status of every alarm, and of every suspicion beside them.

    A suspicion before an alarm, or after it until all is well, is part of it.
    """
    found: List[Status] = []
    level = highest = before[-1].level if before else 0
    for status in inside:
        if status.level < WARN:
            highest = 0
        elif level < ERROR <= status.level or highest < WARN:
            if found and highest == WARN and found[-1].level == WARN:
                found.pop()  # it became this alarm
            found.append(status)
        highest = max(highest, status.level)
        level = status.level
    return found


def _cleared(recovered: float, statuses: Sequence[Status]) -> float:
    after = [status for status in statuses if status.stamp > recovered]
    standing = [status for status in after if status.level >= ERROR]
    if not standing:
        return 0.0
    return math.inf if after[-1].level >= ERROR else standing[-1].stamp - recovered
