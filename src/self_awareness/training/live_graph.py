"""Asks the running robot who listens to whom; the blame needs it to tell roots from victims."""
from __future__ import annotations

from typing import Any, Dict, Iterable, Set
from xmlrpc.client import Fault, MultiCall

from self_awareness import host_in, is_own_type, printable
from self_awareness.training.robot_graph import RobotGraph

_CALLER_ID = '/train'


def fetch() -> RobotGraph:
    """Ask the master, and nobody else: no node sees that somebody asks.

    Nodes of this package look at the robot, and are left out.

    Raises:
        ValueError: no master answers.
    """
    # Imported here: it takes long, and few trainings ask for the graph.
    import rosgraph

    try:
        master = rosgraph.Master(_CALLER_ID)
        state, types = master.getSystemState(), dict(master.getTopicTypes())
        ours = {node for topic, nodes in state[0] for node in nodes
                if is_own_type(types.get(topic, ''))}
        publishers, subscribers = (
            [(topic, set(nodes) - ours) for topic, nodes in nodes_of] for nodes_of in state[:2])
        hosts = _hosts(master, {node for _, nodes in publishers for node in nodes})
    except (OSError, rosgraph.MasterException) as error:
        raise ValueError(f'no master at {rosgraph.get_master_uri()}: is the robot running, and is '
                         'ROS_MASTER_URI right?') from error
    return RobotGraph(_by_topic(publishers), _by_topic(subscribers), hosts)


def _hosts(master: Any, nodes: Iterable[str]) -> Dict[str, str]:
    """Return the computers of nodes, those that the master knows; all of them in one call."""
    known = sorted(nodes)
    calls: Any = MultiCall(master.handle)
    for node in known:
        calls.lookupNode(_CALLER_ID, node)
    try:
        answers = list(calls()) if known else []
    except Fault:  # a master that answers one call at a time
        return {}
    return {printable(node): host for node, (code, _, uri) in zip(known, answers)
            for host in [host_in(uri) if code == 1 else ''] if host}


def _by_topic(state: Any) -> Dict[str, Set[str]]:
    return {printable(topic): {printable(node) for node in nodes} for topic, nodes in state
            if nodes}
