"""A recording that cannot be used is named by every program, and hides no other one."""
from __future__ import annotations

import json
import os
import shutil
from pathlib import Path
from typing import Callable, Dict, List

import pytest
import rosbag
from conftest import printed_by, robot, write_bag

from self_awareness import TrainedModel, recordings_in_event_log
from self_awareness.commands import calibrate, convert, diff, info, learn_more, score, train

PROGRAMS: Dict[str, Callable[[List[str]], int]] = {
    'train': train.main, 'calibrate': calibrate.main, 'score': score.main, 'info': info.main,
    'convert': convert.main, 'diff': diff.main, 'learn_more': learn_more.main}

BAD = {'active.bag.active': 'is still being written, or its recorder was killed; in that case '
                            'mend it with: rosbag reindex',
       'cut.bag': 'rosbag reindex',
       'foreign.bag': 'not a bag',
       'nothing.bag': 'not a bag',
       'empty.bag': 'the bag is empty: it holds no messages; leave it out',
       'other.mcap': 'not a bag of ROS 1: MCAP',
       'old.orig.bag': 'before rosbag reindex; remove it',
       'packed.bag.gz': 'compressed by gzip; unpack it first',
       'ros2.db3': 'a recording of ROS 2 (SQLite)'}


@pytest.fixture
def day(tmp_path: Path) -> Path:
    """A folder with two good recordings, and bad ones between them."""
    made = tmp_path / 'day'
    made.mkdir()
    whole = Path(write_bag(made / 'zz.bag', robot(40000.0, 100.0)))
    write_bag(made / 'a.bag', robot(30000.0, 100.0))
    unindexed = rosbag.Bag(str(made / 'active.bag.active'), 'w')
    unindexed._file.close()
    (made / 'cut.bag').write_bytes(whole.read_bytes()[:9000])
    with rosbag.Bag(str(made / 'empty.bag'), 'w'):
        pass
    (made / 'foreign.bag').write_text('something else\n' * 100)
    (made / 'nothing.bag').touch()
    (made / 'other.mcap').write_bytes(b'\x89MCAP0\r\n')
    write_bag(made / 'old.bag', robot(50000.0, 100.0))
    (made / 'old.orig.bag').write_bytes(whole.read_bytes()[:9000])
    (made / 'packed.bag.gz').write_bytes(b'\x1f\x8b\x08')
    (made / 'ros2.db3').write_bytes(b'SQLite format 3\0')
    (made / 'notes.txt').write_text('monday\n')
    return made


def arguments(program: str, named: str, model: str, output: str) -> List[str]:
    return {'train': [named, '-o', output],
            'calibrate': ['--model', model, '--normal', named, '-o', output],
            'score': [named, '--model', model, '--json', output],
            'info': [named],
            'convert': [named, '-o', output],
            'diff': [model, named],
            'learn_more': [named, '--model', model, '--start-up', '0', '-o', output]}[program]


@pytest.mark.parametrize('program', sorted(PROGRAMS))
def test_all_bad_ones_are_named_at_once_and_are_skipped_if_asked(
        program: str, day: Path, evidence_model: str, tmp_path: Path, capfd) -> None:
    output = tmp_path / 'out'
    named = arguments(program, str(day), evidence_model, str(output))

    def check(kind: str) -> str:
        captured = capfd.readouterr()
        assert captured.err.count(f'{program}: {kind}: ') == len(BAD), captured.err
        for name, told in BAD.items():
            assert len([line for line in captured.err.splitlines()
                        if line.startswith(f'{program}: {kind}: {day}/{name}: ')
                        and told in line]) == 1, captured.err
        return captured.out

    assert PROGRAMS[program](named) == 1
    said = check('error')
    # What says something of each recording by itself goes on; what needs all of them does nothing.
    assert output.exists() == (program == 'score')
    if program in ('score', 'info'):
        assert f'{day}/a.bag: ' in said and f'{day}/zz.bag: ' in said
    assert PROGRAMS[program]([*named, '--skip-bad']) == 0
    check('warning: skipped')
    if program == 'train':
        assert [each.bag for each in TrainedModel.load(str(output)).recordings] == [
            'a.bag', 'old.bag', 'zz.bag']
    elif program == 'convert':
        assert recordings_in_event_log(str(output)) == 3
    elif program == 'score':
        assert len(json.loads(output.read_text(encoding='utf-8'))['skipped']) == len(BAD)


def test_a_damage_that_is_found_late_hides_nothing(evidence_model: str, tmp_path: Path,
                                                   capsys) -> None:
    """In the middle of a file, where nobody looks before the work begins."""
    day = tmp_path / 'day'
    day.mkdir()
    for name in ('a.bag', 'b.bag', 'c.bag'):
        write_bag(day / name, robot(30000.0 + 1000 * ord(name[0]), 100.0))
    content = bytearray((day / 'b.bag').read_bytes())
    middle = len(content) // 2
    content[middle:middle + 2000] = bytes(2000)
    (day / 'b.bag').write_bytes(content)
    for program in sorted(PROGRAMS):
        output = tmp_path / program
        named = arguments(program, str(day), evidence_model, str(output))
        assert PROGRAMS[program](named) == 1
        captured = capsys.readouterr()
        assert captured.err.count(f'{day}/b.bag: ') == 1, captured.err
        if program in ('score', 'info'):
            assert f'{day}/c.bag: ' in captured.out
        assert PROGRAMS[program]([*named, '--skip-bad']) == 0
        assert f'{program}: warning: skipped: {day}/b.bag: ' in capsys.readouterr().err


def test_where_none_is_left_nothing_is_done(day: Path, model_file: str, tmp_path: Path,
                                            capsys) -> None:
    for good in ('a.bag', 'old.bag', 'old.orig.bag', 'zz.bag'):
        os.remove(day / good)
    for program in sorted(PROGRAMS):
        output = tmp_path / program
        assert PROGRAMS[program]([*arguments(program, str(day), model_file, str(output)),
                                  *([] if program == 'info' else ['--skip-bad'])]) == 1
        assert capsys.readouterr().err.count(f'{program}: error: {day}/') == len(BAD) - 1
        assert not output.exists()


def test_a_recorder_that_was_killed_is_read_once_it_is_mended(day: Path, tmp_path: Path) -> None:
    shutil.copy(day / 'a.bag', tmp_path / 'a.bag.active')  # rosbag reindex leaves the name
    assert f'{tmp_path}/a.bag.active: 100.0 s' in printed_by(info, [str(tmp_path)])
