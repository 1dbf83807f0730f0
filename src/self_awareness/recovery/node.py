"""The recovery as a node: hears a monitor, does what the ladder orders, and says what it did."""
from __future__ import annotations

import threading
import time
import traceback
from typing import Dict, Optional, Set, Tuple

import rospy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

from self_awareness import printable
from self_awareness.msg import Incidents, RecoveryAction, RecoveryActions, SelfAwareness
from self_awareness.recovery import history, words
from self_awareness.recovery.actions import ActionError, Actions
from self_awareness.recovery.history import Hold
from self_awareness.recovery.ladder import HOUR_S, Ladder, Order
from self_awareness.recovery.node_calls import NodeCalls
from self_awareness.recovery.rules import Rules
from self_awareness.recovery.watch import Watch
from self_awareness.recovery.xml_rpc import NoAnswer
from self_awareness.srv import Maintenance, MaintenanceRequest, MaintenanceResponse, Mute
from self_awareness.stamps import SECOND_NS, nanoseconds, to_the_second
from self_awareness.status_names import status_name

LONGEST_HOLD_S = 86400.0
_TICK_S = 0.1
_HEARTBEAT_S = 1.0
_LOOK_EVERY_S = 1.0
_LONGEST_NAME = 200
_DIRECTORY = '$ROS_HOME/self_awareness/$NAME'  # the monitor's default


