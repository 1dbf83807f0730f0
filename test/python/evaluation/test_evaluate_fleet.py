"""Robots of one make: what was learned on some watches another, and the page on how well."""
from __future__ import annotations

from pathlib import Path

import pytest

from self_awareness_evaluation import evaluate
from self_awareness_evaluation.fleet import experiment, report
from self_awareness_evaluation.fleet.experiment import FLEET, OWN, DeathRow, NormalRow, Plan
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
    results = experiment.run(plan, 1)
    deaths = {model: {row.source: row for row in results.deaths if row.model == model}
              for model in (FLEET, OWN)}
    assert set(deaths[FLEET]) == set(deaths[OWN]) and '/sensor4' in deaths[OWN]
    assert not deaths[FLEET]['/sensor4'].watched and deaths[OWN]['/sensor4'].watched
    found = [row for row in deaths[FLEET].values() if row.watched]
    assert len(found) > 20 and all(row.latency_s is not None for row in found)
    page, *_ = report.write(tmp_path, plan, results, 'evaluate fleet')
    assert 'Not watched by `fleet`: /sensor4.' in page.read_text()


def test_the_page_compares_the_deaths_that_both_watch(tmp_path: Path) -> None:
    results = experiment.Results(
        [NormalRow(1, FLEET, 10.0, 1, 0.5, ('overdue',)), NormalRow(1, OWN, 10.0, 0, 0.5, ())],
        [DeathRow(1, FLEET, '/a', True, 1.2, True), DeathRow(1, OWN, '/a', True, 1.0, True),
         DeathRow(1, FLEET, '/b', True, None, None), DeathRow(1, OWN, '/b', True, 1.0, True),
         DeathRow(1, FLEET, '/c', False, None, None), DeathRow(1, OWN, '/c', True, 1.0, True)])
    plan = Plan((1,), 20, 2, 1, 150.0, 10.0, 0.5)
    text = report.write(tmp_path, plan, results, 'evaluate fleet')[0].read_text()
    assert 'Of the 2 deaths that both models watch, `fleet` found 1.' in text
    assert '1 of 2 by 0.2 s at most' in text
    assert '| fleet | 1 | 0.1 ' in text and '| own | 0 | 0 ' in text
    assert (tmp_path / 'fleet_deaths.csv').read_text().count('\n') == 7


def test_more_robots_than_a_make_has_are_refused(tmp_path: Path,
                                                 capsys: pytest.CaptureFixture) -> None:
    assert evaluate.main(['fleet', '--robots', '90', '-o', str(tmp_path)]) == 1
    assert '--robots 90: of so many starts each, no more than 45' in capsys.readouterr().err
