"""Asks the running robot who listens to whom; the blame needs it to tell roots from victims."""
from __future__ import annotations

from typing import Dict, Set

from self_awareness import stable_name

_CALLER_ID = '/train'


def fetch() -> Dict[str, Set[str]]:
    """Return the nodes that subscribe to what a node publishes, by the node.

    Anonymous numbers are removed from the names, as the encoding does.

    Raises:
        ValueError: no master answers.
    """
    # Imported here: it takes long, and few trainings ask for the graph.
    import rosgraph

    try:
        publishers, subscribers, _ = rosgraph.Master(_CALLER_ID).getSystemState()
    except (OSError, rosgraph.MasterException) as error:
        raise ValueError(f'--graph: no master at {rosgraph.get_master_uri()}: is the robot '
                         'running, and is ROS_MASTER_URI right?') from error
    listeners = dict(subscribers)
    graph: Dict[str, Set[str]] = {}
    for topic, nodes in publishers:
        for node in nodes:
            followers = {stable_name(listener) for listener in listeners.get(topic, [])}
            if followers:
                graph.setdefault(stable_name(node), set()).update(followers)
    return graph
