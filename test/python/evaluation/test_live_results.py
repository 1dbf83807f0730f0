"""What is measured of stretches of live sessions, and told: tables, what was wrong, sections."""
from __future__ import annotations

import math
import re
from dataclasses import replace
from pathlib import Path
from typing import List, Optional, Tuple

import pytest

from self_awareness_evaluation import evaluate
from self_awareness_evaluation.live import command
from self_awareness_evaluation.live.rows import (AT_RANDOM, BACK_WITHIN_S, DELAY_S, ERROR, HANGS,
                                                 MUST_BE_FOUND_S, RESTARTED, WARN, Row, Status,
                                                 measure, not_mended, of_faults, of_healthy,
                                                 of_recovery, of_soak)
from self_awareness_evaluation.pages import RESULTS
from self_awareness_evaluation.rows import AFTERMATH_S, load

DOCS = Path(__file__).resolve().parents[3] / 'docs'


@pytest.mark.parametrize('name', ['live', 'nodes'])
def test_the_results_in_the_repository_are_those_of_their_rows(name: str) -> None:
    folder = DOCS / 'evaluation'
    lines, _ = of_faults(load(folder / f'{name}.csv', Row))
    section = (folder / RESULTS).read_text(encoding='utf-8').partition(f'<!-- {name} -->')[2]
    assert '\n'.join(lines) in section.partition(f'<!-- /{name} -->')[0]


def test_the_faults_of_the_soak_in_the_repository_are_those_of_its_rows() -> None:
    lines, wrong = of_soak(load(DOCS / 'reliability' / 'soak.csv', Row))
    _, head, faults = '\n'.join(lines).partition('| fault |')
    assert faults and head + faults in (DOCS / command.RELIABILITY).read_text(encoding='utf-8')
    assert wrong == []


def normal(at_s: float, alarms: int = 0) -> Row:
    """Return 100 s of normal operation at 1600 messages a second."""
    return Row('normal', '', onset=at_s, lasted_s=100.0, alarms=alarms, said='why',
               events=160_000, memory_mb=50.0, threads=12, files=80)


CRASH = Row('crash:slam', 'slam', onset=100.0, lasted_s=10.0, recovered_s=11.0, latency_s=0.6,
            blamed_s=0.6, first=True, cleared_s=2.0, events=16_000, memory_mb=50.0)


def test_a_soak_says_what_is_wrong() -> None:
    good = [normal(0.0), CRASH, normal(130.0)]
    lines, wrong = of_soak(good)
    text = '\n'.join(lines)
    assert wrong == [] and '1600 messages a second' in text and '0 of 1' in text
    assert '| crash | 1 | 1 | 0.60 s | 0.60 s | 1 | 2.00 s | 2.00 s |' in text
    assert 'not measured' in text, 'the soak is too short for a slope'
    short = replace(CRASH, onset=125.0, lasted_s=1.5, latency_s=None, fault='hang:slam')
    assert '| hang of less than 2 s | 1 | 0 |' in '\n'.join(of_soak([*good, short])[0])
    for bad, word in (
            ([normal(0.0, alarms=1), CRASH], 'false alarm after 0 s: why'),
            ([normal(0.0), replace(CRASH, latency_s=None)], 'crash:slam at 100 s was missed'),
            ([normal(0.0), replace(CRASH, cleared_s=math.inf)], 'the alarm did not clear'),
            ([replace(normal(at), memory_mb=50.0 + at / 2400.0) for at in range(0, 1500, 100)],
             'memory grows by 1.50 MB')):
        failure, = of_soak(bad)[1]
        assert word in failure


HANG = Row('hang:slam', 'slam', round=AT_RANDOM, onset=100.0, lasted_s=10.0)


def restart(node: str, at_s: float) -> Row:
    """Return a restart by the recovery."""
    return Row(RESTARTED, node, onset=at_s)


def test_a_restart_is_excused_by_a_fault_of_that_node_once() -> None:
    good = restart('slam', 103.0)
    assert of_healthy([HANG, good]) == []
    assert of_healthy([HANG, restart('slam', 110.0 + AFTERMATH_S)]) == []
    for wrong in (restart('slam', 99.0), restart('slam', 110.1 + AFTERMATH_S),
                  restart('player', 103.0), restart('slam', 108.0)):
        assert of_healthy([HANG, good, wrong]) == [wrong]
    for kind, excused in (('crash', True), ('half', False), ('double', False)):
        fault = replace(HANG, fault=f'{kind}:slam')
        assert (of_healthy([fault, good]) == []) == excused, 'who works, more or less, is healthy'


