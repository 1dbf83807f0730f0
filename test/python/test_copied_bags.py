"""Copies by rosbag's Python library keep one sender a topic; the programs notice it."""
from __future__ import annotations

from pathlib import Path
from typing import Any, Callable, Dict, Iterable, Tuple

import pytest
import rosbag
import rospy
from conftest import trained
from rosbag import rosbag_main
from std_msgs.msg import String

from self_awareness import summarise_bag
from self_awareness.commands import calibrate, score

_PERIODS_S = {('/arm', '/joints'): 0.1, ('/hand', '/joints'): 0.11, ('/hand', '/touch'): 0.2}


def _messages(start: float, length: float) -> Iterable[Tuple[float, str, str]]:
    return sorted((start + period * i, source, topic)
                  for (source, topic), period in _PERIODS_S.items()
                  for i in range(int(length / period)))


def _record(path: Path, start: float, length: float = 90.0) -> str:
    """Write a recording of two nodes that publish on the same topic."""
    connections: Dict[str, Any] = {}
    with rosbag.Bag(str(path), 'w') as bag:
        for stamp, source, topic in _messages(start, length):
            # rosbag itself has one connection for each topic, however many nodes publish there.
            bag._topic_connections = connections.setdefault(source, {})
            header = {'callerid': source, 'latching': '0', 'md5sum': String._md5sum,
                      'message_definition': String._full_text, 'topic': topic,
                      'type': String._type}  # in the order of `rosbag record`
            bag.write(topic, String('x'), rospy.Time.from_sec(stamp), connection_header=header)
    return str(path)


def _filtered(bag: str) -> str:
    copy = bag.replace('.bag', '_filtered.bag')
    rosbag_main.filter_cmd([bag, copy, 'True'])
    return copy


def _compressed(bag: str) -> str:
    rosbag_main.compress_cmd(['--quiet', bag])
    return bag


@pytest.fixture
def recorded(tmp_path: Path) -> str:
    """A recording."""
    return _record(tmp_path / 'recorded.bag', 1000.0)


@pytest.fixture
def model(recorded: str, tmp_path: Path) -> str:
    """A model of it, which knows both senders of a topic."""
    trained([recorded], tmp_path / 'm')
    return str(tmp_path / 'm')


@pytest.mark.parametrize('copy', [_filtered, _compressed])
def test_copies_of_recordings_are_told_from_recordings(recorded: str,
                                                       copy: Callable[[str], str]) -> None:
    before = summarise_bag(recorded)
    assert not before.one_sender_a_topic and not before.copied
    after = summarise_bag(copy(recorded))
    assert after.one_sender_a_topic and after.copied
    assert after.fingerprint == before.fingerprint


def test_training_says_so(recorded: str, tmp_path: Path, capsys) -> None:
    copy = _filtered(recorded)
    trained([recorded], tmp_path / 'm')
    assert 'warning' not in capsys.readouterr().out
    trained([copy], tmp_path / 'm')
    line, = [line for line in capsys.readouterr().out.splitlines() if 'warning' in line]
    assert line.startswith(f'{copy}: warning: a copy that rosbag filter, compress or decompress ')
    assert 'Use the bag as it was recorded' in line
    encoding = tmp_path / 'encoding.yaml'
    encoding.write_text('source: none\n')
    trained([copy], tmp_path / 'm', '--encoding', str(encoding))
    assert 'warning' not in capsys.readouterr().out, 'senders do not count'


def test_score_and_calibrate_name_the_topics(model: str, tmp_path: Path, capsys) -> None:
    other = _record(tmp_path / 'other.bag', 2000.0)
    assert score.main([other, '--model', model]) == 0
    assert 'warning' not in capsys.readouterr().err
    copy = _filtered(other)
    for program, arguments in ((score, [copy, '--model', model]),
                               (calibrate, ['--model', model, '--normal', copy, '-o', model])):
        assert program.main(arguments) == 0
        err = capsys.readouterr().err
        assert f': warning: {copy}: this bag names only one sender for each topic' in err
        assert ': /joints (here /arm only, in the model 2 senders); use the bag as it was' in err


def test_a_bag_that_is_no_copy_may_lack_a_sender(model: str, make_bag: Callable[..., str],
                                                 capsys) -> None:
    """A program of Python wrote it; the second sender was off, or is heard on another topic."""
    off = make_bag('off.bag', [m for m in _messages(2000.0, 30.0) if m[1] == '/arm'])
    merged = make_bag('merged.bag', _messages(2000.0, 30.0))
    assert score.main([off, '--model', model]) == 0
    assert 'warning' not in capsys.readouterr().err
    assert score.main([merged, '--model', model]) == 0
    assert f'{merged}: this bag names only one sender for each topic' in capsys.readouterr().err
