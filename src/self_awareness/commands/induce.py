"""`rosrun self_awareness induce`: induces one of the paper's errors in the follow-me robot."""
from __future__ import annotations

import argparse
import contextlib
import math
import multiprocessing
import os
import signal
import socket
import sys
import time
from http.client import HTTPException
from pathlib import Path
from typing import Iterator, List, Optional
from urllib.parse import urlparse
from xmlrpc.client import Fault as XmlRpcFault
from xmlrpc.client import ServerProxy

import rosgraph
import rosgraph.network

from self_awareness import follow_me
from self_awareness.follow_me_faults import CLOCK_DRIFT_ONSET, ClockDrift, Crash, Starvation

_CALLER_ID = '/induce'


class InduceError(RuntimeError):
    """An error cannot be induced; the message says why and what to do."""


def main(argv: Optional[List[str]] = None) -> int:
    """Run the program; return 0 when the error was induced (and ended), 1 if it could not be.

    Args:
        argv: the arguments without the program's name, by default those of the process.
    """
    parser = _parser()
    arguments = parser.parse_args(argv)
    if arguments.duration is not None and not 0.0 < arguments.duration < math.inf:
        parser.error(f'--duration must be more than 0 s, not {arguments.duration}')
    # A termination must clean up like Ctrl-C.
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        scenario = follow_me.load(arguments.scenario)
        effect = getattr(scenario.faults, arguments.kind)
        if isinstance(effect, Crash):
            if arguments.duration is not None:
                parser.error('--duration: a crash does not end')
            pid = crash(effect, arguments.namespace)
            print(f'{time.time():.3f} {effect.component} killed (pid {pid})', flush=True)
        elif isinstance(effect, Starvation):
            with starved(effect):
                _last('CPU starvation', arguments.duration)
        else:
            with drifting(effect, arguments.namespace):
                _last(f'clock drift of host {effect.host}', arguments.duration)
    except (InduceError, follow_me.ScenarioError) as error:
        print(f'induce: error: {error}', file=sys.stderr)
        return 1
    return 0


def crash(effect: Crash, namespace: str = '') -> int:
    """Kill the node of a component with SIGKILL and return its process id.

    Raises:
        InduceError: the node is unknown to the master, does not answer, or runs elsewhere.
    """
    node = _resolved(namespace, effect.component)
    try:
        uri = rosgraph.Master(_CALLER_ID).lookupNode(node)
    except rosgraph.MasterError as error:
        raise InduceError(f'{node} is not known to the master: is the robot running, and is '
                          '--namespace right?') from error
    except (OSError, rosgraph.MasterException) as error:
        raise _no_master() from error
    if not rosgraph.network.is_local_address(urlparse(uri).hostname):
        raise InduceError(f'{node} runs on another machine ({uri}): induce the crash there')
    try:
        with _timeout(5.0):
            code, text, pid = ServerProxy(uri).getPid(_CALLER_ID)
    except (OSError, HTTPException, XmlRpcFault) as error:
        raise InduceError(f'{node} does not answer at {uri}: it is dead already') from error
    if code != 1 or pid <= 1:
        raise InduceError(f'{node} does not tell its process id: {text}')
    try:
        os.kill(pid, signal.SIGKILL)
    except OSError as error:
        raise InduceError(f'{node}: process {pid} cannot be killed: {error.strerror}') from error
    return pid


@contextlib.contextmanager
def drifting(effect: ClockDrift, namespace: str = '') -> Iterator[None]:
    """Let the clock of a host drift away for the time of a with statement.

    Raises:
        InduceError: no robot with such a host is running.
    """
    parameter = _resolved(namespace, CLOCK_DRIFT_ONSET, effect.host)
    master = rosgraph.Master(_CALLER_ID)
    try:
        known = master.hasParam(parameter)
    except (OSError, rosgraph.MasterException) as error:
        raise _no_master() from error
    if not known:
        raise InduceError(f'parameter {parameter} is not set: is the robot running, and is '
                          '--namespace right?')
    try:
        _set_parameter(master, parameter, time.time())
        yield
    finally:
        _set_parameter(master, parameter, 0.0)


@contextlib.contextmanager
def starved(effect: Starvation) -> Iterator[None]:
    """Let a growing number of busy workers take the CPU for the time of a with statement."""
    number = effect.workers_per_core * len(os.sched_getaffinity(0))
    workers = [multiprocessing.Process(target=_work, args=(effect.ramp * i / number, os.getpid()),
                                       daemon=True) for i in range(number)]
    try:
        for worker in workers:
            worker.start()
        yield
    finally:
        for worker in workers:
            if worker.pid is not None:
                worker.kill()
                worker.join()


def _work(delay_s: float, parent: int) -> None:
    """Keep a core busy after a delay, until the parent kills the process or dies itself."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    # The kernel may share the CPU among sessions (autogroup): one session would weigh no more than
    # the whole robot, however many workers it has.
    os.setsid()
    busy_from = time.monotonic() + delay_s
    while os.getppid() == parent:
        if time.monotonic() < busy_from:
            time.sleep(0.05)
        else:
            for _ in range(100_000):
                pass


def _last(what: str, duration_s: Optional[float]) -> None:
    """Wait for the duration (s), without one until Ctrl-C."""
    print(f'{time.time():.3f} {what} begins', flush=True)
    try:
        time.sleep(duration_s) if duration_s is not None else signal.pause()
    except KeyboardInterrupt:
        pass
    print(f'{time.time():.3f} {what} ends', flush=True)


def _set_parameter(master: rosgraph.Master, parameter: str, value: float) -> None:
    try:
        master.setParam(parameter, value)
    except (OSError, rosgraph.MasterException) as error:
        raise _no_master() from error


def _resolved(namespace: str, *names: str) -> str:
    return '/'.join(['', *filter(None, namespace.split('/')), *names])


def _no_master() -> InduceError:
    return InduceError(f'no master at {rosgraph.get_master_uri()}: is the robot running, and is '
                       'ROS_MASTER_URI right?')


@contextlib.contextmanager
def _timeout(seconds: float) -> Iterator[None]:
    before = socket.getdefaulttimeout()
    socket.setdefaulttimeout(seconds)
    try:
        yield
    finally:
        socket.setdefaulttimeout(before)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog='induce', description=__doc__.split(': ', 1)[1])
    parser.add_argument('kind', choices=('cc1', 'cc2', 'rs', 'ac'),
                        help='cc1: the laser driver is killed; cc2: slam is killed; rs: busy '
                             'workers starve the CPU; ac: the clock of one host drifts away')
    parser.add_argument('--duration', type=float, metavar='S',
                        help='how long rs or ac last in s (default: until Ctrl-C)')
    parser.add_argument('--namespace', default='', metavar='NS',
                        help='namespace of the robot (default: none)')
    parser.add_argument('--scenario', type=Path, metavar='FILE',
                        help='the robot (default: config/follow_me.yaml of the package)')
    return parser
