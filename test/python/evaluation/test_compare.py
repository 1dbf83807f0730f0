"""`evaluate compare`: two folders of results side by side."""
from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any, List, Optional

import pytest

from self_awareness_evaluation import evaluate, row_files
from self_awareness_evaluation.records import FAMILIES, NORMAL, OWN, REAL
from self_awareness_evaluation.rows import Row, Subject

TWO = '2 x 150 s + 1 x 150 s'


def row(robot: str, fault: str = NORMAL, latency_s: Optional[float] = None,
        part: str = FAMILIES, **more: Any) -> Row:
    first = None if latency_s is None else latency_s < 1.0
    return Row(Subject(part, robot, '' if part == REAL else TWO, 'evidence'), fault,
               '' if fault == NORMAL else '/a', 2.0 if fault == NORMAL else 0.0,
               latency_s=latency_s, first=first, **more)


OF_FAMILIES = [row('timers 1'), row('bursty 1', alarms=3), row('timers 1', 'crash', 0.5),
               row('timers 1', 'late 60 ms'), row('bursty 1', 'crash', 2.0),
               row('timers 1', 'restart', 0.5, after=2)]
OF_OWN = [row('own robot 1', part=OWN), row('own robot 1', 'ac', 3.5, OWN),
          row('own robot 1', 'crash:slam', 0.25, OWN)]
OF_REAL = [row('wheeled, 13 February', part=REAL), row('wheeled, 13 February', 'outage', .9, REAL)]


def write(folder: Path, families: List[Row], own: List[Row],
          command: str = 'evaluate families --hours 2') -> None:
    (folder / 'full').mkdir(parents=True)
    for name, rows in (('families', families), ('simulated', own), ('recordings', OF_REAL)):
        row_files.save(folder / 'full' / f'{name}.csv', rows, Row)
    (folder / 'research.md').write_text(
        f'# Page\n\nWritten by `{command} -o {folder}`; do not edit.\n', encoding='utf-8')


@pytest.fixture(name='folders')
def _folders(tmp_path: Path) -> List[str]:
    write(tmp_path / 'before' / 'all', OF_FAMILIES, OF_OWN)
    write(tmp_path / 'after' / 'all', [
        OF_FAMILIES[0], row('bursty 1', alarms=1), OF_FAMILIES[2],
        row('timers 1', 'late 60 ms', 0.75), OF_FAMILIES[4], replace(OF_FAMILIES[5], after=0)],
        [OF_OWN[0], row('own robot 1', 'ac', part=OWN), OF_OWN[2]])
    return [str(tmp_path / 'before'), str(tmp_path / 'after')]


def test_a_cell_has_one_value_or_both(folders: List[str], tmp_path: Path) -> None:
    assert evaluate.main(['compare', *folders, '-o', str(tmp_path / 'out')]) == 0
    page = (tmp_path / 'out' / 'before_after.md').read_text(encoding='utf-8')
    lines = page.splitlines()
    assert '    evaluate families --hours 2' in lines  # and no folder
    for line in ('Rows that are the same to the last digit: 3 of 6.',
                 'Rows that are the same to the last digit: 2 of 3.',
                 'Rows that are the same to the last digit: 2 of 2.',
                 '| false alarms | 3 in 4.0 h → **1 in 4.0 h** |',
                 '| crash | 2 / 2 of 2, 0.50 s |',
                 '| late 60 ms | 0 / 0 of 1 → **1 / 1 of 1, 0.75 s** |',
                 '| guilty first | 2 of 3 → **3 of 4** |',
                 '| alarms after a restart | 2 after 1 → **0 after 1** |',
                 '| ac | 1 / 1 of 1, 3.50 s → **0 / 0 of 1** |',
                 '| crash | 1 / 1 of 1, 0.25 s |', '| outage | 1 / 1 of 1, 0.90 s |'):
        assert line in lines, line
    bursty = next(line for line in lines if line.startswith(f'| bursty | evidence, {TWO} |'))
    assert '| 3 in 2.0 h → **1 in 2.0 h** |' in bursty


def test_folders_without_results_are_refused(folders: List[str], tmp_path: Path,
                                             capsys: Any) -> None:
    (tmp_path / 'empty').mkdir()
    assert evaluate.main(['compare', folders[0], str(tmp_path / 'empty'),
                          '-o', str(tmp_path / 'out')]) == 1
    assert 'empty: holds no results' in capsys.readouterr().err
    assert evaluate.main(['compare', folders[0], str(tmp_path / 'missing')]) == 1
    assert 'missing' in capsys.readouterr().err


def test_results_of_other_commands_are_refused(folders: List[str], tmp_path: Path,
                                               capsys: Any) -> None:
    write(tmp_path / 'other' / 'all', OF_FAMILIES, OF_OWN, 'evaluate families --hours 3')
    assert evaluate.main(['compare', folders[0], str(tmp_path / 'other')]) == 1
    error = capsys.readouterr().err
    assert '--hours 2' in error and '--hours 3' in error
    write(tmp_path / 'other' / 'more', OF_FAMILIES, OF_OWN)
    assert evaluate.main(['compare', folders[0], str(tmp_path / 'other')]) == 1
    assert 'more: only one of' in capsys.readouterr().err
