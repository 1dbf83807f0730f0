"""What is told of live sessions: tables by rows, what was wrong, and sections of pages."""
from __future__ import annotations

import math
import re
from dataclasses import replace
from pathlib import Path
from typing import List, Optional

import pytest

from self_awareness_evaluation import evaluate, row_files
from self_awareness_evaluation.live import command, reliability, tables
from self_awareness_evaluation.live.recovery import DELAY_S
from self_awareness_evaluation.live.reliability import (AT_RANDOM, BACK_WITHIN_S, HANGS,
                                                        MUST_BE_FOUND_S, not_mended, of_healthy)
from self_awareness_evaluation.live.rows import RESTARTED, Row
from self_awareness_evaluation.live.usage import slope_mb_per_hour
from self_awareness_evaluation.rows import AFTERMATH_S

DOCS = Path(__file__).resolve().parents[3] / 'docs'


@pytest.mark.parametrize('page, rows, of', [
    ('evaluation/live.md', 'evaluation/live.csv', tables.of_live),
    ('evaluation/nodes.md', 'evaluation/nodes.csv', tables.of_nodes)])
def test_the_tables_in_the_repository_are_those_of_their_rows(page: str, rows: str,
                                                              of: tables.Tables) -> None:
    text = (DOCS / page).read_text(encoding='utf-8')
    assert '\n'.join(of(row_files.load(DOCS / rows, Row))) in text


def test_the_faults_of_the_soak_in_the_repository_are_those_of_its_rows() -> None:
    lines, wrong = reliability.of_soak(row_files.load(DOCS / 'reliability' / 'soak.csv', Row))
    _, head, faults = '\n'.join(lines).partition('| fault |')
    assert faults and head + faults in (DOCS / 'reliability.md').read_text(encoding='utf-8')
    assert wrong == []


def test_tables_of_rounds() -> None:
    crash = Row('cc1', 'player', round=1, lasted_s=6.0, suspicion_s=0.2, latency_s=0.3, first=True,
                among_three=True, evidence='overdue')
    normal = Row('normal', '', lasted_s=360.0, alarms=1, watched=14, components=15)
    rows = [crash, replace(crash, round=2, latency_s=0.4, first=False),
            replace(crash, round=3, latency_s=None, first=None, among_three=None),
            replace(crash, round=4, latency_s=None, void='the alarm stood at the onset'), normal,
            replace(crash, system='paper', latency_s=None, first=None),
            replace(normal, system='paper', watched=None, alarms=0)]
    text = '\n'.join(tables.of_live(rows))
    assert ('| cc1 | 6 s | 3 of 3, 0.20 s (0.20 to 0.20) | 2 of 3, 0.40 s (0.30 to 0.40) '
            '| 0 of 1 |') in text
    assert '| cc1 | 50 % / 100 % | – | overdue |' in text
    assert 'evidence: 1 in 6.0 min' in text
    assert '- evidence: 14 of 15\n- paper: judges all together\n' in text
    assert 'round 4, cc1: void: the alarm stood at the onset' in text


def test_table_of_normal_operation_and_of_one_fault_after_the_other() -> None:
    quiet = Row('undisturbed', '', lasted_s=1800.0, alarms=1, named=1, suspicions=2,
                standing_s=9.0, expected=0.5, watched=33, components=34,
                said='ERROR: this: 1 s; WARN: that: 2 s; ERROR: this: 3 s')
    killed = Row('killed (kill -9)', 'lidar', lasted_s=10.0, suspicion_s=0.2, latency_s=0.3,
                 first=True, among_three=True, cleared_s=2.5, said='silent')
    text = '\n'.join(tables.of_nodes([
        quiet, replace(quiet, alarms=0, named=0, suspicions=1, standing_s=0.0, said=''), killed,
        Row('relays late', 'relay', lasted_s=20.0, suspicion_s=0.4, cleared_s=0.0, note='twice'),
        Row('at half its rate', 'rear', lasted_s=20.0, latency_s=1.0, first=False,
            among_three=False, cleared_s=math.inf, said='a|b'),
        Row('killed', 'base', lasted_s=10.0, void='the alarm stood at the onset')]))
    assert 'The model watches 33 of 34 components.' in text
    assert ('| **undisturbed** | 60 min | 3 (3.0 an hour) | 1 (95 %: 0.2 to 5.7 an hour; expected '
            'by calibrate: 0.5); 1 name a node | – | an alarm stood for 9 s (0.25 % of the time) '
            '| ERROR: this (2x); WARN: that (1x) |') in text
    assert '| `lidar` killed (kill -9) | 10 s | 0.20 s | 0.30 s | yes | 2.5 s | silent |' in text
    assert '| `relay` relays late | 20 s | 0.40 s | none | – | – | – |' in text
    assert '| none | 1.00 s | no | did not clear | a/b |' in text
    assert 'void: the alarm stood' in text and '- `relay` relays late: twice' in text


