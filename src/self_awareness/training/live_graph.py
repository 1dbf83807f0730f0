"""Asks the running robot who listens to whom; the blame needs it to tell roots from victims."""
from __future__ import annotations

from typing import Set, Tuple

from self_awareness import stable_name

_CALLER_ID = '/train'


def fetch() -> Set[Tuple[str, str, str]]:
    """Return whose messages reach whom: (publisher, topic, subscriber), as in TrainedModel.graph.

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
    return {(stable_name(publisher), topic, stable_name(subscriber))
            for topic, nodes in publishers for publisher in nodes
            for subscriber in listeners.get(topic, [])}
