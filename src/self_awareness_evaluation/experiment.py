"""Lets variants learn from robots and judge their records, and keeps the rows."""
from __future__ import annotations

from contextlib import closing
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Callable, Dict, Iterable, Iterator, List, Optional, Sequence, Set, Tuple

from self_awareness.calibration.limits import TooLittleError
from self_awareness.workers import Processes
from self_awareness_evaluation.records import NORMAL, FaultRecord, Learning, Robot, WindowedEvents
from self_awareness_evaluation.row_files import KeptRows
from self_awareness_evaluation.rows import Row, Subject, fault_row, normal_row
from self_awareness_evaluation.systems import System
from self_awareness_evaluation.variants import Variant

AT_ONCE = 16
"""Variants that judge a robot's records at a time: more of them do not fit into the memory."""


@dataclass(frozen=True)
class Unit:
    """What is measured at a time, and then kept: records, and variants that judge them."""

    rows: Callable[[Unit], Iterable[Row]]  # yields the rows of the unit
    # Of the records, see Subject.
    part: str
    name: str
    variants: Tuple[Variant, ...]  # that judge

    def __str__(self) -> str:
        return self.name

    def subject(self, variant: Variant) -> Subject:
        """Return whose rows those of a variant are."""
        learning = '' if variant.learning is None else str(variant.learning)
        return Subject(self.part, self.name, learning, variant.system, variant.change,
                       variant.budget)


def run(units: Sequence[Unit], path: Path, plan: str, jobs: int) -> List[Row]:
    """Return the rows of all units, in their order; `jobs` of them are measured at a time.

    Args:
        path: of the file of rows; what it holds already is not measured again.
        plan: what decides on the rows besides their subjects, in words.

    Raises:
        ValueError: the file holds rows of another plan or of another method.
    """
    kept = KeptRows(path, plan)
    left = [replace(unit, variants=variants[first:first + AT_ONCE]) for unit in units
            for variants in [tuple(variant for variant in unit.variants
                                   if not kept.has(unit.subject(variant)))]
            for first in range(0, len(variants), AT_ONCE)]
    with closing(Processes(jobs).map(_measured, None, left, 'evaluating')) as measured:
        for rows in measured:
            kept.add(rows)
    return kept.of([unit.subject(variant) for unit in units for variant in unit.variants])


def _measured(_: None, unit: Unit) -> List[Row]:
    return list(unit.rows(unit))


def measure(robot_of: Callable[[], Robot], unit: Unit) -> Iterator[Row]:
    """Yield the rows of a unit that is a robot."""
    robot = robot_of()
    judges = list(_judges(unit, robot))
    for recording in robot.normal():
        yield from (judge.normal_row(recording, robot) for judge in judges)
    for fault in robot.faults():
        yield from (judge.fault_row(fault) for judge in judges if judge.variant.faults)


@dataclass(frozen=True)
class _Judge:
    """A system that has learned; refused: why it cannot judge, empty: it can."""

    subject: Subject
    variant: Variant
    system: System
    refused: str = ''

    def normal_row(self, recording: WindowedEvents, robot: Robot) -> Row:
        """Return what it says of normal operation."""
        if self.refused:
            return Row(self.subject, NORMAL, refused=self.refused)
        return normal_row(self.subject, self.system.judge(recording),
                          self.system.expected_per_hour, self._watched(robot.components),
                          len(robot.components))

    def fault_row(self, fault: FaultRecord) -> Row:
        """Return what it says of a fault."""
        if self.refused:
            return Row(self.subject, fault.kind, fault.source, refused=self.refused)
        return fault_row(self.subject, fault, self.system.judge(fault.recording),
                         self._watched(set(fault.culprits)))

    def _watched(self, components: Set[str]) -> Optional[int]:
        watched = self.system.watched
        return None if watched is None else len(watched & components)


def _judges(unit: Unit, robot: Robot) -> Iterator[_Judge]:
    learned_from: Dict[Learning, Tuple[Sequence[WindowedEvents], ...]] = {}
    for variant in unit.variants:
        learning = variant.learning
        assert learning is not None, 'only real recordings say themselves'
        if learning not in learned_from:
            learned_from[learning] = robot.training(learning), robot.calibration(learning)
        training, calibration = learned_from[learning]
        judge = _Judge(unit.subject(variant), variant, variant.make(robot.graph))
        try:
            judge.system.train(training)
            judge.system.calibrate(calibration)
        except TooLittleError as error:
            judge = replace(judge, refused=str(error))
        yield judge
