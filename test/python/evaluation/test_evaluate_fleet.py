"""Robots of one make: what was learned on some watches another, and the page on how well."""
from __future__ import annotations

import pickle
from pathlib import Path

import numpy as np
import pytest

from self_awareness.workers import InProcess, Processes
from self_awareness_evaluation import evaluate
from self_awareness_evaluation.detectors import Evidence
from self_awareness_evaluation.fleet import cluster, experiment, report
from self_awareness_evaluation.fleet.experiment import (FLEET, OWN, DeathRow, NormalRow, Plan,
                                                        Results)
from self_awareness_evaluation.fleet.make import draw, renamed, renamed_graph


def test_robots_of_a_make_differ_by_their_clocks_an_arm_and_a_sensor() -> None:
    first, second = draw(3, 0), draw(3, 1)
    names = [{kind.source for kind in renamed(robot.start(1, 20.0), 'x').event_types}
             for robot in (first, second)]
    assert names[0] - names[1] == {'/arm', '/gripper_1', '/gripper_2', '/sensor0'}
    assert names[1] - names[0] == {'/sensor1'}
    assert '/r1/driver0' in second.sources and '/driver0' in names[1]
    assert renamed_graph(first) >= renamed_graph(second)
    clocks = [[getattr(output.emission, 'ppm', None) for output in robot.outputs[:10]]
              for robot in (first, second)]
    assert clocks[0] != clocks[1]


def test_a_small_fleet_watches_another_robot(tmp_path: Path) -> None:
    plan = Plan((1,), 3, 2, 1, 60.0, 0.1, 0.5)
    results = experiment.run(plan, InProcess())
    deaths = {model: {row.source: row for row in results.deaths if row.model == model}
              for model in (FLEET, OWN)}
    assert set(deaths[FLEET]) == set(deaths[OWN]) and '/sensor4' in deaths[OWN]
    assert not deaths[FLEET]['/sensor4'].watched and deaths[OWN]['/sensor4'].watched
    found = [row for row in deaths[FLEET].values() if row.watched]
    assert len(found) > 20 and all(row.latency_s is not None for row in found)
    page, *_ = report.write(tmp_path, plan, results, 'evaluate fleet')
    assert 'Not watched by `fleet`: /sensor4.' in page.read_text()


PLAN = Plan((1,), 3, 2, 1, 60.0, 0.02, 0.5)


@pytest.fixture(name='in_process', scope='module')
def _in_process() -> Results:
    return experiment.run(PLAN, InProcess())


def test_processes_find_the_same(in_process: Results) -> None:
    assert experiment.run(PLAN, Processes(2)) == in_process


def test_a_dask_cluster_on_this_machine_finds_the_same(in_process: Results) -> None:
    pytest.importorskip('distributed', reason='python3-distributed is not installed')
    with cluster.cluster_here(2) as workers:
        assert experiment.run(PLAN, workers) == in_process


def test_counts_of_robots_add_up_to_what_one_learner_learns() -> None:
    fleet = experiment.learned(PLAN, 1, range(3), InProcess())
    starts = experiment.training_of(PLAN, 1, range(3))
    assert len(starts) == 6
    alone = Evidence(set().union(*(renamed_graph(start.robot) for start in starts)))
    alone.train([start.recording() for start in starts])
    alone.calibrate([start.recording() for start in experiment.calibration_of(PLAN, 1, range(3))])
    judged = renamed(draw(1, 4).start(1000, 60.0), '')
    again = pickle.loads(pickle.dumps(fleet))  # as it is handed over to other machines
    for system in (fleet, again):
        assert np.array_equal(system.judge(judged).score, alone.judge(judged).score)
        assert system.watched == alone.watched
        assert system.expected_per_hour == alone.expected_per_hour


def test_a_cluster_that_does_not_start_says_why(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cluster.sys, 'executable', '/bin/false')
    with pytest.raises(ValueError, match='the scheduler .* does not start .*python3-distributed'):
        with cluster.cluster_here(1):
            pass


def test_the_page_compares_the_deaths_that_both_watch(tmp_path: Path) -> None:
    results = experiment.Results(
        [NormalRow(1, FLEET, 10.0, 1, 0.5, ('overdue',)), NormalRow(1, OWN, 10.0, 0, 0.5, ())],
        [DeathRow(1, FLEET, '/a', True, 1.2, True), DeathRow(1, OWN, '/a', True, 1.0, True),
         DeathRow(1, FLEET, '/b', True, None, None), DeathRow(1, OWN, '/b', True, 1.0, True),
         DeathRow(1, FLEET, '/c', False, None, None), DeathRow(1, OWN, '/c', True, 1.0, True)])
    plan = Plan((1,), 20, 2, 1, 150.0, 10.0, 0.5, 2, True)
    text = report.write(tmp_path, plan, results, 'evaluate fleet')[0].read_text()
    assert 'Of the 2 deaths that both models watch, `fleet` found 1.' in text
    assert '1 of 2 by 0.2 s at most' in text
    assert 'judged by 2 processes of a dask cluster on one machine, as' in text
    assert '| fleet | 1 | 0.1 ' in text and '| own | 0 | 0 ' in text
    assert (tmp_path / 'fleet_deaths.csv').read_text().count('\n') == 7


def test_more_robots_than_a_make_has_are_refused(tmp_path: Path,
                                                 capsys: pytest.CaptureFixture) -> None:
    assert evaluate.main(['fleet', '--robots', '90', '-o', str(tmp_path)]) == 1
    assert '--robots 90: of so many starts each, no more than 45' in capsys.readouterr().err