class Recovery:
    """Does what the rules say about what a monitor (full name) blames; needs rospy.init_node().

    Subscribes to `status` and `incidents` of the monitor. Publishes `~actions` (RecoveryActions,
    latched) and a status on /diagnostics, every second and at once when it changes. Serves `~hold`
    (Maintenance): nothing is done for a while. What it has done is kept in a file beside that of
    the monitor's incidents (history).
    """

    def __init__(self, rules: Rules, monitor: str) -> None:
        self._rules = rules
        self._monitor = monitor
        self._path = ''  # of the file; empty: not read yet
        self._found_path = ''  # the same; empty: not known yet. Guarded by _lock.
        self._history = history.History()
        self._lock = threading.Lock()
        self._watch = Watch()  # Guarded by _lock.
        self._listeners: Optional[Dict[str, Set[str]]] = None  # Guarded by _lock.
        self._ladder = Ladder(rules)  # Guarded by _lock.
        self._held = Hold()  # Guarded by _lock.
        self._done: Optional[Tuple[bool, str]] = None  # Guarded by _lock.
        self._calls = NodeCalls(rospy.get_name())
        self._actions = Actions(self._calls, rules.nodes, rules.grace, self._why_held)
        self._hardware_id = str(rospy.get_param('~hardware_id', 'none'))
        self._said_level = words.OK
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
        if not self._path:
            self._read()
        with self._lock:
            done, self._done = self._done, None
            if done is not None:
                self._ladder.done(now)
            faults = self._watch.faults(now, self._listeners) if self._path else None
            order = self._ladder.advance(now, faults)
            held = self._held
        if self._path and self._history.hold != held:
            self._history.hold = held
            self._keep()
        if done is not None:
            self._end(*done)
        if order is not None:
            self._begin(order)
        self._say(now)

    def _read(self) -> None:
        """Read what was done before the start, once it is known where that is kept.

        The ladder has to know of its last hour, and of a hold, unless another one was told since.
        """
        with self._lock:
            self._path = self._found_path
        if not self._path:
            return
        try:
            self._history = history.load(self._path)
        except (OSError, ValueError) as error:
            rospy.logwarn('what was done before the start is not known: %s', error)
            return
        steady, wall = time.monotonic_ns(), time.time_ns()
        left = min(self._history.hold.left(steady, wall), nanoseconds(LONGEST_HOLD_S))
        with self._lock:
            for age, action in zip(self._history.ages(steady, wall), self._history.actions):
                if age < HOUR_S * SECOND_NS and (self._rules.dry_run or not action.dry_run):
                    self._ladder.restore(action.component, (steady - age) / SECOND_NS)
            if left > 0 and self._held == Hold():
                self._held = Hold(wall + left, steady + left)
                self._ladder.hold(self._held.steady / SECOND_NS)
        if self._history.under_way is None:
            self._publish()
        else:
            self._history.end(False, 'the recovery ended meanwhile')
            self._keep()

    def _begin(self, order: Order) -> None:
        self._history.begin(history.Action(
            order.fault.incident, order.fault.component, order.fault.kind, order.number,
            len(order.rule.steps), str(order.step), time.time_ns(), self._rules.dry_run,
            steady=time.monotonic_ns()))
        rospy.logwarn(words.what(self._history.actions[-1]))
        self._keep()
        threading.Thread(target=self._do, args=(order,), daemon=True).start()

    def _do(self, order: Order) -> None:
        try:
            success = True
            if self._rules.dry_run:
                result = f'nothing, since this is a dry run: {self._actions.would_do(order.step)}'
            else:
                result = self._actions.do(order.step, order.rule.component, self._mute)
        except ActionError as error:
            success, result = False, str(error)
        except Exception as error:  # it must not leave the step under way for ever
            rospy.logerr('the step failed unexpectedly:\n%s', traceback.format_exc())
            success, result = False, f'it failed unexpectedly: {error!r}'
        with self._lock:
            self._done = success, result

    def _mute(self, node: str) -> None:
        """Let the monitor not tell of a node that is stopped for the sake of another one."""
        try:
            answer = self._actions.ask(f'{self._monitor}/mute', Mute, component=node,
                                       duration=self._rules.wait)
            why_not = '' if answer.success else str(answer.message)
        except ActionError as error:
            why_not = str(error)
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
            fields = {**action.told(), 'begin': rospy.Time(*divmod(action.begin, SECOND_NS))}
            message.actions.append(RecoveryAction(**fields))
        self._publisher.publish(message)

    def _say(self, now: float) -> None:
        with self._lock:
            blind = self._watch.why_blind(now) or (
                '' if self._path else 'the master does not say where the monitor keeps its files')
            until = to_the_second(self._held.until)
            level, message = words.status(
                now, len({rule.component for rule in self._rules.rules}), self._ladder.climbs(),
                self._history.actions, blind,
                f'until {until}{self._held.by}' if self._is_held() else '')
        if level == self._said_level and now - self._said_at < _HEARTBEAT_S:
            return
        if level == words.ERROR != self._said_level:
            rospy.logerr(message)
        self._said_level, self._said_at = level, now
        shown = words.values(self._history.actions, self._actions.refused(), self._rules.dry_run)
        array = DiagnosticArray()
        array.header.stamp = rospy.Time.now()
        array.status = [DiagnosticStatus(
            level, status_name(rospy.get_name(), 'recovery'), message, self._hardware_id,
            [KeyValue(key, value) for key, value in shown.items()])]
        self._diagnostics.publish(array)

    def _look(self) -> None:
        wait = threading.Event()
        while not rospy.is_shutdown():
            for look in (self._find_path, self._actions.look, self._ask_listeners):
                try:
                    look()
                except Exception:  # whatever a node answers, the others are looked at again
                    rospy.logerr_throttle(60.0, 'a look at the nodes failed unexpectedly:\n'
                                          + traceback.format_exc())
            wait.wait(_LOOK_EVERY_S)

    def _find_path(self) -> None:
        """Find out where the actions are kept.

        The monitor may be started later than this node: its parameter, or what it says, shows that
        it is there. Before, nothing is done anyway.
        """
        with self._lock:
            if self._found_path:
                return
            heard = self._watch.heard
        try:
            directory = self._calls.parameter(f'{self._monitor}/recorder/directory')
        except NoAnswer:
            return
        if directory is not None or heard:
            with self._lock:
                self._found_path = history.beside_incidents(str(directory or _DIRECTORY),
                                                            self._monitor)

    def _ask_listeners(self) -> None:
        """Ask who hears whom, if more than one component is abnormal."""
        with self._lock:
            asked = bool(self._watch.beside(time.monotonic()))
        listeners = None
        if asked:
            try:
                listeners = self._calls.listeners()
            except NoAnswer as error:
                rospy.logwarn_throttle(60.0, 'only who is to blame is mended: %s' % error)
        with self._lock:
            self._listeners = listeners

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
        by = printable(request._connection_header.get('callerid', 'nobody'))[:_LONGEST_NAME]
        hold = Hold(time.time_ns() + nanoseconds(request.duration),
                    time.monotonic_ns() + nanoseconds(request.duration), f', by {by}')
        with self._lock:
            self._held = hold
            self._ladder.hold(hold.steady / SECOND_NS)
        answer = (f'does nothing until {to_the_second(hold.until)}' if request.duration
                  else 'goes on')
        if request.duration and not self._path:
            answer += '; not kept yet, so another start of the recovery would not know it'
        under_way = self._history.under_way
        if request.duration and under_way is not None:
            answer += f'; still ends what it does: {words.what(under_way)}'
        rospy.logwarn('%s, by %s', answer, by)
        return MaintenanceResponse(True, answer)

    def _why_held(self) -> str:
        """Return why nothing may be done at this moment; empty: it may."""
        with self._lock:
            return f'it is held{self._held.by}' if self._is_held() else ''

    def _is_held(self) -> bool:
        return time.monotonic_ns() < self._held.steady
