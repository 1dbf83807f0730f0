"""The soak without ROS: faults by a seed, alarms compared with them, memory, the page."""
from __future__ import annotations

import itertools
import json
import math
import os
from dataclasses import replace
from pathlib import Path
from typing import List, Sequence, Tuple

import pytest

from self_awareness_evaluation.live.processes import becomes_true
from self_awareness_evaluation.live.samples import ERROR, WARN, Status
from self_awareness_evaluation.soak import report, schedule
from self_awareness_evaluation.soak.measures import Happened, judge
from self_awareness_evaluation.soak.memory import MemoryWatch, Usage, slope_mb_per_hour
from self_awareness_evaluation.soak.session import Soak, SoakPlan
from self_awareness_follow_me.scenario import load_scenario

BEGIN = 1000.0
PLAN = SoakPlan(60.0, 7, 10.0, 4, 90.0, 3, 120.0, 0.1)
CRASH = Happened('crash:slam', '/slam', BEGIN + 100.0, BEGIN + 110.0)


def statuses(*alarms: Tuple[float, float], suspects: Sequence[str] = ('/slam',)) -> List[Status]:
    """Return 10 minutes of statuses, five a second.

    Args:
        alarms: from when until when they stand [s since BEGIN].
    """
    result = []
    for window in range(3000):
        at = window / 5.0
        alarm = any(begin <= at < end for begin, end in alarms)
        result.append(Status(BEGIN + at, BEGIN + at, ERROR if alarm else WARN, False, '',
                             tuple(suspects), 'why'))
    return result


def memory(slope_mb_per_h: float, seconds: int = 1800) -> List[Usage]:
    """Return samples that grow fast for 5 minutes, and then by the slope."""
    return [Usage(float(at), 50e3 + 1e3 * slope_mb_per_h * at / 3600.0 + max(0, 300 - at) * -20.0,
                  12, 80) for at in range(seconds)]


def test_faults_are_those_of_the_seed() -> None:
    robot = load_scenario()
    drawn = [list(itertools.islice(schedule.faults(robot, seed), 300)) for seed in (1, 1, 2)]
    assert drawn[0] == drawn[1] != drawn[2]
    assert {fault.kind for fault in drawn[0]} == {'crash', 'hang', 'half', 'double'}
    assert {fault.component for fault in drawn[0]} == set(schedule.regular(robot))
    for fault in drawn[0]:
        low, high = schedule.SHORT_S if fault.lasts_s < 2.0 else schedule.LONG_S
        assert low <= fault.lasts_s <= high
        assert schedule.PAUSE_S[0] <= fault.after_s <= schedule.PAUSE_S[1]
    assert 10 < sum(fault.lasts_s < 2.0 for fault in drawn[0]) < 100


def test_an_alarm_in_a_fault_is_its_own() -> None:
    (found,), false = judge([CRASH], statuses((101.0, 112.0), suspects=('/player', '/slam')),
                            BEGIN)
    assert not false and not found.missed
    assert (found.onset_s, found.lasted_s) == (100.0, 10.0)
    assert found.latency_s == pytest.approx(1.0)
    assert found.rank == 2
    assert found.cleared_s == pytest.approx(2.0)


def test_a_fault_without_an_alarm_is_missed_if_it_lasts() -> None:
    short = replace(CRASH, onset=BEGIN + 200.0, end=BEGIN + 201.5)
    found, false = judge([CRASH, short], statuses(), BEGIN)
    assert [fault.missed for fault in found] == [True, False]
    assert not false


def test_an_alarm_after_the_end_is_no_find() -> None:
    (found,), false = judge([CRASH], statuses((112.0, 114.0)), BEGIN)
    assert found.missed and found.latency_s is None and not false
    assert found.cleared_s == pytest.approx(4.0)


@pytest.mark.parametrize('alarm', [(99.0, 104.0), (115.4, 116.0), (400.0, 900.0)])
def test_an_alarm_without_a_fault_is_false(alarm: Tuple[float, float]) -> None:
    _, (false,) = judge([CRASH], statuses(alarm), BEGIN)
    assert false.at_s == pytest.approx(alarm[0], abs=0.21)
    assert false.message == 'why'


def test_the_slope_is_that_after_five_minutes() -> None:
    assert slope_mb_per_hour(memory(0.0)) == pytest.approx(0.0, abs=1e-6)
    assert slope_mb_per_hour(memory(3.0)) == pytest.approx(3.0)
    assert slope_mb_per_hour(memory(3.0, seconds=590)) is None
    assert slope_mb_per_hour([]) is None


def test_memory_is_that_of_the_process() -> None:
    with MemoryWatch(os.getpid()) as watch:
        assert becomes_true(lambda: len(watch.seen) >= 2, 10.0)
    first, second = watch.seen[:2]
    assert 0.5 < second.at_s - first.at_s < 5.0
    assert 5e3 < first.resident_kb < 1e7
    assert first.threads >= 2 and first.files >= 3


def soak(slope: float = 0.0, alarms: Sequence[Tuple[float, float]] = ((100.6, 112.0),)) -> Soak:
    """Return ten minutes with a crash."""
    return Soak(BEGIN, BEGIN + 600.0, [CRASH], statuses(*alarms), memory(slope), 960_000,
                [1.5, 2.5])


def test_what_is_wrong_is_said() -> None:
    assert report.result(PLAN, soak(), 'command').failures == []
    for bad, word in ((soak(slope=1.5), 'memory grows by 1.50 MB'),
                      (soak(alarms=((100.6, 112.0), (300.0, 301.0))), 'false alarm at 300 s: why'),
                      (soak(alarms=()), 'crash:slam at 100 s was missed')):
        failure, = report.result(PLAN, bad, 'command').failures
        assert word in failure


def test_the_page_has_the_numbers(tmp_path: Path) -> None:
    page = tmp_path / 'reliability.md'
    page.write_text('# Before\n\n<!-- soak -->\nold\n<!-- /soak -->\nafter\n')
    written = report.write(tmp_path, report.result(PLAN, soak(), 'evaluate soak --minutes 10'))
    assert page in written
    text = page.read_text()
    assert text.startswith('# Before\n') and text.endswith('\nafter\n') and 'old' not in text
    for words in ('`evaluate soak --minutes 10`', 'Seed 7', '1600 messages a second', '0 of 1',
                  '| crash | 1 | 1 | 0.60 s | 0.60 s | 1 | 2.00 s | 2.00 s |', '0.00 MB an hour'):
        assert words in text, words
    numbers = json.loads((tmp_path / 'reliability' / 'soak.json').read_text())
    assert numbers['plan']['seed'] == 7
    assert math.isclose(numbers['messages_per_s'], 1600.0)
    assert numbers['found'][0]['fault'] == 'crash:slam'


def test_a_soak_too_short_for_a_slope_says_so(tmp_path: Path) -> None:
    short = report.result(PLAN, replace(soak(), memory=memory(9.0, seconds=400)), 'command')
    assert short.slope_mb_per_hour is None and not short.failures
    assert 'not measured' in report.section(short)
