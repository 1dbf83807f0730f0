"""`simulate`: recordings as they come from a real robot, of several starts and with its graph."""
from __future__ import annotations

import os
from pathlib import Path
from typing import List

import pytest
import rosbag

from self_awareness import EncodingRules
from self_awareness.commands import induce, simulate
from self_awareness.training.robot_graph import RobotGraph, graph_file

DAY_S = 86_400


@pytest.fixture(scope='module')
def runs(tmp_path_factory: pytest.TempPathFactory) -> List[Path]:
    folder = tmp_path_factory.mktemp('runs')
    assert simulate.main(['-o', str(folder), '--runs', '2', '--duration', '60']) == 0
    return [folder / f'normal_{seed}.bag' for seed in (1, 2)]


def test_each_run_is_a_start_of_the_robot_on_a_day_of_its_own(runs: List[Path]) -> None:
    starts = []
    for path in runs:
        with rosbag.Bag(str(path)) as bag:
            starts.append(bag.get_start_time())
    assert starts[1] - starts[0] == pytest.approx(DAY_S, abs=1.0)


def test_the_same_seed_is_the_same_start_whatever_its_number(runs: List[Path],
                                                             tmp_path: Path) -> None:
    again = tmp_path / 'again.bag'
    assert simulate.main(['-o', str(again), '--seed', '2', '--duration', '60']) == 0
    assert again.stat().st_size == runs[1].stat().st_size
    with rosbag.Bag(str(again)) as one, rosbag.Bag(str(runs[1])) as other:
        assert one.get_start_time() == other.get_start_time()


@pytest.mark.parametrize('seed', ['-1', '123456789012345678901234567890'])
def test_any_seed_is_a_time_that_fits_into_a_bag(seed: str, tmp_path: Path) -> None:
    assert simulate.main(['-o', str(tmp_path / 'a.bag'), '--seed', seed, '--duration', '1']) == 0


@pytest.mark.parametrize('duration', ['inf', 'nan', '0', '-1', 'x'])
def test_a_duration_that_is_none_is_refused(duration: str, tmp_path: Path, capsys) -> None:
    assert simulate.main(['-o', str(tmp_path / 'a.bag'), '--duration', duration]) == 2
    assert '--duration' in capsys.readouterr().err
    assert os.listdir(tmp_path) == []


def test_the_graph_lies_beside_the_bags(runs: List[Path]) -> None:
    for run in runs:
        graph = RobotGraph.load(graph_file(str(run))).edges(EncodingRules())
        assert ('/player', '/scan', '/slam') in graph


def test_a_component_may_be_named_as_its_node(tmp_path: Path, capsys) -> None:
    """So it is called where models are calibrated."""
    assert simulate.main(['-o', str(tmp_path), '--duration', '20', '--fault',
                          'crash:/player@10']) == 0
    assert (tmp_path / 'crash_player_1.bag').is_file()
    assert induce.main(['crash:/nobody']) == 1
    assert "no component 'nobody'" in capsys.readouterr().err
