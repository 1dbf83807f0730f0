"""Asks the running robot who listens to whom; the blame needs it to tell roots from victims."""
from __future__ import annotations

from typing import Any, Dict, Set

from self_awareness import printable
from self_awareness.training.robot_graph import RobotGraph

_CALLER_ID = '/train'


def fetch() -> RobotGraph:
    """Ask the master, and nobody else: no node sees that somebody asks.

    Raises:
        ValueError: no master answers.
    """
    # Imported here: it takes long, and few trainings ask for the graph.
    import rosgraph

    try:
        publishers, subscribers, _ = rosgraph.Master(_CALLER_ID).getSystemState()
    except (OSError, rosgraph.MasterException) as error:
        raise ValueError(f'no master at {rosgraph.get_master_uri()}: is the robot running, and is '
                         'ROS_MASTER_URI right?') from error
    return RobotGraph(_by_topic(publishers), _by_topic(subscribers))


def _by_topic(state: Any) -> Dict[str, Set[str]]:
    return {printable(topic): {printable(node) for node in nodes} for topic, nodes in state}
