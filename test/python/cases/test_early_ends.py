"""A node that is switched off before the recorder."""
from __future__ import annotations

import contextlib
import io
import json
import re
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from self_awareness import TrainedModel
from self_awareness.commands import calibrate, score, train


class Learned(NamedTuple):
    """A model, the folder that it is in with the bags of the case, and what the programs said."""

    folder: Path
    model: str
    trained: str
    calibrated: str


def said(program: Any, *arguments: str) -> str:
    with contextlib.redirect_stdout(io.StringIO()) as out:
        assert program.main(list(arguments)) == 0
    return out.getvalue()


@pytest.fixture(scope='module', name='learned')
def _learned(cases: Any, tmp_path_factory: pytest.TempPathFactory) -> Learned:
    folder = cases.make('37_node_stopped_before_the_recorder', tmp_path_factory.mktemp('early'))
    model = str(folder / 'robot.model')
    trained = said(train, *(str(folder / f'n{k}.bag') for k in range(1, 5)), '-o', model,
                   '--details')
    calibrated = said(calibrate, '--model', model, '--normal', str(folder / 'n5.bag'),
                      str(folder / 'n6.bag'), '-o', model, '--inject', 'crash:/move_base',
                      '--details')
    return Learned(folder, model, trained, calibrated)


def test_who_ends_before_recordings_is_told_and_counts_in_no_promise(learned: Learned) -> None:
    line = re.search(r'/move_base ends before the recording does in 3 of 4: .*', learned.trained)
    assert line and f'{learned.folder}/n4.bag by 14.' in line[0] and '--end' in line[0]
    assert '/move_base ends before the recording does in 1 of 2' in learned.calibrated
    assert learned.trained.count('before the recording does') == 1
    found = {each.component: each.death_found_after
             for each in TrainedModel.load(learned.model).coverage()}
    assert found['/move_base'] < 1.5, 'its longest gap is 0.2 s'
    assert ': 0, and 1 of what stopped before a recording ended\n' in learned.calibrated
    assert 'found 2 of 2' in learned.calibrated


@pytest.mark.parametrize('name, headline', [
    ('crash', r'/move_base \(/cmd_vel\) stopped sending at (59.9|60.0) s\.'),
    ('pause10', r'/move_base \(/cmd_vel\) fell silent at \S+ s, and came back at 70.\d s\.'),
    ('n6', r'/move_base \(/cmd_vel\) stopped sending at 10[89].\d s, 11.\d s before the '
           r'recording ended\.')])
def test_deaths_and_pauses_are_found(learned: Learned, name: str, headline: str,
                                     tmp_path: Path) -> None:
    values = tmp_path / 'said.json'
    text = said(score, str(learned.folder / f'{name}.bag'), '--model', learned.model, '--json',
                str(values))
    incident, = json.loads(values.read_text())['recordings'][0]['incidents']
    assert re.fullmatch(headline, incident['headline']), incident['headline']
    assert ('before the recording ended' in text) == (name == 'n6')
