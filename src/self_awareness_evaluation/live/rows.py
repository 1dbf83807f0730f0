"""The row of a live session: one for each stretch of time, by what the monitor said; what pages
say of rows, and what was not as it should be. No ROS here."""
from __future__ import annotations

import math
from dataclasses import dataclass, replace
from operator import attrgetter
from statistics import median, median_low
from typing import Iterator, List, Optional, Sequence, Tuple

import numpy as np

from self_awareness.calibration import confidence
from self_awareness_evaluation.figures import counted, grouped, of_all, seconds, table
from self_awareness_evaluation.rows import AFTERMATH_S

CRASH, HANG, HALF, DOUBLE = 'crash', 'hang', 'half', 'double'
"""Kinds of faults that hit any component: killed, its process stopped, at half or double rate."""

DELAY_S = 1.0  # of `recovery`: an alarm stands for so long before a node is restarted [s]
MUST_BE_FOUND_S = 2.0  # a fault that lasts for longer is missed if there is no alarm [s]

BACK_WITHIN_S = 5.0
"""From the alarm to when a node that hangs is heard again, besides the delay of the rules [s]."""

_MOST_SLOPE = 1.0  # of resident memory that counts as flat [MB an hour]
_FILLED_S = 300.0  # until then memory may grow: the flight recorder fills its five minutes
_LEAST_S = 300.0  # a slope of less is one of chance
Told = Tuple[List[str], List[str]]  # the lines of a page, and what was not as it should be
RESTARTED = 'restarted by the recovery'  # the fault of a row that tells of such a node
HANGS, AT_RANDOM = 1, 2  # rounds of a recovery: a node hangs again and again; faults at random
ERROR, WARN = 2, 1  # levels of a status that are an alarm, and a suspicion
_RECORDED = '; events in '  # before the file of the flight recorder, which only this machine has
_FAULT = attrgetter('fault')  # of a row


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
    events: int = 0  # in the window

    @property
    def words(self) -> str:
        """What is said, without the file."""
        return self.message.split(_RECORDED)[0]


@dataclass(frozen=True)
class Row:
    """A stretch of time; the columns of the CSV files. All after `load` may be None: where that
    does not apply, never came, or was not measured."""

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
    # Of normal operation, how often an alarm (ERROR) was raised, and how often there was a
    # suspicion (WARN) that did not become one; how many components the model watches, and knows.
    alarms: Optional[int] = None
    suspicions: Optional[int] = None
    watched: Optional[int] = None
    components: Optional[int] = None
    # From the onset to the first WARN or ERROR, to the first ERROR, and to the first one that
    # blames the node.
    suspicion_s: Optional[float] = None
    latency_s: Optional[float] = None
    blamed_s: Optional[float] = None
    first: Optional[bool] = None  # whether the node is the first suspect of the first ERROR
    # What was said when the fault was undone.
    end_level: Optional[int] = None
    end_kind: Optional[str] = None
    end_component: Optional[str] = None
    recovered_s: Optional[float] = None  # from the onset to when the node was as before
    # From then to the end of the alarm; 0: there was none then; inf: it stood to the end of the
    # wait.
    cleared_s: Optional[float] = None
    # From blamed_s to when a new process of the node was heard, by the recovery.
    back_s: Optional[float] = None
    events: Optional[int] = None  # that the monitor judged
    # At the end, the monitor's resident memory [MB], threads, and open files and connections.
    memory_mb: Optional[float] = None
    threads: Optional[int] = None
    files: Optional[int] = None

    @property
    def is_normal(self) -> bool:
        return self.alarms is not None

    @property
    def is_fault(self) -> bool:
        return not self.is_normal and self.fault != RESTARTED

    @property
    def end(self) -> float:
        """When all was as before [s since 1970]."""
        return self.onset + (self.lasted_s if self.recovered_s is None else self.recovered_s)


def measure(row: Row, statuses: Sequence[Status]) -> Row:
    """Measure what the monitor said of a stretch of time, by all statuses so far. The row has what
    is known without it: onset and lasted_s, the stretch; of normal operation 0 alarms; of a fault
    recovered_s, if the statuses go on after that."""
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
            said='; '.join(f'{"ERROR" if status.level >= ERROR else "WARN"}: {status.words}'
                           for status in begun))
    row = replace(row, void=row.void or _void(before, inside))
    if row.recovered_s is not None:
        row = replace(row, cleared_s=_cleared(row.end, statuses))
    return row if row.void else _of_fault(row, inside)


def _of_fault(row: Row, inside: Sequence[Status]) -> Row:
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
    return replace(row, said=alarm.words,
                   first=bool(set(alarm.suspects[:1]) & guilty) if guilty else None)


