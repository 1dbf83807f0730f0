"""The packaged nodes while they run: started, broken and mended."""
from __future__ import annotations

import contextlib
import subprocess
import time
from pathlib import Path
from typing import ContextManager, Dict, Iterator, List, Sequence

import rospy

from self_awareness_evaluation.live import drivers
from self_awareness_evaluation.live.breaking import BUSY, broken_by, stopped
from self_awareness_evaluation.live.listeners import heard
from self_awareness_evaluation.live.packaged_nodes import (CAMERAS_HZ, HALF_RATE, KILL, NODES,
                                                           PARAMETERS, RESTART, STOP, Node)
from self_awareness_evaluation.live.processes import WARM_UP_S, Processes, unregister, wait
from self_awareness_follow_me import induction

_RATE = 'publish_rate'  # of image_publisher
_SERVICE_WITHIN_S = 10.0


class PackagedSystem:
    """All NODES as processes; `rospy.init_node` has been called."""

    def __init__(self, folder: Path, processes: Processes) -> None:
        """Start nothing yet; folder: for what drivers replay."""
        drivers.write(folder)
        self._folder = folder
        self._processes = processes
        self._running: Dict[str, subprocess.Popen] = {}

    def start(self) -> None:
        """Start all; wait until they have published on all their topics, or raise LiveError."""
        for name, value in PARAMETERS.items():
            rospy.set_param(name, value)
        self._start(NODES)
        wait(WARM_UP_S, 'warming up')

    def end(self) -> None:
        """End all nodes, the last one first: nodelets before their managers."""
        self._end([node for node in NODES if node.name in self._running])

    def broken(self, kind: str, node: str) -> ContextManager[float]:
        """Return what induces a fault, hands out its onset [s since 1970], and undoes it.

        Entering and leaving it raise:
            LiveError: it cannot be induced, or the node does not publish again.
        """
        if kind == KILL:
            return self._killed(node)
        if kind == STOP:
            return stopped(self._running[node].pid)
        if kind == RESTART:
            return self._restarted(node)
        return _halved(node) if kind == HALF_RATE else broken_by(induction.starved(BUSY))

    @contextlib.contextmanager
    def _killed(self, name: str) -> Iterator[float]:
        self._running[name].kill()
        yield time.time()
        self._restart(name)

    @contextlib.contextmanager
    def _restarted(self, name: str) -> Iterator[float]:
        onset = time.time()
        self._restart(name)
        yield onset

    def _restart(self, name: str) -> None:
        """Start a node again, and those that load a nodelet into it: they end when it dies."""
        nodes = [node for node in NODES if name in (node.name, node.manager)]
        self._end(nodes)
        self._start(nodes)

    def _start(self, nodes: Sequence[Node]) -> None:
        with heard([(f'/{node.name}', topic) for node in nodes for topic in node.topics]):
            for node in nodes:
                self._running[node.name] = self._processes.start(
                    node.name.replace('/', '_'), *self._command(node))

    def _end(self, nodes: Sequence[Node]) -> None:
        for node in reversed(nodes):
            self._processes.end(self._running.pop(node.name))
        unregister([f'/{node.name}' for node in nodes])

    def _command(self, node: Node) -> List[str]:
        namespace, _, name = f'/{node.name}'.rpartition('/')
        return ['rosrun', node.package, node.program, *node.arguments,
                *([str(self._folder / node.file)] if node.file else []),
                f'__name:={name}', f'__ns:={namespace or "/"}']


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
