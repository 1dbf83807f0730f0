"""Training and calibration of a learning, by the programs."""
from __future__ import annotations

import re
from pathlib import Path

import pytest
from conftest import jittery_robot
from recorded_logs import write_log

from self_awareness import EncodingRules, TrainedModel
from self_awareness.learning.logs import Division, LogFolder, divide
from self_awareness.learning.programs import ProgramError, executable, train_and_calibrate


def divided(folder: Path, length: float) -> Division:
    for number in range(2):
        write_log(folder / f'{number}.bag',
                  jittery_robot(1000.0 * (number + 1), length, number), number + 1)
    logs = LogFolder(str(folder), EncodingRules.defaults())
    assert logs.look() == []
    return divide(logs.logs, 10.0)


def test_a_model_is_learned_and_what_it_finds_is_printed(tmp_path: Path, capfd) -> None:
    model = tmp_path / 'robot.model'
    train_and_calibrate(divided(tmp_path, 200.0), str(model), str(tmp_path), 0.5, lambda: False)
    lines = capfd.readouterr().out.splitlines()
    assert lines[0].startswith('+ rosrun self_awareness train ')
    assert lines[1].startswith('+ rosrun self_awareness calibrate ')
    assert re.fullmatch(r'learned from 2 starts, 6 min: .*; deaths of all 3 nodes found within '
                        r'\d+\.\d+ s', lines[2])
    assert lines[3].startswith('record next: ')
    assert re.fullmatch(r'faults: found 6 of 6, half of them within 0\.\d+ s, the last after '
                        r'0\.\d+ s; the node is named first in 6 of 6', lines[4])
    assert len(lines) == 5
    trained = TrainedModel.load(str(model))
    assert trained.calibration.method == 'held-out'
    assert {recording.robot_start for recording in trained.recordings} == {10**9, 2 * 10**9}
    assert not list(tmp_path.glob('.training*'))


def test_too_little_is_said_in_one_line_and_leaves_nothing(tmp_path: Path, capfd) -> None:
    model = tmp_path / 'robot.model'
    with pytest.raises(ProgramError, match='too short'):
        train_and_calibrate(divided(tmp_path, 60.0), str(model), str(tmp_path), 0.5,
                            lambda: False)
    with pytest.raises(ProgramError, match='^calibrate: error: --normal: [^\n]*$'):
        division = divided(tmp_path, 110.0)
        train_and_calibrate(Division(division.training, division.calibration[:1]), str(model),
                            str(tmp_path), 0.5, lambda: False)
    assert not model.exists()
    assert not list(tmp_path.glob('.training*'))


def test_it_can_be_interrupted(tmp_path: Path, capfd) -> None:
    model = tmp_path / 'robot.model'
    with pytest.raises(ProgramError, match='interrupted'):
        train_and_calibrate(divided(tmp_path, 200.0), str(model), str(tmp_path), 0.5,
                            lambda: True)
    assert capfd.readouterr().out == '' and not model.exists()


def test_a_program_that_is_not_there_is_an_error() -> None:
    with pytest.raises(ValueError, match='no_such_program is not there'):
        executable('no_such_program')
