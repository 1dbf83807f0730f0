"""`evaluate compare`: two folders of results side by side."""
from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any, List, Optional

import pytest

from self_awareness_evaluation import evaluate, row_files
from self_awareness_evaluation.families.measures import FaultRow, NormalRow, Subject
from self_awareness_evaluation.families.robot import CRASH, LATE, RESTART
from self_awareness_evaluation.recordings.outages import OutageRow
from self_awareness_evaluation.simulated.measures import NORMAL, Row

LEARNING = '2 x 150 s + 1 x 150 s'


def normal(family: str, alarms: int) -> NormalRow:
    return NormalRow(Subject(family, 1, LEARNING, 'evidence', 0.5), 2.0, alarms, 0.01 * alarms,
                     2 * alarms, ('pairs',) * alarms, None)


def fault(family: str, kind: str, latency_s: Optional[float]) -> FaultRow:
    first = None if latency_s is None else latency_s < 1.0
    return FaultRow(Subject(family, 1, LEARNING, 'evidence', 0.5), kind, '/a', False, latency_s,
                    first, first)


def simulated(record: str, latency_s: Optional[float] = None) -> Row:
    return Row('evidence', 1.0, 5, record, 36_000, 0, 0, 0, latency_s=latency_s,
               stood_before=False, top1=None if latency_s is None else True)


OUTAGE = OutageRow('wheeled_robot, 1', 'evidence', 5, True, False, 0.9, 0, 0.0, 70.0)


def write(folder: Path, normals: List[NormalRow], faults: List[FaultRow], rows: List[Row],
          outages: List[OutageRow], command: str = 'evaluate families --hours 2') -> None:
    (folder / 'full').mkdir(parents=True)
    row_files.save(folder / 'full' / 'families_normal.csv', normals, NormalRow)
    row_files.save(folder / 'full' / 'families_faults.csv', faults, FaultRow)
    row_files.save(folder / 'full' / 'simulated.csv', rows, Row)
    row_files.save(folder / 'recordings.csv', outages, OutageRow)
    (folder / 'families.md').write_text(
        f'# Page\n\nWritten by `{command} -o {folder}`; do not edit.\n', encoding='utf-8')


NORMALS = [normal('timers', 0), normal('bursty', 3)]
FAULTS = [fault('timers', CRASH, 0.5), fault('timers', LATE, None), fault('bursty', CRASH, 2.0),
          replace(fault('timers', RESTART, 0.5), after=2)]
ROWS = [simulated(NORMAL), simulated('ac', 3.5), simulated('crash:slam', 0.25)]


@pytest.fixture(name='folders')
def _folders(tmp_path: Path) -> List[str]:
    write(tmp_path / 'before' / 'all', NORMALS, FAULTS, ROWS, [OUTAGE])
    write(tmp_path / 'after' / 'all', [NORMALS[0], normal('bursty', 1)],
          [FAULTS[0], fault('timers', LATE, 0.75), FAULTS[2], replace(FAULTS[3], after=0)],
          [ROWS[0], simulated('ac'), ROWS[2]], [replace(OUTAGE, latency_s=1.5, watched=6)])
    return [str(tmp_path / 'before'), str(tmp_path / 'after')]


def test_rows_are_read_as_they_were_written(tmp_path: Path) -> None:
    path = tmp_path / 'rows.csv'
    every: List[List[Any]] = [NORMALS, FAULTS, ROWS, [OUTAGE]]
    for rows in every:
        row_files.save(path, rows, type(rows[0]))
        assert row_files.load(path, type(rows[0])) == rows
    path.write_text('recording,system\na,b\n', encoding='utf-8')
    with pytest.raises(ValueError, match='rows.csv, line 2: there is no watched'):
        row_files.load(path, OutageRow)
    path.write_text(f'{",".join(row_files.columns(OutageRow))}\na,b,many,,True,,0,0,0\n',
                    encoding='utf-8')
    with pytest.raises(ValueError, match="rows.csv, line 2: watched is 'many', no number"):
        row_files.load(path, OutageRow)


def test_a_cell_has_one_value_or_both(folders: List[str], tmp_path: Path) -> None:
    assert evaluate.main(['compare', *folders, '-o', str(tmp_path / 'out')]) == 0
    page = (tmp_path / 'out' / 'before_after.md').read_text(encoding='utf-8')
    lines = page.splitlines()
    assert '    evaluate families --hours 2' in lines  # and no folder
    assert '- families, faults: 2 of 4' in lines and '- simulated robot: 2 of 3' in lines
    for line in ('| false alarms | 3 in 4 h (0.75/h) → **1 in 4 h (0.25/h)** |',
                 '| crashes within 1 / 5 / 50 s | 1 / 2 / 2 of 2, 0.50 s |',
                 '| late 60 ms, found | 0 of 1 → **1 of 1, 0.75 s** |',
                 '| guilty first, all | 2 of 3 → **3 of 4** |',
                 '| alarms after a restart | 2 after 1 → **0 after 1** |',
                 '| death, found | – |',
                 f'| timers | evidence, {LEARNING}, budget 0.5 | 0 in 2 h (0/h) | 0 in 2 h (0/h) '
                 '| 1 / 1 / 1 of 1, 0.50 s | – | 0 of 1 → **1 of 1, 0.75 s** | – '
                 '| – | – | – | – | 2 after 1 → **0 after 1** '
                 '| 2 of 2 → **3 of 3** |',
                 '| ac | 1 of 1, 3.50 s → **0 of 1** |',
                 '| every crash within 1 / 5 / 50 s | 1 / 1 / 1 of 1, 0.25 s |',
                 '| wheeled_robot, 1 | evidence | 5 → **6** | 0.90 s → **1.50 s** | 0 | 0.00 s |'):
        assert line in lines, line


def test_folders_without_results_are_refused(folders: List[str], tmp_path: Path,
                                             capsys: Any) -> None:
    (tmp_path / 'empty').mkdir()
    assert evaluate.main(['compare', folders[0], str(tmp_path / 'empty'),
                          '-o', str(tmp_path / 'out')]) == 1
    assert 'empty: holds no results' in capsys.readouterr().err
    assert evaluate.main(['compare', folders[0], str(tmp_path / 'missing')]) == 1
    assert 'missing' in capsys.readouterr().err
    assert not (tmp_path / 'out').exists()


def test_results_of_other_commands_are_refused(folders: List[str], tmp_path: Path,
                                               capsys: Any) -> None:
    write(tmp_path / 'other' / 'all', NORMALS, FAULTS, ROWS, [OUTAGE],
          'evaluate families --hours 3')
    assert evaluate.main(['compare', folders[0], str(tmp_path / 'other')]) == 1
    error = capsys.readouterr().err
    assert '--hours 2' in error and '--hours 3' in error
    write(tmp_path / 'other' / 'more', NORMALS, FAULTS, ROWS, [OUTAGE])
    assert evaluate.main(['compare', folders[0], str(tmp_path / 'other')]) == 1
    assert 'more: only one of' in capsys.readouterr().err
