"""What the evaluation of a recovery counts, without ROS."""
from __future__ import annotations

from pathlib import Path

import pytest

from self_awareness_evaluation.recovery import report
from self_awareness_evaluation.recovery.measures import (BACK_WITHIN_S, Blamed, Hang, Restart,
                                                         not_mended, of_healthy)
from self_awareness_evaluation.recovery.session import DELAY_S, Recovered, RecoveryPlan
from self_awareness_evaluation.rows import AFTERMATH_S
from self_awareness_evaluation.soak.measures import MUST_BE_FOUND_S, Happened

PLAN = RecoveryPlan(2, 5.0, 1, 10.0, 90.0)
HANG = Happened('hang:slam', '/slam', 100.0, 110.0)


def test_a_restart_is_excused_by_a_fault_of_that_node_once() -> None:
    good = Restart('/slam', 103.0)
    assert of_healthy([good], [HANG]) == []
    assert of_healthy([Restart('/slam', 110.0 + AFTERMATH_S)], [HANG]) == []
    for wrong in (Restart('/slam', 99.0), Restart('/slam', 110.1 + AFTERMATH_S),
                  Restart('/player', 103.0)):
        assert of_healthy([good, wrong], [HANG]) == [wrong]
    again = Restart('/slam', 108.0)
    assert of_healthy([good, again], [HANG]) == [again]


@pytest.mark.parametrize('name, excused', [('crash', True), ('hang', True), ('half', False),
                                           ('double', False)])
def test_only_who_does_not_work_at_all_may_be_restarted(name: str, excused: bool) -> None:
    restart = Restart('/slam', 103.0)
    fault = Happened(f'{name}:slam', '/slam', 100.0, 110.0)
    assert (of_healthy([restart], [fault]) == []) == excused


LONG = Happened('hang:camera', '/camera', 200.0, 212.0)


def test_who_hangs_for_long_has_to_be_restarted() -> None:
    delay = 1.0
    mended = Restart('/camera', 203.0)
    assert not_mended([LONG], [], [], delay) == [LONG]
    assert not_mended([LONG], [], [mended], delay) == []
    assert not_mended([LONG], [], [Restart('/camera', 199.0), Restart('/slam', 203.0)],
                      delay) == [LONG]
    late = LONG.end - delay - BACK_WITHIN_S
    assert not_mended([LONG], [Blamed('/camera', late)], [], delay) == []
    assert not_mended([LONG], [Blamed('/camera', late - 0.1), Blamed('/camera', late)], [],
                      delay) == [LONG]
    assert not_mended([LONG], [Blamed('/slam', late)], [], delay) == [LONG]
    short = Happened('hang:camera', '/camera', 200.0,
                     200.0 + MUST_BE_FOUND_S + delay + BACK_WITHIN_S)
    crash = Happened('crash:camera', '/camera', 200.0, 212.0)
    assert not_mended([short, crash], [], [], delay) == []


@pytest.mark.parametrize('back_s, in_time', [(None, False), (0.1, True), (5.9, True),
                                             (6.1, False)])
def test_in_time_is_5_s_and_the_delay_after_the_alarm(back_s: float, in_time: bool) -> None:
    assert Hang(0.3, back_s).in_time(1.0) == in_time


def test_the_section_says_what_is_wrong(tmp_path: Path) -> None:
    page = tmp_path / 'reliability.md'
    page.write_text('a\n<!-- recovery -->\n<!-- /recovery -->\nb\n')
    hangs = [Hang(0.3, DELAY_S + 3.0), Hang(0.5, DELAY_S + 9.0)]
    recovered = Recovered(hangs, [HANG, LONG], [Restart('/slam', 103.0), Restart('/base', 103.0)],
                          [])
    report.write(tmp_path, PLAN, recovered, 'command')
    text = page.read_text()
    assert '| all | 1 of 2 |' in text and '| of them healthy | none | 1 |' in text
    assert '- hang 2 was not back in time' in text
    assert '- /base was healthy and restarted at 103.0' in text
    assert '| hangs that lasted on | none | 1 |' in text
    assert '- /camera hung from 200.0 to 212.0, and was not restarted' in text
    assert text.endswith('<!-- /recovery -->\nb\n')
    assert report.failures(Recovered(hangs[:1], [HANG], [Restart('/slam', 103.0)], [])) == []
