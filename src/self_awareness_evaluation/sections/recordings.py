"""What the pages say of recordings of real robots."""
from __future__ import annotations

from typing import List, Sequence

from self_awareness_evaluation.figures import NONE, grouped, seconds, table
from self_awareness_evaluation.outages import CASES, END, OUTAGE, Case, Span
from self_awareness_evaluation.pages import RESEARCH, RESULTS, Section
from self_awareness_evaluation.records import NORMAL
from self_awareness_evaluation.rows import HOUR_S, Row

NAME = 'recordings'


def section(rows: Sequence[Row]) -> Section:
    """Return what is written of rows; the first system is the one that a user is told of."""
    first = [row for row in rows if row.subject.system == rows[0].subject.system]
    return Section(NAME, 'Recordings of real robots', {
        RESULTS: _table(first),
        RESEARCH: [*(_told(case) for case in CASES), '', *_table(rows)]},
        lambda row: row.subject.robot)


def _table(rows: Sequence[Row]) -> List[str]:
    return table(['recording', 'system', 'watched', 'outage', 'latency', 'at its end',
                  'false alarms', 'alarm stood in normal operation'],
                 [_cells(of_subject) for of_subject in
                  grouped(rows, lambda row: row.subject).values()])


def _cells(rows: Sequence[Row]) -> List[str]:
    normal = next(row for row in rows if row.fault == NORMAL)
    outage = next((row for row in rows if row.fault == OUTAGE), None)
    subject = normal.subject
    if normal.refused:
        return [subject.robot, subject.system, NONE, normal.refused, *[NONE] * 4]
    told, latency, at_end = NONE, NONE, NONE
    if outage is not None:
        told = 'found' if outage.stood_before or outage.latency_s is not None else 'missed'
        told += ', stood before' if outage.stood_before else ''
        latency = NONE if outage.latency_s is None else seconds(outage.latency_s)
        at_end = ', '.join(each for each in (outage.level, outage.kind, outage.culprit)
                           if each) or NONE
    return [subject.robot, subject.system, str(normal.watched), told, latency, at_end,
            str(normal.alarms), f'{normal.standing_hours * HOUR_S:.1f} of '
            f'{normal.hours * HOUR_S:.1f} s']


def _told(case: Case) -> str:
    outage = 'no outage' if case.outage is None else f'outage {_spans([case.outage])}'
    return (f'- {case.name}: from `{case.training}` and `{case.calibration}`; judged '
            f'`{case.judged}`: {outage}, normal {_spans(case.normal)}')


def _spans(spans: Sequence[Span]) -> str:
    return ' and '.join(f'from {start:g} s on' if end == END else f'{start:g} to {end:g} s'
                        for start, end in spans)
