"""Robots in one mode: what is recorded of them, what dies, and what the page says."""
from __future__ import annotations

from pathlib import Path
from typing import Dict, List, Optional

import numpy as np
import pytest

from self_awareness_evaluation import evaluate, pages
from self_awareness_evaluation.families.kinds import draw
from self_awareness_evaluation.families.measures import FaultRow, NormalRow, Subject
from self_awareness_evaluation.families.protocol import Learning, Records
from self_awareness_evaluation.families.robot import CRASH
from self_awareness_evaluation.modes import experiment, report
from self_awareness_evaluation.modes.experiment import ALONE, BOTH, DeathRow, Plan, Results
from self_awareness_evaluation.windowed_events import WindowedEvents, stamps_by


def of_topics(recording: WindowedEvents) -> Dict[str, np.ndarray]:
    return stamps_by(recording, lambda event_type: event_type.scope)


def test_a_robot_in_a_mode_never_leaves_it() -> None:
    robot = draw('driving_docked', 3)
    changing, active, idle = (of_topics(each.start(5, 600.0)) for each in (
        robot, robot.in_mode(True), robot.in_mode(False)))
    motion = {topic for topic in active if '/motion' in topic}
    assert set(active) - set(idle) == motion and set(idle) == {
        topic for topic in changing if '/motion' not in topic}
    for topic, rate in (('/motion0/data', 10.0), ('/motion2/data', 50.0)):
        assert len(active[topic]) == pytest.approx(600.0 * rate, abs=2)
        assert len(changing.get(topic, [])) < 590.0 * rate
    # All else is the same start: its timers tick as they do.
    for topic in ('/driver0/data', '/driver5/data'):
        assert np.array_equal(changing[topic], active[topic])
        assert np.array_equal(changing[topic], idle[topic])


@pytest.mark.parametrize('family', experiment.FAMILIES)
def test_who_is_regular_in_a_mode_dies_in_it(family: str) -> None:
    died = {on: {fault.source for fault in Records(family, 2, on).faults((CRASH,))}
            for on in (True, False)}
    assert died[False] <= died[True] and died[False]
    if family in ('driving_docked', 'long_pauses'):
        assert died[True] > died[False]


def test_both_models_judge_the_same_deaths() -> None:
    plan = Plan(('long_pauses',), (2,), Learning(2, 60.0, 1, 60.0), 0.02)
    results = experiment.run(plan, 1)
    assert sum(row.hours for row in results.normal) == pytest.approx(0.02, abs=0.002)
    died: Dict[str, List[str]] = {
        model: [f'{row.mode} {row.fault.kind} {row.fault.source}' for row in results.deaths
                if row.model == model] for model in (BOTH, ALONE)}
    assert died[BOTH] == died[ALONE] and len(set(died[BOTH])) == len(died[BOTH]) > 10
    assert sum(row.fault.latency_s is not None for row in results.deaths) > 15


SUBJECT = Subject('driving_docked', 1, '4 x 600 s + 2 x 600 s', 'evidence', 0.5)


def death(source: str, both_s: Optional[float], alone_s: Optional[float],
          mode: str = 'active') -> List[DeathRow]:
    return [DeathRow(mode, model, FaultRow(SUBJECT, CRASH, source, False, latency_s,
                                           None if latency_s is None else True, None))
            for model, latency_s in ((BOTH, both_s), (ALONE, alone_s))]


def test_the_page_says_what_is_met(tmp_path: Path) -> None:
    plan = Plan(('driving_docked',), (1,), Learning.of(4, 600.0, 600.0), 10.0)
    normal = [NormalRow(SUBJECT, 10.0, 1, 0.1, 1, ('overdue',), 0.3)]
    results = Results(normal, [*death('/a', 1.0, 0.5), *death('/b', 0.6, 0.5),
                               *death('/c', 0.3, 0.3), *death('/d', None, 0.3),
                               *death('/e', 4.0, 0.4, 'idle')])
    text = report.write(tmp_path, plan, results, 'evaluate modes')[-1].read_text()
    assert '| deaths found within 50 s | 98 % | 80 %, 4 of 5 | not met |' in text
    assert 'by the mode alone, median | 1.2 | 2.00; 2 of 5 no more | not met |' in text
    assert '| false alarms an hour (95 %) | 0.05 | 0.1 (' in text
    assert '1 in 10 h | not met |' in text
    row, = [line for line in text.splitlines() if line.startswith('| driving_docked | active')]
    assert row == ('| driving_docked | active | 3 / 3 / 3 of 4, 0.60 s | 4 / 4 / 4 of 4, 0.30 s '
                   '| 1.20, not found | 3 of 3 | 1 in 10 h (0.1/h) |')
    assert len(pages.written(text)) == 1
    assert (tmp_path / 'full' / 'modes_deaths.csv').read_text().count('\n') == 11


def test_families_without_modes_are_refused(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    assert evaluate.main(['modes', '--families', 'timers', '-o', str(tmp_path)]) == 2
    assert 'timers' in capsys.readouterr().err
