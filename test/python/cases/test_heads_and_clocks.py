"""A node that is switched off before the recorder, and a clock that is set in between."""
from __future__ import annotations

import contextlib
import io
import json
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any, Dict, NamedTuple

import pytest

from self_awareness import TrainedModel
from self_awareness.commands import calibrate, score, train

STOPPED, LEAP = '37_node_stopped_before_the_recorder', '09_clock_leaps_forward'

_SET_BACK = """
import sys
sys.path.insert(0, sys.argv[1])
from robot import MultiBag, T, standard
for by in (-5.0, 0.5):
    robot = standard(16, 110)
    robot.ev.sort(key=lambda each: each.t)
    bag = MultiBag(f'{sys.argv[2]}/{by:g}.bag')
    for each in robot.ev:
        step = by if each.t >= 50 else 0.0
        each.stamp += step
        bag.write(each.caller, each.topic, each.make(each), T(robot.epoch, each.t + step))
    bag.close()
"""
"""Writes recordings in which the clock is set after 50 s, in the order in which messages came."""


def run(*command: str, **environment: str) -> None:
    subprocess.run([sys.executable, *command], check=True, stdout=subprocess.DEVNULL,
                   env={**os.environ, **environment})


@pytest.fixture(scope='module', name='bags')
def _bags(shared: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder with the bags of both cases."""
    cases = shared / 'cases'
    missing = [case for case in (STOPPED, LEAP) if not (cases / case / 'make.py').is_file()]
    if missing:
        pytest.skip(f'no {", ".join(missing)} in {cases}')
    folder = tmp_path_factory.mktemp('heads')
    run(str(cases / STOPPED / 'make.py'), OUT=str(folder))
    run(str(cases / LEAP / 'make.py'), OUT=str(folder), SKIP_NORMAL='1')
    run('-c', _SET_BACK, str(cases / 'lib'), str(folder))
    return folder


class Learned(NamedTuple):
    """A model, and what the programs said."""

    model: str
    trained: str
    calibrated: str


def said(program: Any, *arguments: str) -> str:
    with contextlib.redirect_stdout(io.StringIO()) as out:
        assert program.main(list(arguments)) == 0
    return out.getvalue()


@pytest.fixture(scope='module', name='learned')
def _learned(bags: Path) -> Learned:
    model = str(bags / 'robot.model')
    trained = said(train, *(str(bags / f'n{k}.bag') for k in range(1, 5)), '-o', model)
    calibrated = said(calibrate, '--model', model, '--normal', str(bags / 'n5.bag'),
                      str(bags / 'n6.bag'), '-o', model, '--inject', 'crash:/move_base')
    return Learned(model, trained, calibrated)


def judged(learned: Learned, bag: Path) -> Dict[str, Any]:
    """Return what score says of a recording: its JSON, and what it prints."""
    values = str(bag) + '.json'
    text = said(score, str(bag), '--model', learned.model, '--json', values)
    return {**json.loads(Path(values).read_text())['recordings'][0], 'text': text}


def test_who_ends_before_recordings_is_told(bags: Path, learned: Learned) -> None:
    line = re.search(r'/move_base ends before the recording does in 3 of 4: .*', learned.trained)
    assert line and f'{bags}/n4.bag by 14.' in line[0] and '--end' in line[0]
    assert '/move_base ends before the recording does in 1 of 2' in learned.calibrated
    assert learned.trained.count('before the recording does') == 1


def test_a_tail_makes_no_death_later_and_counts_in_no_promise(learned: Learned) -> None:
    found = {each.component: each.death_found_after
             for each in TrainedModel.load(learned.model).coverage()}
    assert found['/move_base'] < 1.5, 'its longest gap is 0.2 s'
    assert 'alarms: 0, and 1 of who stopped before a recording ended' in learned.calibrated
    assert 'found 2 of 2' in learned.calibrated


def test_deaths_and_pauses_are_found(bags: Path, learned: Learned) -> None:
    for name, headline in (
            ('crash', r'/move_base \(/cmd_vel\) stopped sending at (59.9|60.0) s\.'),
            ('pause10', r'/move_base \(/cmd_vel\) fell silent at \S+ s, and came back at 70.\d '
                        r's\.'),
            ('n6', r'/move_base \(/cmd_vel\) stopped sending at 10[89].\d s, 11.\d s before the '
                   r'recording ended\.')):
        found = judged(learned, bags / f'{name}.bag')
        incident, = found['incidents']
        assert re.fullmatch(headline, incident['headline']), incident['headline']
        assert ('before the recording ended' in found['text']) == (name == 'n6')


@pytest.mark.parametrize('bag, way, by_s', [('leap', 'forward', 3600.0), ('-5', 'back', -5.0),
                                            ('0.5', 'forward', 0.5)])
def test_a_clock_that_is_set_is_told_and_is_no_fault(bags: Path, learned: Learned, bag: str,
                                                     way: str, by_s: float) -> None:
    found = judged(learned, bags / f'{bag}.bag')
    assert f'the clock was set {way} by {abs(by_s):.1f} s before ' in found['text']
    step, = found['clock_steps']
    assert step['by_s'] == pytest.approx(by_s, abs=0.05)
    assert found['alarms'] == []