def normal(at_s: float, alarms: int = 0) -> Row:
    """Return 100 s of normal operation at 1600 messages a second."""
    return Row('normal', '', onset=at_s, lasted_s=100.0, alarms=alarms, said='why',
               events=160_000, memory_mb=50.0, threads=12, files=80)


CRASH = Row('crash:slam', 'slam', onset=100.0, lasted_s=10.0, recovered_s=11.0, latency_s=0.6,
            blamed_s=0.6, first=True, cleared_s=2.0, events=16_000, memory_mb=50.0)


def test_a_soak_says_what_is_wrong() -> None:
    good = [normal(0.0), CRASH, normal(130.0)]
    lines, wrong = reliability.of_soak(good)
    text = '\n'.join(lines)
    assert wrong == [] and '1600 messages a second' in text and '0 of 1' in text
    assert '| crash | 1 | 1 | 0.60 s | 0.60 s | 1 | 2.00 s | 2.00 s |' in text
    assert 'not measured' in text, 'the soak is too short for a slope'
    short = replace(CRASH, onset=125.0, lasted_s=1.5, latency_s=None, fault='hang:slam')
    assert '| hang of less than 2 s | 1 | 0 |' in '\n'.join(reliability.of_soak([*good, short])[0])
    for bad, word in (
            ([normal(0.0, alarms=1), CRASH], 'false alarm after 0 s: why'),
            ([normal(0.0), replace(CRASH, latency_s=None)], 'crash:slam at 100 s was missed'),
            ([normal(0.0), replace(CRASH, cleared_s=math.inf)], 'the alarm did not clear'),
            ([replace(normal(at), memory_mb=50.0 + at / 2400.0) for at in range(0, 1500, 100)],
             'memory grows by 1.50 MB')):
        failure, = reliability.of_soak(bad)[1]
        assert word in failure


def test_the_slope_is_that_after_five_minutes() -> None:
    rows = [replace(normal(at_s), memory_mb=50.0 + 3.0 * at_s / 3600.0 + max(0, 200 - at_s) / 9.0)
            for at_s in range(0, 1800, 100)]
    assert slope_mb_per_hour(rows) == pytest.approx(3.0)
    assert slope_mb_per_hour(rows[:5]) is None and slope_mb_per_hour([]) is None


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


@pytest.mark.parametrize('kind, excused', [('crash', True), ('hang', True), ('half', False),
                                           ('double', False)])
def test_only_who_does_not_work_at_all_may_be_restarted(kind: str, excused: bool) -> None:
    fault = replace(HANG, fault=f'{kind}:slam')
    assert (of_healthy([fault, restart('slam', 103.0)]) == []) == excused


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
    lines, wrong = reliability.of_recovery([hang])
    assert (wrong == []) == in_time and f'| all | {int(in_time)} of 1 |' in lines[2]


def test_a_recovery_says_what_is_wrong() -> None:
    rows = [replace(HANG, round=HANGS, onset=50.0, blamed_s=0.3, back_s=3.0), HANG,
            restart('slam', 52.0), restart('slam', 103.0), restart('base', 104.0),
            replace(HANG, fault='hang:camera', node='camera', onset=200.0, lasted_s=40.0)]
    lines, wrong = reliability.of_recovery(rows)
    text = '\n'.join(lines)
    assert 'median 0.30 s, longest 0.30 s' in text and 'median 3.00 s' in text
    assert '| faults at random, in 2 minutes |  | 2 |' in text
    assert '| nodes restarted meanwhile |  | 2 |' in text and '| none | 1 |' in text
    assert wrong == ['base was healthy and restarted at 54 s',
                     'camera hung at 150 s, and was not restarted']


def test_a_section_is_written_and_what_is_wrong_is_an_error(tmp_path: Path) -> None:
    arguments = evaluate.parser().parse_args(['soak', '-o', str(tmp_path), '--starts', '3'])
    rows = [replace(normal(0.0), load=1.5), replace(CRASH, load=2.5)]
    page = tmp_path / 'reliability.md'
    command.write(arguments, page.name, 'soak', 'the command', rows, ['| table |'])
    assert re.match('<!-- soak -->\nWritten by `the command` on .* Learned from 3 x 90 s, limits '
                    r'by 4 x 120 s, .* load average 1\.5 to 2\.5, [^\n]*\n\n\| table \|\n',
                    page.read_text())
    page.write_text('# Before\n\n<!-- soak -->\nold\n<!-- /soak -->\nafter\n')
    with pytest.raises(ValueError, match='one; two'):
        command.write(arguments, page.name, 'soak', 'the command', rows, [], ['one', 'two'])
    text = page.read_text()
    assert text.startswith('# Before\n') and 'old' not in text
    assert text.endswith('\n- one\n- two\n<!-- /soak -->\nafter\n')


def test_rows_are_read_as_they_were_written(tmp_path: Path) -> None:
    rows: List[Row] = [normal(0.0), CRASH, replace(CRASH, cleared_s=math.inf, first=False),
                       restart('slam', 103.0)]
    row_files.save(tmp_path / 'rows.csv', rows, Row)
    assert row_files.load(tmp_path / 'rows.csv', Row) == rows
