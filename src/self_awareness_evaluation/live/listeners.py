"""What the live evaluation listens to: the monitor's statuses, and the robot's topics."""
from __future__ import annotations

import threading
import time
from typing import Dict, List, Sequence, Tuple

import rospy
from std_srvs.srv import Trigger

from self_awareness.msg import SelfAwareness
from self_awareness_evaluation.live.processes import LiveError, await_condition, becomes_true
from self_awareness_evaluation.live.samples import ERROR, Status
from self_awareness_evaluation.systems import distinct

QUIET_S = 3.0
"""The monitor has settled, and there is no alarm, for so long before the next fault [s]."""

STARTED_WITHIN_S = 90.0
"""What is started, robot or monitor, has said something after so long at the latest [s]."""

_MONITOR = '/self_awareness'
_NO_STATUS_S = 15.0  # a starved CPU takes its time
_SERVICE_WITHIN_S = 10.0
_QUIET_WITHIN_S = 15.0
_MOST_RESETS = 3


class MonitorListener:
    """Keeps all statuses of the monitor; `rospy.init_node` has been called."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._statuses: List[Status] = []  # Guarded by _lock.
        self._heard_at = time.monotonic()
        self._quiet_since = time.monotonic()
        rospy.Subscriber(f'{_MONITOR}/status', SelfAwareness, self._on_status, queue_size=1000)

    @property
    def statuses(self) -> List[Status]:
        """All so far."""
        with self._lock:
            return list(self._statuses)

    def quiet_for(self) -> float:
        """Return for how long [s] there has been no alarm, and no settling, until now.

        Raises:
            LiveError: the monitor has gone silent.
        """
        now = time.monotonic()
        with self._lock:
            if now - self._heard_at > _NO_STATUS_S and self._statuses:
                raise LiveError(f'the monitor has said nothing for {_NO_STATUS_S:g} s')
            return now - self._quiet_since if self._statuses else 0.0

    def reset(self) -> None:
        """Reset the monitor; what it said before does not count as quiet.

        Raises:
            LiveError: it does not answer.
        """
        try:
            rospy.wait_for_service(f'{_MONITOR}/reset', _SERVICE_WITHIN_S)
            rospy.ServiceProxy(f'{_MONITOR}/reset', Trigger)()
        except (rospy.ROSException, rospy.ServiceException) as error:
            raise LiveError(f'{_MONITOR}/reset: {error}') from error
        with self._lock:
            self._quiet_since = time.monotonic()

    def _on_status(self, message: SelfAwareness) -> None:
        status = Status(message.header.stamp.to_sec(), time.time(), message.level,
                        message.settling, message.evidence,
                        tuple(distinct([suspect.source for suspect in message.suspects])),
                        message.message, message.component)
        with self._lock:
            self._statuses.append(status)
            self._heard_at = time.monotonic()
            if status.level >= ERROR or status.settling:
                self._quiet_since = self._heard_at


def reset_until_quiet(monitor: MonitorListener) -> str:
    """Reset the monitor and wait until it is quiet; return a note if that took long or failed.

    The alarm of one fault must not stand at the onset of the next one.
    """
    await_condition('the monitor says something', lambda: bool(monitor.statuses),
                    STARTED_WITHIN_S)
    for resets in range(1, _MOST_RESETS + 1):
        monitor.reset()
        if becomes_true(lambda: monitor.quiet_for() >= QUIET_S, _QUIET_WITHIN_S):
            return '' if resets == 1 else f'no alarm only after {resets} times ~reset'
    return f'the alarm stood after {_MOST_RESETS} times ~reset'


class RobotListener:
    """Remembers when each node was last heard on each topic [s since 1970]."""

    def __init__(self, topics: Sequence[str]) -> None:
        self._lock = threading.Lock()
        self._last: Dict[Tuple[str, str], float] = {}  # Guarded by _lock.
        self._subscribers = [rospy.Subscriber(f'/{topic}', rospy.AnyMsg, self._on_message, topic,
                                              queue_size=100) for topic in topics]

    def close(self) -> None:
        """Listen no longer."""
        for subscriber in self._subscribers:
            subscriber.unregister()

    def last(self, source: str, topic: str) -> float:
        """Return when a node was last heard on a topic; 0: never."""
        with self._lock:
            return self._last.get((source, topic), 0.0)

    def _on_message(self, message: rospy.AnyMsg, topic: str) -> None:
        source = message._connection_header['callerid']
        with self._lock:
            self._last[source, topic] = time.time()
