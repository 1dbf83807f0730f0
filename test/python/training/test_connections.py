"""Who does not subscribe as in all starts of the training: learned from event logs, and scored."""
from __future__ import annotations

import json
from pathlib import Path
from typing import Any, Dict, List, Optional, Tuple

import pytest
import rosbag
from conftest import trained

from self_awareness import TrainedModel
from self_awareness.commands import convert, info, score, simulate

MISSING = ('/navigation', '/pose_hypotheses')


def as_heard_live(log: str) -> None:
    """Make an event log of a bag one that was heard live: its graph is all that there was."""
    with rosbag.Bag(log) as bag:
        messages = list(bag.read_messages(return_connection_header=True))
    with rosbag.Bag(log, 'w') as bag:
        for topic, message, stamp, header in messages:
            if topic == '/event_log/start':
                message.bag = ''
            bag.write(topic, message, stamp, connection_header=header)


@pytest.fixture(name='logs', scope='module')
def _logs(tmp_path_factory: pytest.TempPathFactory) -> Dict[str, str]:
    folder = tmp_path_factory.mktemp('connections')
    logs = {}
    for name, seed, fault in (('1', 1, None), ('2', 2, None), ('fine', 3, None),
                              ('deaf', 3, 'unsubscribed:navigation')):
        bag, log = str(folder / f'{name}.bag'), str(folder / f'{name}.events.bag')
        options = [] if fault is None else ['--fault', fault]
        assert simulate.main(['-o', bag, '--duration', '100', '--seed', str(seed), *options]) == 0
        assert convert.main([bag, '-o', log]) == 0
        logs[f'{name} bag'] = bag
        logs[f'{name} of a bag'] = str(folder / f'{name}.of_bag.bag')
        Path(logs[f'{name} of a bag']).write_bytes(Path(log).read_bytes())
        as_heard_live(log)
        logs[name] = log
    return logs


@pytest.fixture(name='model', scope='module')
def _model(logs: Dict[str, str]) -> str:
    path = Path(logs['1']).parent / 'robot.model'
    trained([logs['1'], logs['2']], path)
    return str(path)


def suspicions(model: str, log: str, tmp_path: Path) -> List[Tuple[str, Optional[str], str]]:
    """Kind, culprit and reason of alarms and suspicions, in their order."""
    out = tmp_path / 'score.json'
    assert score.main([log, '--model', model, '--json', str(out)]) == 0
    recording: Dict[str, Any] = json.loads(out.read_text(encoding='utf-8'))['recordings'][0]
    return [(each['kind'], each['culprit'], each['reason'])
            for each in recording['alarms']]


def test_what_every_start_had_is_learned(logs: Dict[str, str], model: str,
                                         capsys: pytest.CaptureFixture) -> None:
    known = TrainedModel.load(model)
    assert MISSING in known.subscriptions and len(known.subscriptions) > 25
    assert {node for node, _ in known.subscriptions} <= {
        kind.source for kind in known.event_types}
    assert info.main([model, '--json']) == 0
    assert dict(zip(('node', 'topic'), MISSING)) in json.loads(
        capsys.readouterr().out)['subscriptions']


def test_who_does_not_subscribe_is_named_after_a_minute(logs: Dict[str, str], model: str,
                                                        tmp_path: Path) -> None:
    assert suspicions(model, logs['deaf'], tmp_path) == [
        ('not subscribed', '/navigation',
         'does not subscribe to /pose_hypotheses, as it did in all 2 starts')]
    assert suspicions(model, logs['fine'], tmp_path) == []


@pytest.mark.parametrize('names', [
    ('1',), ('1 bag', '2 bag'), ('1 of a bag', '2 of a bag'), ('1', '2', '3 of no graph'),
    ('1', '2', 'deaf')])
def test_what_not_every_start_is_known_to_have_is_not_expected(
        logs: Dict[str, str], tmp_path: Path, names: Tuple[str, ...]) -> None:
    bags = [logs['fine of a bag' if name == '3 of no graph' else name] for name in names]
    expected = trained(bags, tmp_path / 'robot.model').subscriptions
    assert MISSING not in expected
    assert bool(expected) == (names == ('1', '2', 'deaf'))
