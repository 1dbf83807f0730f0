"""Writes what the evaluation on real recordings found: a CSV file, and a page with a table."""
from __future__ import annotations

from pathlib import Path
from typing import List, Sequence

from self_awareness.output_files import replacing
from self_awareness_evaluation import row_files
from self_awareness_evaluation.pages import written_by
from self_awareness_evaluation.recordings.outages import (CASES, END, MOST_SILENT, RATE, Case,
                                                          OutageRow, Span)
from self_awareness_evaluation.simulated.tables import seconds, table

NAME = 'recordings'

_INTRODUCTION = """\
# Evaluation on recordings of real robots

{written}

Recordings that others made and published; what is abnormal in them was judged by eye from the
timing, not by those who made them. Every system learns from normal recordings of the same robot
(`BAG@START-END`: a part, in seconds from the first message); what is neither outage nor normal,
such as the start-up, is not counted. On 17 January all nodes stall from 42 s on, for up to 1.8 s
at a time, before they fall silent: that is not counted either.

{cases}

`evidence` learns from both parts, and finds its limits by what each says of the other (cross-fit,
as `train` does), without the graph of subscriptions. `paper` and `frequency_learned` learn from
the first part; their threshold is the one that a share of {rate:g} of the second part's windows
falls below. `paper` takes twice that share, and so on, while as many windows are silent; if more
than {silent:g} are, it watches nothing. From windows to an alarm, all are the same code.

An alarm that stood at the onset of an outage is a false one, whatever followed: read `found`
together with the false alarms. `watched` is the number of event types (of `frequency_learned`:
topics) that a system watches at all: one that watches nothing raises no false alarm. The
recordings are few and short; no rate can be told from them.

All numbers: [{name}.csv]({name}.csv).
"""


def write(folder: Path, rows: Sequence[OutageRow], command: str) -> List[Path]:
    """Write all files, each whole or not at all; return their names.

    Args:
        folder: exists.
        rows: what was found.
        command: that the page says it was written by.

    Raises:
        OSError: a file cannot be written.
    """
    paths = [folder / f'{NAME}.csv', folder / f'{NAME}.md']
    row_files.save(paths[0], rows, OutageRow)
    with replacing(str(paths[1])) as temporary:
        Path(temporary).write_text(page(rows, command), encoding='utf-8')
    return paths


def page(rows: Sequence[OutageRow], command: str) -> str:
    """Return the page."""
    head = ['recording', 'system', 'watched', 'outage', 'latency', 'false alarms',
            'alarm stood in normal operation']
    return '\n'.join([
        _INTRODUCTION.format(written=written_by(command), name=NAME, rate=RATE, silent=MOST_SILENT,
                             cases='\n'.join(_told(case) for case in CASES)),
        *table(head, [_cells(row) for row in rows]), ''])


def _told(case: Case) -> str:
    outage = 'no outage' if case.outage is None else f'outage {_spans([case.outage])}'
    return (f'- {case.name}: from `{case.training}` and `{case.calibration}`; judged '
            f'`{case.judged}`: {outage}, normal {_spans(case.normal)}')


def _spans(spans: Sequence[Span]) -> str:
    return ' and '.join(f'from {start:g} s on' if end == END else f'{start:g} to {end:g} s'
                        for start, end in spans)


def _cells(row: OutageRow) -> List[str]:
    found = {None: '–', True: 'found', False: 'missed'}[row.outage_found]
    if row.stood_before:
        found += ', stood before'
    return [row.recording, row.system, str(row.watched), found,
            '–' if row.latency_s is None else seconds(row.latency_s), str(row.false_alarms),
            f'{row.false_s:.1f} of {row.normal_s:.1f} s']
