"""What rows come to, with intervals, and how tables in Markdown tell it."""
from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass
from statistics import median_low
from typing import Any, Callable, Dict, Iterable, List, Mapping, Optional, Sequence, Tuple, TypeVar

from self_awareness.calibration import confidence
from self_awareness.calibration.confidence import Interval
from self_awareness_evaluation.rows import NORMAL, Row

_Item = TypeVar('_Item')
_Key = TypeVar('_Key')

SOON_S, WITHIN_S = 5.0, (1.0, 5.0, 50.0)  # times in which faults are to be found [s]
NONE = '–'  # what a table says where there is nothing to tell
LEAST_LATENCY_S = 0.05  # medians that differ by less are told as the same [s]
_NOTHING: Interval = (math.nan, math.nan)


class Quiet:
    """How normal operation was judged: the time without a fault in rows."""

    def __init__(self, rows: Sequence[Row]) -> None:
        robots = list(grouped(rows, lambda row: row.subject.robot).values())
        counts = [(sum(row.alarms for row in of_robot), sum(row.hours for row in of_robot))
                  for of_robot in robots]
        normal = [next((row for row in of_robot if row.fault == NORMAL), of_robot[0])
                  for of_robot in robots]
        self.hours = sum(row.hours for row in rows)  # together; where this is 0, shares are NaN
        self.alarms = sum(row.alarms for row in rows)  # false ones
        self.per_hour = part_of((self.alarms, self.hours))
        self.interval = rate_interval(counts)  # 95 % interval of that
        self.warnings = sum(row.warnings for row in rows)  # times that WARN or an alarm began
        self.warnings_per_hour = part_of((self.warnings, self.hours))
        # Share of the time in which an alarm stood.
        self.standing = part_of((sum(row.standing_hours for row in rows), self.hours))
        # The alarms by what raised them, most often first.
        self.evidence = Counter(
            text for row in rows for text in row.evidence if text).most_common()
        # False alarms an hour that the calibrations promised on average; NaN: none did.
        self.expected = _mean([row.expected for row in normal])
        # Share of the robots with no more than were promised; NaN: there is no robot.
        self.kept = _mean([count <= row.expected * time for row, (count, time)
                           in zip(normal, counts) if row.expected is not None])
        # How many of a robot's components are watched on average, of how many; NaN: not known, or
        # the system judges all together.
        self.watched = _mean([row.watched for row in normal])
        self.components = _mean([row.components for row in normal])


class Found:
    """How faults were found, by the rows of their records. Two counts are those of which it is so,
    and all of which it is known whether it is."""

    def __init__(self, rows: Sequence[Row]) -> None:
        after = [row.after for row in rows if row.after is not None]
        self.records = len(rows)
        # From the onset to the first alarm, and to the first suspicion or alarm; infinite where
        # there was none [s].
        self.latencies_s = [_or_never(row.latency_s) for row in rows]
        self.noticed_s = [_or_never(row.noticed_s) for row in rows]
        # The median; infinite if fewer than half were found; NaN: there is no record.
        self.median_s = median(self.latencies_s)
        # Alarms that name a guilty one first, or among the first three.
        self.first = counted(row.first for row in rows)
        self.among_three = counted(row.among_three for row in rows)
        # What stands when the fault ends, and blames a guilty one, or nobody where nobody is.
        self.at_end = counted(row.right_at_end for row in rows)
        # Alarms that name who has nothing to do with the fault.
        self.bystanders = counted(
            None if row.bystanders is None else row.bystanders > 0 for row in rows)
        # Records in which a false alarm stood at the onset.
        self.stood_before = sum(row.stood_before for row in rows)
        # Alarms for who was back already, and the number of records with somebody who was.
        self.after = sum(after), len(after)

    def within(self, seconds: float = math.inf) -> int:
        """Return how many were found in this time [s]."""
        return sum(latency <= seconds and latency < math.inf for latency in self.latencies_s)

    def share(self, seconds: float = math.inf) -> float:
        """Return the share of them; NaN: there is no record."""
        return part_of((self.within(seconds), self.records))

    @property
    def interval(self) -> Interval:
        """The 95 % interval of that share."""
        return confidence.wilson(self.within(), self.records) if self.records else _NOTHING


