"""Induces faults in the running follow-me robot, for good or for the time of a with statement."""
from __future__ import annotations

import contextlib
import math
import multiprocessing
import os
import signal
import subprocess
import time
from ctypes import c_double
from pathlib import Path
from typing import ContextManager, Dict, Iterator, Optional

import rosgraph

from self_awareness.recovery.node_calls import NodeCalls
from self_awareness.recovery.xml_rpc import NoAnswer
from self_awareness_follow_me.effects import Crash, Effect, Intruder, Starvation
from self_awareness_follow_me.faults import INDUCED_FAULT
from self_awareness_follow_me.scenario import Scenario

_CALLER_ID = '/induce'
_WITHIN_S = 5.0  # the robot answers, and a node ends


class InduceError(ValueError):
    """A fault cannot be induced: no robot is running there, or a node is unknown to the master,
    does not answer, or runs elsewhere. The message says what to do."""


class _DeadError(InduceError):
    """A node is dead already."""


def lasting(effect: Effect, kind: str, namespace: str = '', scenario: Optional[Path] = None
            ) -> ContextManager[None]:
    """Return what makes a fault last as long as a with statement.

    Args:
        effect: of the fault; one that kills no node.
        kind: name of the fault.
        namespace: of the robot.
        scenario: its file; None: the one that comes with the package.
    """
    if isinstance(effect, Starvation):
        return starved(effect)
    if isinstance(effect, Intruder):
        return intruding(effect, namespace, scenario)
    return disturbed(kind, namespace)


def crash(effect: Crash, namespace: str = '') -> int:
    """Kill the node of a component with SIGKILL, and return its process id."""
    node = _resolved(namespace, effect.component)
    pid = process_id(node)
    _kill(node, pid)
    return pid


def silence(scenario: Scenario, namespace: str = '') -> Dict[str, int]:
    """Kill the nodes of all components and return the process ids of those that were alive; raise
    InduceError if none was."""
    pids: Dict[str, int] = {}
    # All at the same time: finding them takes long, so all are found before the first is killed.
    for spec in scenario.components:
        with contextlib.suppress(_DeadError):
            pids[spec.name] = process_id(_resolved(namespace, spec.name))
    if not pids:
        raise InduceError('all components are dead already')
    for name, pid in pids.items():
        _kill(_resolved(namespace, name), pid)
    return pids


def _kill(node: str, pid: int) -> None:
    try:
        os.kill(pid, signal.SIGKILL)
    except OSError as error:
        raise InduceError(f'{node}: process {pid} cannot be killed: {error.strerror}') from error


def process_id(node: str) -> int:
    """Return the process id of a node by its full name; or raise InduceError."""
    with _asking() as calls:
        address = calls.address(node)
        if not calls.is_here(address):
            raise InduceError(f'{node} runs on another machine ({address}): induce the fault '
                              'there')
        try:
            return calls.process_id(node, address)
        except NoAnswer as error:
            raise _DeadError(f'{error}: it is dead already') from error


@contextlib.contextmanager
def disturbed(kind: str, namespace: str = '') -> Iterator[None]:
    """Tell the components to misbehave for the time of a with statement; kind: name of a fault
    that they know of, such as a clock that drifts."""
    parameter = _resolved(namespace, INDUCED_FAULT)
    _check_running(parameter)
    try:
        _set_parameter(parameter, f'{kind}@{time.time():.6f}')
        yield
    finally:
        _set_parameter(parameter, '')


@contextlib.contextmanager
def intruding(effect: Intruder, namespace: str = '', scenario: Optional[Path] = None
              ) -> Iterator[None]:
    """Let a foreign node publish for the time of a with statement; raise InduceError if it ended
    by itself."""
    _check_running(_resolved(namespace, INDUCED_FAULT))
    command = ['rosrun', 'self_awareness', 'component', effect.spec.name]
    command += [] if scenario is None else ['--scenario', str(scenario)]
    try:
        process = subprocess.Popen(command + [f'__ns:={_resolved(namespace) or "/"}'])
    except OSError as error:
        raise InduceError(f'rosrun cannot be started: {error.strerror}') from error
    try:
        yield
        if process.poll():
            raise InduceError(f'the node {effect.spec.name} ended by itself, see above')
    finally:
        process.terminate()
        try:
            process.wait(_WITHIN_S)
        except subprocess.TimeoutExpired:
            process.kill()  # the master keeps its names
            process.wait()


@contextlib.contextmanager
def starved(effect: Starvation) -> Iterator[None]:
    """Let a growing number of busy workers take the CPU for the time of a with statement."""
    number = effect.workers_per_core * len(os.sched_getaffinity(0))
    # They wait for each other: beside busy ones, others would take seconds to start, and when the
    # fault began would not be known.
    begin = multiprocessing.Value('d', math.inf, lock=False)
    workers = [multiprocessing.Process(
        target=_work, args=(begin, effect.ramp * i / number, os.getpid()), daemon=True)
        for i in range(number)]
    try:
        for worker in workers:
            worker.start()
        begin.value = time.monotonic()
        yield
    finally:
        for worker in workers:
            if worker.pid is not None:
                worker.kill()
                worker.join()


def _work(begin: c_double, delay_s: float, parent: int) -> None:
    """Keep a core busy from a delay after the begin on, until the parent kills the process or dies
    itself.

    Args:
        begin: by the steady clock [s]; infinite while it is not known.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    # The kernel may share the CPU among sessions (autogroup): one session would weigh no more than
    # the whole robot, however many workers it has.
    os.setsid()
    while os.getppid() == parent:
        if time.monotonic() < begin.value + delay_s:
            time.sleep(0.01)
        else:
            for _ in range(100_000):
                pass


def _check_running(parameter: str) -> None:
    """Check that a robot has set its parameter."""
    with _asking() as calls:
        if calls.parameter(parameter) is None:
            raise NoAnswer(f'parameter {parameter} is not set')


def _set_parameter(parameter: str, value: str) -> None:
    with _asking() as calls:
        calls.master('setParam', parameter, value)


def _resolved(namespace: str, *names: str) -> str:
    return '/'.join(['', *filter(None, namespace.split('/')), *names])


@contextlib.contextmanager
def _asking() -> Iterator[NodeCalls]:
    """Hand out what asks the robot; without an answer, say what may be wrong."""
    try:
        yield NodeCalls(_CALLER_ID, _WITHIN_S)
    except NoAnswer as error:
        raise InduceError(f'{error}: is the robot running, and are --namespace and ROS_MASTER_URI '
                          f'({rosgraph.get_master_uri()}) right?') from error
