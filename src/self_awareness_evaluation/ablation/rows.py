"""What a variant says of the records: a row for each, kept in a file as they come."""
from __future__ import annotations

import csv
import io
import os
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Dict, Iterator, List, Optional

import numpy as np

from self_awareness import DEFAULT_WINDOW, Tuning
from self_awareness.calibration.limits import TooLittleError
from self_awareness.stamps import SECOND_NS
from self_awareness_evaluation import row_files
from self_awareness_evaluation.ablation.bench import RECORDINGS, Bench, Fault, Robot
from self_awareness_evaluation.ablation.variants import Variant
from self_awareness_evaluation.detectors import Evidence
from self_awareness_evaluation.recordings import outages
from self_awareness_evaluation.simulated.measures import (NORMAL, alarms_until_return, beginnings,
                                                          first_alarm)
from self_awareness_evaluation.systems import Judged

OUTAGE = 'outage'
"""Kind of fault: what is wrong in a recording of a real robot."""

_HOUR_S = 3600.0


@dataclass(frozen=True)
class Row:
    """A variant on a record.

    Args:
        variant: its name.
        part: of the bench.
        robot: with its seed; the case of a recording.
        learning: what was learned from.
        kind: NORMAL, or that of the fault.
        name: what is at fault.
        hours: of normal operation, settled: all of it, or what was before the onset [h].
        alarms: raised in it, all of them false.
        warnings: times that a suspicion or an alarm began in it.
        latency_s: from the onset to the first alarm raised after it [s]; None: none was.
        first: whether that alarm names the guilty one first; None: no alarm, or nobody to name.
        refused: why nothing could be judged; empty: it was.
        after: alarms for who was back already, all of them false; None: the fault lasts.
    """

    variant: str
    part: str
    robot: str
    learning: str
    kind: str
    name: str = ''
    hours: float = 0.0
    alarms: int = 0
    warnings: int = 0
    latency_s: Optional[float] = None
    first: Optional[bool] = None
    refused: str = ''
    after: Optional[int] = None


def judge(bench: Bench, variant: Variant) -> List[Row]:
    """Let a variant learn from all robots and judge all records."""
    tuning = variant.tuning()
    rows = [row for robot in bench.robots for row in _robot_rows(robot, variant, tuning)]
    if bench.data is not None:
        rows += [row for case in outages.CASES
                 for row in _case_rows(case, bench.data, variant, tuning)]
    return rows


def _robot_rows(robot: Robot, variant: Variant, tuning: Tuning) -> Iterator[Row]:
    known = Row(str(variant), robot.part, robot.name, robot.learning, NORMAL)
    system = Evidence(robot.graph, tuning=tuning)
    refused = ''
    try:
        system.train(robot.training)
        system.calibrate(robot.calibration)
    except TooLittleError as error:
        refused = str(error)
    for recording in robot.normal:
        if refused:
            yield replace(known, refused=refused)
            continue
        yield _before(known, system.judge(recording), recording.end)
    for fault in robot.faults:
        row = replace(known, kind=fault.kind, name=fault.name, refused=refused)
        yield row if refused else _fault_row(row, fault, system)


def _fault_row(row: Row, fault: Fault, system: Evidence) -> Row:
    judged = system.judge(fault.recording)
    row = _before(row, judged, fault.onset)
    alarms, after = alarms_until_return(judged.alarms, fault.back)
    row = replace(row, after=after)
    alarm = first_alarm(alarms, fault.onset)
    if alarm is None:
        return row
    first = alarm.suspects[:1] if alarm.suspects is not None and fault.culprits else None
    return replace(row, latency_s=(alarm.start - fault.onset) / SECOND_NS,
                   first=None if first is None else bool(set(first) & set(fault.culprits)))


def _before(row: Row, judged: Judged, until: int) -> Row:
    """Return the row with what was judged before some time [ns]."""
    early = judged.start + DEFAULT_WINDOW <= until
    settled_h = int((early & ~judged.settling).sum()) * DEFAULT_WINDOW / SECOND_NS / _HOUR_S
    return replace(row, hours=settled_h,
                   alarms=sum(alarm.start <= until for alarm in judged.alarms),
                   warnings=beginnings(np.asarray(judged.noticed & early)))


def _case_rows(case: outages.Case, data: Path, variant: Variant, tuning: Tuning) -> Iterator[Row]:
    row = Row(str(variant), RECORDINGS, case.name, '', NORMAL)
    try:
        found = outages.outage_row(case, '', outages.judge_by_evidence(case, data, tuning))
    except TooLittleError as error:
        row = replace(row, refused=str(error))
    else:
        row = replace(row, hours=found.normal_s / _HOUR_S, alarms=found.false_alarms)
    yield row
    if case.outage is not None:
        yield replace(row, kind=OUTAGE, hours=0.0, alarms=0,
                      latency_s=None if row.refused else found.latency_s)


class RowFile:
    """The rows of all variants that have been judged, in a file that grows with each.

    Args:
        path: of the file; rows that it holds already are kept.

    Raises:
        OSError: it cannot be read.
        ValueError: it is another file.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._rows: Dict[str, List[Row]] = {}
        if path.is_file():
            _cut_torn_line(path)
            for row in row_files.load(path, Row):
                self._rows.setdefault(row.variant, []).append(row)

    def __getitem__(self, variant: Variant) -> List[Row]:
        return self._rows.get(str(variant), [])

    def add(self, variant: Variant, rows: List[Row]) -> None:
        """Add the rows of a variant, in place of those that an interrupted run left of it.

        Raises:
            OSError: they cannot be written.
        """
        whole = str(variant) not in self._rows and self._path.is_file()
        self._rows[str(variant)] = rows
        if not whole:
            row_files.save(self._path, [row for of in self._rows.values() for row in of], Row)
            return
        text = io.StringIO()
        writer = csv.DictWriter(text, row_files.columns(Row), lineterminator='\n')
        writer.writerows(row_files.flat(row) for row in rows)
        with open(self._path, 'a', encoding='utf-8', newline='') as file:
            file.write(text.getvalue())
            file.flush()
            os.fsync(file.fileno())


def _cut_torn_line(path: Path) -> None:
    """Remove what a run that was interrupted while it wrote left at the end."""
    text = path.read_bytes()
    if not text.endswith(b'\n'):
        path.write_bytes(text[:text.rfind(b'\n') + 1])
