"""`nodes/recovery.py`: restarts what the monitor blames, by the rules of a file."""
from __future__ import annotations

import argparse
import os
import sys
import traceback
from contextlib import contextmanager
from typing import Iterator

import rospy

from self_awareness.commands import cli, ros_node
from self_awareness.recovery import rules
from self_awareness.recovery.node import Recovery

_EPILOG = """\
Better: roslaunch self_awareness recovery.launch rules:=FILE. config/recovery.yaml explains the
rules. Call ~hold (self_awareness/Maintenance) before you work on the robot.
"""


def _recover(arguments: argparse.Namespace) -> None:
    with _to_be_started_again():
        ros_node.limit_goodbye()
        ros_node.begin('self_awareness_recovery')
        monitor = rospy.resolve_name(arguments.monitor)
    allowed = rules.load(os.path.expanduser(arguments.rules), monitor, rospy.get_name())
    with _to_be_started_again():
        Recovery(allowed, monitor).run()


@contextmanager
def _to_be_started_again() -> Iterator[None]:
    """Let what fails here end the program with START_AGAIN: it may go well the next time.

    So launch/until_refused.sh starts it again, unless the rules cannot be used.
    """
    try:
        yield
    except Exception:
        traceback.print_exc()
        sys.exit(ros_node.START_AGAIN)


def _arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('rules', metavar='FILE', help='the rules (example: config/recovery.yaml)')
    parser.add_argument('--monitor', default='/self_awareness', metavar='NAME',
                        help='of the monitor (default: /self_awareness)')


main = cli.Program('recovery.py', __doc__, _EPILOG, _arguments, _recover, is_node=True)
