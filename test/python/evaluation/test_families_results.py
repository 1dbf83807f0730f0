"""The families' protocol, what is measured, the figures with their intervals, and the page."""
from __future__ import annotations

import csv
import math
import re
from dataclasses import replace
from pathlib import Path
from typing import List, Optional, Set, Tuple

import numpy as np
import pytest

from self_awareness import DEFAULT_WINDOW, Tuning
from self_awareness.calibration import confidence
from self_awareness.stamps import SECOND_NS
from self_awareness_evaluation import evaluate
from self_awareness_evaluation.detectors import Evidence
from self_awareness_evaluation.families import experiment, summary, tables
from self_awareness_evaluation.families.experiment import Plan, Results
from self_awareness_evaluation.families.measures import (FaultRow, NormalRow, Subject, fault_row,
                                                         normal_row)
from self_awareness_evaluation.families.protocol import DEATH, FaultRecord, Learning, Records
from self_awareness_evaluation.families.robot import CRASH, HALF_RATE, LATE, RESTART
from self_awareness_evaluation.families.summary import ALL, Group, rate_interval
from self_awareness_evaluation.systems import Judged, SystemAlarm
from self_awareness_evaluation.windowed_events import WindowedEvents

TWO = Learning.of(2, 60.0, 60.0)


def begins(recordings: List[WindowedEvents]) -> List[float]:
    """Return when recordings begin [s]."""
    return [recording.stamps[0] / SECOND_NS for recording in recordings]


def test_half_as_many_starts_are_calibrated_on_but_one_at_least() -> None:
    assert [Learning.of(starts, 150.0, 60.0).calibrations for starts in (1, 2, 4, 8)] \
        == [1, 1, 2, 4]
    assert str(Learning.of(4, 150.0, 60.0)) == '4 x 150 s + 2 x 60 s'


@pytest.mark.parametrize('family,learned_in,watched_in',
                         [('timers', 4, 4), ('timers_one_start', 1, 4), ('stalls', 1, 1)])
def test_recordings_are_of_as_many_starts_as_the_family_says(family: str, learned_in: int,
                                                             watched_in: int) -> None:
    records = Records(family, 1)
    learned = begins(records.training(Learning.of(3, 20.0, 20.0))
                     + records.calibration(Learning.of(3, 20.0, 20.0)))
    watched = begins(list(records.watched(0.51)))
    assert len(learned) == 4 and len(watched) == 2
    # Starts lie more than a day apart, recordings of one start do not overlap.
    assert 1 + (np.diff(learned) > 86_400.0).sum() == learned_in
    assert 1 + (np.diff([learned[0], *watched]) > 86_400.0).sum() == (
        3 if watched_in == 4 else watched_in)
    assert min(np.diff(learned)) > 20.0


def test_watched_hours_are_those_that_were_asked_for() -> None:
    lengths = [(recording.end - recording.stamps[0]) / SECOND_NS
               for recording in Records('events_only', 1).watched(1.25)]
    assert lengths == pytest.approx([1800.0, 1800.0, 900.0], abs=5.0)


def test_every_component_has_its_faults() -> None:
    records = Records('bursty', 2)
    robot = records.robot
    found = [(fault.kind, fault.source) for fault in records.faults((CRASH, HALF_RATE, LATE))]
    assert found == [
        *((kind, source) for kind in (CRASH, HALF_RATE) for source in robot.regular),
        *((LATE, source) for source in robot.regular if source in robot.answering)]
    # Which faults are left out does not change the others.
    late = next(records.faults((LATE,))).recording
    same = next(fault.recording for fault in records.faults((CRASH, LATE)) if fault.kind == LATE)
    assert np.array_equal(late.stamps, same.stamps)


def test_a_death_counts_from_the_first_message_that_is_missing() -> None:
    deaths = list(Records('events_only', 1).faults((DEATH,)))
    assert 5 <= len(deaths) <= 9
    for death in deaths:
        of_source = np.array([kind.source == death.source
                              for kind in death.recording.event_types])
        stamps = death.recording.stamps[of_source[death.recording.ids]]
        assert (stamps < death.onset).all()
        assert death.onset < death.recording.end - 60 * SECOND_NS


SUBJECT = Subject('timers', 1, str(TWO), 'evidence', 0.5)
START = 1_000 * SECOND_NS


def judged(alarms: List[SystemAlarm], suspicion: Optional[List[int]] = None) -> Judged:
    """Return 100 windows, of which 50 settle."""
    start = START + DEFAULT_WINDOW * np.arange(100, dtype=np.int64)
    suspicious = np.zeros(100, dtype=bool)
    suspicious[suspicion or []] = True
    return Judged(start, np.zeros(100, dtype=bool), np.zeros(100), np.arange(100) < 50, alarms,
                  -1.0, suspicious)


