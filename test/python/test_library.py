"""`import self_awareness as sa`: the package as a library."""
from __future__ import annotations

import doctest
import json
import re
import subprocess
import sys
from pathlib import Path
from typing import Callable

import pytest
from conftest import jittery_robot, write_bag

import self_awareness as sa
from self_awareness import library
from self_awareness.commands import calibrate, score, train

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope='module')
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The recordings that the documentation names: the laser of crash.bag is dead from 12 s on."""
    made = tmp_path_factory.mktemp('library')
    for day, name in enumerate(['monday', 'tuesday', 'wednesday', 'thursday']):
        write_bag(made / f'{name}.bag', jittery_robot(1000.0 * (day + 1), 120.0, day))
    write_bag(made / 'crash.bag', [message for message in jittery_robot(9000.0, 40.0, 9)
                                   if message[1] != '/laser' or message[0] < 9012.0])
    sa.learn([made / 'monday.bag', str(made / 'tuesday.bag')]).save(made / 'robot.model')
    return made


@pytest.mark.parametrize('module', [sa, library], ids=['package', 'library'])
def test_the_examples_of_docstrings_do_what_they_say(module, folder: Path,
                                                     monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(folder)
    result = doctest.testmod(module, extraglobs={'load': sa.load, 'learn': sa.learn})
    assert result.attempted > 1 and result.failed == 0


def test_the_code_of_the_page_does_what_it_says(folder: Path,
                                                monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(folder)
    text = (ROOT / 'docs/library.md').read_text(encoding='utf-8')
    blocks = re.findall(r'```python\n(.*?)```', text, re.DOTALL)
    assert len(blocks) > 3
    code = doctest.DocTestParser().get_doctest(''.join(blocks), {}, 'library.md', None, 0)
    assert len(code.examples) > 8
    runner = doctest.DocTestRunner(optionflags=doctest.ELLIPSIS)
    runner.run(code)
    assert runner.failures == 0


def test_it_learns_and_judges_as_the_programs_do(folder: Path, tmp_path: Path) -> None:
    bags = [str(folder / f'{name}.bag') for name in ('monday', 'tuesday')]
    held_out, crash = str(folder / 'wednesday.bag'), str(folder / 'crash.bag')
    trained, calibrated = str(tmp_path / 'trained'), str(tmp_path / 'calibrated')
    values = tmp_path / 'alarms.json'
    assert train.main([*bags, '-o', trained]) == 0
    assert calibrate.main(['--model', trained, '--normal', held_out, '-o', calibrated]) == 0
    assert score.main([crash, '--model', calibrated, '--json', str(values)]) == 0
    model = sa.learn(bags)
    assert model.trained.calibration.limits == pytest.approx(
        sa.load(trained).trained.calibration.limits, nan_ok=True)
    model.calibrate([held_out])
    alarms = model.judge(crash)
    assert json.loads(alarms.to_json()) == alarms.table()
    assert alarms.table() == json.loads(values.read_text())['recordings'][0]['alarms']
    assert alarms[-1].level == 'ERROR' and alarms[:1][0].begin == alarms[0].begin
    assert len(alarms) == len(list(alarms)) >= 1
    assert str(alarms[-1]).startswith(f'{alarms[-1].culprit} (')


def test_a_part_of_a_recording_is_judged(folder: Path) -> None:
    model = sa.load(folder / 'robot.model')
    assert list(model.judge(f'{folder / "crash.bag"}@0-11')) == []


@pytest.mark.parametrize('mistake, said', [
    (lambda folder, model: sa.learn([]), 'no bag is named'),
    (lambda folder, model: sa.learn([folder / 'nothing.bag']), 'nothing.bag'),
    (lambda folder, model: sa.learn([folder / 'monday.bag@0-20']).judge(folder / 'crash.bag'),
     'calibrate it'),
    (lambda folder, model: sa.load(folder / 'monday.bag'), 'monday.bag'),
    (lambda folder, model: model.judge(folder / 'nothing.bag'), 'nothing.bag'),
    (lambda folder, model: model.calibrate([folder / 'monday.bag']), 'was trained on it'),
    (lambda folder, model: model.calibrate([folder / 'wednesday.bag@0-20']), 'too little normal'),
])
def test_mistakes_are_told(folder: Path, mistake: Callable, said: str) -> None:
    with pytest.raises((ValueError, OSError, RuntimeError), match=re.escape(said)):
        mistake(folder, sa.load(folder / 'robot.model'))


def test_names_that_are_not_there_are_told() -> None:
    with pytest.raises(AttributeError, match="no attribute 'lern'"):
        sa.lern  # noqa: B018


def test_what_needs_no_numpy_does_not_wait_for_it() -> None:
    code = "import self_awareness, sys; sys.exit('numpy' in sys.modules)"
    assert subprocess.run((sys.executable, '-c', code)).returncode == 0
