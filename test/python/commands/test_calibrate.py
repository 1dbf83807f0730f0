"""`calibrate` by either detector: limits and threshold, what is said of them, what is refused."""
from __future__ import annotations

import csv
import math
import os
import re
from pathlib import Path
from typing import Any, Callable, Dict, List, Tuple

import pytest
from conftest import error_of, jittery_robot, printed_by, robot, trained

from self_awareness import EvidenceModel, Roc, TrainedModel
from self_awareness.calibration import confidence
from self_awareness.calibration.threshold_rule import ThresholdRule
from self_awareness.commands import calibrate
from self_awareness.reporting import evidence_report

Bags = Tuple[str, str]
Calibrated = Callable[..., Tuple[int, str, str]]


def calibrating(capsys: Any, folder: Path, *options: str) -> Calibrated:
    """Return a function that calibrates with these options: exit code, output, errors."""
    def calibrated(*arguments: str) -> Tuple[int, str, str]:
        code = calibrate.main([*options, '-o', str(folder / 'm'), *arguments])
        captured = capsys.readouterr()
        return code, captured.out, captured.err
    return calibrated


@pytest.fixture
def by_paper(model_file: str, robot_bags: Bags, tmp_path: Path, capsys) -> Calibrated:
    return calibrating(capsys, tmp_path, '--model', model_file, '--normal', robot_bags[1],
                       '--detector', 'paper')


@pytest.fixture(name='base', scope='module')
def _base(long_bags: Bags, tmp_path_factory) -> str:
    path = tmp_path_factory.mktemp('trained') / 'm'
    trained([long_bags[0]], path)
    return str(path)


@pytest.fixture
def by_evidence(base: str, long_bags: Bags, tmp_path: Path, capsys) -> Calibrated:
    return calibrating(capsys, tmp_path, '--model', base, '--normal', long_bags[1])


