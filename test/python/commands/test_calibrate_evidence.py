"""`calibrate` for the evidence detector: the limits, what is said of them, and what is refused."""
from __future__ import annotations

import math
import os
import re
from pathlib import Path
from typing import Any, Callable, Dict, List, Tuple

import pytest
from conftest import error_of, jittery_robot, printed_by, trained

from self_awareness import EvidenceModel, TrainedModel
from self_awareness.commands import calibrate
from self_awareness.reporting import evidence_report

Bags = Tuple[str, str]


@pytest.fixture(name='base', scope='module')
def _base(long_bags: Bags, tmp_path_factory) -> str:
    path = tmp_path_factory.mktemp('trained') / 'm'
    trained([long_bags[0]], path)
    return str(path)


@pytest.fixture(name='run')
def _run(base: str, long_bags: Bags, tmp_path, capsys) -> Callable[..., Tuple[int, str, str]]:
    """Return a function that calibrates on the second recording: exit code, output, errors."""
    def calibrated(*arguments: str) -> Tuple[int, str, str]:
        code = calibrate.main(['--model', base, '--normal', long_bags[1], '-o',
                               str(tmp_path / 'm'), *arguments])
        captured = capsys.readouterr()
        return code, captured.out, captured.err
    return calibrated


def test_the_limits_are_stored_with_how_they_were_found(run, base: str, tmp_path) -> None:
    code, out, err = run('--budget', '0.25')
    assert code == 0 and err == ''
    model = TrainedModel.load(str(tmp_path / 'm'))
    found = model.calibration
    assert len(found.limits) == len(EvidenceModel(model).tracks)
    assert all(math.isnan(limit) or limit > 0.0 for limit in found.limits)
    assert (found.method, found.budget) == ('held-out', 0.25)
    assert [recording.bag for recording in found.recordings] == ['tuesday.bag']
    # 120 s of which 5 s settle, and what the halves of the training said of each other.
    of_training = TrainedModel.load(base).calibration.windows
    assert found.windows == pytest.approx(1150 + of_training, abs=2) and of_training > 1000
    # Nothing exceeded what the others showed; half an hour is known of all robots.
    assert found.false_alarms_per_hour == pytest.approx(0.58 / (0.5 + 240.0 / 3600.0), rel=0.02)
    assert found.stamp > 1.7e18
    assert model.paper_calibration is None  # the paper's detector is another matter
    assert TrainedModel.load(base).calibration.method == 'cross-fit'  # left alone


def test_whose_death_another_budget_finds_sooner_is_a_table() -> None:
    def coverage(of_joy: float) -> List[Dict[str, Any]]:
        return [{'component': component, 'death_found_after': after}
                for component, after in (('/joy', of_joy), ('/imu', 0.5), ('/new', None))]

    found = {0.05: coverage(900.0), 0.5: coverage(450.0), 5.0: coverage(225.0)}
    lines = evidence_report.budgets(found)
    assert lines[0].startswith('--budget: deaths found with 0.05, 0.5, 5 false alarms an hour')
    assert [line.split() for line in lines[1:]] == [
        ['component', '0.05', '0.5', '5'], ['/joy', '15', 'min', '8', 'min', '4', 'min']]


def test_the_verdict_comes_first_then_what_to_record_and_the_next_command(run, tmp_path) -> None:
    model = tmp_path / 'm'
    _, out, _ = run()
    lines = out.splitlines()
    # Half an hour is known of all robots, and what was judged.
    assert re.fullmatch(r'learned from 2 starts, 4 min: at most 1 false alarm an hour; deaths of '
                        r'all 3 nodes found within 0\.\d+ s', lines[0])
    needed = {each.component: each.more_starts
              for each in TrainedModel.load(str(model)).coverage() if each.more_starts}
    more = min(needed.values())
    names = ', '.join(name for name, starts in needed.items() if starts == more)
    assert more > 1
    assert lines[1] == (
        f'record next: 34 min of other starts, for half as many false alarms; {more} more starts, '
        f'to find late answers of {names} (fewer with train --graph)')
    assert lines[2:] == [f'written: {model}', 'next:',
                         f'  roslaunch self_awareness monitor.launch model:={model}']
    assert not re.search(r'\b(tracks?|relations?|gains?|overdue|linkers?|pairs)\b', out), out
    assert ('--budget: with 0.05, 0.5, 5 false alarms an hour, all deaths are found equally soon'
            in run('--details')[1])


