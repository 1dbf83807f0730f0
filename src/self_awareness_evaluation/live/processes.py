"""The processes of a live session and their master, all ended together; and how time passes."""
from __future__ import annotations

import contextlib
import os
import random
import signal
import socket
import subprocess
import time
from pathlib import Path
from typing import Callable, Iterator, List, Sequence

import rosgraph
import rosnode
import rospy

from self_awareness import progress

WARM_UP_S = 10.0  # so long after the start of a robot is no normal operation yet [s]
STARTED_WITHIN_S = 90.0  # until then, what is started, robot or monitor, has said something [s]
_END_WITHIN_S = 30.0  # roslaunch takes half of it before it kills its nodes, which only it can
_POLL_S = 0.05
_PORTS = range(12000, 22000)
"""Of masters: below those that a kernel gives to connections, which may take any of its own
before the master does."""


class LiveError(ValueError):
    """The running robot or the monitor does not do what it should; the message says what."""


def free_port() -> int:
    """Return a port of the loopback interface that a master can have."""
    while True:
        port = random.choice(_PORTS)
        with contextlib.suppress(OSError), socket.socket() as free:
            free.bind(('127.0.0.1', port))
            return port


def say(text: str) -> None:
    """Print a line with the time of day."""
    progress.say(f'{time.strftime("%H:%M:%S")} {text}')


def wait(seconds: float, what: str) -> None:
    """Let time pass, and tell for what."""
    say(f'{what} ({seconds:g} s)')
    for _ in progress.waiting(seconds, what):
        pass


def await_condition(what: str, condition: Callable[[], bool], within_s: float) -> None:
    """Wait until a condition holds; raise LiveError if it does not before the limit [s]."""
    if not becomes_true(condition, within_s):
        raise LiveError(f'not within {within_s:g} s: {what}')


def becomes_true(condition: Callable[[], bool], within_s: float) -> bool:
    """Wait until a condition holds, and return whether it did before the limit [s]."""
    deadline = time.monotonic() + within_s
    while not condition():
        if time.monotonic() > deadline:
            return False
        time.sleep(_POLL_S)
    return True


class Processes:
    """Programs that run at the same time as this one; their output goes to files of a folder. As a
    context manager it ends all that still run."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._running: List[subprocess.Popen] = []

    def __enter__(self) -> Processes:
        return self

    def __exit__(self, *_: object) -> None:
        for process in self._running[::-1]:
            self.end(process)

    def start(self, log: str, *command: str) -> subprocess.Popen:
        """Start a program; its output is appended to a log of that name."""
        with open(self._folder / f'{log}.log', 'ab') as output:
            process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=output,
                                       stderr=subprocess.STDOUT, start_new_session=True)
        self._running.append(process)
        return process

    def run(self, log: str, within_s: float, *command: str) -> None:
        """Run a program; raise LiveError if it fails, or still runs after the limit [s]."""
        process = self.start(log, *command)
        try:
            code: object = process.wait(within_s)
        except subprocess.TimeoutExpired:
            code = 'not yet'
        self.end(process)
        if code != 0:
            raise LiveError(f'{" ".join(command)}: exit code {code}, see '
                            f'{self._folder / log}.log')

    def end(self, process: subprocess.Popen) -> None:
        """Interrupt a program and all that it started, and kill what does not end."""
        deadline = time.monotonic() + _END_WITHIN_S
        _signal(process, signal.SIGINT)
        while _signal(process, 0) and time.monotonic() < deadline:
            time.sleep(_POLL_S)
        _signal(process, signal.SIGKILL)
        process.wait()
        self._running.remove(process)


def _signal(process: subprocess.Popen, number: int) -> bool:
    """Send a signal, or none (0), to a program and all that it started; return whether any of
    them still runs."""
    process.poll()  # reaps the leader, which would count otherwise
    try:
        os.killpg(process.pid, number)
    except ProcessLookupError:
        return False
    return True


@contextlib.contextmanager
def own_master(folder: Path, node: str, pinned: Sequence[str] = ()) -> Iterator[Processes]:
    """Start a master on a free port of the loopback interface, and make this process a node of it;
    nothing of it runs on afterwards. The folder is for the logs of all processes that are started;
    pinned: command that runs the master on some cores; empty: on any."""
    port = free_port()
    os.environ.update(ROS_MASTER_URI=f'http://127.0.0.1:{port}', ROS_IP='127.0.0.1',
                      ROS_LOG_DIR=str(folder / 'log'))
    os.environ.pop('ROS_HOSTNAME', None)
    with Processes(folder) as processes:
        processes.start('roscore', *pinned, 'roscore', '-p', str(port))
        await_condition('the master answers', rosgraph.is_master_online, STARTED_WITHIN_S)
        # What it logs would be heard by the monitor.
        rospy.init_node(node, disable_signals=True, disable_rosout=True)
        try:
            yield processes
        finally:
            rospy.signal_shutdown('the session is over')


def unregister(ended: Sequence[str]) -> None:
    """Take back what nodes that have ended left at the master; raise LiveError if that is silent.
    When such a node is started again, the master has the one before shut down, at a port that
    another node may have by then."""
    try:
        left = sorted(set(rosnode.get_node_names()) & set(ended))
        rosnode.cleanup_master_blacklist(rosgraph.Master('/evaluate'), left)
    except (rosnode.ROSNodeException, rosgraph.MasterException, OSError) as error:
        raise LiveError(f'the master does not answer any more: {error}') from error
