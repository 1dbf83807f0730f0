"""The program evaluate: what it measures, files written whole, and what it refuses."""
from __future__ import annotations

import csv
from pathlib import Path
from typing import Any, List, Tuple
from unittest.mock import patch

import pytest

from self_awareness_evaluation import evaluate, offline, row_files, simulated
from self_awareness_evaluation.families.protocol import Records
from self_awareness_evaluation.families.robot import CRASH
from self_awareness_evaluation.records import Robot
from self_awareness_evaluation.robots import of_family
from self_awareness_evaluation.rows import Row


@pytest.fixture(name='written', scope='module')
def _written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp('evaluation') / 'new'
    assert evaluate.main([
        'families', '--families', 'events_only', 'small', '--robots', '1', '--seed', '3',
        '--starts', '1', '2', '--training', '60', '--calibration', '60', '--hours', '0.1',
        '--systems', 'evidence', 'gaps', '--budgets', '0.5', '5', '--faults', 'crash', 'late',
        '--jobs', '2', '-o', str(folder)]) == 0
    with patch.object(simulated, 'NORMAL_TEST_S', 60.0):
        assert evaluate.main([
            'simulated', '--seeds', '1', '--seed', '5', '--systems', 'paper', 'frequency_learned',
            '--faults', 'cc1', 'crash:slam', '--calibration', '60', '--jobs', '2',
            '-o', str(folder)]) == 0
    return folder


def test_there_is_a_row_for_everything(written: Path) -> None:
    rows = row_files.load(written / 'full' / 'simulated.csv', Row)
    assert [(row.fault, row.subject.system) for row in rows] == [
        (fault, system) for fault in ('normal', 'cc1', 'crash:slam')
        for system in ('paper', 'frequency_learned')]
    assert {row.subject.robot for row in rows} == {'own robot 5'}
    found = [row for row in rows if row.fault == 'cc1']
    assert all(row.latency_s is not None and 0.0 < row.latency_s < 3.0 for row in found)
    assert all(row.among_three and row.level == 'ERROR' for row in found)
    assert rows[0].watched is None, 'the paper judges all together'
    assert rows[1].watched in range(1, 16) and rows[1].components == 15


def test_the_rows_of_families(written: Path) -> None:
    rows = row_files.load(written / 'full' / 'families.csv', Row)
    crashes = [row for row in rows if row.subject.robot == 'small 3' and row.fault == CRASH
               and row.subject.system == 'gaps' and row.subject.learning.startswith('2')]
    assert [row.source for row in crashes] == Records('small', 3).robot.regular
    assert {row.subject.budget for row in rows if row.fault == CRASH
            and row.subject.system == 'evidence'} == {0.5}
    with open(written / 'families.csv', encoding='utf-8', newline='') as file:
        figures = list(csv.DictReader(file))
    assert len(figures) == 3 * 2 * 3  # families and all, learnings, budgets and the peer
    figure = next(each for each in figures if (each['of'], each['system']) == ('small', 'gaps')
                  and each['learning'].startswith('2'))
    found = sum(row.latency_s is not None for row in crashes) / len(crashes)
    assert float(figure['crash: found']) == pytest.approx(found, abs=0.005)


def test_the_pages_have_a_section_of_each(written: Path) -> None:
    for name in ('README.md', 'research.md'):
        page = (written / name).read_text(encoding='utf-8')
        for command in ('families --families events_only small', 'simulated --seeds 1 --seed 5'):
            assert page.count(f'rosrun self_awareness evaluate {command}') == 1
        assert 'nan' not in page and 'inf' not in page.replace('info', '')
        for block in page.split('\n\n'):
            assert len({line.count('|') for line in block.splitlines()
                        if line.startswith('|')}) <= 1, block


def test_an_ablation_judges_each_robot_by_every_variant(tmp_path: Path,
                                                        monkeypatch: pytest.MonkeyPatch) -> None:
    def own(seed: int, faults: Tuple[str, ...]) -> Robot:
        assert 'ac' in faults and 'extra' not in faults, 'that is a suspicion only'
        return of_family('small', seed, 0.1, ('crash',), 1)

    monkeypatch.setattr(offline.robots, 'own', own)
    arguments = ['ablation', '--families', 'events_only', '--seed', '3', '--own-seeds', '1',
                 '--starts', '1', '--training', '60', '--calibration', '60', '--hours', '0.1',
                 '--faults', '1', '--channels', 'overdue', '--numbers', '--jobs', '2',
                 '-o', str(tmp_path)]
    assert evaluate.main(arguments) == 0
    rows = row_files.load(tmp_path / 'full' / 'ablation.csv', Row)
    assert {(row.subject.robot, row.subject.change) for row in rows} == {
        (robot, change) for robot in ('own robot 3', 'events_only 3')
        for change in ('', 'without overdue')}
    assert '| without overdue |' in (tmp_path / 'research.md').read_text(encoding='utf-8')
    assert evaluate.main(arguments) == 0  # all is done already
    assert row_files.load(tmp_path / 'full' / 'ablation.csv', Row) == rows


@pytest.mark.parametrize('wrong', [
    ['simulated', '--faults', 'flood'], ['simulated', '--seeds', '0'],
    ['simulated', '--jobs', '0'], ['simulated', '--calibration', '5'],
    ['simulated', '--systems', 'oracle'], ['families', '--families', 'cars'],
    ['families', '--starts', '0'], ['families', '--starts', '17'], ['families', '--hours', '0'],
    ['families', '--budgets', '0'], ['families', '--faults', 'rust'],
    ['families', '--seed', '0'], ['ablation', '--kinds', 'luck'],
    ['families', '--families', 'timers', 'stalls', '--hours', '20']])
def test_wrong_arguments_are_refused(wrong: List[str], tmp_path: Path, capsys: Any) -> None:
    assert evaluate.main([wrong[0], '-o', str(tmp_path / 'out'), *wrong[1:]]) in (1, 2)
    told = capsys.readouterr().err
    assert any(word in told for word in wrong[2:])
    assert not (tmp_path / 'out').exists()
