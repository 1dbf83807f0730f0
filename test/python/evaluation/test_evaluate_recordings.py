"""`evaluate recordings`: what is counted, the files, and a folder that lacks a recording."""
from __future__ import annotations

from pathlib import Path
from typing import Any, List, Optional

import pytest

from self_awareness.parts import BagPart
from self_awareness.stamps import SECOND_NS
from self_awareness_evaluation import evaluate, outages
from self_awareness_evaluation.experiment import Unit
from self_awareness_evaluation.outages import Case, JudgedCase, Span
from self_awareness_evaluation.records import NORMAL, REAL, SystemAlarm
from self_awareness_evaluation.rows import HOUR_S, Row, load
from self_awareness_evaluation.variants import Variant

FIRST = 1_600_000_000 * SECOND_NS


def rows_of(alarms: List[Span], monkeypatch: pytest.MonkeyPatch) -> List[Row]:
    """Let a system that raises these alarms judge a recording of 100 s, with an outage or not."""
    normal = BagPart('a.bag')
    cases = (Case('faulty', normal, normal, 'a.bag', (50.0, 60.0), ((10.0, 50.0), (70.0, 1e9))),
             Case('healthy', normal, normal, 'a.bag', None, ((0.0, 1e9),)))
    raised = [SystemAlarm(FIRST + round(start * SECOND_NS), FIRST + round(end * SECOND_NS), True,
                          [], culprit='/a') for start, end in alarms]
    said = JudgedCase(raised, [], FIRST, FIRST + 100 * SECOND_NS, 3)
    monkeypatch.setattr(outages, 'SYSTEMS', {'oracle': lambda *_: said})
    unit = Unit(lambda _: [], REAL, 'a case', (Variant('oracle'),))
    return [row for case in cases for row in outages.rows(case, Path(), unit)]


@pytest.mark.parametrize('alarms, false, standing_s, latency_s, stood, level', [
    # Start-up and the time after the outage are not counted, but the alarm may not stay in them.
    ([(5.0, 12.0), (50.5, 72.0)], 0, 4.0, 0.5, False, 'ERROR'),
    ([(48.0, 55.0), (56.0, 57.0)], 1, 2.0, 6.0, True, ''),
    ([(61.0, 65.0), (80.0, 81.0)], 1, 1.0, None, False, '')])
def test_an_alarm_in_the_outage_finds_it_and_others_are_false(
        alarms: List[Span], false: int, standing_s: float, latency_s: Optional[float], stood: bool,
        level: str, monkeypatch: pytest.MonkeyPatch) -> None:
    normal, outage, healthy = rows_of(alarms, monkeypatch)
    assert (normal.watched, normal.alarms) == (3, false)
    assert normal.hours * HOUR_S == pytest.approx(70.0)
    assert normal.standing_hours * HOUR_S == pytest.approx(standing_s)
    assert (outage.stood_before, outage.level) == (stood, level)
    assert outage.latency_s == (latency_s and pytest.approx(latency_s))
    assert outage.culprit == ('/a' if level else '')
    assert (healthy.fault, healthy.alarms) == (NORMAL, len(alarms))
    assert healthy.standing_hours * HOUR_S == pytest.approx(sum(end - begin
                                                                for begin, end in alarms))


def test_a_folder_without_the_recordings_is_told(tmp_path: Path, capsys: Any) -> None:
    output = tmp_path / 'out'
    assert evaluate.main(['recordings', '--data', str(tmp_path), '-o', str(output)]) == 1
    error = capsys.readouterr().err
    assert str(tmp_path / 'wheeled_robot') in error and '--data' in error
    assert not output.exists()


def test_every_case_and_system_has_a_row(shared: Path, tmp_path: Path, monkeypatch) -> None:
    monkeypatch.chdir(shared)
    output = tmp_path / 'out'
    assert evaluate.main(['recordings', '--data', 'data', '-o', str(output)]) == 0
    rows = load(output / 'full' / 'recordings.csv', Row)
    assert ([(row.subject.robot, row.subject.system) for row in rows if row.fault == NORMAL]
            == [(case.name, system) for case in outages.CASES
                for system in ('evidence', 'paper', 'frequency_learned')])
    page = (output / 'research.md').read_text(encoding='utf-8')
    assert page.count('\n| wheeled_robot') == 6 and page.count('\n| social_robot') == 9
    assert str(shared) not in page and 'evaluate recordings --data data' in page
    of_outages = {(row.subject.robot, row.subject.system): row for row in rows
                  if row.fault == outages.OUTAGE}
    found = of_outages['wheeled_robot, 13 February', 'evidence']
    assert found.watched == 5 and found.latency_s is not None and found.level == 'ERROR'
    assert of_outages['wheeled_robot, 13 February', 'frequency_learned'].watched == 0
    assert of_outages['wheeled_robot, 17 January', 'evidence'].stood_before
