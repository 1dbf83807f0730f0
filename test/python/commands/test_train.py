"""`train`: what it learns, says and writes."""
from __future__ import annotations

import math
import os
import re
import subprocess
import sys
import threading
from pathlib import Path
from typing import Any, Callable, Dict, List, Tuple
from xmlrpc.server import SimpleXMLRPCServer

import pytest
from conftest import error_of, printed_by, robot, trained, wait_until

from self_awareness import TrainedModel, stable_name
from self_awareness.commands import calibrate, info, score, train

Bags = Tuple[str, str]


def said(arguments: List[str]) -> List[str]:
    """Return the lines that are printed with --details."""
    lines = printed_by(train, [*arguments, '--details']).splitlines()
    return [' '.join(line.split()) for line in lines]


def test_it_says_what_it_learned(robot_bags: Bags, tmp_path) -> None:
    output = str(tmp_path / 'm')
    lines = said([*robot_bags, '-o', output])
    assert f'{robot_bags[0]}: 30.0 s, 1282 events' in lines
    for line in ('recordings 2, 60 s', 'events 2564', 'sources 3', 'pairs 9 of 9 with delays'):
        assert line in lines
    model = TrainedModel.load(output)
    assert [recording.bag for recording in model.recordings] == ['first.bag', 'second.bag']
    assert model.bin_size == 10_000_000 and model.window == 100_000_000
    assert model.horizon_bins == 0 and model.threshold is None
    assert model.encoding.source == 'callerid' and model.detectors == 'evidence'


def test_parts_of_bags_are_trained_on(robot_bags: Bags, tmp_path) -> None:
    output, (first, second) = str(tmp_path / 'm'), robot_bags
    lines = said([f'{first}@2-12', f'{first}@12.01-20', second, '--start', '5', '-o', output])
    assert f'{first}@2-12: 10.0 s, 428 events' in lines
    assert [line.split(':')[0] for line in lines[1:3]] == [f'{first}@12.01-20', f'{second}@5']
    assert lines[3].startswith('learned from 2 starts, 43 s: ')
    spans = [((each.start - origin) / 1e9, (each.end - origin) / 1e9)
             for each, origin in zip(TrainedModel.load(output).recordings,
                                     (1000 * 10**9, 1000 * 10**9, 2000_033 * 10**6))]
    assert spans == [pytest.approx(span, abs=0.06) for span in ((2, 12), (12, 20), (5, 30))]


@pytest.mark.parametrize('parts, same', [
    (('@2-12', '@11-20'), ('@11-20', '@2-12')), (('', '@25'), ('@25', '')),
    (('@3', '@2-4'), ('@2-4', '@3'))])
def test_parts_that_overlap_are_refused(robot_bags: Bags, parts: Bags, same: Bags,
                                        tmp_path) -> None:
    bag = robot_bags[0]
    error = error_of(train, [bag + parts[0], bag + parts[1], '-o', str(tmp_path / 'm')])
    assert f'{bag}{same[0]}: the same recording as {bag}{same[1]}; name it once' in error


def test_the_options_reach_the_model(robot_bags: Bags, tmp_path) -> None:
    encoding = tmp_path / 'encoding.yaml'
    encoding.write_text('source: none\nexclude_topics: [/charge]\n')
    output = str(tmp_path / 'm')
    lines = said([robot_bags[0], '-o', output, '--bin', '0.005', '--window', '0.25', '--horizon',
                  '10', '--start', '10', '--end', '20', '--encoding', str(encoding)])
    assert 'sources not told apart' in lines
    model = TrainedModel.load(output)
    assert (model.bin_size, model.window, model.horizon_bins) == (5_000_000, 250_000_000, 2000)
    assert [str(kind) for kind in model.event_types] == ['- /scan std_msgs/String',
                                                         '- /map std_msgs/String']
    start, end = model.recordings[0].start / 1e9, model.recordings[0].end / 1e9
    assert 1010.0 <= start < 1010.05 and 1019.95 < end <= 1020.0


@pytest.mark.parametrize('detector, other', [('evidence', 'paper'), ('paper', 'evidence')])
def test_a_model_is_for_the_detector_that_it_was_trained_for(
        detector: str, other: str, long_bags: Bags, tmp_path) -> None:
    model, output = str(tmp_path / 'm'), str(tmp_path / 'calibrated')
    trained([long_bags[0]], tmp_path / 'm', '--end', '50', '--detector', detector)
    model_of_both = trained([long_bags[1]], tmp_path / 'm', '--add-to', model)
    assert model_of_both.detectors == detector and len(model_of_both.recordings) == 2
    for program, arguments in (
            (calibrate, ['--model', model, '--normal', long_bags[0], '-o', output]),
            (score, [long_bags[0], '--model', model])):
        error = error_of(program, [*arguments, '--detector', other])
        assert f'{model}: it holds no counts for the {other}' in error
        assert f'--detector {other} or both' in error
    assert not os.path.exists(output)
    assert f'detector     {detector}' in printed_by(info, [model, '--details'])