def _void(before: Sequence[Status], inside: Sequence[Status]) -> str:
    if not before or not inside:
        return 'nothing was said'
    if before[0].level >= ERROR:
        return 'the alarm stood at the onset'
    return 'the monitor settled at the onset' if before[0].settling else ''


def _begun(before: Sequence[Status], inside: Sequence[Status]) -> List[Status]:
    """Return the first status of every alarm, and of every suspicion beside them. A suspicion
    before an alarm, or after it until all is well, is part of it."""
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


def of_faults(rows: Sequence[Row]) -> Told:
    """Return a line on all faults that count, and one on each kind of normal operation."""
    faults = [row for row in rows if row.is_fault and not row.void]
    missed = ', '.join(fault for fault, of_fault in grouped(faults, _FAULT).items()
                       if all(row.latency_s is None for row in of_fault))
    return [f'- faults: alarms {_found([row.latency_s for row in faults])}; WARN or alarm '
            f'{_found([row.suspicion_s for row in faults])}; the right node first '
            f'{of_all(counted(row.first for row in faults))}'
            + (f'; never an alarm: {missed}' if missed else ''),
            *(_of_normal(kind, of_kind) for kind, of_kind in
              grouped((row for row in rows if row.is_normal), _FAULT).items()),
            *(f'- void: {row.fault} {row.node} ({row.void})' for row in rows if row.void)], []


def _found(values: Sequence[Optional[float]]) -> str:
    raised = [math.inf if value is None else value for value in values]
    return (f'{sum(map(math.isfinite, raised))} of {len(raised)}, median '
            f'{seconds(median_low(raised or [math.inf]))}')


def _of_normal(kind: str, rows: Sequence[Row]) -> str:
    hours = sum(row.lasted_s for row in rows) / 3600.0
    alarms = sum(row.alarms or 0 for row in rows)
    low, high = confidence.poisson_rate(alarms, hours)
    return (f'- {kind}, {60.0 * hours:.3g} min: false alarms {alarms} (95 %: {low:.1f} to '
            f'{high:.1f} an hour), suspicions {sum(row.suspicions or 0 for row in rows)}, '
            f'watched {rows[0].watched} of {rows[0].components}')


def of_soak(rows: Sequence[Row]) -> Told:
    """Return the tables of a soak, and what was missed or made up, or whether memory grows."""
    faults = [row for row in rows if row.is_fault]
    long = [row for row in faults if row.lasted_s > MUST_BE_FOUND_S]
    missed = [row for row in long if row.latency_s is None]
    slope, first, last = slope_mb_per_hour(rows), rows[0], rows[-1]
    wrong = [*(f'{row.fault} at {_at(row, rows)} was missed: {row.void}' for row in missed),
             *(f'false alarm after {_at(row, rows)}: {row.said}' for row in rows if row.alarms),
             *(f'{row.fault} at {_at(row, rows)}: the alarm did not clear' for row in rows
               if row.cleared_s == math.inf)]
    if slope is not None and slope >= _MOST_SLOPE:
        wrong.append(f'memory grows by {slope:.2f} MB an hour')
    lines = [f'{(last.onset + last.lasted_s - first.onset) / 60.0:.0f} minutes, '
             f'{sum(row.events or 0 for row in rows) / sum(row.lasted_s for row in rows):.0f} '
             'messages a second.', '', *table(['what', 'demanded', 'measured'], [
                 [f'faults of more than {MUST_BE_FOUND_S:g} s that were missed', 'none',
                  f'{len(missed)} of {len(long)}'],
                 ['alarms without a fault', 'none', str(sum(row.alarms or 0 for row in rows))],
                 [f'slope of resident memory after {_FILLED_S / 60.0:g} minutes',
                  f'less than {_MOST_SLOPE:g} MB an hour',
                  'not measured: it takes 10 minutes' if slope is None
                  else f'{slope:.2f} MB an hour'],
                 ['resident memory at the beginning and the end', '',
                  f'{first.memory_mb or math.nan:.1f} MB, {last.memory_mb or math.nan:.1f} MB'],
                 ['threads, open files', '', f'{first.threads} and {first.files}, then '
                  f'{last.threads} and {last.files}']])]
    return [*lines, '', *table(
        ['fault', 'number', 'found', 'median time to the alarm', 'longest', 'named first',
         'alarm over after the end, median', 'longest'],
        [_of_kind(*each) for each in sorted(grouped(faults, _kind).items())])], wrong


