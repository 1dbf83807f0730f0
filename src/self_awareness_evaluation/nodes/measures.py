"""What is measured beside the nodes: a row for each fault and each stretch without one."""
from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Callable, List, Optional, Sequence

from self_awareness_evaluation.live.samples import ERROR, WARN, Status, Stretch, measure
from self_awareness_evaluation.nodes.system import Fault

UNDISTURBED = 'undisturbed'
"""The name of normal operation in the column of faults."""

BURSTS = 'undisturbed, but for short bursts of foreign load'
"""The same while other programs take the processor for a moment now and then."""

SEPARATOR = '; '
"""Between what was said of one alarm or suspicion, and of the next one."""


RECORDED = '; events in '
"""In what is said of an alarm, before the file of the flight recorder."""


@dataclass(frozen=True)
class Promised:
    """What the model says of itself.

    Args:
        alarms: false ones an hour that calibrate expects.
        watched: components whose death it would find.
        components: that it knows.
    """

    alarms: float
    watched: int
    components: int


@dataclass(frozen=True)
class Row:
    """A stretch of time; the columns of the CSV file.

    Args:
        fault: its kind, UNDISTURBED or BURSTS.
        node: that is broken; empty: none, or the whole machine.
        lasted_s: how long the fault lasted; of normal operation: time that was judged.
        alarms: of normal operation: how often an alarm (ERROR) was raised; nan of faults.
        suspicions: of normal operation: how often there was a suspicion (WARN) that did not
            become an alarm; nan of faults.
        standing_s: of normal operation: time that an alarm stood; nan of faults.
        expected: of normal operation: alarms an hour that calibrate expects; nan of faults.
        watched, components: of normal operation: as in Promised; nan of faults.
        named: of normal operation: alarms that blamed a node as they began; nan of faults.
        suspicion_s, latency_s: from the onset to the first WARN or ERROR, and to the first ERROR;
            None: there was none while the fault lasted.
        first, among_three: whether the node is the first suspect, or among the first three, of
            that ERROR; None: no alarm, or no guilty node.
        cleared_s: from the end of the fault to the end of the alarm; 0: there was none then;
            inf: it stood to the end of the wait.
        said: reasons in the monitor's words: of the alarm of a fault; in normal operation of each
            alarm and suspicion as it began.
        suspects: of the alarm of a fault, the most likely first.
        void: why a fault does not count; empty: it does.
        note: what did not go as planned.
        load: the machine's load average of the last minute at the onset.
    """

    fault: str
    node: str
    lasted_s: float
    alarms: float = math.nan
    suspicions: float = math.nan
    standing_s: float = math.nan
    expected: float = math.nan
    watched: float = math.nan
    components: float = math.nan
    named: float = math.nan
    suspicion_s: Optional[float] = None
    latency_s: Optional[float] = None
    first: Optional[bool] = None
    among_three: Optional[bool] = None
    cleared_s: float = 0.0
    said: str = ''
    suspects: str = ''
    void: str = ''
    note: str = ''
    load: float = 0.0


def of_quiet(stretch: Stretch, promised: Promised, statuses: Sequence[Status]) -> Row:
    """Measure a stretch of normal operation.

    Args:
        stretch: when it was.
        promised: by the model.
        statuses: of the whole session, in their order.
    """
    before = [status for status in statuses if status.stamp <= stretch.onset]
    inside = [status for status in statuses if stretch.onset < status.stamp <= stretch.end]
    length_s = stretch.end - stretch.onset
    begun = _begun(before[-1:], inside)
    return Row(stretch.kind, '', length_s * _share(inside, lambda status: not status.settling),
               alarms=sum(status.level >= ERROR for status in begun),
               named=sum(status.level >= ERROR and bool(status.component) for status in begun),
               suspicions=sum(status.level == WARN for status in begun),
               standing_s=length_s * _share(inside, lambda status: status.level >= ERROR),
               expected=promised.alarms, watched=promised.watched,
               components=promised.components,
               said=SEPARATOR.join(f'{_level(status)}: {_words(status)}' for status in begun),
               note=stretch.note, load=stretch.load)


def of_fault(fault: Fault, stretch: Stretch, recovered: float, statuses: Sequence[Status]) -> Row:
    """Measure a fault.

    Args:
        fault: which.
        stretch: from its onset until it was undone.
        recovered: when the node was as before [s since 1970]; the statuses go on after it.
        statuses: of the whole session, in their order.
    """
    sample = measure('', stretch, statuses)
    alarm = next((status for status in statuses if stretch.onset < status.stamp <= stretch.end
                  and status.level >= ERROR), None)
    return Row(fault.kind, fault.node, sample.lasted_s, suspicion_s=sample.suspicion_s,
               latency_s=sample.latency_s, first=sample.top1, among_three=sample.top3,
               cleared_s=_cleared(recovered, statuses),
               said='' if alarm is None or sample.void else _words(alarm),
               suspects=sample.suspects, void=sample.void, note=sample.note, load=sample.load)


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
    standing: List[Status] = [status for status in after if status.level >= ERROR]
    if not standing:
        return 0.0
    return math.inf if after[-1].level >= ERROR else standing[-1].stamp - recovered


def _share(statuses: Sequence[Status], is_so: Callable[[Status], bool]) -> float:
    return sum(map(is_so, statuses)) / max(1, len(statuses))
