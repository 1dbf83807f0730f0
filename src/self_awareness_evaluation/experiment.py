"""Lets variants learn from robots and judge their records, and keeps the rows."""
from __future__ import annotations

import csv
import os
import zlib
from contextlib import closing
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Callable, Dict, Iterable, Iterator, List, Optional, Sequence, Set, Tuple

from self_awareness import METHOD, Tuning, _core
from self_awareness.calibration.limits import TooLittleError
from self_awareness.output_files import replacing
from self_awareness.workers import Processes
from self_awareness_evaluation.records import NORMAL, Learning, Robot, System, WindowedEvents
from self_awareness_evaluation.rows import Row, Subject, fault_row, flat, load, normal_row, save
from self_awareness_evaluation.variants import Variant

# Variants that judge a robot's records at a time: more of them do not fit into the memory.
_AT_ONCE = 16


@dataclass(frozen=True)
class Unit:
    """What is measured at a time, and then kept: records, and variants that judge them."""

    rows: Callable[[Unit], Iterable[Row]]  # yields the rows of the unit
    part: str  # of the records, see Subject
    name: str  # of their robot
    variants: Tuple[Variant, ...]  # that judge

    def __str__(self) -> str:
        return self.name

    def subject(self, variant: Variant) -> Subject:
        """Return whose rows those of a variant are."""
        learning = '' if variant.learning is None else str(variant.learning)
        return Subject(self.part, self.name, learning, variant.system, variant.change,
                       variant.budget)


def run(units: Sequence[Unit], path: Path, plan: str, jobs: int) -> List[Row]:
    """Return the rows of all units, in their order; `jobs` of them are measured at a time, but for
    what the file of rows holds already (see KeptRows)."""
    kept = KeptRows(path, plan)
    left = [replace(unit, variants=variants[first:first + _AT_ONCE]) for unit in units
            for variants in [tuple(variant for variant in unit.variants
                                   if unit.subject(variant) not in kept.rows)]
            for first in range(0, len(variants), _AT_ONCE)]
    with closing(Processes(jobs).map(lambda _, unit: list(unit.rows(unit)), None, left,
                                     'evaluating')) as measured:
        for rows in measured:
            kept.add(rows)
    return [row for unit in units for variant in unit.variants
            for row in kept.rows[unit.subject(variant)]]


def measure(robot_of: Callable[[], Robot], unit: Unit) -> Iterator[Row]:
    """Yield the rows of a unit that is a robot."""
    robot = robot_of()
    judges = list(_learned(unit, robot))
    for recording in robot.normal():
        for subject, _, system, refused in judges:
            yield Row(subject, NORMAL, refused=refused) if refused else normal_row(
                subject, system.judge(recording), system.expected_per_hour,
                _watched(system, robot.components), len(robot.components))
    for fault in robot.faults():
        for subject, variant, system, refused in judges:
            if variant.faults:
                yield (Row(subject, fault.kind, fault.source, refused=refused) if refused else
                       fault_row(subject, fault, system.judge(fault.recording),
                                 _watched(system, set(fault.culprits))))


def _learned(unit: Unit, robot: Robot) -> Iterator[Tuple[Subject, Variant, System, str]]:
    """Yield the systems, which have learned, and why they cannot judge; empty: they can."""
    learned_from: Dict[Learning, Tuple[Sequence[WindowedEvents], ...]] = {}
    for variant in unit.variants:
        learning = variant.learning
        assert learning is not None, 'only real recordings say themselves'
        if learning not in learned_from:
            learned_from[learning] = robot.training(learning), robot.calibration(learning)
        training, calibration = learned_from[learning]
        system, refused = variant.make(robot.graph), ''
        try:
            system.train(training)
            system.calibrate(calibration)
        except TooLittleError as error:
            refused = str(error)
        yield unit.subject(variant), variant, system, refused


def _watched(system: System, components: Set[str]) -> Optional[int]:
    """Return how many of some components it watches; None: it judges all together."""
    return None if system.watched is None else len(system.watched & components)


class KeptRows:
    """Rows in a CSV file, and beside it a file of what they are of, and how much is whole. The
    plan is what decides on the rows besides their subjects, in words. What the file holds already
    is kept; ValueError is raised if that is of another plan or of another method."""

    def __init__(self, path: Path, plan: str) -> None:
        self._path = path
        self._beside = path.with_suffix('.plan')
        self._plan = f'{_method()}\n{plan}\n'
        self.rows: Dict[Subject, List[Row]] = {}  # of each subject all, or it is not there
        if path.is_file():
            self._check()
        else:
            save(path, [], Row)
        self._remember(load(path, Row))

    def add(self, rows: Sequence[Row]) -> None:
        """Add all rows of some subjects."""
        with open(self._path, 'a', encoding='utf-8', newline='') as file:
            csv.writer(file, lineterminator='\n').writerows(flat(row).values() for row in rows)
            file.flush()
            os.fsync(file.fileno())
        self._remember(rows)

    def _check(self) -> None:
        """Check the plan, and cut off what an interrupted run left half written."""
        told = self._beside.read_text(encoding='utf-8') if self._beside.is_file() else ''
        size, _, plan = told.partition('\n')
        if plan != self._plan or not size.isdigit():
            raise ValueError(f'{self._path}: of another plan, or of another build of the method; '
                             'remove it or choose another --output')
        os.truncate(self._path, int(size))

    def _remember(self, rows: Sequence[Row]) -> None:
        """Note rows that the file has, and that it is whole."""
        for row in rows:
            self.rows.setdefault(row.subject, []).append(row)
        with replacing(str(self._beside)) as temporary:
            Path(temporary).write_text(f'{self._path.stat().st_size}\n{self._plan}',
                                       encoding='utf-8')


def _method() -> str:
    """Return what tells one method from another: version, numbers, and how it was built."""
    numbers = [f'{number.name}={number.default:g}' for number in Tuning.numbers()]
    return f'method {METHOD}, build {_build():08x}: {" ".join([*Tuning.channels(), *numbers])}'


def _build() -> int:
    """Return a checksum of the module and of the libraries that it has loaded: the method is in
    one of these."""
    with open('/proc/self/maps', encoding='utf-8') as maps:
        files = {line.split(maxsplit=5)[-1].rstrip() for line in maps
                 if '/libself_awareness_' in line}
    checksum = 0
    for path in (_core.__file__, *sorted(files)):
        checksum = zlib.crc32(Path(path).read_bytes(), checksum)
    return checksum
