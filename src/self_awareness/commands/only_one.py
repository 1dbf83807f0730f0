"""`rosrun self_awareness only_one`: starts a node, unless one of its name runs already."""
from __future__ import annotations

import argparse
import os
import sys
import time
from typing import Any, Optional, Sequence

import roslib.packages
import rosgraph

from self_awareness.commands import cli
from self_awareness.recovery.node_calls import NodeCalls
from self_awareness.recovery.node_process import begun, has_another_name
from self_awareness.recovery.xml_rpc import NoAnswer

_NAME = 'only_one'
_WITHIN_S = 3.0
_POLL_S = 1.0
_START_AGAIN = 3

_EPILOG = """\
The launch files start the monitor and the learner by it. The master ends the older one of two
nodes of one name; if both are started again, they end each other for ever. A node that has died
and is still registered keeps nobody out.
"""


def main(argv: Optional[Sequence[str]] = None) -> int:
    """Run the program, unless it becomes the node.

    Returns:
        see cli.run; 3 if the master stopped answering, so that it may be started again
        (launch/until_refused.sh).
    """
    try:
        return _PROGRAM(argv)
    except NoAnswer as error:
        print(f'{_NAME}: error: {error}', file=sys.stderr)
        return _START_AGAIN


def _start(arguments: argparse.Namespace) -> None:
    package, _, program = arguments.program.rpartition('/')
    found = roslib.packages.find_node(package or 'self_awareness', program)
    if not found:
        raise ValueError(f'{arguments.program} is not there: was the package built?')
    name = _name(arguments.arguments)
    calls = NodeCalls(name, _WITHIN_S)
    _await_master(calls, name)
    running = _running(calls, name)
    if arguments.parameters:
        launched = rosgraph.names.resolve_name(arguments.parameters, name)
        _take(calls, launched, name, kept=not running)
    if running:
        raise ValueError(f'{name} runs already ({running}): stop it first (end its roslaunch, or '
                         f'`rosnode kill {name}`), or give this one another name')
    sys.stdout.flush()
    os.execv(found[0], [found[0], *arguments.arguments])


def _name(words: Sequence[str]) -> str:
    """Return the full name that the node will have."""
    own = [word.split(':=', 1)[1] for word in words if word.startswith('__name:=')]
    if not own:
        raise ValueError('the node has no name: give it one, as roslaunch does (__name:=NAME)')
    return rosgraph.names.ns_join(
        rosgraph.names.get_ros_namespace(argv=list(words)), own[-1])


def _await_master(calls: NodeCalls, name: str) -> None:
    """Wait for the master, as the node itself would: only it knows who runs."""
    told = False
    while True:
        try:
            calls.master('getPid')
            return
        except NoAnswer as error:
            if not told:
                cli.warn(_NAME, f'{name} waits: {error}')
            told = True
        time.sleep(_POLL_S)


def _running(calls: NodeCalls, name: str) -> str:
    """Return which process has the name, in words; empty: there is none."""
    try:
        address = calls.address(name)
    except NoAnswer:
        calls.master('getPid')  # it does answer: nobody is registered
        return ''
    try:
        pid = calls.process_id(name, address)
        is_here = calls.is_here(address)
    except NoAnswer:
        return ''  # it is dead, or hangs
    since = ''
    if is_here:
        if has_another_name(pid, name):
            return ''  # which has the port of the dead one
        began = begun(pid)  # None: in another container
        if began is not None:
            since = time.strftime(', since %Y-%m-%d %H:%M:%S', time.localtime(began))
    return f'pid {pid} on {rosgraph.network.parse_http_host_and_port(address)[0]}{since}'


def _take(calls: NodeCalls, launched: str, name: str, kept: bool) -> None:
    """Move what roslaunch has set to the private parameters of the node.

    roslaunch sets parameters before it starts nodes. Were they the private ones at once, those of
    a node that runs already would be overwritten. If a node is started again, there are none.
    """
    try:
        given = calls.master('getParam', launched)
        if kept:
            _set(calls, name, given)
        calls.master('deleteParam', launched)
    except NoAnswer:
        if kept and calls.master('hasParam', launched):
            raise  # else they were taken before


def _set(calls: NodeCalls, key: str, value: Any) -> None:
    """Set each parameter for itself: others of the node stay."""
    if isinstance(value, dict):
        for below, each in value.items():
            _set(calls, f'{key}/{below}', each)
    else:
        calls.master('setParam', key, value)


def _arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('--parameters', metavar='NAMESPACE',
                        help='move the parameters of this namespace to the private ones of the '
                             'node, if it is started')
    parser.add_argument('program', metavar='PROGRAM',
                        help='the node: one of this package, or PACKAGE/PROGRAM')
    parser.add_argument('arguments', metavar='ARGUMENT', nargs=argparse.REMAINDER,
                        help='of the node, with its name (__name:=NAME)')


_PROGRAM = cli.Program(_NAME, __doc__, _EPILOG, _arguments, _start)
