"""The live evaluation without ROS: from statuses to samples, from samples to tables and files."""
from __future__ import annotations

import csv
from dataclasses import replace
from pathlib import Path
from typing import List

import pytest

from self_awareness.stamps import SECOND_NS
from self_awareness_evaluation import evaluate
from self_awareness_evaluation.live import report
from self_awareness_evaluation.live.offline import Found
from self_awareness_evaluation.live.processes import LiveError, Processes, await_condition
from self_awareness_evaluation.live.samples import (ERROR, WARN, Sample, Status, Stretch, measure,
                                                    measure_alarms)
from self_awareness_evaluation.live.session import SessionPlan
from self_awareness_evaluation.records import NORMAL
from self_awareness_evaluation.systems import SystemAlarm

ONSET = 1000.0
CRASH = Stretch(2, 'cc1', ONSET, ONSET + 8.0, ('/player',))


def statuses(**levels: int) -> List[Status]:
    """Return 12 s of statuses from 2 s before the onset on.

    Args:
        levels: by the window from when on they hold: w21 ends 0.1 s after the onset.
    """
    result, level = [], 0
    for window in range(120):
        level = levels.get(f'w{window}', level)
        stamp = ONSET - 2.0 + window / 10.0
        result.append(Status(stamp, stamp + 0.03, level, False, 'overdue' if level else '',
                             ('/slam', '/player') if level else ()))
    return result


def test_latency_and_blame_are_those_of_the_first_error() -> None:
    sample = measure('evidence', CRASH, statuses(w22=WARN, w23=ERROR, w60=0))
    assert sample.void == ''
    assert sample.suspicion_s == pytest.approx(0.2)
    assert sample.latency_s == pytest.approx(0.3)
    assert sample.received_s == pytest.approx(0.33)
    assert (sample.top1, sample.top3) == (False, True)
    assert (sample.suspects, sample.evidence) == ('/slam /player', 'overdue')


def test_error_after_the_fault_does_not_count() -> None:
    sample = measure('evidence', CRASH, statuses(w50=WARN, w60=0, w105=ERROR))
    assert sample.suspicion_s == pytest.approx(3.0)
    assert (sample.latency_s, sample.top1) == (None, None)


@pytest.mark.parametrize('stretch, said, why', [
    (CRASH, statuses(w5=ERROR, w30=0, w40=ERROR), 'stood'),
    (replace(CRASH, clock_set_s=-0.4), statuses(w23=ERROR), 'clock'),
    (CRASH, [replace(status, settling=status.stamp <= ONSET) for status in statuses()], 'settled'),
    (CRASH, [], 'no status'),
])
def test_samples_that_are_void(stretch: Stretch, said: List[Status], why: str) -> None:
    sample = measure('evidence', stretch, said)
    assert why in sample.void
    assert sample.latency_s is None


def test_alarms_of_normal_operation_are_counted_where_it_is_judged() -> None:
    normal = Stretch(1, NORMAL, ONSET, ONSET + 9.0)
    said = statuses(w10=ERROR, w25=0, w30=ERROR, w40=WARN, w50=ERROR)
    sample = measure('evidence', normal, said)
    assert sample.false_alarms == 2  # the first one was raised before
    assert sample.lasted_s == pytest.approx(9.0)
    half = [replace(status, settling=status.stamp > ONSET + 4.5) for status in said]
    assert measure('evidence', normal, half).lasted_s == pytest.approx(4.5, abs=0.11)


def test_alarms_of_other_systems() -> None:
    def alarm(start: float, end: float, cleared: bool = True) -> SystemAlarm:
        return SystemAlarm(round((ONSET + start) * SECOND_NS), round((ONSET + end) * SECOND_NS),
                           cleared, ['/player'])

    sample = measure_alarms('paper', CRASH, [alarm(-5, -1), alarm(0.5, 3), alarm(4, 5)])
    assert sample.latency_s == pytest.approx(0.5)
    assert (sample.top1, sample.void) == (True, '')
    assert 'stood' in measure_alarms('paper', CRASH, [alarm(-5, 1), alarm(2, 3)]).void
    assert 'stood' in measure_alarms('paper', CRASH, [alarm(-5, -1, cleared=False)]).void
    assert measure_alarms('paper', CRASH, [alarm(8.5, 9)]).latency_s is None
    normal = Stretch(1, NORMAL, ONSET, ONSET + 3.0)
    assert measure_alarms('paper', normal, [alarm(0.5, 1), alarm(4, 5)]).false_alarms == 1


def test_page_csv_and_plot(tmp_path: Path) -> None:
    crash = Sample('evidence', 1, 'cc1', ONSET, 8.0, suspicion_s=0.2, latency_s=0.3, top1=True,
                   top3=True, evidence='overdue')
    live = [crash, replace(crash, round=2, latency_s=0.4, top1=False),
            replace(crash, round=3, latency_s=None, top1=None, top3=None),
            replace(crash, round=4, latency_s=None, void='the alarm stood at the onset'),
            Sample('evidence', 1, NORMAL, ONSET, 360.0, false_alarms=1)]
    afterwards = Found([replace(crash, system='paper', latency_s=None, top1=None, top3=None)],
                       {'evidence': 14, 'paper': None}, 15)
    plan = SessionPlan(4, (60.0, 60.0), 240.0, 60.0)
    paths = report.write(tmp_path, plan, live, afterwards, 'the command')
    assert [path.name for path in paths] == ['live.csv', 'live.md', 'live.png']
    with open(paths[0], encoding='utf-8', newline='') as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 6 and rows[2]['latency_s'] == '' and rows[0]['top1'] == 'True'
    text = paths[1].read_text(encoding='utf-8')
    assert 'the command' in text
    assert ('| cc1 | 6 s | 3 of 3, 0.20 s (0.20 to 0.20) | 2 of 3, 0.40 s (0.30 to 0.40) '
            '| 0 of 1 |') in text
    assert '| cc1 | 50 % / 100 % | – | overdue |' in text
    assert 'evidence: 1 in 6.0 min' in text
    assert '- evidence: 14 of 15\n- paper: judges all together\n' in text
    assert 'round 4, cc1: void: the alarm stood at the onset' in text
    assert 'nan' not in text
    assert paths[2].read_bytes().startswith(b'\x89PNG')


def test_processes_are_ended_and_failures_are_told(tmp_path: Path) -> None:
    with Processes(tmp_path) as processes:
        asleep = processes.start('asleep', 'sleep', '1000')
        processes.run('right', 10.0, 'echo', 'well')
        with pytest.raises(LiveError, match='exit code 3.*wrong.log'):
            processes.run('wrong', 10.0, 'sh', '-c', 'exit 3')
    assert asleep.poll() is not None
    assert (tmp_path / 'right.log').read_text() == 'well\n'
    with pytest.raises(LiveError, match='not within 0 s: a wonder'):
        await_condition('a wonder', lambda: False, 0.0)


def test_recording_of_a_session_is_not_overwritten(tmp_path: Path,
                                                   capsys: pytest.CaptureFixture) -> None:
    (tmp_path / 'session.bag').write_text('precious')
    assert evaluate.main(['live', '-o', str(tmp_path), '--recordings', str(tmp_path)]) == 1
    assert 'name another folder' in capsys.readouterr().err
    assert (tmp_path / 'session.bag').read_text() == 'precious'
