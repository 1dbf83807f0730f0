"""The recovery as a node: hears a monitor, does what the ladder orders, and says what it did."""
from __future__ import annotations

import threading
import time
from dataclasses import asdict
from typing import Optional, Tuple

import rospy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

from self_awareness.msg import Incidents, RecoveryAction, RecoveryActions, SelfAwareness
from self_awareness.recovery import history, words
from self_awareness.recovery.actions import ActionError, Actions
from self_awareness.recovery.ladder import HOUR_S, Ladder, Order
from self_awareness.recovery.node_calls import NodeCalls
from self_awareness.recovery.rules import Rules
from self_awareness.recovery.watch import Watch
from self_awareness.srv import Maintenance, MaintenanceRequest, MaintenanceResponse
from self_awareness.stamps import SECOND_NS, nanoseconds, utc

LONGEST_HOLD_S = 86400.0
_TICK_S = 0.1
_HEARTBEAT_S = 1.0
_LOOK_EVERY_S = 1.0


class Recovery:
    """Does what the rules say; needs rospy.init_node().

    Subscribes to `status` and `incidents` of the monitor. Publishes `~actions` (RecoveryActions,
    latched) and a status on /diagnostics, every second and at once when it changes. Serves `~hold`
    (Maintenance): nothing is done for a while.

    Args:
        rules: what may be done.
        monitor: full name of the monitor.
        path: of the file of actions (history).
    """

    def __init__(self, rules: Rules, monitor: str, path: str) -> None:
        self._rules = rules
        self._monitor = monitor
        self._path = path
        self._history = self._kept()
        self._lock = threading.Lock()
        self._watch = Watch()  # Guarded by _lock.
        self._ladder = self._restored()  # Guarded by _lock.
        self._hold: Optional[int] = None  # until when [ns since 1970], as told. Guarded by _lock.
        self._held_by = ''  # Guarded by _lock.
        self._done: Optional[Tuple[bool, str]] = None  # Guarded by _lock.
        self._actions = Actions(NodeCalls(rospy.get_name()), rules.nodes, rules.grace)
        self._hardware_id = str(rospy.get_param('~hardware_id', 'none'))
        self._said: Tuple[int, str] = (words.OK, '')
        self._said_at = float('-inf')
        self._diagnostics = rospy.Publisher('/diagnostics', DiagnosticArray, queue_size=10)
        # By its type, monitors know this node for one of this package, whatever its name is.
        self._publisher = rospy.Publisher('~actions', RecoveryActions, queue_size=10, latch=True)
        rospy.Subscriber(f'{monitor}/incidents', Incidents, self._on_incidents, queue_size=10)
        rospy.Subscriber(f'{monitor}/status', SelfAwareness, self._on_status, queue_size=100)
        self._service = rospy.Service('~hold', Maintenance, self._on_hold)

    def run(self) -> None:
        """Go on until ROS shuts down."""
        threading.Thread(target=self._look, daemon=True).start()
        self._publish()
        tick = threading.Event()
        while not rospy.is_shutdown():
            try:
                self._advance(time.monotonic())
            except rospy.ROSException:  # the publishers close first when ROS shuts down
                if not rospy.is_shutdown():
                    raise
            tick.wait(_TICK_S)

    def _advance(self, now: float) -> None:
        with self._lock:
            done, self._done = self._done, None
            if done is not None:
                self._ladder.done(now)
            order = self._ladder.advance(now, self._watch.faults(now))
            hold, self._hold = self._hold, None
        if hold is not None:
            self._history.held_until = hold
            self._keep()
        if done is not None:
            self._end(*done)
        if order is not None:
            self._begin(order)
        self._say(now)

    def _begin(self, order: Order) -> None:
        self._history.begin(history.Action(
            order.fault.incident, order.fault.component, order.fault.kind, order.number,
            len(order.rule.steps), str(order.step), time.time_ns(), self._rules.dry_run))
        rospy.logwarn(words.what(self._history.actions[-1]))
        self._keep()
        threading.Thread(target=self._do, args=(order,), daemon=True).start()

    def _do(self, order: Order) -> None:
        success, result = True, 'nothing, since this is a dry run'
        if not self._rules.dry_run:
            try:
                result = self._actions.do(order.step, order.rule.component, self._mute)
            except ActionError as error:
                success, result = False, str(error)
        with self._lock:
            self._done = success, result

    def _mute(self, node: str) -> None:
        """Let the monitor not tell of a node that is stopped for the sake of another one."""
        why_not = self._actions.mute(self._monitor, node, self._rules.wait)
        if why_not:
            rospy.logwarn('%s will be told as a fault while it is started again: %s', node,
                          why_not)

    def _end(self, success: bool, result: str) -> None:
        self._history.end(success, result)
        (rospy.loginfo if success else rospy.logerr)(words.what(self._history.actions[-1]))
        self._keep()

    def _keep(self) -> None:
        self._publish()
        try:
            self._history.save(self._path)
        except OSError as error:
            rospy.logwarn('what is done is not kept: %s: %s', self._path, error)

    def _publish(self) -> None:
        message = RecoveryActions()
        message.header.stamp = rospy.Time.now()
        for action in self._history.actions:
            fields = {**asdict(action), 'begin': rospy.Time(*divmod(action.begin, SECOND_NS))}
            message.actions.append(RecoveryAction(**fields))
        self._publisher.publish(message)

    def _say(self, now: float) -> None:
        with self._lock:
            said = words.status(len({rule.component for rule in self._rules.rules}),
                                self._ladder.standings(now), self._history.actions,
                                self._watch.why_blind(now), self._held())
        if said[0] == self._said[0] and now - self._said_at < _HEARTBEAT_S:
            return
        if said[0] == words.ERROR != self._said[0]:
            rospy.logerr(said[1])
        self._said, self._said_at = said, now
        array = DiagnosticArray()
        array.header.stamp = rospy.Time.now()
        shown = words.values(self._history.actions, self._actions.refused(), self._rules.dry_run)
        array.status = [DiagnosticStatus(
            said[0], f'{rospy.get_name()[1:]}: recovery', said[1], self._hardware_id,
            [KeyValue(key, value) for key, value in shown.items()])]
        self._diagnostics.publish(array)

    def _look(self) -> None:
        wait = threading.Event()
        while not rospy.is_shutdown():
            self._actions.look()
            wait.wait(_LOOK_EVERY_S)

    def _on_incidents(self, message: Incidents) -> None:
        with self._lock:
            self._watch.on_incidents(message.incidents)

    def _on_status(self, message: SelfAwareness) -> None:
        with self._lock:
            self._watch.on_status(time.monotonic(), message)

    def _on_hold(self, request: MaintenanceRequest) -> MaintenanceResponse:
        if request.duration != 0.0 and not 1.0 <= request.duration <= LONGEST_HOLD_S:
            return MaintenanceResponse(False, f'duration: {request.duration:g}; it must be from 1 '
                                       f'to {LONGEST_HOLD_S:g} s, or 0 to go on')
        by = request._connection_header.get('callerid', 'nobody')
        until = time.time_ns() + nanoseconds(request.duration)
        with self._lock:
            self._hold, self._held_by = until, f', by {by}'
            self._ladder.hold(time.monotonic() + request.duration)
        answer = (f'does nothing until {_shown(until)}' if request.duration else 'goes on')
        rospy.logwarn('%s, by %s', answer, by)
        return MaintenanceResponse(True, answer)

    def _held(self) -> str:
        """Return until when nothing is done, and who wanted it; empty: it is not held."""
        if self._history.held_until <= time.time_ns():
            return ''
        return f'until {_shown(self._history.held_until)}{self._held_by}'

    def _kept(self) -> history.History:
        try:
            return history.load(self._path)
        except (OSError, ValueError) as error:
            rospy.logwarn('what was done before the start is not known: %s', error)
            return history.History()

    def _restored(self) -> Ladder:
        """Return a ladder that knows of the hour before the start, and of the hold."""
        ladder = Ladder(self._rules)
        now, wall = time.monotonic(), time.time_ns()
        for action in self._history.actions:
            ago = max(0, wall - action.begin) / SECOND_NS  # the clock may have been set
            if ago < HOUR_S and (self._rules.dry_run or not action.dry_run):
                ladder.restore(action.component, now - ago)
        held = (self._history.held_until - wall) / SECOND_NS
        ladder.hold(now + min(held, LONGEST_HOLD_S))
        return ladder


def _shown(stamp: int) -> str:
    return f'{utc(stamp)[:19]} UTC'
