"""What is measured of a stretch of time, by what a system said of it. No ROS here."""
from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Callable, List, NamedTuple, Optional, Sequence, Tuple

from self_awareness_evaluation.live.rows import Row

ERROR, WARN = 2, 1
"""Levels of a status that are an alarm, and a suspicion."""

SEPARATOR = '; '
"""Between what was said of one alarm or suspicion, and of the next one."""

RECORDED = '; events in '
"""In what is said of an alarm, before the file of the flight recorder."""


@dataclass(frozen=True)
class Status:
    """What a system says of a window.

    Args:
        stamp: end of the window [s since 1970].
        level: that of the message SelfAwareness.
        settling: whether it is too early for an alarm.
        evidence: what is abnormal.
        suspects: sources, the most likely first, each once; None: the system names nobody.
        message: the same in words.
        component: that is to blame; empty: none.
        kind: what is wrong with it.
        alarm: id of the alarm or suspicion.
        events: in the window.
    """

    stamp: float
    level: int
    settling: bool
    evidence: str = ''
    suspects: Optional[Tuple[str, ...]] = ()
    message: str = ''
    component: str = ''
    kind: str = ''
    alarm: int = 0
    events: int = 0


class Incident(NamedTuple):
    """What one cause has done: ids of its first and last alarm, and its times [s since 1970]."""

    id: int
    last: int
    opened: float
    ended: float


def measure(row: Row, statuses: Sequence[Status], incidents: Sequence[Incident] = ()) -> Row:
    """Measure what a system said of a stretch of time.

    Args:
        row: what is known without it: of normal operation, with 0 alarms; of a fault, with
            recovered_s, if the statuses go on after that. Its onset and lasted_s are the stretch.
        statuses: of the whole session, in their order.
        incidents: so far, in their order.
    """
    end = row.onset + row.lasted_s
    before = [status for status in statuses if status.stamp <= row.onset][-1:]
    inside = [status for status in statuses if row.onset < status.stamp <= end]
    row = replace(row, events=sum(status.events for status in inside) or None)
    if row.is_normal:
        return _of_normal(row, before, inside)
    row = replace(row, void=row.void or _void(before, inside))
    if row.recovered_s is not None:
        row = replace(row, cleared_s=_cleared(row.onset + row.recovered_s, statuses))
    return row if row.void else _of_fault(row, inside, incidents)


def _of_normal(row: Row, before: Sequence[Status], inside: Sequence[Status]) -> Row:
    begun = _begun(before, inside)
    return replace(
        row, lasted_s=row.lasted_s * _share(inside, lambda status: not status.settling),
        alarms=sum(status.level >= ERROR for status in begun),
        named=sum(status.level >= ERROR and bool(status.component) for status in begun),
        suspicions=sum(status.level == WARN for status in begun),
        standing_s=row.lasted_s * _share(inside, lambda status: status.level >= ERROR),
        said=SEPARATOR.join(f'{_level(status)}: {_words(status)}' for status in begun))


def _of_fault(row: Row, inside: Sequence[Status], incidents: Sequence[Incident]) -> Row:
    guilty = {f'/{name}' for name in row.node.split()}
    alarms = [status for status in inside if status.level >= ERROR]
    row = replace(
        row, end_level=inside[-1].level, end_kind=inside[-1].kind,
        end_component=inside[-1].component,
        suspicion_s=_first_s(row, [status for status in inside if status.level >= WARN]),
        latency_s=_first_s(row, alarms),
        blamed_s=_first_s(row, [status for status in alarms if status.component in guilty]))
    if not alarms:
        return row
    alarm = alarms[0]
    row = replace(row, said=_words(alarm), evidence=alarm.evidence,
                  suspects=' '.join(alarm.suspects or ()))
    if alarm.suspects is not None and guilty:
        row = replace(row, first=bool(set(alarm.suspects[:1]) & guilty),
                      among_three=bool(set(alarm.suspects[:3]) & guilty))
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


def _first_s(row: Row, statuses: Sequence[Status]) -> Optional[float]:
    return statuses[0].stamp - row.onset if statuses else None


def _words(status: Status) -> str:
    """Return what is said, without the file that only this machine has."""
    return status.message.split(RECORDED)[0]


def _level(status: Status) -> str:
    if status.level < ERROR:
        return 'WARN'
    return 'ERROR, a node is named' if status.component else 'ERROR, no node is named'


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


def _share(statuses: Sequence[Status], is_so: Callable[[Status], bool]) -> float:
    return sum(map(is_so, statuses)) / max(1, len(statuses))
