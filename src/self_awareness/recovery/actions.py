"""Does the steps of a ladder: stops nodes, and calls services."""
from __future__ import annotations

import threading
from contextlib import suppress
from functools import lru_cache
from typing import Any, Callable, Dict, List, Optional, Sequence, Tuple

import rospy
from std_srvs.srv import Trigger

from self_awareness.recovery.node_calls import Launchers, NodeCalls
from self_awareness.recovery.node_process import (NodeProcess, NotItsProcess, line_of,
                                                  process_of)
from self_awareness.recovery.rules import Call, Step
from self_awareness.recovery.xml_rpc import NoAnswer

_SERVICE_S = 10.0
_OF_ROS = {'/rosout'}
_ENDED = 'has ended already; roslaunch starts it again'


class ActionError(Exception):
    """A step could not be done; the message says why."""


class Actions:
    """What can be done; needs rospy.init_node().

    Args:
        calls: to the master and to nodes.
        nodes: that may be stopped.
        grace: a node has so long to end, before the next way to stop it [s].
        held: returns whether nothing may be done at this moment, in words; empty: it may.
    """

    def __init__(self, calls: NodeCalls, nodes: Sequence[str], grace: float,
                 held: Callable[[], str] = str) -> None:
        self._calls = calls
        self._nodes = nodes
        self._grace = grace
        self._held = held
        self._lock = threading.Lock()
        # By node, its process when it was well, and its address then. Guarded by _lock.
        self._known: Dict[str, Tuple[NodeProcess, str]] = {}
        # By node, why it cannot be stopped. Guarded by _lock.
        self._refused = {node: f'{node}: not heard so far' for node in nodes}
        self._asking: Dict[str, threading.Thread] = {}  # by service, who waits for its answer

    def look(self) -> None:
        """Ask the nodes which processes they are, and remember it; it may take a while."""
        launchers = lru_cache(maxsize=None)(self._calls.launchers)  # asked only if needed, once
        for node in self._nodes:
            # What hangs is remembered as it was; what is refused is told by refused().
            with suppress(NoAnswer, NotItsProcess):
                self._look_at(node, self._calls.address(node), launchers)

    def refused(self) -> List[str]:
        """Return which nodes cannot be stopped, and why."""
        with self._lock:
            return list(self._refused.values())

    def do(self, step: Step, culprit: str, mute: Callable[[str], None]) -> str:
        """Do a step; return what came of it, in words.

        Before it stops another node than the culprit, it has that one muted.

        Raises:
            ActionError: it could not be done, or not to its end.
        """
        self._check_hold()
        if isinstance(step, Call):
            answer = self.ask(step.service, Trigger)
            told = f'{step.service} says: {answer.message}'
            if not answer.success:
                raise ActionError(told)
            return told if answer.message else 'called'
        results: List[str] = []
        try:
            self._check(step.nodes)
            for node in step.nodes:
                self._check_hold()
                if node != culprit:
                    mute(node)
                results.append(f'{node} {self._stop(node)}')
            return ', '.join(results)
        except (ActionError, NoAnswer, NotItsProcess, OSError) as error:
            raise ActionError('; '.join([*results, str(error)])) from error

    def would_do(self, step: Step) -> str:
        """Return what a step would be done to, which is looked up, in words.

        Raises:
            ActionError: it could not be done.
        """
        try:
            if isinstance(step, Call):
                self._calls.service(step.service)
                return f'{step.service} is there'
            self._check(step.nodes)
            return ', '.join(self._would_stop(node) for node in step.nodes)
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
            except Exception as error:  # rospy hands on whatever the answer is decoded to
                problems.append(f'{service}: {error}')

        # rospy waits for an answer for ever.
        self._asking[service] = threading.Thread(target=run, daemon=True)
        self._asking[service].start()
        self._asking[service].join(_SERVICE_S)
        if not answers:
            raise ActionError(problems[0] if problems
                              else f'{service} does not answer within {_SERVICE_S:g} s')
        return answers[0]

    def _check(self, nodes: Sequence[str]) -> None:
        everybody, own = self._calls.robot()
        for node in nodes:
            if node in own:
                raise NotItsProcess(f'{node} is a monitor or a recorder, or hosts one: it may not '
                                    'be stopped')
        if everybody - own - _OF_ROS <= set(nodes):
            raise NotItsProcess('these are all nodes of the robot: it may not be stopped as a '
                                'whole')

    def _check_hold(self) -> None:
        held = self._held()
        if held:
            raise ActionError(f'not done to its end: {held}')

    def _stop(self, node: str) -> str:
        found = self._find(node)
        if found is None:
            return _ENDED
        address, process, hangs = found
        if process is not None and hangs:
            return f'{process.end(self._grace, self._check_hold)}, since it hangs'
        self._check_hold()  # to find it may have taken a while
        try:
            self._calls.shut_down(node, address, 'stopped by the recovery')
        except NoAnswer as error:
            if process is None:
                raise ActionError(f'{node} was asked to end, on another machine, and did not '
                                  f'answer: {error}') from error
            # else by signals
        if process is None:
            return 'asked to end, on another machine'
        if process.ends_within(self._grace, self._check_hold):
            return 'ended when it was asked to'
        return process.end(self._grace, self._check_hold)

    def _would_stop(self, node: str) -> str:
        found = self._find(node)
        if found is None:
            return f'{node} {_ENDED}'
        _, process, hangs = found
        where = 'on another machine' if process is None else f'process {process.pid}'
        return f'{node} {"hangs, and is" if hangs else "is"} {where}'

    def _find(self, node: str) -> Optional[Tuple[str, Optional[NodeProcess], bool]]:
        """Return what a node is now; None: it was known, and has ended.

        Returns:
            address of its slave API; its process, None: on another machine; whether it hangs.

        Raises:
            NoAnswer: the master does not know it, or does not answer.
            NotItsProcess: it may not be stopped, or its process is not known.
        """
        with self._lock:
            known, address_then = self._known.get(node, (None, ''))
        try:
            address = self._calls.address(node)
        except NoAnswer:
            if known is None or known.runs():
                raise
            return None
        with suppress(NoAnswer):
            return address, self._look_at(node, address), False
        if not self._calls.is_here(address):
            raise NotItsProcess(f'{node} does not answer, and runs on another machine ({address})')
        if known is None or address_then != address:
            raise NotItsProcess(f'{node} does not answer, and has not since it was started: its '
                                'process is not known')
        if not known.runs():
            return None
        self._check_launched(node, known, self._calls.launchers)
        return address, known, True

    def _look_at(self, node: str, address: str,
                 launchers: Optional[Callable[[], Launchers]] = None) -> Optional[NodeProcess]:
        """Return the process of a node that is well, and remember it; None: it is elsewhere.

        Who starts nodes is not asked for a process that is known, if `launchers` is given.

        Raises:
            NoAnswer: it does not answer.
            NotItsProcess: it may not be stopped.
        """
        pid = self._calls.process_id(node, address)
        try:
            process = process_of(node, pid) if self._calls.is_here(address) else None
            with self._lock:
                known, _ = self._known.get(node, (None, ''))
            if launchers is None or process is None or known != process:
                self._check_launched(node, process, launchers or self._calls.launchers)
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

    def _check_launched(self, node: str, process: Optional[NodeProcess],
                        launchers: Callable[[], Launchers]) -> None:
        """Raise NotItsProcess unless a node is started again, and its end does no further harm."""
        try:
            started = launchers()
        except NoAnswer as error:
            raise NotItsProcess(f'{node} may stay dead: who has started it is not known '
                                f'({error})') from error
        why_not = started.why_not(node, None if process is None else line_of(process.pid))
        if why_not:
            raise NotItsProcess(why_not)
