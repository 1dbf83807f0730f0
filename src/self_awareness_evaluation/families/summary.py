"""What was measured of a system on the robots of a family, as figures with their intervals."""
from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass
from typing import Dict, List, Optional, Sequence, Tuple

from self_awareness.calibration import confidence
from self_awareness.calibration.confidence import Interval
from self_awareness_evaluation.families.measures import FaultRow, NormalRow
from self_awareness_evaluation.simulated.summary import quantile

ALL = 'all'
"""Stands for all families."""

_NOTHING: Interval = (math.nan, math.nan)


@dataclass(frozen=True)
class Group:
    """Whose figures they are; see measures.Subject."""

    family: str
    learning: str
    system: str
    budget: Optional[float]


@dataclass(frozen=True)
class Quiet:
    """How normal operation was judged.

    Args:
        robots: how many were watched.
        hours: for how long, together [h].
        alarms: false ones.
        per_hour: the same an hour, and its 95 % interval.
        standing: share of the time in which an alarm stood.
        warnings_per_hour: times that a suspicion or an alarm began.
        evidence: the alarms by what raised them, most often first.
        expected_per_hour: what the calibrations promised on average; NaN: they did not say.
        watched, components: how many a robot has on average, and how many of them are watched;
            NaN: not noted, or the system judges all together.
    """

    robots: int
    hours: float
    alarms: int
    per_hour: float
    interval: Interval
    standing: float
    warnings_per_hour: float
    evidence: Tuple[Tuple[str, int], ...]
    expected_per_hour: float
    watched: float = math.nan
    components: float = math.nan


@dataclass(frozen=True)
class Found:
    """How faults of a kind were found. Shares are of all records; NaN where there are none.

    Args:
        records: with such a fault.
        stood_before: share of them with a false alarm that stood at the onset.
        latencies_s: to the first alarm of each; infinite where there was none [s].
        first: share of the alarms that name the guilty component first; NaN: none names anybody.
        among_three: the same of the first three.
        after: alarms for components that were back already.
    """

    records: int
    stood_before: float
    latencies_s: Tuple[float, ...]
    first: float
    among_three: float
    after: int = 0

    def within(self, seconds: float = math.inf) -> float:
        """Return the share found in this time [s], at the most in that of the recording."""
        return self._number(seconds) / self.records if self.records else math.nan

    def interval(self, seconds: float = math.inf) -> Interval:
        """Return the 95 % interval of within()."""
        return (confidence.wilson(self._number(seconds), self.records) if self.records
                else _NOTHING)

    @property
    def median_s(self) -> float:
        """The median latency [s]; infinite if fewer than half were found; NaN: no record."""
        return quantile(self.latencies_s, 0.5)

    def _number(self, seconds: float) -> int:
        return sum(latency <= seconds and latency < math.inf for latency in self.latencies_s)


def groups(normal: Sequence[NormalRow]) -> Dict[Group, List[NormalRow]]:
    """Return the rows by group, and those of all families together by groups of their own."""
    found: Dict[Group, List[NormalRow]] = {}
    for family_of in (lambda row: row.subject.family, lambda row: ALL):
        for row in normal:
            subject = row.subject
            found.setdefault(Group(family_of(row), subject.learning, subject.system,
                                   subject.budget), []).append(row)
    return found


def quiet(rows: Sequence[NormalRow]) -> Quiet:
    """Return the figures of normal operation."""
    hours = sum(row.hours for row in rows)
    alarms = sum(row.alarms for row in rows)
    robots = _by_robot(rows)
    expected = [of_robot[0].expected for of_robot in robots]
    evidence = Counter(text for row in rows for text in row.evidence if text)
    return Quiet(
        len(robots), hours, alarms, alarms / hours,
        rate_interval([(sum(row.alarms for row in of_robot), sum(row.hours for row in of_robot))
                       for of_robot in robots]),
        sum(row.standing_hours for row in rows) / hours,
        sum(row.warnings for row in rows) / hours, tuple(evidence.most_common()),
        _mean(expected), _mean([of_robot[0].watched for of_robot in robots]),
        _mean([of_robot[0].components for of_robot in robots]))


def kept(rows: Sequence[NormalRow]) -> float:
    """Return the share of the robots with no more false alarms an hour than were promised."""
    robots = _by_robot(rows)
    return sum(sum(row.alarms for row in of_robot)
               <= (of_robot[0].expected or 0.0) * sum(row.hours for row in of_robot)
               for of_robot in robots) / len(robots)


def found(rows: Sequence[FaultRow], group: Group, kind: str) -> Found:
    """Return how a group found faults of a kind, one of protocol.KINDS."""
    chosen = [row for row in rows if row.kind == kind
              and group.family in (ALL, row.subject.family)
              and (group.learning, group.system, group.budget)
              == (row.subject.learning, row.subject.system, row.subject.budget)]
    return Found(
        len(chosen), _share([row.stood_before for row in chosen]),
        tuple(math.inf if row.latency_s is None else row.latency_s for row in chosen),
        _share([row.first for row in chosen]), _share([row.among_three for row in chosen]),
        sum(row.after or 0 for row in chosen))


def rate_interval(robots: Sequence[Tuple[int, float]]) -> Interval:
    """Return the 95 % interval of alarms an hour, by the alarms and the hours of every robot.

    Alarms come in clusters: one robot has many, another one none. Where the robots differ by more
    than chance, the alarms count for as much fewer as Pearson's chi-square is larger than its
    degrees of freedom (quasi-Poisson; McCullagh and Nelder 1989, section 6.2).
    """
    alarms, hours = sum(robot[0] for robot in robots), sum(robot[1] for robot in robots)
    spread = 1.0
    if alarms and len(robots) > 1:
        chi_square = sum((count - alarms / hours * time) ** 2 / (alarms / hours * time)
                         for count, time in robots)
        spread = max(1.0, chi_square / (len(robots) - 1))
    return confidence.poisson_rate(alarms / spread, hours / spread)


def _by_robot(rows: Sequence[NormalRow]) -> List[List[NormalRow]]:
    robots: Dict[Tuple[str, int], List[NormalRow]] = {}
    for row in rows:
        robots.setdefault((row.subject.family, row.subject.seed), []).append(row)
    return list(robots.values())


def _mean(values: Sequence[Optional[float]]) -> float:
    known = [value for value in values if value is not None]
    return sum(known) / len(known) if known else math.nan


def _share(values: Sequence[Optional[bool]]) -> float:
    known = [value for value in values if value is not None]
    return sum(known) / len(known) if known else math.nan