def at(window: int) -> int:
    """Return the end of a window [ns]."""
    return START + (window + 1) * DEFAULT_WINDOW


def test_measures_of_normal_operation() -> None:
    found = judged([SystemAlarm(at(60), at(70), True, ['/a'], 'answers')], [80, 81, 90])
    row = normal_row(SUBJECT, replace(found, suspicions=[
        SystemAlarm(at(80), at(82), True, [], 'new mode'),
        SystemAlarm(at(90), at(91), True, ['/a'], 'pairs')]), 0.4)
    assert row.hours == pytest.approx(5.0 / 3600.0)
    assert row.standing_hours == pytest.approx(1.0 / 3600.0)
    assert (row.alarms, row.warnings, row.evidence, row.expected) == (1, 3, ('answers',), 0.4)
    assert row.suspicions == ('new mode', 'pairs')


def fault_at(window: int, kind: str = CRASH) -> FaultRecord:
    recording = WindowedEvents([], np.array([START]), np.array([0]), at(99))
    return FaultRecord(kind, '/a', recording, at(window) - 1)


def test_measures_of_a_fault() -> None:
    alarms = [SystemAlarm(at(60), at(62), True, ['/a']),
              SystemAlarm(at(80), at(90), True, ['/b', '/a'])]
    row = fault_row(SUBJECT, fault_at(70), judged(alarms))
    assert row.latency_s == pytest.approx(1.0, abs=1e-6)
    assert (row.first, row.among_three, row.stood_before) == (False, True, False)
    row = fault_row(SUBJECT, fault_at(59), judged(alarms))
    assert (row.latency_s, row.first) == (pytest.approx(0.1, abs=1e-6), True)
    row = fault_row(SUBJECT, fault_at(90), judged(alarms))
    assert (row.latency_s, row.first, row.among_three) == (None, None, None)


def test_alarms_for_who_is_back_are_counted_apart() -> None:
    alarms = [SystemAlarm(at(71), at(90), True, ['/a']), SystemAlarm(at(121), at(125), True, []),
              SystemAlarm(at(131), at(140), True, ['/a'])]
    record = replace(fault_at(70, RESTART), back=at(80))  # windows of 0.1 s, so 5 s are fifty
    row = fault_row(SUBJECT, record, judged(alarms))
    assert row.latency_s == pytest.approx(0.1, abs=1e-6) and row.after == 1
    row = fault_row(SUBJECT, record, judged(alarms[2:]))
    assert (row.latency_s, row.first, row.after) == (None, None, 1)
    assert fault_row(SUBJECT, fault_at(70), judged(alarms)).after is None


def test_a_false_alarm_that_stands_at_the_onset_is_told() -> None:
    for alarm, stood in ((SystemAlarm(at(60), at(69), True, []), False),
                         (SystemAlarm(at(60), at(71), True, []), True),
                         (SystemAlarm(at(60), at(99), False, []), True),
                         (SystemAlarm(at(71), at(99), False, []), False)):
        assert fault_row(SUBJECT, fault_at(70), judged([alarm])).stood_before == stood


def normal(seed: int, alarms: int, hours: float = 1.0, system: str = 'evidence',
           family: str = 'timers', budget: Optional[float] = 0.5) -> NormalRow:
    """Return a row of a recording."""
    return NormalRow(Subject(family, seed, str(TWO), system, budget), hours, alarms,
                     0.001 * alarms, 2 * alarms, ('answers',) * alarms, 0.25 * seed)


def fault(kind: str, latency_s: Optional[float], first: Optional[bool],
          family: str = 'timers', system: str = 'evidence') -> FaultRow:
    """Return a row of a fault."""
    return FaultRow(Subject(family, 1, str(TWO), system, 0.5), kind, '/a', latency_s is None,
                    latency_s, first, None if first is None else True)


def test_figures_of_normal_operation() -> None:
    rows = [normal(1, 3), normal(1, 1), normal(2, 0, 2.0)]
    quiet = summary.quiet(rows)
    assert (quiet.robots, quiet.hours, quiet.alarms, quiet.per_hour) == (2, 4.0, 4, 1.0)
    assert (quiet.standing, quiet.warnings_per_hour) == (pytest.approx(0.001), 2.0)
    assert quiet.evidence == (('answers', 4),)
    assert quiet.expected_per_hour == pytest.approx((0.25 + 0.5) / 2)  # the mean of the robots
    assert summary.kept(rows) == 0.5


