"""Files of every release are read, and say for ever what they said (docs/monitor.md).

The files are in test/data: README.md there says how they were made.
"""
from __future__ import annotations

import json
import subprocess
import sys
from collections import defaultdict
from pathlib import Path
from typing import Any, Dict, List, Tuple

import pytest
import rosbag
import yaml
from conftest import printed_by

from self_awareness import METHOD, EncodingRules, FileVersion, ResultBag, TrainedModel
from self_awareness.commands import calibrate, info, merge, score, train
from self_awareness.training.robot_graph import RobotGraph

DATA = Path(__file__).resolve().parents[1] / 'data'
RELEASES = [DATA / '0.1.0']
RECORDINGS = ('normal_6.events.bag', 'dead.events.bag', 'late.events.bag')
FORMATS = {'robot.model': 8, 'dead.events.bag': 6, 'results.bag': 2}
"""What is written now, by the file of its kind."""

every_release = pytest.mark.parametrize('folder', RELEASES, ids=[path.name for path in RELEASES])

Key = Tuple[str, str, str]


def says(folder: Path) -> Dict[str, Any]:
    """Return what the model of a format says now, in a process of its own."""
    done = subprocess.run(
        (sys.executable, str(DATA / 'says.py'), 'robot.model', *RECORDINGS), cwd=folder,
        stdout=subprocess.PIPE, text=True, check=True)
    return json.loads(done.stdout)


def by_track(limits: List[Dict[str, Any]]) -> Dict[Key, List[float]]:
    """Return the limits of each pair of event types on a channel, in order."""
    found: Dict[Key, List[float]] = defaultdict(list)
    for each in limits:
        found[each['channel'], each['to'], each['from']].append(each['limit'])
    return {key: sorted(values) for key, values in found.items()}


def printed(path: Path, *options: str) -> str:
    return printed_by(info, [str(path), *options])


def test_what_is_written_now_has_its_files(tmp_path: Path) -> None:
    for folder in RELEASES:
        size = sum(path.stat().st_size for path in folder.iterdir())
        assert size < 300_000, 'they are small'
    newest = str(RELEASES[-1] / 'robot.model')
    TrainedModel.load(newest).save(str(tmp_path / 'now'))
    for model in (newest, str(tmp_path / 'now')):
        assert TrainedModel.load(model).version.format == FORMATS['robot.model']


@every_release
def test_a_model_says_for_ever_what_it_said(folder: Path) -> None:
    found, expected = says(folder), json.loads((folder / 'expected.json').read_text())
    first = [[alarm['suspects'][0].split()[0] for alarm in said['evidence']]
             for said in map(expected['recordings'].get, RECORDINGS)]
    assert first == [[], ['/laser'], ['/slam']], 'they hold what they are for'
    assert {each['channel'] for each in expected['limits']} >= {'overdue', 'pairs'}
    assert found['threshold'] == expected['threshold']
    limits, said = by_track(found['limits']), by_track(expected['limits'])
    assert set(limits) == set(said)
    for key, values in limits.items():
        # On one channel, a pair may have been watched in more than one way.
        assert values and set(values) <= set(said[key]), key
    for name in RECORDINGS:
        now, then = found['recordings'][name], expected['recordings'][name]
        assert now['paper'] == then['paper'], name
        assert now["sum of the paper's scores"] == then["sum of the paper's scores"], name
        assert len(now['evidence']) == len(then['evidence']), name
        for alarm, before in zip(now['evidence'], then['evidence']):
            assert alarm['start'] == pytest.approx(before['start'], abs=0.25)
            assert alarm['end'] == pytest.approx(before['end'], abs=0.25)
            assert alarm['suspects'][0] == before['suspects'][0]


@every_release
def test_info_prints_the_versions(folder: Path) -> None:
    for name, number in FORMATS.items():
        version = json.loads(printed(folder / name, '--json'))['version']
        assert version['oldest_reader'] <= version['format'] <= number
        assert (version['method'] is None) == (name == 'dead.events.bag')
        text = f'written by   self_awareness {version["package"]}, format {version["format"]}'
        assert text in printed(folder / name, '--details')


@every_release
def test_programs_go_on_with_files_of_any_release(folder: Path, tmp_path: Path) -> None:
    model, results = str(tmp_path / 'm'), str(tmp_path / 'results.bag')
    normal, dead = (str(folder / name) for name in RECORDINGS[:2])
    assert calibrate.main(['--model', str(folder / 'robot.model'), '--normal', normal,
                           '-o', model]) == 0
    before, after = TrainedModel.load(str(folder / 'robot.model')), TrainedModel.load(model)
    assert after.version.format == FORMATS['robot.model'], 'what is written is of this version'
    assert after.version.method == before.version.method, 'but its counts are not'
    assert '1. /laser' in printed_by(score, [dead, '--model', model, '--result-bag', results])
    assert FileVersion.of_result_bag(results).format == FORMATS['results.bag']
    assert train.main([normal, '--add-to', model, '-o', model]) == 0
    other = str(tmp_path / 'other')
    assert train.main([dead, '--detector', 'both', '-o', other]) == 0
    assert merge.main([other, str(folder / 'robot.model'), '-o', model]) == 0
    assert TrainedModel.load(model).version.method == min(METHOD, before.version.method)


@every_release
def test_result_bags_of_any_release_are_known(folder: Path) -> None:
    results = str(folder / 'results.bag')
    assert ResultBag.is_one(results)
    assert FileVersion.of_result_bag(results).format <= FORMATS['results.bag']
    with rosbag.Bag(results) as bag:
        assert any(bag.read_messages('/self_awareness/alarm', raw=True))


@every_release
def test_graphs_of_any_release_are_read(folder: Path, tmp_path: Path) -> None:
    graph = RobotGraph.load(str(folder / 'dead.graph.yaml'))
    assert ('/laser', '/scan', '/slam') in graph.edges(EncodingRules())
    graph.save(str(tmp_path / 'g.yaml'))
    assert RobotGraph.load(str(tmp_path / 'g.yaml')) == graph
    assert yaml.safe_load((tmp_path / 'g.yaml').read_text())['version']['format'] == 3


def test_a_graph_of_a_newer_format_is_read_if_it_says_so(tmp_path: Path) -> None:
    path = tmp_path / 'g.yaml'
    topic = '/a: {publishers: [/x], subscribers: [/y], since: 3}\n'
    path.write_text(f'version: {{format: 9, oldest_reader: 2, new: 1}}\nservices: [/s]\n{topic}')
    assert RobotGraph.load(str(path)).edges(EncodingRules()) == {('/x', '/a', '/y')}
    path.write_text(f'version: {{format: 9, oldest_reader: 9, package: 3.2.1}}\n{topic}')
    with pytest.raises(ValueError, match=f'^{path}: version: written by a newer self_awareness '
                                         '.3.2.1, format 9'):
        RobotGraph.load(str(path))
    for version in ('9', '{format: 9}', '{format: x, oldest_reader: 1}',
                    '{format: 1, oldest_reader: -1}', '{format: 1, oldest_reader: 4294967296}'):
        path.write_text(f'version: {version}\n{topic}')
        with pytest.raises(ValueError, match=f'^{path}: version'):
            RobotGraph.load(str(path))


def test_an_event_log_of_before_versions_is_read() -> None:
    path = DATA / 'former.events.bag'
    assert 'format 1' in printed(path, '--details')
    summary = json.loads(printed(path, '--json'))
    counts = {each['source']: each['count'] for each in summary['event_types']}
    assert (summary['events'], counts['/laser']) == (958, 200)  # it died after 20 s, of 10 Hz