def grouped(rows: Iterable[_Item], key: Callable[[_Item], _Key]) -> Dict[_Key, List[_Item]]:
    """Return rows, of whatever kind, by a key, in the order in which keys come first."""
    found: Dict[_Key, List[_Item]] = {}
    for row in rows:
        found.setdefault(key(row), []).append(row)
    return found


def of_fault(rows: Iterable[Row], kind: str) -> List[Row]:
    """Return the rows of a kind of fault, or of NORMAL; `crash` stands for those of every
    component, and an empty one for all faults."""
    return [row for row in rows if row.fault == kind or row.fault.startswith(f'{kind}:')
            or not kind and row.fault != NORMAL]


def median(times_s: Sequence[float]) -> float:
    """Return the lower median of times, of which some may be infinite; NaN: there is none."""
    return median_low(times_s) if times_s else math.nan


def part_of(counts: Tuple[float, float]) -> float:
    """Return the first of two numbers as a share of the second; NaN: that is 0."""
    return counts[0] / counts[1] if counts[1] else math.nan


def rate_interval(robots: Sequence[Tuple[int, float]]) -> Interval:
    """Return the 95 % interval of alarms an hour, by the alarms and the hours of every robot.

    Alarms come in clusters: one robot has many, another one none. Where the robots differ by more
    than chance, the alarms count for as much fewer as Pearson's chi-square is larger than its
    degrees of freedom (quasi-Poisson; McCullagh and Nelder 1989, section 6.2).
    """
    alarms, hours = sum(robot[0] for robot in robots), sum(robot[1] for robot in robots)
    if not hours:
        return _NOTHING
    spread = 1.0
    if alarms and len(robots) > 1:
        chi_square = sum((count - alarms / hours * time) ** 2 / (alarms / hours * time)
                         for count, time in robots if time)
        spread = max(1.0, chi_square / (len(robots) - 1))
    return confidence.poisson_rate(alarms / spread, hours / spread)


def columns(rows: Sequence[Row], kinds: Sequence[str]) -> Dict[str, Any]:
    """Return all figures of rows as columns of a CSV file, with those of each kind of fault."""
    quiet = Quiet(of_fault(rows, NORMAL))
    found: Dict[str, Any] = {
        'hours': quiet.hours, 'false_alarms': quiet.alarms, 'per_hour': quiet.per_hour,
        'per_hour_low': quiet.interval[0], 'per_hour_high': quiet.interval[1],
        'standing': quiet.standing, 'warnings_per_hour': quiet.warnings_per_hour,
        'expected_per_hour': quiet.expected, 'robots_within_promise': quiet.kept,
        'watched': quiet.watched, 'components': quiet.components,
        'evidence': '; '.join(f'{text} {number}' for text, number in quiet.evidence)}
    for kind in kinds:
        each = Found(of_fault(rows, kind))
        of_kind = {
            'records': each.records, 'found': each.share(), 'low': each.interval[0],
            'high': each.interval[1],
            **{f'within {seconds:g} s': each.share(seconds) for seconds in WITHIN_S},
            'median_s': each.median_s, 'first': part_of(each.first),
            'among_three': part_of(each.among_three), 'at_end': part_of(each.at_end),
            'bystanders': each.bystanders[0], 'stood_before': each.stood_before,
            'alarms_after': each.after[0]}
        found.update((f'{kind}: {name}', value) for name, value in of_kind.items())
    return {name: value if not isinstance(value, float) else
            f'{value:.4g}' if math.isfinite(value) else '' for name, value in found.items()}


def counted(values: Iterable[Optional[bool]]) -> Tuple[int, int]:
    """Return how many values are true, and how many are known."""
    known = [value for value in values if value is not None]
    return sum(known), len(known)


def _or_never(value: Optional[float]) -> float:
    return math.inf if value is None else value


