"""What a recovery did: how soon a node was back, and which healthy ones were restarted. No ROS."""
from __future__ import annotations

from dataclasses import dataclass
from typing import List, Optional, Sequence

from self_awareness_evaluation.soak.measures import AFTERMATH_S, Happened

BACK_WITHIN_S = 5.0
"""From the alarm to when a node that hangs is heard again, besides the delay of the rules [s]."""


@dataclass(frozen=True)
class Hang:
    """A node was stopped, for good.

    Args:
        alarm_s: from then to the alarm that names it; None: none came.
        back_s: from the alarm to when the node was heard again; None: it was not.
    """

    alarm_s: Optional[float]
    back_s: Optional[float]

    def in_time(self, delay_s: float) -> bool:
        """Return whether the node was back in time, with that delay of the rules [s]."""
        return self.back_s is not None and self.back_s <= delay_s + BACK_WITHIN_S


@dataclass(frozen=True)
class Restart:
    """A node that the recovery has stopped.

    Args:
        node: its name.
        at: [s since 1970].
    """

    node: str
    at: float


def of_healthy(restarts: Sequence[Restart], happened: Sequence[Happened]) -> List[Restart]:
    """Return the restarts of nodes that had no fault then, nor had just had one.

    Each fault excuses one restart.

    Args:
        restarts: all of them, in their order.
        happened: all faults.
    """
    left = list(happened)
    wrong = []
    for restart in restarts:
        excuse = next((fault for fault in left if fault.culprit == restart.node
                       and fault.onset < restart.at <= fault.end + AFTERMATH_S), None)
        if excuse is None:
            wrong.append(restart)
        else:
            left.remove(excuse)
    return wrong
