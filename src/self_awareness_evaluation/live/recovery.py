"""The recovery in a session: its rules, what it restarts, and whether who hangs comes back."""
from __future__ import annotations

import threading
import time
from pathlib import Path
from typing import Callable, Dict, List, Optional, Sequence

import rospy
import yaml

from self_awareness.msg import RecoveryAction, RecoveryActions
from self_awareness.recovery import history
from self_awareness.recovery.ladder import SHORTEST_HEALING_S
from self_awareness.recovery.node_process import process_of
from self_awareness_evaluation.live.listeners import TopicListener
from self_awareness_evaluation.live.processes import becomes_true
from self_awareness_evaluation.live.rows import RESTARTED, Row
from self_awareness_follow_me.induction import process_id

DELAY_S = 1.0  # of the rules: an alarm stands for so long before a node is restarted [s]

HEALED_S = max(DELAY_S, SHORTEST_HEALING_S) + 1.0
"""After so long without an alarm, the next fault is a new one, and not what the last step did not
help against [s]."""

_RECOVERY = '/self_awareness_recovery'
_GRACE_S = 1.0
_MOST_STEPS = history.MOST  # more than faults: what is wrong is to be seen


def command(rules: Path, components: Sequence[str]) -> List[str]:
    """Write rules that restart every one of these components that has died; return the command."""
    rules.write_text(yaml.safe_dump({
        'delay': DELAY_S, 'grace': _GRACE_S, 'limit': _MOST_STEPS, 'limit_of_all': _MOST_STEPS,
        'rules': [{'component': f'/{name}', 'kinds': ['silent', 'never came'],
                   'steps': [{'stop': [f'/{name}']}]} for name in components]}))
    return ['rosrun', 'self_awareness', 'recovery.py', str(rules), f'__name:={_RECOVERY[1:]}']


class RestartListener:
    """Makes a row of each node that the recovery stops; `rospy.init_node` has been called."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._seen: Dict[int, RecoveryAction] = {}  # by their begin. Guarded by _lock.
        self._told = 0
        rospy.Subscriber(f'{_RECOVERY}/actions', RecoveryActions, self._on_actions)

    def rows(self) -> List[Row]:
        """Return those since the last call."""
        with self._lock:
            new = list(self._seen.values())[self._told:]
        self._told += len(new)
        return [Row(RESTARTED, each.component[1:], onset=each.begin.to_sec()) for each in new]

    def _on_actions(self, message: RecoveryActions) -> None:
        with self._lock:
            self._seen.update((each.begin.to_nsec(), each) for each in message.actions)


def returns(node: str, topic: str, within_s: float) -> Callable[[], Optional[float]]:
    """Return what waits until a node that was stopped is another process, and is heard.

    Args:
        node: its name; it runs.
        topic: on which it publishes all the time.
        within_s: None is returned instead of when it was heard, if it takes longer [s].
    """
    process = process_of(node, process_id(node))

    def wait() -> Optional[float]:
        until = time.monotonic() + within_s
        with TopicListener([topic]) as listener:
            if not becomes_true(lambda: not process.runs(), within_s):
                return None
            ended = time.time()
            is_back = becomes_true(lambda: listener.last(node, topic) > ended,
                                   until - time.monotonic())
            return listener.last(node, topic) if is_back else None

    return wait