def slope_mb_per_hour(rows: Sequence[Row]) -> Optional[float]:
    """Return the slope of the line through the resident memory, once the flight recorder is full;
    None: too little was seen for one."""
    seen = [(row.onset + row.lasted_s - rows[0].onset, row.memory_mb) for row in rows
            if row.memory_mb is not None]
    later = [each for each in seen if each[0] >= _FILLED_S]
    if len(later) < 2 or later[-1][0] - later[0][0] < _LEAST_S:
        return None
    at_s, memory_mb = np.transpose(later)
    return float(np.polyfit(at_s / 3600.0, memory_mb, 1)[0])


def of_recovery(rows: Sequence[Row]) -> Told:
    """Return the table of a recovery, and who was not back in time, or restarted though well."""
    faults = [row for row in rows if row.is_fault]
    hangs = [row for row in faults if row.round == HANGS]
    late = [row for row in hangs if row.back_s is None or row.back_s > DELAY_S + BACK_WITHIN_S]
    begin = min((row.onset for row in rows if row.round == AT_RANDOM), default=math.inf)
    end = max(row.onset + row.lasted_s for row in rows)
    healthy, lasting = of_healthy(rows), not_mended(rows)
    wrong = [*(f'hang at {_at(row, rows)} was not back in time: {row.back_s} {row.void}'
               for row in late),
             *(f'{row.node} was healthy and restarted at {_at(row, rows)}' for row in healthy),
             *(f'{row.node} hung at {_at(row, rows)}, and was not restarted' for row in lasting)]
    return table(['what', 'demanded', 'measured'], [
        [f'back within {BACK_WITHIN_S:g} s and the delay of {DELAY_S:g} s after the alarm', 'all',
         f'{len(hangs) - len(late)} of {len(hangs)}'],
        ['from the hang to the alarm', '', _times([row.blamed_s for row in hangs])],
        ['from the alarm to the first message of the new process', '',
         _times([row.back_s for row in hangs])],
        [f'faults at random, in {max(0.0, end - begin) / 60.0:.0f} minutes', '',
         str(sum(row.round == AT_RANDOM for row in faults))],
        ['nodes restarted meanwhile', '', str(sum(row.onset >= begin for row in _restarts(rows)))],
        ['of them healthy', 'none', str(len(healthy))],
        ['hangs that lasted on', 'none', str(len(lasting))]]), wrong


def of_healthy(rows: Sequence[Row]) -> List[Row]:
    """Return the restarts of nodes that did not hang or crash then, nor just had. Each fault
    excuses one restart. Those that only change a rate excuse none: the rules are about who has
    died."""
    left = list(_of_who_died(rows, HANG, CRASH))
    wrong = []
    for restart in _restarts(rows):
        excuse = next((row for row in left if row.node == restart.node
                       and row.onset < restart.onset <= row.end + AFTERMATH_S), None)
        if excuse is None:
            wrong.append(restart)
        else:
            left.remove(excuse)
    return wrong


def not_mended(rows: Sequence[Row]) -> List[Row]:
    """Return the hangs that lasted on, although the node should have been restarted. A hang that
    no alarm names should have been found in time all the same."""
    return [row for row in _of_who_died(rows, HANG)
            if row.end - row.onset > (MUST_BE_FOUND_S if row.blamed_s is None else row.blamed_s)
            + DELAY_S + BACK_WITHIN_S
            and not any(each.node == row.node and row.onset < each.onset <= row.end
                        for each in _restarts(rows))]


def _of_who_died(rows: Sequence[Row], *kinds: str) -> Iterator[Row]:
    return (row for row in rows if row.is_fault and row.fault.partition(':')[0] in kinds)


def _restarts(rows: Sequence[Row]) -> List[Row]:
    return [row for row in rows if row.fault == RESTARTED]


def _at(row: Row, rows: Sequence[Row]) -> str:
    return f'{row.onset - rows[0].onset:.0f} s'


def _kind(row: Row) -> str:
    """Return the kind of a fault; those that need not be found are one of their own."""
    kind = row.fault.partition(':')[0]
    return (f'{kind} of less than {MUST_BE_FOUND_S:g} s' if row.lasted_s <= MUST_BE_FOUND_S
            else kind)


def _of_kind(kind: str, rows: Sequence[Row]) -> List[str]:
    found = [row.latency_s for row in rows if row.latency_s is not None]
    cleared = [row.cleared_s for row in rows if row.cleared_s or row.latency_s is not None]
    return [kind, str(len(rows)), str(len(found)), *_columns(found),
            str(sum(bool(row.first) for row in rows)), *_columns(cleared)]


def _columns(values: Sequence[Optional[float]]) -> List[str]:
    """Return median and longest."""
    known = [value for value in values if value is not None]
    return [f'{median(known):.2f} s', f'{max(known):.2f} s'] if known else ['', '']


def _times(values: Sequence[Optional[float]]) -> str:
    times = _columns(values)
    return f'median {times[0]}, longest {times[1]}' if times[0] else ''
