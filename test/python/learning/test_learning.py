"""A learning: its folder of logs, how they are divided, and the programs that it runs."""
from __future__ import annotations

import re
from pathlib import Path
from typing import List

import pytest
from conftest import jittery_robot, robot, write_bag
from recorded_logs import write_log

from self_awareness import EncodingRules, TrainedModel, read_events
from self_awareness.learning import logs
from self_awareness.learning.logs import HEARD_S, Division, Log, LogFolder, divide
from self_awareness.learning.programs import ProgramError, executable, train_and_calibrate
from self_awareness.parts import BagPart

RULES = EncodingRules.defaults()


def folder(path: Path) -> LogFolder:
    return LogFolder(str(path), RULES)


def test_hours_and_starts_are_those_of_the_recordings(tmp_path: Path) -> None:
    for name, length, start in (('a', 90.0, 7), ('b', 60.0, 7), ('c', 30.0, 8)):
        write_log(tmp_path / f'{name}.bag', robot(1000.0, length), start)
    found = folder(tmp_path)
    assert found.hours == found.starts == 0
    assert found.look() == []
    assert found.hours == pytest.approx(180.0 / 3600.0, rel=0.01)
    assert found.starts == 2
    assert [log.part.path for log in found.logs] == [str(tmp_path / f'{x}.bag') for x in 'abc']
    write_log(tmp_path / 'd.bag', robot(2000.0, 60.0), 9)
    assert found.look() == []
    assert found.starts == 3


def test_time_in_which_nobody_is_heard_does_not_count(tmp_path: Path) -> None:
    write_log(tmp_path / 'a.bag', [*robot(1000.0, 60.0), *robot(1600.0, 60.0)], 7)
    write_log(tmp_path / 'b.bag', [(stamp, '/play_7', topic)
                                   for stamp, _, topic in robot(1000.0, 60.0)], 8)
    found = folder(tmp_path)
    assert found.look() == []
    assert found.hours == pytest.approx((120.0 + HEARD_S) / 3600.0, rel=0.01)
    assert found.starts == 1
    assert [log.seconds for log in found.logs] == pytest.approx([660.0], rel=0.01)


def test_what_a_crash_left_behind_is_mended_or_named(tmp_path: Path) -> None:
    (tmp_path / 'a.bag.active').write_bytes(b'')
    (tmp_path / 'b.bag.active').write_bytes(b'no bag at all')
    crashed = write_log(tmp_path / 'c.bag.active', robot(1000.0, 60.0), 7, crashed=True)
    found = folder(tmp_path)
    assert found.look() == [] and found.logs == []
    lines = found.mend()
    for line, name in zip(lines, 'ab'):
        assert line.startswith(f'left out: {tmp_path}/{name}.bag.active: cannot be mended')
    assert lines[2:] == [f'mended: {tmp_path}/c.bag']
    assert (tmp_path / 'a.bag.active').exists() and not Path(crashed).exists()
    assert found.look() == []
    assert len(found.logs) == found.starts == 1
    events = read_events(str(tmp_path / 'c.bag'), RULES, recording=0)
    assert len(events.stamps) == len(list(robot(1000.0, 60.0)))


def test_what_is_no_good_log_is_named_once_and_left_out(tmp_path: Path) -> None:
    write_log(tmp_path / 'damaged.bag', robot(1000.0, 60.0), 7, without=1)
    write_log(tmp_path / 'good.bag', robot(1000.0, 60.0), 7)
    write_bag(tmp_path / 'messages.bag', robot(1000.0))
    (tmp_path / 'text.bag').write_text('no bag')
    found = folder(tmp_path)
    problems = found.look()
    assert [log.part.path for log in found.logs] == [str(tmp_path / 'good.bag')]
    for problem, name, why in zip(problems, ('damaged', 'messages', 'text'),
                                  ('damaged', 'no event log', 'text.bag')):
        assert problem.startswith(f'left out: {tmp_path}/{name}.bag') and why in problem
    assert len(problems) == 3
    assert found.look() == []


def test_logs_of_another_encoding_are_left_out(tmp_path: Path) -> None:
    path = write_log(tmp_path / 'a.bag', robot(1000.0), 7)
    rules = EncodingRules.defaults()
    rules.exclude_topics += ['/scan']
    found = LogFolder(str(tmp_path), rules)
    assert found.look() == [f'left out: {path}: was recorded by another encoding']


def test_only_one_learns_in_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(logs, '_UNLOCKED_S', 0.0)
    with folder(tmp_path).locked():
        with pytest.raises(ValueError, match='somebody else learns here'):
            with folder(tmp_path).locked():
                pass
    with folder(tmp_path).locked():
        pass


def parts(lengths: List[float], starts: List[int], start_up: float = 30.0) -> List[List[str]]:
    logs = [Log(BagPart(f'{number}.bag', recording=0), seconds, start)
            for number, (seconds, start) in enumerate(zip(lengths, starts))]
    division = divide(logs, start_up)
    return [[str(part) for part in half] for half in (division.training, division.calibration)]


def test_recordings_are_cut_and_the_start_up_of_the_robot_is_left_out() -> None:
    training, calibration = parts([1800.0, 900.4, 330.0], [1, 1, 2])
    assert training == ['0.bag@30-1210', '1.bag@0-600', '2.bag@30-230']
    assert calibration == ['0.bag@1211', '1.bag@601', '2.bag@231']


def test_what_is_too_short_to_be_cut_is_trained_on_as_a_whole() -> None:
    training, calibration = parts([121.0, 122.0, 91.0, 92.0], [1, 2, 2, 2])
    assert training == ['0.bag@30', '1.bag@30-91', '2.bag', '3.bag@0-61']
    assert calibration == ['1.bag@92', '3.bag@62']


def test_a_start_that_soon_ended_is_left_out() -> None:
    assert parts([39.0, 9.0, 41.0], [1, 1, 2]) == [['2.bag@30'], []]


def test_no_part_of_the_training_is_in_the_calibration() -> None:
    logs = [Log(BagPart('a.bag', recording=0), seconds / 7.0, 1) for seconds in range(0, 5000, 13)]
    for log in logs:
        division = divide([log], 20.0)
        for part in division.calibration:
            assert division.training and not part.meets(division.training[0])
            assert part.start is not None and log.seconds - part.start >= 30.0


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