def test_robots_that_differ_widen_the_interval() -> None:
    assert rate_interval([(5, 10.0), (5, 10.0)]) == confidence.poisson_rate(10, 20.0)
    low, high = rate_interval([(10, 10.0), (0, 10.0)])
    # Chi-square is 25 / 5 + 25 / 5 = 10 at one degree of freedom.
    assert (low, high) == pytest.approx(confidence.poisson_rate(1, 2.0))
    assert rate_interval([(0, 10.0), (0, 10.0)]) == confidence.poisson_rate(0, 20.0)


def test_figures_of_faults() -> None:
    rows = [fault(CRASH, 0.4, True), fault(CRASH, 4.0, False), fault(CRASH, None, None),
            fault(LATE, 0.1, True), fault(CRASH, 0.1, True, family='large'),
            fault(CRASH, 0.1, True, system='gaps')]
    group = Group('timers', str(TWO), 'evidence', 0.5)
    crash = summary.found(rows, group, CRASH)
    assert (crash.records, crash.stood_before) == (3, pytest.approx(1 / 3))
    assert [crash.within(s) for s in (0.3, 1.0, 5.0)] == pytest.approx([0.0, 1 / 3, 2 / 3])
    assert crash.within() == pytest.approx(2 / 3)
    assert crash.interval() == confidence.wilson(2, 3)
    assert (crash.median_s, crash.first, crash.among_three) == (4.0, 0.5, 1.0)
    assert summary.found(rows, Group(ALL, str(TWO), 'evidence', 0.5), CRASH).records == 4
    none = summary.found(rows, group, HALF_RATE)
    assert none.records == 0 and math.isnan(none.within()) and math.isnan(none.median_s)


def test_the_detector_gets_the_graph_of_the_robot_and_the_budget(
        monkeypatch: pytest.MonkeyPatch) -> None:
    made = []

    class Told(Evidence):
        """Remembers what it was told."""

        def __init__(self, graph: Set[Tuple[str, str, str]], budget: float,
                     tuning: Tuning) -> None:
            super().__init__(graph, budget=budget, tuning=tuning)
            made.append((graph, budget))

    monkeypatch.setattr(experiment, 'Evidence', Told)
    plan = Plan(('events_only',), (1,), (TWO,), ('evidence', 'evidence_no_graph', 'gaps'),
                (0.5, 5.0), 0.1, ())
    results = experiment.run_robot(plan, ('events_only', 1))
    graph = Records('events_only', 1).robot.graph
    assert made == [(graph, 0.5), (graph, 5.0), (set(), 0.5), (set(), 5.0)]
    assert [(row.subject.system, row.subject.budget) for row in results.normal] == [
        ('evidence', 0.5), ('evidence', 5.0), ('evidence_no_graph', 0.5),
        ('evidence_no_graph', 5.0), ('gaps', None)]
    assert results.faults == []


def test_the_table_tells_what_was_found() -> None:
    results = Results([normal(1, 12, 2.0), normal(2, 0, 2.0),
                       normal(1, 1, 2.0, 'gaps', budget=None),
                       normal(2, 0, 2.0, 'gaps', budget=None)],
                      [fault(CRASH, 0.4, True), fault(CRASH, 4.0, False), fault(CRASH, None, None),
                       fault(LATE, 0.1, True), fault(HALF_RATE, None, None),
                       replace(fault(RESTART, 0.4, True), after=0),
                       replace(fault(RESTART, None, None), after=3)])
    plan = Plan(('timers',), (1, 2), (TWO,), ('evidence', 'gaps'), (0.5,), 4.0, (CRASH, LATE))
    low, high = rate_interval([(12, 2.0), (0, 2.0)])
    assert tables.families_table(plan, results)[2:] == [
        f'| timers | 3 ({low:.2g} to {high:.0f}) | 0.25 (0.044 to 1.4) | 0.3 % | 6 '
        '| 33 / 67 / 67 %, first 50 % | 0 %, – | 100 %, 0.10 s, first 100 % | – | – | – | – | – '
        '| 3 after 2 | – / – of – | answers 12 |']
    assert tables.budgets_table(plan, results)[2:] == [
        f'| 2 starts | 0.5 | 0.38 | 3 ({low:.2g} to {high:.0f}) | 50 % |']


@pytest.fixture(name='written', scope='module')
def _written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp('families') / 'new'
    assert evaluate.main([
        'families', '--families', 'events_only', 'bursty', '--robots', '1', '--seed', '3',
        '--starts', '1', '2', '--training', '60', '--calibration', '60', '--hours', '0.1',
        '--systems', 'evidence', 'gaps', '--budgets', '0.5', '5', '--faults', 'crash', 'late',
        '--jobs', '2', '-o', str(folder)]) == 0
    return folder