def test_alarms_on_normal_operation_are_told_with_their_reason(base: str, make_bag,
                                                               tmp_path) -> None:
    stranger = [(stamp, '/stranger', '/new') for stamp, _, _ in jittery_robot(9000.0, 240.0, 9)]
    bag = make_bag('new.bag', sorted([*jittery_robot(9000.0, 240.0, 8), *stranger]))
    out = printed_by(calibrate, ['--model', base, '--normal', bag, '--unknown', 'error', '-o',
                                 str(tmp_path / 'm')])
    told = out[out.index('alarms on these '):].splitlines()
    assert told[0] == ('alarms on these 4 min of normal operation: 1; if that was a fault, leave '
                       'it out')
    assert re.match(r'  \S*new.bag: \d+\.\d s: /stranger /new std_msgs/String: ', told[1]), told
    assert 'unknown events' not in told[1]


def test_faults_are_told_in_a_table_and_without_details_those_that_were_not_found(run) -> None:
    faults = ('--inject', 'crash:*', 'slow:/laser:1.01')
    found = ('half of them within {0}, the last after {0}; the node is named first in 3 of 3'
             ).format(r'\d\.\d+ s')
    head = ['fault', 'node', 'found', 'after', 'named first', 'among three']

    def table(*options: str) -> Tuple[str, List[List[str]]]:
        lines = run(*faults, *options)[1].splitlines()
        at, = [i for i, line in enumerate(lines) if line.startswith('faults: ')]
        rows = [re.split(r' {2,}', line.strip()) for line in lines[at + 1:]]
        return lines[at], rows[:next(i for i, row in enumerate(rows) if len(row) == 1)]

    told, rows = table('--details')
    assert re.fullmatch(rf'faults: found 3 of 4 \(95 %: \d+\.\d% to \d+\.\d%\), {found}', told)
    assert rows[0] == head and [row[:3] for row in rows[1:4]] == [
        ['crash', f'/{name}', '1 of 1'] for name in ('battery', 'laser', 'slam')]
    assert all(row[4:] == ['1 of 1', '1 of 1'] for row in rows[1:4])
    battery, laser, slam = (float(row[3].split()[0]) for row in rows[1:4])
    assert 0.0 < laser < 1.0 and 0.0 < slam < 1.0 and 0.37 < battery < 3.0
    told, rows = table()
    assert re.fullmatch(f'faults: found 3 of 4, {found}', told)
    assert rows == [head, ['slow:1.01', '/laser', '0 of 1', '-', '-', '-']]


@pytest.mark.parametrize('arguments, parts', [
    (('--cutoff', 'youden'), ['--cutoff', '--detector paper', '--budget']),
    (('--detector', 'paper', '--budget', '1'), ['--budget', '--detector evidence', '--cutoff']),
    (('--settle-time', '80'), ['--normal', 'too little normal operation', 'at least 50 s',
                               'of every recording']),
    (('--inject', 'crash:/motor'), ['/motor', '/battery, /laser, /slam']),
])
def test_an_error_names_the_way_out_and_writes_nothing(run, tmp_path, arguments,
                                                       parts: List[str]) -> None:
    code, _, err = run(*arguments)
    assert code == 1 and err.count('\n') == 1 and err.startswith('calibrate: error: ')
    for part in parts:
        assert part in err
    assert os.listdir(tmp_path) == []


def test_a_source_that_is_silent_after_the_middle_is_no_obstacle(tmp_path: Path, make_bag) -> None:
    model = str(tmp_path / 'm')

    def bag(name: str, start: float) -> str:
        once = [(start + 0.1 * i, '/starter', '/hello') for i in range(20)]
        return make_bag(name, sorted([*jittery_robot(start, 120.0, int(start)), *once]))

    trained([bag('train.bag', 1000.0)], tmp_path / 'm')
    normal = bag('normal.bag', 5000.0)
    arguments = ['--model', model, '--normal', normal, '-o', model]
    out = printed_by(calibrate, [*arguments, '--inject', 'crash:*', 'crash:/laser', '--details'])
    assert 'not tried, silent after the middle of every recording: crash:/starter\n' in out
    assert len(re.findall(r'^  crash  ', out, re.MULTILINE)) == 3
    # Who names it wants to know.
    assert 'nothing would change' in error_of(calibrate, [*arguments, '--inject',
                                                          'crash:/starter'])


def test_a_model_that_watches_nothing_is_what_is_wrong(robot_bags: Bags, long_bags: Bags,
                                                       tmp_path) -> None:
    model = str(tmp_path / 'm')
    trained([f'{robot_bags[0]}@0-0.2'], tmp_path / 'm')
    error = error_of(calibrate, ['--model', model, '-o', model, '--normal', long_bags[1]])
    assert f'{model}: the model watches nothing' in error and '--normal' not in error
