"""The program evaluate: what it measures, changes, compares and refuses; files written whole."""
from __future__ import annotations

import argparse
import csv
from dataclasses import replace
from pathlib import Path
from typing import Any, List, Optional, Tuple
from unittest.mock import patch

import pytest
from conftest import error_of

from self_awareness import Tuning
from self_awareness.parts import BagPart
from self_awareness.stamps import SECOND_NS
from self_awareness_evaluation import evaluate, outages, simulated
from self_awareness_evaluation.experiment import Unit
from self_awareness_evaluation.families.protocol import Records, recorded
from self_awareness_evaluation.families.scene import CRASH
from self_awareness_evaluation.outages import Case, JudgedCase, Span
from self_awareness_evaluation.records import FAMILIES, NORMAL, OWN, REAL, Robot, SystemAlarm
from self_awareness_evaluation.rows import HOUR_S, Row, Subject, load, save
from self_awareness_evaluation.variants import Variant, add_changes, change_of, tuning_of


@pytest.fixture(name='written', scope='module')
def _written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp('evaluation') / 'new'
    assert evaluate.main([
        'families', '--families', 'events_only', 'small', '--robots', '1', '--seed', '3',
        '--starts', '1', '2', '--training', '60', '--calibration', '60', '--hours', '0.1',
        '--systems', 'evidence', 'gaps', '--budgets', '0.5', '5', '--faults', 'crash', 'late',
        '--jobs', '2', '-o', str(folder)]) == 0
    with patch.object(simulated, 'NORMAL_TEST_S', 60.0), patch.object(
            simulated, 'LEARNING', replace(simulated.LEARNING, calibration_s=60.0)):
        assert evaluate.main([
            'simulated', '--seeds', '1', '--seed', '5', '--systems', 'paper', 'frequency_learned',
            '--faults', 'cc1', 'crash:slam', '--jobs', '2',
            '-o', str(folder)]) == 0
    return folder


def test_there_is_a_row_for_everything(written: Path) -> None:
    rows = load(written / 'full' / 'simulated.csv', Row)
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
    rows = load(written / 'full' / 'families.csv', Row)
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
        return recorded('small', seed, 0.1, ('crash',), 1)

    monkeypatch.setattr(simulated, 'own', own)
    arguments = ['ablation', '--families', 'events_only', '--seed', '3', '--own-seeds', '1',
                 '--starts', '1', '--training', '60', '--calibration', '60', '--hours', '0.1',
                 '--faults', '1', '--channels', 'overdue', '--numbers', '--jobs', '2',
                 '-o', str(tmp_path)]
    assert evaluate.main(arguments) == 0
    rows = load(tmp_path / 'full' / 'ablation.csv', Row)
    assert {(row.subject.robot, row.subject.change) for row in rows} == {
        (robot, change) for robot in ('own robot 3', 'events_only 3')
        for change in ('', 'without overdue')}
    assert '| without overdue |' in (tmp_path / 'research.md').read_text(encoding='utf-8')
    assert evaluate.main(arguments) == 0  # all is done already
    assert load(tmp_path / 'full' / 'ablation.csv', Row) == rows


@pytest.mark.parametrize('wrong', [
    ['simulated', '--faults', 'flood'], ['simulated', '--seeds', '0'],
    ['simulated', '--jobs', '0'], ['families', '--calibration', '5'],
    ['simulated', '--systems', 'oracle'], ['families', '--families', 'cars'],
    ['families', '--starts', '0'], ['families', '--starts', '17'], ['families', '--hours', '0'],
    ['families', '--budgets', '0'], ['families', '--faults', 'rust'],
    ['families', '--seed', '0'],
    ['families', '--families', 'timers', 'stalls', '--hours', '20']])
def test_wrong_arguments_are_refused(wrong: List[str], tmp_path: Path, capsys: Any) -> None:
    assert evaluate.main([wrong[0], '-o', str(tmp_path / 'out'), *wrong[1:]]) in (1, 2)
    told = capsys.readouterr().err
    assert any(word in told for word in wrong[2:])
    assert not (tmp_path / 'out').exists()


