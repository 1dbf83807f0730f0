"""`calibrate --detector paper`: the threshold, what is said of it, and what is not written."""
from __future__ import annotations

import csv
import math
import os
import re
from typing import Callable, List, Tuple

import pytest
from conftest import robot

from self_awareness import Roc, TrainedModel
from self_awareness.calibration import confidence
from self_awareness.calibration.threshold_rule import ThresholdRule
from self_awareness.commands import calibrate

Bags = Tuple[str, str]


@pytest.fixture
def run(model_file: str, robot_bags: Bags, tmp_path,
        capsys) -> Callable[..., Tuple[int, str, str]]:
    """Return a function that calibrates on the second recording: exit code, output, errors."""
    options = ['--model', model_file, '--normal', robot_bags[1], '--detector', 'paper']

    def calibrated(*arguments: str) -> Tuple[int, str, str]:
        code = calibrate.main([*options, '-o', str(tmp_path / 'm'), *arguments])
        captured = capsys.readouterr()
        return code, captured.out, captured.err
    return calibrated


def test_injected_faults_are_told_and_their_alarms_timed(run, tmp_path) -> None:
    code, out, err = run('--inject', 'crash:/laser', 'starve', '--inject', 'slow:/laser:2')
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


def test_what_is_stored_follows_from_the_windows_in_the_csv(run, tmp_path) -> None:
    table = tmp_path / 'w.csv'
    assert run('--inject', 'crash:/laser', 'crash:/slam', '--csv', str(table))[0] == 0
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
        run, make_bag: Callable[..., str], tmp_path) -> None:
    dead = [m for m in robot(3000.0) if not (3012.0 <= m[0] < 3020.0 and m[1] == '/laser')]
    bag = make_bag('dead.bag', dead)
    table = tmp_path / 'w.csv'
    code, out, _ = run('--faulty', f'{bag}@12-20', '--csv', str(table))
    assert code == 0 and f'{bag}@12-20: 80 abnormal windows' in out
    with open(table, newline='') as file:
        starts = [int(row['window_start_ns']) / 1e9 for row in csv.DictReader(file)
                  if row['label'] == 'abnormal']
    assert min(starts) >= 3012.0 and max(starts) + 0.1 <= 3020.001
    calibration = TrainedModel.load(str(tmp_path / 'm')).paper_calibration
    assert calibration.auc > 0.95 and calibration.injected == []
    assert (calibration.faulty[0].bag, calibration.faulty[0].start) == ('dead.bag', 3012 * 10 ** 9)


def test_a_level_needs_no_faults(run, tmp_path) -> None:
    code, out, _ = run('--cutoff', 'fpr=0.02')
    calibration = TrainedModel.load(str(tmp_path / 'm')).paper_calibration
    assert code == 0 and 'AUC' not in out and calibration.method == 'fpr=0.02'
    assert math.isnan(calibration.auc) and math.isnan(calibration.true_positive_rate)
    assert 0.0 < calibration.false_positive_rate <= 0.02
    out = run('--cutoff', 'fpr=0.0001')[1]
    assert 'too little to say' in out and 'less than one of these windows' in out
    assert re.search(r'false alarms after persistence: [1-9]', run('--cutoff', 'fpr=0.9')[1])
    assert TrainedModel.load(str(tmp_path / 'm')).paper_calibration.false_alarms_per_hour > 100.0


@pytest.mark.parametrize('arguments, parts', [
    ((), ['youden', '--faulty', '--inject', 'fpr=RATE']),
    (('--cutoff', 'closest'), ['closest', '--inject']),
    (('--inject', 'crash:/motor'), ['/motor', '/battery, /laser, /slam']),
    (('--roc', 'r.png', '--cutoff', 'fpr=0.1'), ['--roc', '--inject']),
    (('--inject', 'starve', '--settle-time', '60'), ['--normal', '--settle-time']),
])
def test_an_error_names_the_way_out_and_writes_nothing(run, tmp_path, monkeypatch, arguments,
                                                       parts: List[str]) -> None:
    monkeypatch.chdir(tmp_path)
    code, _, err = run(*arguments)
    assert code == 1 and err.count('\n') == 1 and err.startswith('calibrate: error: ')
    for part in parts:
        assert part in err
    assert os.listdir(tmp_path) == []


def test_recordings_that_were_trained_on_are_refused(run, robot_bags: Bags, model_file: str,
                                                     tmp_path) -> None:
    os.symlink(robot_bags[0], tmp_path / 'renamed.bag')
    for option in ('--normal', '--faulty'):
        code, _, err = run(option, str(tmp_path / 'renamed.bag'), '--inject', 'starve')
        assert code == 1 and 'renamed.bag: the model was trained on it (as first.bag)' in err
        assert 'BAG@START-END' in err
    code, _, err = run('--normal', robot_bags[1], '--inject', 'starve')
    assert code == 1 and 'the same recording' in err
    assert not (tmp_path / 'm').exists()


def test_a_fault_that_is_over_before_the_detector_settled_is_refused(
        run, make_bag: Callable[..., str], tmp_path) -> None:
    bag = make_bag('early.bag', robot(3000.0))
    for part, told in (('1-4', '--settle-time'), ('40', 'lasts 30.0 s'), ('9-7', 'no part')):
        code, _, err = run('--faulty', f'{bag}@{part}')
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


def test_faults_that_score_higher_get_a_warning(run, make_bag: Callable[..., str], tmp_path,
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
