"""`info`: what is in a model, for people and for programs."""
from __future__ import annotations

import json
import math
import os
import subprocess
import sys
from pathlib import Path
from typing import Any, Dict

import pytest
from conftest import error_of, printed_by, robot, train_tuned, trained

from self_awareness import EvidenceModel, TrainedModel, Tuning
from self_awareness.commands import calibrate, info

LASER, SLAM = '/laser /scan std_msgs/String', '/slam /map std_msgs/String'


def as_json(path: str) -> Dict[str, Any]:
    return json.loads(printed_by(info, [path, '--json']))


def test_json_holds_all_but_the_histograms(model_file: str) -> None:
    summary = as_json(model_file)
    assert summary['window'] == 0.1 and summary['bin_size'] == 0.01
    assert summary['horizon'] is None and summary['calibration'] is None
    assert summary['graph'] == [] and summary['evidence']['calibration'] is None
    assert summary['sources'] == ['/battery', '/laser', '/slam']
    assert summary['events'] == 1282 and summary['pairs'] == 9
    assert summary['encoding']['type_fields']['rosgraph_msgs/Log'] == 'level'
    assert [recording['bag'] for recording in summary['recordings']] == ['first.bag']
    laser = next(kind for kind in summary['event_types'] if kind['scope'] == '/scan')
    assert laser['count'] == 600 and laser['gaps'] == 599 and laser['judged']
    assert laser['rate'] == pytest.approx(20.0, rel=0.01)
    assert laser['usual_shortest'] <= 0.05 <= laser['usual_longest'] <= 0.07
    assert summary['highest_rate'] == pytest.approx(20.0, rel=0.01)
    assert summary['lowest_rate'] == pytest.approx(1 / 0.37, rel=0.02)


def test_json_holds_the_calibration(model_file: str, robot_bags, tmp_path) -> None:
    output = str(tmp_path / 'm')
    assert calibrate.main(['--model', model_file, '--normal', robot_bags[1], '--detector', 'paper',
                           '--cutoff', 'fpr=0.01', '-o', output]) == 0
    found = as_json(output)['calibration']
    stored = TrainedModel.load(output).paper_calibration
    assert found['threshold'] == stored.threshold and found['method'] == 'fpr=0.01'
    assert found['auc'] is None and found['true_positive_rate'] is None  # no faulty windows
    assert found['normal'][0]['fingerprint'] == f'{stored.normal[0].fingerprint:016x}'


def test_json_holds_the_evidence(evidence_model: str) -> None:
    found = as_json(evidence_model)['evidence']
    model = TrainedModel.load(evidence_model)
    stored = model.calibration
    assert set(found['tracks']) <= {'overdue', 'pace', 'pairs', 'deadlines', 'size'}
    assert found['tracks']['overdue'] == 3 and found['tracks']['pace'] == 6
    assert sum(found['tracks'].values()) == len(EvidenceModel(model).tracks)
    assert found['not_judged'] == []
    assert found['tuning'] == {each.name: each.default for each in Tuning.numbers()}
    assert found['without'] == []
    calibration = found['calibration']
    assert (calibration['method'], calibration['budget']) == ('held-out', 0.5)
    assert calibration['windows'] == stored.windows
    assert calibration['calibrated_ns'] == stored.stamp
    assert calibration['false_alarms_per_hour'] == stored.false_alarms_per_hour >= 0.0
    assert [recording['bag'] for recording in calibration['normal']] == ['tuesday.bag']
    judged = sum(not math.isnan(limit) for limit in stored.limits)
    assert sum(calibration['judged_tracks'].values()) == judged


def test_the_graph_is_told_with_who_publishes_nothing(long_bags, tmp_path: Path) -> None:
    output = tmp_path / 'm'
    model = trained(long_bags[:1], output)
    model.graph = {('/laser', '/scan', '/slam'), ('/laser', '/scan', '/map_saver')}
    model.save(str(output))
    summary = as_json(str(output))
    assert summary['graph'] == [
        {'publisher': '/laser', 'topic': '/scan', 'subscriber': '/map_saver'},
        {'publisher': '/laser', 'topic': '/scan', 'subscriber': '/slam'}]
    assert summary['evidence']['calibration']['method'] == 'cross-fit'
    printed = printed_by(info, [str(output), '--details'])
    assert 'sources that somebody listens to: 1, connections: 2' in printed
    assert 'not watched, since they publish nothing: /map_saver' in printed


