"""What a live session listens to: the monitor, and the robot's topics."""
from __future__ import annotations

import contextlib
import threading
import time
from typing import Dict, Iterator, List, Sequence, Tuple

import rospy
from std_srvs.srv import Trigger

from self_awareness.msg import Incidents, SelfAwareness
from self_awareness_evaluation.live.processes import (STARTED_WITHIN_S, LiveError, await_condition,
                                                      becomes_true)
from self_awareness_evaluation.live.rows import ERROR, Incident, Status

MONITOR = '/self_awareness'  # the monitor's node

QUIET_S = 3.0
"""The monitor has settled, and there is no alarm, for so long before the next fault [s]."""

_NO_STATUS_S = 15.0  # a starved CPU takes its time
_SERVICE_WITHIN_S = 10.0
_QUIET_WITHIN_S = 15.0
_MOST_RESETS = 3


class MonitorListener:
    """Keeps all that the monitor says; `rospy.init_node` has been called."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._statuses: List[Status] = []  # This and all below: guarded by _lock.
        self._incidents: List[Incident] = []
        self._heard_at = time.monotonic()
        self._quiet_since = time.monotonic()
        rospy.Subscriber(f'{MONITOR}/status', SelfAwareness, self._on_status, queue_size=1000)
        rospy.Subscriber(f'{MONITOR}/incidents', Incidents, self._on_incidents)

    @property
    def statuses(self) -> List[Status]:
        """All so far."""
        with self._lock:
            return list(self._statuses)

    @property
    def incidents(self) -> List[Incident]:
        """The last ones, in the order in which they were opened."""
        with self._lock:
            return list(self._incidents)

    def quiet_for(self) -> float:
        """Return for how long [s] there has been no alarm, and no settling, until now; raise
        LiveError if the monitor has gone silent."""
        now = time.monotonic()
        with self._lock:
            if now - self._heard_at > _NO_STATUS_S and self._statuses:
                raise LiveError(f'the monitor has said nothing for {_NO_STATUS_S:g} s')
            return now - self._quiet_since if self._statuses else 0.0

    def reset_until_quiet(self) -> str:
        """Reset the monitor until it is quiet; return a note if that took long or failed.

        The alarm of one fault must not stand at the onset of the next one.

        Raises:
            LiveError: it does not answer.
        """
        for resets in range(1, _MOST_RESETS + 1):
            try:
                rospy.wait_for_service(f'{MONITOR}/reset', _SERVICE_WITHIN_S)
                rospy.ServiceProxy(f'{MONITOR}/reset', Trigger)()
            except (rospy.ROSException, rospy.ServiceException) as error:
                raise LiveError(f'{MONITOR}/reset: {error}') from error
            with self._lock:  # what it said before does not count as quiet
                self._quiet_since = time.monotonic()
            if becomes_true(lambda: self.quiet_for() >= QUIET_S, _QUIET_WITHIN_S):
                return '' if resets == 1 else f'no alarm only after {resets} times ~reset'
        return f'the alarm stood after {_MOST_RESETS} times ~reset'

    def _on_status(self, message: SelfAwareness) -> None:
        suspects = dict.fromkeys(suspect.source for suspect in message.suspects)  # each once
        status = Status(message.header.stamp.to_sec(), message.level, message.settling,
                        tuple(suspects), message.message, message.component, message.kind,
                        message.alarm, message.events)
        with self._lock:
            self._statuses.append(status)
            self._heard_at = time.monotonic()
            if status.level >= ERROR or status.settling:
                self._quiet_since = self._heard_at

    def _on_incidents(self, message: Incidents) -> None:
        incidents = [Incident(each.id, each.last, each.opened.to_sec(), each.ended.to_sec())
                     for each in message.incidents]
        with self._lock:
            self._incidents = incidents


class TopicListener:
    """Remembers when each node was last heard on each topic [s since 1970]."""

    def __init__(self, topics: Sequence[str]) -> None:
        self._lock = threading.Lock()
        self._last: Dict[Tuple[str, str], float] = {}  # Guarded by _lock.
        self._subscribers = [rospy.Subscriber(topic, rospy.AnyMsg, self._on_message, topic,
                                              queue_size=100) for topic in dict.fromkeys(topics)]

    def __enter__(self) -> TopicListener:
        return self

    def __exit__(self, *_: object) -> None:
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


@contextlib.contextmanager
def heard(expected: Sequence[Tuple[str, str]]) -> Iterator[None]:
    """Wait at the end of a with statement until sources were heard on topics since its begin, or
    raise LiveError."""
    begin = time.time()
    with TopicListener([topic for _, topic in expected]) as listener:
        yield
        for source, topic in expected:
            await_condition(f'{source} publishes {topic}',
                            lambda: listener.last(source, topic) > begin, STARTED_WITHIN_S)
