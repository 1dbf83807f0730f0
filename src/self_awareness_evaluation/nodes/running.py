"""The nodes of the system while they run: started, broken and mended."""
from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Dict, Iterator, List, Sequence

import rospy
from std_srvs.srv import SetBool

from self_awareness_evaluation.live.listeners import STARTED_WITHIN_S, RobotListener
from self_awareness_evaluation.live.master import unregister
from self_awareness_evaluation.live.processes import LiveError, Processes, await_condition
from self_awareness_evaluation.nodes.system import (CAMERAS_HZ, HALF_RATE, KILL, LATE, NODES,
                                                    PARAMETERS, RESTART, STARVE, STOP, Fault,
                                                    Node)
from self_awareness_follow_me import induction
from self_awareness_follow_me.effects import Starvation

_STARVATION = Starvation(ramp=0.0, slowdown=1.0, workers_per_core=4)
_RATE = 'publish_rate'  # of image_publisher
_SERVICE_WITHIN_S = 10.0


class RunningSystem:
    """All NODES as processes; `rospy.init_node` has been called."""

    def __init__(self, folder: Path, processes: Processes) -> None:
        """Start nothing yet.

        Args:
            folder: drivers.write has written into it.
            processes: to be started among.
        """
        self._folder = folder
        self._processes = processes
        self._running: Dict[str, subprocess.Popen] = {}

    def start(self) -> None:
        """Start all nodes and wait until they have published on all their topics.

        Raises:
            LiveError: one has not in time.
        """
        for name, value in PARAMETERS.items():
            rospy.set_param(name, value)
        self._start(NODES)

    def end(self) -> None:
        """End all nodes, the last one first: nodelets before their managers."""
        self._end([node for node in reversed(NODES) if node.name in self._running])

    @contextlib.contextmanager
    def broken(self, fault: Fault) -> Iterator[float]:
        """Induce a fault and hand out its onset [s since 1970]; it ends with the with statement.

        Raises:
            LiveError: it cannot be induced, or the node does not publish again.
        """
        effect = {KILL: self._killed, STOP: self._stopped, RESTART: self._restarted,
                  HALF_RATE: self._halved, LATE: self._late, STARVE: self._starved}[fault.kind]
        with effect(fault.node) as onset:
            yield onset

    @contextlib.contextmanager
    def _killed(self, name: str) -> Iterator[float]:
        self._running[name].kill()
        yield time.time()
        nodes = _with_nodelets(name)
        self._end(nodes[::-1])
        self._start(nodes)

    @contextlib.contextmanager
    def _stopped(self, name: str) -> Iterator[float]:
        pid = self._running[name].pid
        os.kill(pid, signal.SIGSTOP)
        try:
            yield time.time()
        finally:
            os.kill(pid, signal.SIGCONT)

    @contextlib.contextmanager
    def _restarted(self, name: str) -> Iterator[float]:
        onset = time.time()
        nodes = _with_nodelets(name)
        self._end(nodes[::-1])
        self._start(nodes)
        yield onset

    @staticmethod
    @contextlib.contextmanager
    def _halved(name: str) -> Iterator[float]:
        # Installed with the nodes; only here it is needed.
        from dynamic_reconfigure.client import Client
        client = Client(f'/{name}', timeout=_SERVICE_WITHIN_S)
        try:
            client.update_configuration({_RATE: CAMERAS_HZ[name] / 2.0})
            yield time.time()
        finally:
            client.update_configuration({_RATE: CAMERAS_HZ[name]})
            client.close()

    @staticmethod
    @contextlib.contextmanager
    def _late(name: str) -> Iterator[float]:
        _call(f'/{name}/late', True)
        try:
            yield time.time()
        finally:
            _call(f'/{name}/late', False)

    @staticmethod
    @contextlib.contextmanager
    def _starved(_: str) -> Iterator[float]:
        with induction.starved(_STARVATION):
            yield time.time()

    def _start(self, nodes: Sequence[Node]) -> None:
        begin = time.time()
        topics = [topic for node in nodes for topic in node.topics]
        robot = RobotListener([topic[1:] for topic in dict.fromkeys(topics)])
        for node in nodes:
            self._running[node.name] = self._processes.start(
                node.name.replace('/', '_'), *self._command(node))
        try:
            for node in nodes:
                for topic in node.topics:
                    _await_heard(robot, node, topic, begin)
        finally:
            robot.close()

    def _end(self, nodes: Sequence[Node]) -> None:
        for node in nodes:
            self._processes.end(self._running.pop(node.name))
        unregister([f'/{node.name}' for node in nodes])

    def _command(self, node: Node) -> List[str]:
        namespace, _, name = f'/{node.name}'.rpartition('/')
        module = f'self_awareness_evaluation.nodes.{node.program}'
        return [*(['rosrun', node.package, node.program] if node.package
                  else [sys.executable, '-m', module]),
                *node.arguments, *([str(self._folder / node.file)] if node.file else []),
                f'__name:={name}', f'__ns:={namespace or "/"}']


def _await_heard(robot: RobotListener, node: Node, topic: str, after: float) -> None:
    await_condition(f'/{node.name} publishes {topic}',
                    lambda: robot.last(f'/{node.name}', topic[1:]) > after, STARTED_WITHIN_S)


def _with_nodelets(name: str) -> List[Node]:
    """Return a node, and those that load a nodelet into it: they end when it dies."""
    return [node for node in NODES if name in (node.name, node.manager)]


def _call(service: str, value: bool) -> None:
    try:
        rospy.wait_for_service(service, _SERVICE_WITHIN_S)
        rospy.ServiceProxy(service, SetBool)(value)
    except (rospy.ROSException, rospy.ServiceException) as error:
        raise LiveError(f'{service}: {error}') from error