def cells(line: str) -> List[str]:
    """Return the cells of a line of a table."""
    return [cell.strip() for cell in line.split('|')[1:-1]]


def test_the_page_has_a_table_of_families_and_one_of_budgets(written: Path) -> None:
    page = (written / 'families.md').read_text(encoding='utf-8')
    assert 'rosrun self_awareness evaluate families --families events_only bursty' in page
    tables = [block.split('\n') for block in page.split('\n\n') if block.startswith('| ')]
    assert len(tables) == 2
    head = cells(tables[0][0])
    assert head[:5] == ['family', 'false alarms/h, 1 start', 'false alarms/h, 2 starts',
                        'gaps, 2 starts', 'alarm stands']
    assert [cells(line)[0] for line in tables[0][2:5]] == ['events_only', 'bursty', 'all']
    assert all(len(cells(line)) == len(head) for line in tables[0] if line)
    bursty = dict(zip(head, cells(tables[0][3])))
    crash = re.fullmatch(r'(\d+) / (\d+) / (\d+) %, first \d+ %',
                         bursty['crash, within 1 / 5 / 50 s'])
    assert crash is not None
    assert 30 < int(crash[1]) <= int(crash[2]) <= int(crash[3]) <= 100
    assert bursty['half rate'] == '–'
    assert [cells(line)[:2] for line in tables[1][2:6]] == [
        ['1 start', '0.5'], ['1 start', '5'], ['2 starts', '0.5'], ['2 starts', '5']]
    assert 'nan' not in page and 'inf' not in page.replace('info', '')


def test_the_csv_files_have_all_figures(written: Path) -> None:
    with open(written / 'families.csv', encoding='utf-8', newline='') as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 3 * 2 * 3  # families and all, learnings, budgets and the peer
    with open(written / 'full' / 'families_faults.csv', encoding='utf-8', newline='') as file:
        faults = list(csv.DictReader(file))
    robot = Records('bursty', 3).robot
    crashes = [row for row in faults if row['family'] == 'bursty' and row['kind'] == CRASH
               and row['system'] == 'gaps' and row['learning'].startswith('2')]
    assert [row['source'] for row in crashes] == robot.regular
    assert {row['budget'] for row in faults if row['system'] == 'evidence'} == {'0.5'}
    found = sum(row['latency_s'] != '' for row in crashes) / len(crashes)
    figure = next(row for row in rows if (row['family'], row['system']) == ('bursty', 'gaps')
                  and row['learning'].startswith('2'))
    assert float(figure['crash_found']) == pytest.approx(found, abs=0.005)
    assert figure['half_found'] == ''  # there are no such records


@pytest.mark.parametrize('wrong', [['--families', 'cars'], ['--starts', '0'], ['--starts', '17'],
                                   ['--hours', '0'], ['--budgets', '0'], ['--faults', 'stall'],
                                   ['--systems', 'oracle'], ['--seed', '0']])
def test_wrong_arguments_are_refused(wrong: List[str], tmp_path: Path,
                                     capsys: pytest.CaptureFixture) -> None:
    assert evaluate.main(['families', '-o', str(tmp_path / 'out'), *wrong]) == 2
    assert wrong[1] in capsys.readouterr().err
    assert not (tmp_path / 'out').exists()


def test_more_hours_than_a_start_lasts_are_refused(tmp_path: Path,
                                                   capsys: pytest.CaptureFixture) -> None:
    assert evaluate.main(['families', '--families', 'timers', 'stalls', '--hours', '20',
                          '-o', str(tmp_path)]) == 1
    assert 'stalls can be watched for 15 hours' in capsys.readouterr().err


def test_every_system_says_how_many_components_it_watches() -> None:
    plan = Plan(('events_only',), (1,), (TWO,), ('evidence', 'gaps', 'markov'), (0.5,), 0.1, ())
    rows = experiment.run_robot(plan, ('events_only', 1)).normal
    watched = {row.subject.system: row.watched for row in rows}
    components = len(Records('events_only', 1).robot.sources)
    assert {row.components for row in rows} == {components}
    assert watched['markov'] is None, 'it judges all together'
    assert watched['evidence'] is not None and 0 < watched['evidence'] <= components
    assert watched['gaps'] == components
    table = '\n'.join(tables.families_table(plan, Results(rows, [])))
    assert 'watched: evidence / gaps / markov' in table
    assert f'| {watched["evidence"]} / {components} / – of {components} |' in table
