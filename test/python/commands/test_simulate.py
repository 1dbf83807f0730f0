"""`simulate`: recordings as they come from a real robot, of several starts and with its graph."""
from __future__ import annotations

from pathlib import Path
from typing import List

import pytest
import rosbag
from conftest import error_of

from self_awareness.commands import induce, simulate

DAY_S = 86_400


def start_of(bag: Path) -> float:
    with rosbag.Bag(str(bag)) as opened:
        return opened.get_start_time()


def test_each_seed_is_a_start_of_the_robot_on_a_day_of_its_own(tmp_path: Path) -> None:
    again, first, second = (tmp_path / name for name in (
        'again.bag', 'normal_1.bag', 'normal_2.bag'))
    assert simulate.main(['-o', str(tmp_path), '--runs', '2', '--duration', '60']) == 0
    assert simulate.main(['-o', str(again), '--seed', '2', '--duration', '60']) == 0
    assert start_of(second) - start_of(first) == pytest.approx(DAY_S, abs=1.0)
    assert again.stat().st_size == second.stat().st_size
    assert start_of(again) == start_of(second)


@pytest.mark.parametrize('seed', ['-1', '123456789012345678901234567890'])
def test_any_seed_is_a_time_that_fits_into_a_bag(seed: str, tmp_path: Path) -> None:
    assert simulate.main(['-o', str(tmp_path / 'a.bag'), '--seed', seed, '--duration', '1']) == 0


@pytest.mark.parametrize('arguments, code, message', [
    *((['--duration', duration], 2, '--duration') for duration in ('inf', 'nan', '0', '-1', 'x')),
    (['--fault', 'cc1@2'], 1, 'beyond'),
    (['--fault', 'cc1@x'], 1, '--fault cc1@x'),
    (['--fault', 'cc9'], 1, 'choose one of cc1, cc2, rs, ac'),
    (['--runs', '2'], 1, 'need a folder'),
    (['--runs', '0'], 1, 'at least 1'),
    (['--scenario', 'nowhere.yaml'], 1, 'nowhere.yaml: cannot be read'),
    ([], 1, 'exists already')])
def test_it_says_what_is_wrong(tmp_path: Path, capsys, arguments: List[str], code: int,
                               message: str) -> None:
    path = tmp_path / 'run.bag'
    if not arguments:
        path.write_text('precious')
    assert simulate.main(['-o', str(path), '--duration', '2', *arguments]) == code
    assert message in capsys.readouterr().err
    assert not path.exists() or path.read_text() == 'precious'


def test_a_component_may_be_named_as_its_node(tmp_path: Path) -> None:
    """So it is called where models are calibrated."""
    assert simulate.main(['-o', str(tmp_path), '--duration', '20', '--fault',
                          'crash:/player@10']) == 0
    assert (tmp_path / 'crash_player_1.bag').is_file()
    assert "no component 'nobody'" in error_of(induce, ['crash:/nobody'])
