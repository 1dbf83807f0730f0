"""Why a learner hears nothing, by what the master says of who publishes and who subscribes."""
from __future__ import annotations

from typing import Dict, Iterable, List, Mapping, Set, Tuple

import rosgraph
import rospy

from self_awareness import EncodingRules, is_own_type, printable

HEARD_S = 10.0
"""For so long after an event the robot counts as heard [s]."""

# What is published there is about all that run, whether that is a robot or not.
_OF_EVERYBODY = {'/rosout', '/rosout_agg', '/clock', '/statistics', '/diagnostics',
                 '/diagnostics_agg', '/diagnostics_toplevel_state'}

Nodes = Iterable[Tuple[str, List[str]]]


def ask_why(encoding: EncodingRules, subscribe: str) -> str:
    """Return what the running master's answers say (see why)."""
    try:
        master = rosgraph.Master(rospy.get_name())
        publishers, subscribers, _ = master.getSystemState()
        types = dict(master.getTopicTypes())
    except (OSError, rosgraph.MasterException):
        return f'no master at {rosgraph.get_master_uri()}'
    return why(publishers, subscribers, types, encoding, subscribe)


def why(publishers: Nodes, subscribers: Nodes, types: Mapping[str, str], encoding: EncodingRules,
        subscribe: str) -> str:
    """Return why nothing is heard, in words.

    Args:
        publishers, subscribers: nodes by topic.
        types: by topic.
        encoding: how messages become events.
        subscribe: used or all, see launch/record.launch.
    """
    publishers = [(topic, nodes) for topic, nodes in publishers if topic not in _OF_EVERYBODY]
    ours = {node for topic, nodes in publishers for node in nodes
            if is_own_type(types.get(topic, ''))}
    robot, players = _topics(publishers, ours, encoding)
    if not robot:
        return '; '.join(
            f'{printable(node)} plays {number} topic{"s" * (number > 1)}; players are left out: '
            'use `score BAG` or `train BAG`, or `source: none` in the encoding'
            for node, number in sorted(players.items())) or 'no node of a robot publishes anything'
    used = {topic for topic, nodes in subscribers
            if any(encoding.includes_source(source) for source in
                   encoding.sources_of(set(nodes) - ours).values())}
    if subscribe == 'used' and not robot & used:
        return (f'no node of the robot subscribes to {_some(robot)}; launch it with '
                'subscribe:=all to listen all the same')
    return f'nothing is sent on {_some(robot & used or robot)}'


def _topics(publishers: Nodes, ours: Set[str],
            encoding: EncodingRules) -> Tuple[Set[str], Dict[str, int]]:
    """Return the topics of a robot, and how many topics each player has."""
    robot: Set[str] = set()
    players: Dict[str, int] = {}
    for topic, nodes in publishers:
        for node, source in encoding.sources_of(set(nodes) - ours).items():
            if encoding.includes_source(source):
                robot.add(topic)
            elif source.rpartition('/')[2] == 'play':
                players[node] = players.get(node, 0) + 1
    return robot, players


def _some(topics: Set[str]) -> str:
    first, *others = sorted(map(printable, topics))
    return f'{first} and {len(others)} more' if others else first
