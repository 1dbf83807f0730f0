"""What a recovery did: how soon a node was back, and which healthy ones were restarted. No ROS."""
from __future__ import annotations

from dataclasses import dataclass
from typing import List, Optional, Sequence

from self_awareness_evaluation.rows import AFTERMATH_S
from self_awareness_evaluation.soak.measures import MUST_BE_FOUND_S, Happened
from self_awareness_evaluation.soak.schedule import CRASH, HANG

BACK_WITHIN_S = 5.0
"""From the alarm to when a node that hangs is heard again, besides the delay of the rules [s]."""


@dataclass(frozen=True)
class Hang:
    """A node was stopped, for good.

    Args:
        alarm_s: from then to the alarm that names it; None: none came.
        back_s: from the alarm to when another process of the node was heard; None: none was.
        problem: why it could not be measured; empty: it was.
    """

    alarm_s: Optional[float]
    back_s: Optional[float]
    problem: str = ''

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


@dataclass(frozen=True)
class Blamed:
    """An alarm that names a node.

    Args:
        node: its name.
        at: [s since 1970].
    """

    node: str
    at: float


def of_healthy(restarts: Sequence[Restart], happened: Sequence[Happened]) -> List[Restart]:
    """Return the restarts of nodes that did not hang or crash then, nor just had.

    Each fault excuses one restart. Those that only change a rate excuse none: the rules are about
    who has died.

    Args:
        restarts: all of them, in their order.
        happened: all faults.
    """
    left = [fault for fault in happened if _kind(fault) in (HANG, CRASH)]
    wrong = []
    for restart in restarts:
        excuse = next((fault for fault in left if fault.culprit == restart.node
                       and fault.onset < restart.at <= fault.end + AFTERMATH_S), None)
        if excuse is None:
            wrong.append(restart)
        else:
            left.remove(excuse)
    return wrong


def not_mended(happened: Sequence[Happened], blamed: Sequence[Blamed],
               restarts: Sequence[Restart], delay_s: float) -> List[Happened]:
    """Return the hangs that lasted on, although the node should have been restarted.

    Args:
        happened: all faults.
        blamed: all alarms. A hang that none names should have been found in time all the same.
        restarts: all of them.
        delay_s: of the rules [s].
    """
    wrong = []
    for fault in happened:
        found = min((alarm.at for alarm in blamed if alarm.node == fault.culprit
                     and fault.onset < alarm.at <= fault.end),
                    default=fault.onset + MUST_BE_FOUND_S)
        if (_kind(fault) == HANG and fault.end > found + delay_s + BACK_WITHIN_S
                and not any(each.node == fault.culprit and fault.onset < each.at <= fault.end
                            for each in restarts)):
            wrong.append(fault)
    return wrong


def _kind(fault: Happened) -> str:
    return fault.fault.partition(':')[0]