# Whatever the method has: one that no value switches off, one that is, and two channels.
PLAIN = next(number for number in Tuning.numbers() if number.off is None)
RULE = next(number for number in Tuning.numbers() if number.off is not None)
CHANNELS = Tuning.channels()[:2]


def asked(*arguments: str) -> Tuning:
    parser = argparse.ArgumentParser()
    add_changes(parser)
    return tuning_of(change_of(parser.parse_args(arguments)))


def test_numbers_are_set_and_channels_left_out() -> None:
    assert asked() == Tuning()
    tuning = asked('--set', f'{PLAIN.name}={PLAIN.most}', '--without', CHANNELS[0],
                   '--set', f'{RULE.name}=off', '--without', CHANNELS[1])
    assert (tuning.get(PLAIN.name), tuning.get(RULE.name)) == (PLAIN.most, RULE.off)
    assert sorted(tuning.without) == sorted(CHANNELS)


@pytest.mark.parametrize('wrong, told', [
    (['--set', 'luck=3'], ['luck']), (['--set', PLAIN.name], ['NAME=VALUE', PLAIN.name]),
    (['--set', f'{PLAIN.name}=much'], [PLAIN.name, 'much']),
    (['--set', f'{PLAIN.name}={PLAIN.least - 1.0:g}'], [PLAIN.name, f'{PLAIN.least:g}']),
    (['--set', f'{PLAIN.name}=off'], [PLAIN.name, 'off']),
    (['--set', f'{PLAIN.name}=nan'], [PLAIN.name, 'nan']),
    (['--without', 'smell'], ['smell', CHANNELS[0]])])
def test_wrong_changes_are_refused(wrong: List[str], told: List[str], tmp_path: Path,
                                   capsys: Any) -> None:
    for part in (['simulated'], ['families'], ['recordings', '--data', str(tmp_path)]):
        assert evaluate.main([*part, '-o', str(tmp_path / 'out'), *wrong]) == 2
        error = capsys.readouterr().err.splitlines()[-1]
        assert all(word in error for word in told), error
        assert not (tmp_path / 'out').exists()


@pytest.mark.parametrize('part', ['simulated', 'families'])
def test_a_change_that_no_system_has_is_refused(part: str, tmp_path: Path) -> None:
    assert '--systems' in error_of(evaluate, [part, '--systems', 'gaps', '--without', CHANNELS[0],
                                              '-o', str(tmp_path / 'out')])
    assert not (tmp_path / 'out').exists()


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
        save(folder / 'full' / f'{name}.csv', rows, Row)
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


def test_folders_without_results_are_refused(folders: List[str], tmp_path: Path) -> None:
    (tmp_path / 'empty').mkdir()
    assert 'empty: holds no results' in error_of(evaluate, ['compare', folders[0],
                                                            str(tmp_path / 'empty'), '-o',
                                                            str(tmp_path / 'out')])
    assert 'missing' in error_of(evaluate, ['compare', folders[0], str(tmp_path / 'missing')])


def test_results_of_other_commands_are_refused(folders: List[str], tmp_path: Path) -> None:
    write(tmp_path / 'other' / 'all', OF_FAMILIES, OF_OWN, 'evaluate families --hours 3')
    error = error_of(evaluate, ['compare', folders[0], str(tmp_path / 'other')])
    assert '--hours 2' in error and '--hours 3' in error
    write(tmp_path / 'other' / 'more', OF_FAMILIES, OF_OWN)
    assert 'more: only one of' in error_of(evaluate, ['compare', folders[0],
                                                      str(tmp_path / 'other')])


FIRST = 1_600_000_000 * SECOND_NS


