"""Faults in recordings that were cut, or that have a bad one among them (../shared/cases)."""
from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any, Dict

import pytest

from self_awareness.commands import info

SPLIT = '17_split_bags_death_before_a_split'
EMPTY = '28_empty_bag_in_a_folder'
NAME = 'run_2026-03-04-10-11-12_{}.bag'
DEATH_S = 59.7


@pytest.fixture(scope='module', name='bags')
def _bags(cases: Any, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the bags of both cases."""
    out = tmp_path_factory.mktemp('cut')
    for name in (SPLIT, EMPTY):
        cases.make(name, out)
    return out


def check_death(said: Dict[str, Any], origin_s: float = 0.0) -> None:
    """Check that there is one alarm, to the end, and one incident, since the death."""
    alarm, = [alarm for alarm in said['alarms'] if alarm['level'] == 'ERROR']
    assert alarm['culprit'] == '/lidar' and alarm['kind'] == 'died' and not alarm['over']
    incident, = said['incidents']
    assert incident['level'] == 'ERROR' and incident['cause'] == '/lidar'
    since = min(each['from_s'] for each in incident['silent'] if each['component'] == '/lidar')
    assert since == pytest.approx(DEATH_S - origin_s, abs=0.1)


def test_a_death_before_a_split_is_one_alarm(scored, bags: Path, tmp_path: Path, capsys) -> None:
    said, = scored(str(bags / 'run'))
    check_death(said)
    out = capsys.readouterr().out
    assert f'{NAME.format(0)}..4: 5 files of one recording' in out
    assert f'/lidar and /amcl stopped sending at 59.6 s. (29.6 s of {NAME.format(1)})' in out
    assert f'29.6 s of {NAME.format(1)}' in (tmp_path / 'r.html').read_text(encoding='utf-8')
    assert info.main([str(bags / 'run')]) == 0
    assert f'from 30.0 s on: {NAME.format(1)}' in capsys.readouterr().out


def test_files_may_be_named_in_any_order(scored, bags: Path) -> None:
    said, = scored(*(str(bags / 'run' / NAME.format(number))
                     for number in (3, 0, 4, 2, 1)))
    check_death(said)


def test_a_missing_file_ends_the_recording(scored, bags: Path, tmp_path: Path, capsys) -> None:
    day = tmp_path / 'day'
    day.mkdir()
    for number in (0, 1, 3, 4):
        shutil.copy(bags / 'run' / NAME.format(number), day)
    assert [[each['file'] for each in said['files']]
            for said in scored(str(day))] == [
        [str(day / NAME.format(number)) for number in numbers] for numbers in ((0, 1), (3, 4))]
    assert 'number 2 is missing' in capsys.readouterr().out


def test_a_recording_goes_on_before_what_is_named_first(scored, bags: Path) -> None:
    said, = scored(*(str(bags / 'run' / NAME.format(number))
                     for number in (1, 2, 3, 4)))
    check_death(said, origin_s=30.0)


def test_an_empty_bag_hides_nothing_behind_it(scored, bags: Path, tmp_path: Path, capsys) -> None:
    day = bags / 'day'
    quiet, dead = scored(str(day), code=1)
    assert quiet['bag'] == str(day / 'a.bag') and not quiet['alarms']
    assert dead['bag'] == str(day / 'c.bag')
    assert {alarm['culprit'] for alarm in dead['alarms'] if alarm['level'] == 'ERROR'} == {
        '/lidar'}
    error = capsys.readouterr().err
    assert error.startswith(f'score: error: {day}/b.bag: the bag is empty'), error
    assert error.count('\n') == 1
    scored(str(day), '--skip-bad')
    assert f'warning: skipped: {day}/b.bag: the bag is empty' in capsys.readouterr().err
