"""Why a learner hears nothing, by what the master says of who publishes and who subscribes."""
from __future__ import annotations

import rosgraph
import rospy

from self_awareness import EncodingRules, why_nothing_is_heard

HEARD_S = 10.0
"""For so long after an event the robot counts as heard [s]."""


def ask_why(encoding: EncodingRules, subscribe: str) -> str:
    """Return why nothing is heard, in words.

    Args:
        encoding: how messages become events.
        subscribe: used or all, see launch/record.launch.
    """
    try:
        master = rosgraph.Master(rospy.get_name())
        publishers, subscribers, _ = master.getSystemState()
        types = dict(master.getTopicTypes())
    except (OSError, rosgraph.MasterException):
        return f'no master at {rosgraph.get_master_uri()}'
    return why_nothing_is_heard(
        encoding, {topic: set(nodes) for topic, nodes in publishers},
        {topic: set(nodes) for topic, nodes in subscribers}, types, subscribe == 'used')
