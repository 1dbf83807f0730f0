"""The program evaluate: files written whole, and errors that name the way out."""
from __future__ import annotations

import csv
import re
import shutil
import subprocess
from pathlib import Path
from typing import Any, Optional

import pytest

from self_awareness_evaluation import catalogue, evaluate
from self_awareness_evaluation.simulated import report, tables
from self_awareness_evaluation.simulated.experiment import Results
from self_awareness_evaluation.simulated.measures import Row

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture(name='written', scope='module')
def _written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp('evaluation') / 'new'
    assert evaluate.main(['simulated', '--seeds', '2', '--seed', '5', '--systems', 'paper',
                          'frequency', 'frequency_learned', '--without-systems', 'frequency',
                          '--faults', 'cc1', 'rs', '--calibration', '60', '--jobs', '2',
                          '-o', str(folder)]) == 0
    return folder


def test_csv_has_a_row_for_everything(written: Path) -> None:
    with open(written / 'full' / 'simulated.csv', encoding='utf-8', newline='') as file:
        rows = list(csv.DictReader(file))
    assert ({(row['system'], row['training_share'], row['seed'], row['record']) for row in rows}
            == {(system, share, seed, record) for system in ('paper', 'frequency_learned')
                for share in ('1.0', '0.1') for seed in '56'
                for record in ('normal', 'cc1', 'rs')})
    assert len(rows) == 24
    for row in rows:
        assert (row['auc'] == '') == (row['record'] == 'normal')
        if row['record'] == 'cc1' and row['training_share'] == '1.0':
            assert 0.0 < float(row['latency_s']) < 3.0
            assert row['top3'] == 'True'


def rows_have_a_cell_for_every_system(page: str) -> bool:
    rows = [line for line in page.splitlines() if line.startswith('| cc1')]
    return bool(rows) and all(line.count('|') == 4 for line in rows)


def test_page_has_what_is_read_and_how_to_repeat_it(written: Path) -> None:
    page = (written / 'simulated.md').read_text(encoding='utf-8')
    assert 'rosrun self_awareness evaluate simulated --seeds 2 --seed 5' in page
    assert 'Seeds 5, 6.' in page
    head = next(line for line in page.splitlines() if 'target' in line and line.startswith('|'))
    assert [cell.strip() for cell in head.split('|')][2:-1] == ['target', 'paper',
                                                                'frequency_learned']
    for title in ('Targets', 'False alarms an hour at equal latency', 'Alarms', 'Blame',
                  'With 0.1 of the training data'):
        assert f'\n## {title}\n' in page
    watched = [line for line in page.splitlines() if line.startswith('| components watched')]
    for line in watched:
        assert re.fullmatch(r'\| components watched \| all \| – \| \d+ of 15 \|', line), line
    assert len(watched) == 2
    assert rows_have_a_cell_for_every_system(page)
    assert 'full/simulated.csv' in page and 'full/simulated.md' in page
    assert 'nan' not in page and 'inf' not in page.split('## Targets')[1]
    for name in ('figure2.png', 'overview.png'):
        assert (written / name).read_bytes().startswith(b'\x89PNG')


def test_full_page_has_a_table_of_every_quantity(written: Path) -> None:
    page = (written / 'full' / 'simulated.md').read_text(encoding='utf-8')
    assert 'rosrun self_awareness evaluate simulated --seeds 2 --seed 5' in page
    assert '## With 0.1 of the training data' in page
    for title in ('Latency', 'AUC', 'FNR', 'suspicion', 'blame', 'bare verdict'):
        assert page.count(title) >= 2, title
    assert rows_have_a_cell_for_every_system(page)
    assert 'nan' not in page and 'inf' not in page


def fault(kind: str, seed: int, latency_s: Optional[float], first: Optional[bool]) -> Row:
    return Row('oracle', 1.0, seed, kind, 500, 0, 0, 0, latency_s=latency_s, top1=first,
               top3=None if first is None else True)


def test_page_tells_alarms_and_blame() -> None:
    rows = {'oracle': [fault('cc1', 1, 0.2, True), fault('cc1', 2, 0.4, False),
                       fault('crash:slam', 1, None, None), fault('rs', 1, 2.0, None)],
            'deaf': [fault('cc1', 1, None, None), fault('cc1', 2, None, None),
                     fault('crash:slam', 1, None, None), fault('rs', 1, None, None)]}
    assert tables.alarms(rows) == [
        '| fault | oracle | deaf |', '| --- | --- | --- |', '| cc1 | 100 %, 0.20 s | – |',
        '| crash:slam | – | – |', '| rs | 100 %, 2.00 s | – |', '| every crash | – | – |']
    assert tables.blame(rows)[2:] == ['| cc1 | 50 % / 100 % | – / – |']


def test_a_failure_leaves_the_old_page(written: Path, tmp_path: Path,
                                       monkeypatch: pytest.MonkeyPatch) -> None:
    page = tmp_path / 'simulated.md'
    page.write_text('old', encoding='utf-8')

    def fail(*_: Any) -> str:
        raise OSError('no space left')

    monkeypatch.setattr(report, 'page', fail)
    monkeypatch.setattr(report.row_files, 'save', lambda *_: None)
    monkeypatch.setattr(report, 'full_page', lambda *_: '')
    with pytest.raises(OSError, match='no space left'):
        report.write(tmp_path, None, Results(), '')
    assert page.read_text(encoding='utf-8') == 'old'
    assert [path.name for path in tmp_path.iterdir() if path.is_file()] == ['simulated.md']
    assert not list(written.rglob('.part*')) and not list(tmp_path.rglob('.part*'))


def test_a_missing_library_is_named_with_the_way_out(tmp_path: Path, capsys: Any,
                                                     monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(catalogue.util, 'find_spec', lambda name: None)
    arguments = ['simulated', '--faults', 'cc1', '-o', str(tmp_path / 'out')]
    assert evaluate.main(arguments) == 1
    error = capsys.readouterr().err
    for word in ('sklearn', 'hmmlearn', 'scripts/evaluation_env.sh',
                 'without isolation_forest and one_class_svm and hmm (--systems)'):
        assert word in error
    assert not (tmp_path / 'out').exists()
    catalogue.check_libraries(['paper', 'frequency', 'markov'])


@pytest.mark.parametrize('wrong', [['--faults', 'flood'], ['--seeds', '0'], ['--jobs', '0'],
                                   ['--calibration', '5'], ['--calibration', 'x'],
                                   ['--training-share', '1'], ['--systems', 'oracle'],
                                   ['--systems', 'paper', '--without-systems', 'paper']])
def test_wrong_arguments_are_refused(wrong: list, tmp_path: Path, capsys: Any) -> None:
    arguments = wrong if '--systems' in wrong else ['--systems', 'paper', *wrong]
    assert evaluate.main(['simulated', '-o', str(tmp_path / 'out'), *arguments]) in (1, 2)
    assert wrong[-1] in capsys.readouterr().err or wrong[-2] == '--without-systems'
    assert not (tmp_path / 'out').exists()


def test_the_environment_script_is_sound() -> None:
    if shutil.which('shellcheck') is None:
        subprocess.run(('bash', '-n', str(ROOT / 'scripts' / 'evaluation_env.sh')), check=True)
    else:
        subprocess.run(('shellcheck', '-x', '-P', 'SCRIPTDIR',
                        str(ROOT / 'scripts' / 'evaluation_env.sh')), check=True)