def rows_of(alarms: List[Span], monkeypatch: pytest.MonkeyPatch) -> List[Row]:
    """Let a system that raises these alarms judge a recording of 100 s, with an outage or not."""
    normal = BagPart('a.bag')
    cases = (Case('faulty', normal, normal, 'a.bag', (50.0, 60.0), ((10.0, 50.0), (70.0, 1e9))),
             Case('healthy', normal, normal, 'a.bag', None, ((0.0, 1e9),)))
    raised = [SystemAlarm(FIRST + round(start * SECOND_NS), FIRST + round(end * SECOND_NS), True,
                          [], culprit='/a') for start, end in alarms]
    said = JudgedCase(raised, [], FIRST, FIRST + 100 * SECOND_NS, 3)
    monkeypatch.setattr(outages, 'SYSTEMS', {'oracle': lambda *_: said})
    unit = Unit(lambda _: [], REAL, 'a case', (Variant('oracle'),))
    return [row for case in cases for row in outages.rows(case, Path(), unit)]


@pytest.mark.parametrize('alarms, false, standing_s, latency_s, stood, level', [
    # Start-up and the time after the outage are not counted, but the alarm may not stay in them.
    ([(5.0, 12.0), (50.5, 72.0)], 0, 4.0, 0.5, False, 'ERROR'),
    ([(48.0, 55.0), (56.0, 57.0)], 1, 2.0, 6.0, True, ''),
    ([(61.0, 65.0), (80.0, 81.0)], 1, 1.0, None, False, '')])
def test_an_alarm_in_the_outage_finds_it_and_others_are_false(
        alarms: List[Span], false: int, standing_s: float, latency_s: Optional[float], stood: bool,
        level: str, monkeypatch: pytest.MonkeyPatch) -> None:
    normal, outage, healthy = rows_of(alarms, monkeypatch)
    assert (normal.watched, normal.alarms) == (3, false)
    assert normal.hours * HOUR_S == pytest.approx(70.0)
    assert normal.standing_hours * HOUR_S == pytest.approx(standing_s)
    assert (outage.stood_before, outage.level) == (stood, level)
    assert outage.latency_s == (latency_s and pytest.approx(latency_s))
    assert outage.culprit == ('/a' if level else '')
    assert (healthy.fault, healthy.alarms) == (NORMAL, len(alarms))
    assert healthy.standing_hours * HOUR_S == pytest.approx(sum(end - begin
                                                                for begin, end in alarms))


def test_a_folder_without_the_recordings_is_told(tmp_path: Path) -> None:
    output = tmp_path / 'out'
    error = error_of(evaluate, ['recordings', '--data', str(tmp_path), '-o', str(output)])
    assert str(tmp_path / 'wheeled_robot') in error and '--data' in error
    assert not output.exists()


def test_every_case_and_system_has_a_row(shared: Path, tmp_path: Path, monkeypatch) -> None:
    monkeypatch.chdir(shared)
    output = tmp_path / 'out'
    assert evaluate.main(['recordings', '--data', 'data', '-o', str(output)]) == 0
    rows = load(output / 'full' / 'recordings.csv', Row)
    assert ([(row.subject.robot, row.subject.system) for row in rows if row.fault == NORMAL]
            == [(case.name, system) for case in outages.CASES
                for system in ('evidence', 'paper', 'frequency_learned')])
    page = (output / 'research.md').read_text(encoding='utf-8')
    assert page.count('\n| wheeled_robot') == 6 and page.count('\n| social_robot') == 9
    assert str(shared) not in page and 'evaluate recordings --data data' in page
    of_outages = {(row.subject.robot, row.subject.system): row for row in rows
                  if row.fault == outages.OUTAGE}
    found = of_outages['wheeled_robot, 13 February', 'evidence']
    assert found.watched == 5 and found.latency_s is not None and found.level == 'ERROR'
    assert of_outages['wheeled_robot, 13 February', 'frequency_learned'].watched == 0
    assert of_outages['wheeled_robot, 17 January', 'evidence'].stood_before