@pytest.mark.parametrize('detector, arguments, parts', [
    ('paper', (), ['youden', '--faulty', '--inject', 'fpr=RATE']),
    ('paper', ('--cutoff', 'closest'), ['closest', '--inject']),
    ('paper', ('--inject', 'crash:/motor'), ['/motor', '/battery, /laser, /slam']),
    ('paper', ('--roc', 'r.png', '--cutoff', 'fpr=0.1'), ['--roc', '--inject']),
    ('paper', ('--inject', 'starve', '--settle-time', '60'), ['--normal', '--settle-time']),
    ('evidence', ('--cutoff', 'youden'), ['--cutoff', '--detector paper', '--budget']),
    ('evidence', ('--detector', 'paper', '--budget', '1'),
     ['--budget', '--detector evidence', '--cutoff']),
    ('evidence', ('--settle-time', '80'), ['--normal', 'too little normal operation',
                                           'at least 50 s', 'of every recording']),
    ('evidence', ('--inject', 'crash:/motor'), ['/motor', '/battery, /laser, /slam']),
])
def test_an_error_names_the_way_out_and_writes_nothing(
        detector: str, arguments: Tuple[str, ...], parts: List[str], tmp_path: Path,
        request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    code, _, err = request.getfixturevalue(f'by_{detector}')(*arguments)
    assert code == 1 and err.count('\n') == 1 and err.startswith('calibrate: error: ')
    for part in parts:
        assert part in err
    assert os.listdir(tmp_path) == []


def test_injected_faults_are_told_and_their_alarms_timed(by_paper, tmp_path) -> None:
    code, out, err = by_paper('--inject', 'crash:/laser', 'starve', '--inject', 'slow:/laser:2')
    assert code == 0 and err == ''
    for fault in ('crash:/laser', 'starve', 'slow:/laser:2', 'all together'):
        assert f'{fault}: ' in out
    latency = float(re.search(r'crash:/laser: .*?median ([\d.]+) s', out, re.DOTALL)[1])
    assert 0.0 < latency < 2.0
    calibration = TrainedModel.load(str(tmp_path / 'm')).paper_calibration
    assert calibration.auc > 0.95 and calibration.true_positive_rate > 0.9
    assert calibration.false_positive_rate < 0.1
    assert calibration.injected == ['crash:/laser', 'starve', 'slow:/laser:2']
    assert calibration.method == 'youden' and calibration.faulty == []
    assert [recording.bag for recording in calibration.normal] == ['second.bag']


def test_what_is_stored_follows_from_the_windows_in_the_csv(by_paper, tmp_path) -> None:
    table = tmp_path / 'w.csv'
    assert by_paper('--inject', 'crash:/laser', 'crash:/slam', '--csv', str(table))[0] == 0
    with open(table, newline='') as file:
        rows = list(csv.DictReader(file))
    scores = {label: [float(row['score']) for row in rows if row['label'] == label]
              for label in ('normal', 'abnormal', '')}
    calibration = TrainedModel.load(str(tmp_path / 'm')).paper_calibration
    roc = Roc(scores['normal'], scores['abnormal'])
    assert calibration.auc == roc.auc
    assert calibration.threshold == roc.youden().cutoff
    assert calibration.normal_windows == len(scores['normal'])
    assert calibration.faulty_windows == len(scores['abnormal'])
    assert calibration.false_positive_rate == roc.youden().false_positive_rate
    # 30 s of which 5 s settle, and twice the half of it.
    assert len(scores['normal']) == pytest.approx(250, abs=1)
    assert len(scores['abnormal']) == pytest.approx(300, abs=3)
    assert {row['fault'] for row in rows} == {'', 'crash:/laser', 'crash:/slam'}


def test_windows_of_a_recorded_fault_are_abnormal_only_in_its_range(
        by_paper, make_bag: Callable[..., str], tmp_path) -> None:
    dead = [m for m in robot(3000.0) if not (3012.0 <= m[0] < 3020.0 and m[1] == '/laser')]
    bag = make_bag('dead.bag', dead)
    table = tmp_path / 'w.csv'
    code, out, _ = by_paper('--faulty', f'{bag}@12-20', '--csv', str(table))
    assert code == 0 and f'{bag}@12-20: 80 abnormal windows' in out
    with open(table, newline='') as file:
        starts = [int(row['window_start_ns']) / 1e9 for row in csv.DictReader(file)
                  if row['label'] == 'abnormal']
    assert min(starts) >= 3012.0 and max(starts) + 0.1 <= 3020.001
    calibration = TrainedModel.load(str(tmp_path / 'm')).paper_calibration
    assert calibration.auc > 0.95 and calibration.injected == []
    assert (calibration.faulty[0].bag, calibration.faulty[0].start) == ('dead.bag', 3012 * 10 ** 9)


def test_a_level_needs_no_faults(by_paper, tmp_path) -> None:
    code, out, _ = by_paper('--cutoff', 'fpr=0.02')
    calibration = TrainedModel.load(str(tmp_path / 'm')).paper_calibration
    assert code == 0 and 'AUC' not in out and calibration.method == 'fpr=0.02'
    assert math.isnan(calibration.auc) and math.isnan(calibration.true_positive_rate)
    assert 0.0 < calibration.false_positive_rate <= 0.02
    out = by_paper('--cutoff', 'fpr=0.0001')[1]
    assert 'too little to say' in out and 'less than one of these windows' in out
    assert re.search(r'false alarms after persistence: [1-9]', by_paper('--cutoff', 'fpr=0.9')[1])
    assert TrainedModel.load(str(tmp_path / 'm')).paper_calibration.false_alarms_per_hour > 100.0


def test_recordings_that_were_trained_on_are_refused(by_paper, robot_bags: Bags, model_file: str,
                                                     tmp_path) -> None:
    os.symlink(robot_bags[0], tmp_path / 'renamed.bag')
    for option in ('--normal', '--faulty'):
        code, _, err = by_paper(option, str(tmp_path / 'renamed.bag'), '--inject', 'starve')
        assert code == 1 and 'renamed.bag: the model was trained on it (as first.bag)' in err
        assert 'BAG@START-END' in err
    code, _, err = by_paper('--normal', robot_bags[1], '--inject', 'starve')
    assert code == 1 and 'the same recording' in err
    assert not (tmp_path / 'm').exists()


def test_a_fault_that_is_over_before_the_detector_settled_is_refused(
        by_paper, make_bag: Callable[..., str], tmp_path) -> None:
    bag = make_bag('early.bag', robot(3000.0))
    for part, told in (('1-4', '--settle-time'), ('40', 'lasts 30.0 s'), ('9-7', 'no part')):
        code, _, err = by_paper('--faulty', f'{bag}@{part}')
        assert code == 1 and f'early.bag@{part}' in err and told in err
    assert not (tmp_path / 'm').exists()


def test_a_threshold_that_cannot_be_found_or_that_no_window_could_miss_is_refused() -> None:
    for scores in (([1.0, 2.0], [3.0, 4.0]), ([1.0, 1.0], [1.0])):
        with pytest.raises(ValueError, match='finds no threshold.*fpr=RATE'):
            ThresholdRule('youden').choose(Roc(*scores))
    normal = [0.0, 0.0] + [1.0] * 98
    with pytest.raises(ValueError, match='allow a higher rate'):
        ThresholdRule('fpr', 0.01).choose(Roc(normal, []))
    assert ThresholdRule('fpr', 0.02).choose(Roc(normal, [])).cutoff == 0.5


def test_faults_that_score_higher_get_a_warning(by_paper, make_bag: Callable[..., str], tmp_path,
                                                model_file: str, capsys) -> None:
    crashed = make_bag('crashed.bag', [m for m in robot(5000.0) if m[1] != '/laser'])
    normal = make_bag('normal.bag', robot(6000.0))
    assert calibrate.main(['--model', model_file, '--normal', crashed, '--faulty', normal, '-o',
                           str(tmp_path / 'm'), '--detector', 'paper', '--cutoff', 'fpr=0.1']) == 0
    captured = capsys.readouterr()
    assert captured.err.startswith('calibrate: warning: AUC 0.')


def test_intervals_are_those_of_the_textbooks() -> None:
    # Wilson: Newcombe (1998), table I, method 3.
    assert confidence.wilson(81, 263) == pytest.approx((0.2553, 0.3662), abs=5e-5)
    assert confidence.wilson(0, 20) == pytest.approx((0.0, 0.1611), abs=5e-5)
    assert confidence.wilson(29, 29) == pytest.approx((0.8830, 1.0), abs=5e-5)
    # The limits of a Poisson count by the score: (count - rate)^2 = z^2 rate.
    for count in (0, 4):
        for limit in confidence.poisson_rate(count, 1.0):
            assert (count - limit) ** 2 == pytest.approx(1.959964 ** 2 * limit, abs=1e-5)
    low, high = confidence.poisson_rate(4, 2.0)
    assert 2 * low < 4 < 2 * high


def test_the_limits_are_stored_with_how_they_were_found(by_evidence, base: str, tmp_path) -> None:
    code, out, err = by_evidence('--budget', '0.25')
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


def test_the_verdict_comes_first_then_what_to_record_and_the_next_command(by_evidence,
                                                                          tmp_path) -> None:
    model = tmp_path / 'm'
    _, out, _ = by_evidence()
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
            in by_evidence('--details')[1])


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


def test_faults_are_told_in_a_table_and_without_details_those_that_were_not_found(
        by_evidence) -> None:
    faults = ('--inject', 'crash:*', 'slow:/laser:1.01')
    found = ('half of them within {0}, the last after {0}; the node is named first in 3 of 3'
             ).format(r'\d\.\d+ s')
    head = ['fault', 'node', 'found', 'after', 'named first', 'among three']

    def table(*options: str) -> Tuple[str, List[List[str]]]:
        lines = by_evidence(*faults, *options)[1].splitlines()
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
