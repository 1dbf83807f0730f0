"""What nodes of this package say in a recording is no communication of the robot."""
from __future__ import annotations

from pathlib import Path
from typing import Dict, Set, Tuple, Type

import genpy
import rosbag
from conftest import put
from diagnostic_msgs.msg import DiagnosticArray
from rosgraph_msgs.msg import Log
from std_msgs.msg import String

from self_awareness import EncodingRules, read_events
from self_awareness.msg import SelfAwareness


def _record(path: Path, topics: Dict[Tuple[str, str], Type[genpy.Message]]) -> str:
    """Write a minute of these messages, by publisher and topic, at 10 Hz each."""
    with rosbag.Bag(str(path), 'w') as bag:
        for tick in range(600):
            for number, ((source, topic), kind) in enumerate(topics.items()):
                put(bag, source, topic, kind(), 1000.0 + 0.1 * tick + 0.001 * number)
    return str(path)


def _heard(bag: str, encoding: EncodingRules) -> Set[Tuple[str, str]]:
    return {(kind.source, kind.scope) for kind in read_events(bag, encoding).event_types}


def test_nodes_of_this_package_are_left_out_whatever_their_names(tmp_path: Path) -> None:
    bag = _record(tmp_path / 'a.bag', {
        ('/watch', '/watch/status'): SelfAwareness, ('/watch', '/rosout'): Log,
        ('/base', '/diagnostics'): DiagnosticArray, ('/watch', '/scan'): String})
    encoding = EncodingRules.defaults()
    assert _heard(bag, encoding) == {('/base', '/diagnostics'), ('/watch', '/scan')}
    # Where all is under the name of a player, nobody can be told from the robot's nodes.
    encoding.source = 'none'
    assert _heard(bag, encoding) == {('', '/diagnostics'), ('', '/rosout'), ('', '/scan')}
