"""`evaluate recordings`: what is counted, the files, and a folder that lacks a recording."""
from __future__ import annotations

import csv
from pathlib import Path
from typing import Any, List

import pytest

from self_awareness.parts import BagPart
from self_awareness_evaluation import evaluate
from self_awareness_evaluation.recordings import outages
from self_awareness_evaluation.recordings.outages import Case, JudgedCase, OutageRow, Span


def rows_of(alarms: List[Span], tmp_path: Path,
            monkeypatch: pytest.MonkeyPatch) -> List[OutageRow]:
    """Let a system that raises these alarms judge a recording of 100 s, with an outage or not."""
    (tmp_path / 'a.bag').touch()
    normal = BagPart('a.bag')
    monkeypatch.setattr(outages, 'CASES', (
        Case('faulty', normal, normal, 'a.bag', (50.0, 60.0), ((10.0, 50.0), (70.0, 1e9))),
        Case('healthy', normal, normal, 'a.bag', None, ((0.0, 1e9),))))
    monkeypatch.setattr(outages, 'SYSTEMS',
                        {'oracle': lambda *_: JudgedCase(alarms, 100.0, 3)})
    return outages.evaluate(tmp_path)


def test_an_alarm_in_the_outage_finds_it(tmp_path: Path, monkeypatch) -> None:
    faulty, healthy = rows_of([(5.0, 12.0), (50.5, 72.0)], tmp_path, monkeypatch)
    # Start-up and the time after the outage are not counted, but the alarm may not stay in them.
    assert faulty == OutageRow('faulty', 'oracle', 3, True, False, 0.5, 0, pytest.approx(4.0),
                               70.0)
    assert healthy == OutageRow('healthy', 'oracle', 3, None, False, None, 2, pytest.approx(28.5),
                                100.0)


def test_an_alarm_that_stood_before_is_false(tmp_path: Path, monkeypatch) -> None:
    faulty, _ = rows_of([(48.0, 55.0), (56.0, 57.0)], tmp_path, monkeypatch)
    assert (faulty.outage_found, faulty.stood_before, faulty.false_alarms) == (True, True, 1)
    assert faulty.latency_s == pytest.approx(6.0) and faulty.false_s == pytest.approx(2.0)


def test_an_alarm_after_the_outage_does_not_find_it(tmp_path: Path, monkeypatch) -> None:
    faulty, _ = rows_of([(61.0, 65.0), (80.0, 81.0)], tmp_path, monkeypatch)
    assert (faulty.outage_found, faulty.latency_s, faulty.false_alarms) == (False, None, 1)


def test_a_folder_without_the_recordings_is_told(tmp_path: Path, capsys: Any) -> None:
    output = tmp_path / 'out'
    assert evaluate.main(['recordings', '--data', str(tmp_path), '-o', str(output)]) == 1
    error = capsys.readouterr().err
    assert str(tmp_path / 'wheeled_robot') in error and '--data' in error
    assert not output.exists()


def test_every_case_and_system_has_a_row(shared: Path, tmp_path: Path, monkeypatch) -> None:
    monkeypatch.chdir(shared)
    assert evaluate.main(['recordings', '--data', 'data', '-o', str(tmp_path / 'out')]) == 0
    with open(tmp_path / 'out' / 'recordings.csv', encoding='utf-8', newline='') as file:
        rows = list(csv.DictReader(file))
    assert ([(row['recording'], row['system']) for row in rows]
            == [(case.name, system) for case in outages.CASES
                for system in ('evidence', 'paper', 'frequency_learned')])
    page = (tmp_path / 'out' / 'recordings.md').read_text(encoding='utf-8')
    assert page.count('\n| wheeled_robot') == 6 and page.count('\n| social_robot') == 9
    assert str(shared) not in page and 'evaluate recordings --data data' in page
    found = {row['recording']: row['outage_found'] for row in rows if row['system'] == 'evidence'}
    watched = {(row['recording'], row['system']): int(row['watched']) for row in rows}
    assert watched['wheeled_robot, 13 February', 'evidence'] == 5
    assert watched['wheeled_robot, 13 February', 'frequency_learned'] == 0
    assert [found[case.name] for case in outages.CASES] == ['True', 'True', '', '', '']
