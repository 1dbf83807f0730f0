"""Does the steps of a ladder: stops nodes, and calls services."""
from __future__ import annotations

import threading
from typing import Any, Callable, Dict, List, Optional, Sequence, Tuple

import rospy
from std_srvs.srv import Trigger

from self_awareness.recovery.node_calls import NoAnswer, NodeCalls
from self_awareness.recovery.node_process import NodeProcess, NotItsProcess, process_of
from self_awareness.recovery.rules import Call, Step
from self_awareness.srv import Mute

_SERVICE_S = 10.0
_OF_ROS = {'/rosout'}


class ActionError(Exception):
    """A step could not be done; the message says why."""


class Actions:
    """What can be done; needs rospy.init_node().

    Args:
        calls: to the master and to nodes.
        nodes: that may be stopped.
        grace: a node has so long to end, before the next way to stop it [s].
    """

    def __init__(self, calls: NodeCalls, nodes: Sequence[str], grace: float) -> None:
        self._calls = calls
        self._nodes = nodes
        self._grace = grace
        self._lock = threading.Lock()
        # By node, its process when it was well, and its address then. Guarded by _lock.
        self._known: Dict[str, Tuple[NodeProcess, str]] = {}
        self._refused: Dict[str, str] = {}  # node: why it cannot be stopped. Guarded by _lock.
        self._asking: Dict[str, threading.Thread] = {}  # by service, who waits for its answer

    def look(self) -> None:
        """Ask the nodes which processes they are, and remember it; it may take a while."""
        for node in self._nodes:
            try:
                self._look_at(node, self._calls.address(node))
            except (NoAnswer, NotItsProcess):
                pass  # what hangs is remembered as it was; what is refused is told by refused()

    def refused(self) -> List[str]:
        """Return which nodes cannot be stopped, and why."""
        with self._lock:
            return list(self._refused.values())

    def do(self, step: Step, culprit: str, mute: Callable[[str], None]) -> str:
        """Do a step; return what came of it, in words.

        Args:
            step: to be done.
            culprit: the component that is to blame.
            mute: called with each other node before it is stopped.

        Raises:
            ActionError: it could not be done, or not to its end.
        """
        if isinstance(step, Call):
            answer = self.ask(step.service, Trigger)
            if not answer.success:
                raise ActionError(f'{step.service} says: {answer.message}')
            return f'{step.service} says: {answer.message}' if answer.message else 'called'
        try:
            self._check(step.nodes)
            results = []
            for node in step.nodes:
                if node != culprit:
                    mute(node)
                results.append(f'{node} {self._stop(node)}')
            return ', '.join(results)
        except (NoAnswer, NotItsProcess, OSError) as error:
            raise ActionError(str(error)) from error

    def ask(self, service: str, kind: Any, **fields: Any) -> Any:
        """Call a service; return its answer.

        Raises:
            ActionError: it is not there, fails, or does not answer in time.
        """
        before = self._asking.get(service)
        if before is not None and before.is_alive():
            raise ActionError(f'{service} has not answered since it was called last')
        answers: List[Any] = []
        problems: List[str] = []

        def run() -> None:
            try:
                answers.append(rospy.ServiceProxy(service, kind)(**fields))
            except (rospy.ServiceException, rospy.ROSException, OSError) as error:
                problems.append(f'{service}: {error}')

        # rospy waits for an answer for ever.
        self._asking[service] = threading.Thread(target=run, daemon=True)
        self._asking[service].start()
        self._asking[service].join(_SERVICE_S)
        if not answers:
            raise ActionError(problems[0] if problems
                              else f'{service} does not answer within {_SERVICE_S:g} s')
        return answers[0]

    def mute(self, monitor: str, node: str, seconds: float) -> str:
        """Tell a monitor that a node is stopped on purpose; return why not, or nothing."""
        try:
            answer = self.ask(f'{monitor}/mute', Mute, component=node, duration=seconds)
        except ActionError as error:
            return str(error)
        return '' if answer.success else str(answer.message)

    def _check(self, nodes: Sequence[str]) -> None:
        everybody, own = self._calls.robot()
        for node in nodes:
            if node in own:
                raise NotItsProcess(f'{node} is a monitor or a recorder, or hosts one: it may not '
                                    'be stopped')
        if everybody - own - _OF_ROS <= set(nodes):
            raise NotItsProcess('these are all nodes of the robot: it may not be stopped as a '
                                'whole')

    def _stop(self, node: str) -> str:
        address = self._calls.address(node)
        try:
            process = self._look_at(node, address)
        except NoAnswer:
            return f'{self._hanging(node, address).end(self._grace)}, since it hangs'
        try:
            self._calls.shut_down(node, address, 'stopped by the recovery')
        except NoAnswer:
            pass  # then by signals
        if process is None:
            return 'asked to end, on another machine'
        if process.ends_within(self._grace):
            return 'ended when it was asked to'
        return process.end(self._grace)

    def _look_at(self, node: str, address: str) -> Optional[NodeProcess]:
        """Return the process of a node that is well, and remember it; None: it is elsewhere.

        Raises:
            NoAnswer: it does not answer.
            NotItsProcess: it may not be stopped.
        """
        pid = self._calls.process_id(node, address)
        try:
            process = process_of(node, pid) if self._calls.is_here(address) else None
        except NotItsProcess as error:
            with self._lock:
                self._known.pop(node, None)
                self._refused[node] = str(error)
            raise
        with self._lock:
            self._refused.pop(node, None)
            if process is not None:
                self._known[node] = process, address
        return process

    def _hanging(self, node: str, address: str) -> NodeProcess:
        """Return the process of a node that does not answer.

        Raises:
            NotItsProcess: it is not known, or has ended.
        """
        if not self._calls.is_here(address):
            raise NotItsProcess(f'{node} does not answer, and runs on another machine ({address})')
        with self._lock:
            process, address_then = self._known.get(node, (None, ''))
        if process is None or address_then != address:
            raise NotItsProcess(f'{node} does not answer, and has not since it was started: its '
                                'process is not known')
        if not process.runs():
            raise NotItsProcess(f'{node} does not run; roslaunch starts it again if its launch '
                                'file says respawn="true"')
        return process