def test_one_recording_gives_preliminary_limits_by_its_halves(long_bags: Bags, tmp_path,
                                                              capsys) -> None:
    output = tmp_path / 'm'
    found = trained([long_bags[0]], output).calibration
    lines = capsys.readouterr().out.splitlines()
    # The detector settles for 5 s of 120 s; the second part settles in the first one.
    assert found.method == 'cross-fit' and found.windows == pytest.approx(1150, abs=4)
    assert re.fullmatch(r'learned from 1 start, 2 min: at most 1\.\d false alarms an hour '
                        r'\(preliminary\); deaths of all 3 nodes found within 0\.\d+ s', lines[0])
    assert re.fullmatch('record next: 32 min of other starts, for half as many false alarms.*',
                        lines[1])
    assert lines[2:] == [
        f'written: {output}', 'next, with recordings that it was not trained on:',
        f'  rosrun self_awareness calibrate --model {output} --normal BAG -o {output}']
    assert [recording.bag for recording in found.recordings] == ['monday.bag']
    assert 0.0 <= found.false_alarms_per_hour < math.inf and found.budget == 0.5


def test_too_little_for_limits_is_told_and_the_model_is_written(robot_bags: Bags, tmp_path,
                                                                capsys) -> None:
    assert trained([robot_bags[0]], tmp_path / 'm').calibration is None
    told = capsys.readouterr()
    assert told.out.splitlines()[0] == (
        'learned from 1 start, 30 s: no limits yet, so that nothing is an alarm')
    warning, = told.err.splitlines()
    assert warning.startswith('train: warning: no limits: too little normal operation')
    assert '50 s' in warning


def test_the_graph_needs_a_master(robot_bags: Bags, tmp_path, monkeypatch) -> None:
    # Nobody listens on port 1.
    monkeypatch.setenv('ROS_MASTER_URI', 'http://127.0.0.1:1')
    error = error_of(train, [robot_bags[0], '--graph', '-o', str(tmp_path / 'm')])
    assert error.startswith('train: error: --graph: no master at http://127.0.0.1:1')
    assert 'ROS_MASTER_URI' in error
    assert not (tmp_path / 'm').exists()


def test_only_the_master_is_asked_for_the_graph(robot_bags: Bags, tmp_path, monkeypatch) -> None:
    asked = []
    node, slam = '/slam_4242_1600000000000', stable_name('/slam_4242_1600000000000')

    class Master:
        """Answers all calls, and remembers them."""

        def _dispatch(self, method: str, arguments: Tuple) -> Any:
            asked.append(method)
            if method == 'system.multicall':  # looks up nodes
                return [[(1, '', 'http://base:1234/')] for _ in arguments[0]]
            state = [[['/scan', ['/laser']], ['/map', [node]], ['/charge', ['/battery']]],
                     [['/scan', [node, '/log']], ['/map', ['/log']]], []]
            return (1, '', {'getSystemState': state, 'getTopicTypes': []}[method])

    with SimpleXMLRPCServer(('127.0.0.1', 0), logRequests=False) as server:
        server.register_instance(Master())
        threading.Thread(target=server.serve_forever).start()
        monkeypatch.setenv('ROS_MASTER_URI', f'http://127.0.0.1:{server.server_address[1]}')
        model = trained([robot_bags[0]], tmp_path / 'm', '--graph')
        server.shutdown()
    # It neither registered, nor asked any node.
    assert asked == ['getSystemState', 'getTopicTypes', 'system.multicall']
    assert set(model.hosts) == {'/laser', '/battery', slam} and model.hosts['/laser'] == 'base'
    assert model.graph == {('/laser', '/scan', slam), ('/laser', '/scan', '/log'),
                           (slam, '/map', '/log')}


@pytest.mark.parametrize('program', [['train'], ['calibrate', '--model', 'm', '--normal']])
def test_the_robots_nodes_go_first(program: List[str], model_file: str, tmp_path) -> None:
    own = os.getpriority(os.PRIO_PROCESS, 0)
    if own == 19:
        pytest.skip('these tests run at the lowest priority')
    bag = tmp_path / 'never_ends.bag'
    os.mkfifo(bag)  # who opens it waits
    script = Path(__file__).resolve().parents[3] / 'scripts' / program[0]
    arguments = [model_file if argument == 'm' else argument for argument in program[1:]]
    with subprocess.Popen([sys.executable, str(script), *arguments, str(bag), '-o',
                           str(tmp_path / 'm')], stderr=subprocess.DEVNULL) as process:
        try:
            wait_until(lambda: os.getpriority(os.PRIO_PROCESS, process.pid) > own, 'stands back')
        finally:
            process.kill()


def found_after(model: TrainedModel) -> Dict[str, float]:
    """Return how soon the death of each component is found [s]; infinity: it is not."""
    return {each.component: each.death_found_after or math.inf for each in model.coverage()}


def test_a_hole_in_one_recording_is_named_and_left_out_if_asked(
        make_bag: Callable[..., str], tmp_path, capsys) -> None:
    """Of one start; where most starts do not say otherwise, it decides (calibration/holes.py)."""
    whole = [make_bag(f'{day}.bag', robot(70.0 * number, 60.0))
             for number, day in enumerate(('monday', 'tuesday'), 1)]
    hung = make_bag('friday.bag', [each for each in robot(210.0, 60.0)
                                   if each[1] != '/slam' or not 230.0 < each[0] < 236.0])
    model = trained([*whole, hung], tmp_path / 'm')
    told = capsys.readouterr().err
    assert re.search(r'friday.bag: /slam \(/map\) is silent for 6.\d s from (19.9|20.0) s', told)
    assert 'because of that its death is found after' in told and '--leave-out-holes' in told
    assert found_after(model)['/laser'] < 1.0 and found_after(model)['/slam'] > 6.0
    model = trained([*whole, hung], tmp_path / 'm', '--leave-out-holes')
    assert 'left out: ' in capsys.readouterr().err
    assert found_after(model)['/slam'] < 1.0
    assert [recording.bag for recording in model.recordings].count('friday.bag') == 2