def test_who_hangs_for_long_has_to_be_restarted() -> None:
    long = replace(HANG, lasted_s=12.0)
    late = 12.0 - DELAY_S - BACK_WITHIN_S
    assert not_mended([long]) == [long]
    assert not_mended([long, restart('slam', 103.0)]) == []
    assert not_mended([long, restart('slam', 99.0), restart('base', 103.0)]) == [long]
    assert not_mended([replace(long, blamed_s=late)]) == []
    assert not_mended([replace(long, blamed_s=late - 0.1)]) != []
    short = replace(HANG, lasted_s=MUST_BE_FOUND_S + DELAY_S + BACK_WITHIN_S)
    assert not_mended([short, replace(long, fault='crash:slam')]) == []


@pytest.mark.parametrize('back_s, in_time', [(None, False), (0.1, True), (5.9, True),
                                             (6.1, False)])
def test_in_time_is_5_s_and_the_delay_after_the_alarm(back_s: Optional[float],
                                                      in_time: bool) -> None:
    hang = replace(HANG, round=HANGS, blamed_s=0.3, back_s=back_s, lasted_s=1.0)
    lines, wrong = of_recovery([hang])
    assert (wrong == []) == in_time and f'| all | {int(in_time)} of 1 |' in lines[2]


def test_a_recovery_says_what_is_wrong() -> None:
    rows = [replace(HANG, round=HANGS, onset=50.0, blamed_s=0.3, back_s=3.0), HANG,
            restart('slam', 52.0), restart('slam', 103.0), restart('base', 104.0),
            replace(HANG, fault='hang:camera', node='camera', onset=200.0, lasted_s=40.0)]
    lines, wrong = of_recovery(rows)
    text = '\n'.join(lines)
    assert 'median 0.30 s, longest 0.30 s' in text and 'median 3.00 s' in text
    assert '| faults at random, in 2 minutes |  | 2 |' in text
    assert '| nodes restarted meanwhile |  | 2 |' in text and '| none | 1 |' in text
    assert wrong == ['base was healthy and restarted at 54 s',
                     'camera hung at 150 s, and was not restarted']


def test_a_section_is_written_and_what_is_wrong_is_an_error(tmp_path: Path) -> None:
    arguments = evaluate.parser().parse_args(['soak', '-o', str(tmp_path)])
    arguments.page = 'page.md'
    rows = [replace(normal(0.0), load=1.5), replace(CRASH, load=2.5)]
    page = tmp_path / arguments.page
    command.write(arguments, 'the command', rows, ['| table |'], [])
    assert re.search('<!-- soak -->\nWritten by `the command` on .* Learned from 4 x 90 s, limits '
                     r'by 4 x 120 s, .* load average 1\.5 to 2\.5, [^\n]*\n\n\| table \|\n',
                     page.read_text())
    page.write_text('# Before\n\n<!-- soak -->\nold\n<!-- /soak -->\nafter\n')
    with pytest.raises(ValueError, match='one; two'):
        command.write(arguments, 'the command', rows, [], ['one', 'two'])
    text = page.read_text()
    assert text.startswith('# Before\n') and 'old' not in text
    assert text.endswith('\n- one\n- two\n<!-- /soak -->\nafter\n')


ONSET = 1000.0
QUIET = Row('undisturbed', '', onset=ONSET, lasted_s=10.0, load=1.5, alarms=0)
KILLED = Row('killed', 'lidar', onset=ONSET, lasted_s=5.0, recovered_s=6.0)


def said(*levels: Tuple[float, int], settled_after_s: float = -2.0) -> List[Status]:
    """Return ten statuses a second, from 2 s before the onset to 12 s after it.

    Args:
        levels: from when on after the onset [s], and which.
        settled_after_s: until then the monitor settles.
    """
    found = []
    for number in range(1, 141):
        after_s = round(0.1 * number - 2.0, 1)
        level = ([0] + [level for begin_s, level in levels if begin_s <= after_s])[-1]
        name = '/lidar' if level else ''
        found.append(Status(ONSET + after_s, level, after_s <= settled_after_s,
                            ('/base', name) if level else (),
                            f'level {level} at {after_s:g}; events in /tmp/a.bag',
                            name, 'silent' if level else '', events=16))
    return found