def _mean(values: Sequence[Optional[float]]) -> float:
    known = [value for value in values if value is not None]
    return sum(known) / len(known) if known else math.nan


def table(head: Sequence[str], body: Sequence[Sequence[str]]) -> List[str]:
    """Return the lines of a Markdown table."""
    return [f'| {" | ".join(row)} |' for row in (head, ['---'] * len(head), *body)]


def percent(value: float) -> str:
    """Return a share in percent; a dash for NaN."""
    return NONE if math.isnan(value) else f'{100.0 * value:.3g} %'


def seconds(value: float) -> str:
    """Return a time [s]; a dash for NaN, and for what never happened."""
    return f'{value:.2f} s' if math.isfinite(value) else NONE


def number(value: float) -> str:
    """Return a rate with as many digits as are worth reading; a dash for NaN."""
    if math.isnan(value):
        return NONE
    return f'{value:.0f}' if value >= 9.95 else f'{value:.2g}'


def rate(quiet: Quiet) -> str:
    """Return the false alarms an hour with their interval."""
    low, high = quiet.interval
    return f'{number(quiet.per_hour)} ({number(low)} to {number(high)})'


def share(found: Found) -> str:
    """Return the share that was found, and the median latency; a dash where nothing was."""
    return f'{percent(found.share())}, {seconds(found.median_s)}' if found.within() else NONE


def part(of: Tuple[int, int]) -> str:
    """Return the first of two counts as a share of the second."""
    return percent(part_of(of))


def of_all(counts: Tuple[int, int], joint: str = 'of') -> str:
    """Return two counts, such as one that is a part of the second; a dash where that is 0."""
    return f'{counts[0]} {joint} {counts[1]}' if counts[1] else NONE


def with_interval(found: Found) -> str:
    """Return the share that was found with its 95 % interval; dashes where there is no record."""
    low, high = found.interval
    told = f'{100.0 * low:.0f}–{100.0 * high:.0f} %' if found.records else NONE
    return f'{percent(found.share())} ({told})'


@dataclass(frozen=True)
class Cell:
    """A figure of rows that are compared with others."""

    text: str  # in a table
    values: Tuple[float, ...]  # that are compared
    same_within: Tuple[float, ...]  # by how much each may differ and still be told as the same

    def differs(self, other: Cell) -> bool:
        """Return whether it is told as another one."""
        return self.text != other.text and any(
            one != two and not abs(one - two) <= within
            for one, two, within in zip(self.values, other.values, self.same_within))


def cells(rows: Sequence[Row], kinds: Mapping[str, Sequence[str]]) -> Dict[str, Cell]:
    """Return the figures of rows by title; kinds: of faults, by title."""
    quiet = Quiet(rows)
    found = {'false alarms': Cell(f'{quiet.alarms} in {quiet.hours:.1f} h',
                                  (quiet.alarms, quiet.hours), (0.0, 0.05)),
             'WARN': Cell(str(quiet.warnings), (quiet.warnings,), (1.0,))}
    known = [kind for names in kinds.values() for kind in names]
    by_title = {title: [row for kind in names for row in of_fault(rows, kind)]
                for title, names in kinds.items()}
    by_title['other faults'] = [
        row for row in of_fault(rows, '')
        if not {row.fault, row.fault.partition(':')[0]} & set(known)]
    for title, of_title in by_title.items():
        each = Found(of_title)
        median = f', {seconds(each.median_s)}' if math.isfinite(each.median_s) else ''
        found[title] = Cell(
            f'{each.within(SOON_S)} / {each.within()} of {each.records}{median}'
            if each.records else NONE,
            (each.within(SOON_S), each.within(), each.median_s), (0.0, 0.0, LEAST_LATENCY_S))
    every = Found(of_fault(rows, ''))
    found['alarms after a restart'] = Cell(of_all(every.after, 'after'), every.after[:1], (0.0,))
    for title, named in (('guilty first', every.first), ('guilty at the end', every.at_end)):
        found[title] = Cell(of_all(named), (named[1] - named[0],), (0.0,))
    return found