def test_the_tuning_of_the_training_stays_and_is_shown(long_bags, tmp_path) -> None:
    output = train_tuned(long_bags[:1], tmp_path / 'm', least_effect=0.0025, deadlines=1)
    assert calibrate.main(['--model', output, '--normal', long_bags[1], '-o', output]) == 0
    evidence = as_json(output)['evidence']
    assert evidence['calibration']['method'] == 'held-out'
    assert evidence['tuning']['least_effect'] == 0.0025
    lines = printed_by(info, [output, '--tuning']).splitlines()
    assert [line.split()[0] for line in lines] == [each.name for each in Tuning.numbers()]
    assert [line.split()[:2] for line in lines if '(default: ' in line] == [
        ['deadlines', '1'], ['least_effect', '0.0025']]


def test_people_read_the_same(model_file: str, evidence_model: str) -> None:
    for model, parts in (
            (evidence_model, ['evidence     watches: overdue 3, pace 6',
                              'limits       of recordings that were not trained on, for 0.5 false',
                              'graph        none', 'tuesday.bag', 'next:\n  roslaunch ']),
            (model_file, ['not calibrated', 'first.bag', '1282', LASER, SLAM, '/rosout_agg',
                          'no horizon'])):
        text = printed_by(info, [model, '--details'])
        assert [part for part in parts if part not in text] == []
        assert ('death found after' in text) == (model == evidence_model)


def test_a_reader_that_has_seen_enough_is_told_nothing(model_file: str) -> None:
    script = Path(__file__).resolve().parents[3] / 'scripts' / 'info'
    reading, writing = os.pipe()
    os.close(reading)
    process = subprocess.run([sys.executable, str(script), model_file], stdout=writing,
                             stderr=subprocess.PIPE, text=True)
    os.close(writing)
    assert process.stderr == '' and process.returncode == 1


def test_rates_of_a_recording_stand_beside_the_usual_ones_what_is_most_off_first(
        model_file: str, make_bag: Any) -> None:
    messages = [each for each in robot(3000.0, 20.0) if each[1] != '/slam']
    messages += [(3000.0 + 0.5 * k, '/rostopic', '/cmd_vel') for k in range(1, 40)]
    half = [each for k, each in enumerate(m for m in messages if m[1] == '/laser') if k % 2]
    bag = make_bag('odd.bag', sorted([m for m in messages if m[1] != '/laser'] + half))
    head, columns, *rows = printed_by(info, [bag, '--model', model_file]).splitlines()
    assert head.startswith(f'{bag}: 20.0 s') or head.startswith(f'{bag}: 19.')
    assert columns.split() == ['component', 'topic', 'now', '[Hz]', 'usual', '[Hz]', 'ratio']
    cells = [row.split() for row in rows]
    assert [row[:2] for row in cells] == [['/slam', '/map'], ['/rostopic', '/cmd_vel'],
                                          ['/laser', '/scan'], ['/battery', '/charge']]
    slam, stranger, laser, battery = cells
    assert slam[2] == slam[4] == '0' and slam[5:] == ['missing']
    assert stranger[3:] == ['-', '-', 'unknown'] and 1.8 < float(stranger[2]) < 2.1
    assert 9.5 < float(laser[2]) < 10.5 and 19.5 < float(laser[3]) < 20.5
    assert 0.45 < float(laser[4]) < 0.55 and len(laser) == 5
    assert 0.9 < float(battery[4]) < 1.1

    part, whole = json.loads(printed_by(info, [f'{bag}@5-15', bag, '--model', model_file,
                                               '--json']))['recordings']
    assert part['duration'] == pytest.approx(10.0)
    assert whole['topics'][0] == {'component': '/slam', 'topic': '/map', 'rate': 0.0,
                                  'usual_rate': pytest.approx(20.0, rel=0.1), 'ratio': 0.0,
                                  'note': 'missing'}
    assert part['topics'][2]['rate'] == pytest.approx(10.0, rel=0.1)


def test_rates_of_what_cannot_be_read_are_refused(model_file: str, robot_bags: Any,
                                                  capsys: pytest.CaptureFixture) -> None:
    assert info.main([robot_bags[0], '/gone.bag', '--model', model_file]) == 1
    said = capsys.readouterr()
    assert '/laser' in said.out and '/gone.bag' in said.err
    assert info.main([robot_bags[0], '/gone.bag', '--model', model_file, '--skip-bad']) == 0
    assert 'skipped: /gone.bag' in capsys.readouterr().err
    assert 'is a model, and no recording' in error_of(info, [model_file, '--model', model_file])
    assert '--tuning: is for one model alone' in error_of(info, [robot_bags[0], '--model',
                                                                 model_file, '--tuning'])
    assert 'holds no model' in error_of(info, [robot_bags[0], '--model', robot_bags[0]])
    error = error_of(info, [robot_bags[0]])
    assert f"info '{robot_bags[0]}' --model MODEL" in error
    assert f"score '{robot_bags[0]}' --model MODEL" in error and 'train' not in error