def test_a_fault_that_is_found_and_clears() -> None:
    row = measure(KILLED, said((0.2, WARN), (0.4, ERROR), (8.0, WARN), (9.0, 0)))
    assert (row.suspicion_s, row.latency_s) == (pytest.approx(0.2), pytest.approx(0.4))
    assert (row.blamed_s, row.first) == (pytest.approx(0.4), False)
    assert row.cleared_s == pytest.approx(1.9)
    assert (row.end_level, row.end_kind, row.end_component) == (ERROR, 'silent', '/lidar')
    assert (row.void, row.events) == ('', 50 * 16)
    assert row.said == 'level 2 at 0.4', 'files of this machine are not told'


def test_a_fault_that_is_not_found_or_does_not_clear() -> None:
    row = measure(KILLED, said((0.2, WARN), (3.0, 0)))
    assert (row.latency_s, row.first, row.said, row.cleared_s) == (None, None, '', 0.0)
    assert (row.suspicion_s, row.end_level) == (pytest.approx(0.2), 0)
    row = measure(KILLED, said((5.5, ERROR)))
    assert (row.latency_s, row.said, row.cleared_s) == (None, '', math.inf)
    assert measure(replace(KILLED, recovered_s=None), said()).cleared_s is None


def test_an_alarm_that_blames_another_node_first() -> None:
    other = [replace(status, component='/base' if status.stamp < ONSET + 2.0 else '/lidar')
             for status in said((1.0, ERROR))]
    row = measure(KILLED, other)
    assert (row.latency_s, row.blamed_s) == (pytest.approx(1.0), pytest.approx(2.0))
    assert measure(replace(KILLED, node='base'), other).first
    assert measure(replace(KILLED, node=''), other).first is None, 'nobody is guilty'


@pytest.mark.parametrize('row, statuses, why', [
    (KILLED, said((-1.0, ERROR), (1.0, 0), (2.0, ERROR)), 'stood'),
    (KILLED, said((1.0, ERROR), settled_after_s=0.0), 'settled'),
    (KILLED, [], 'nothing was said'),
    (replace(KILLED, void='the clock was set'), said((1.0, ERROR)), 'clock')])
def test_faults_that_do_not_count(row: Row, statuses: List[Status], why: str) -> None:
    measured = measure(row, statuses)
    assert why in measured.void and measured.latency_s is None and measured.said == ''


@pytest.mark.parametrize('levels, alarms, suspicions, told', [
    ([(1.0, WARN), (2.0, 0), (4.0, WARN), (5.0, ERROR), (7.0, WARN), (8.0, 0), (9.0, ERROR)], 2, 1,
     'WARN: level 1 at 1; ERROR: level 2 at 5; ERROR: level 2 at 9'),
    # What began earlier is not counted again.
    ([(-1.0, ERROR), (2.0, WARN), (3.0, 0)], 0, 0, ''),
    ([(-1.0, WARN), (2.0, ERROR), (3.0, 0)], 1, 0, 'ERROR: level 2 at 2'),
    # A suspicion between two alarms is none of its own.
    ([(1.0, WARN), (1.5, ERROR), (3.0, WARN), (4.0, ERROR), (5.0, WARN), (6.0, 0), (7.0, WARN)],
     2, 1, 'ERROR: level 2 at 1.5; ERROR: level 2 at 4; WARN: level 1 at 7')])
def test_alarms_and_suspicions_of_normal_operation(levels: List[Tuple[float, int]], alarms: int,
                                                   suspicions: int, told: str) -> None:
    row = measure(QUIET, said(*levels))
    assert (row.alarms, row.suspicions, row.said) == (alarms, suspicions, told)
    assert (row.lasted_s, row.load) == (pytest.approx(10.0), 1.5)
    assert measure(QUIET, said(settled_after_s=4.0)).lasted_s == pytest.approx(6.0)
