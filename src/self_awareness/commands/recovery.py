"""`nodes/recovery.py`: restarts what the monitor blames, by the rules of a file."""
from __future__ import annotations

import argparse
import os
import sys
import traceback
from contextlib import contextmanager
from typing import Iterator, Optional, Sequence

import rospy

from self_awareness.commands import cli, ros_node
from self_awareness.recovery import rules
from self_awareness.recovery.node import Recovery

_EPILOG = """\
Better: roslaunch self_awareness recovery.launch rules:=FILE. config/recovery.yaml explains the
rules. Call ~hold (self_awareness/Maintenance) before you work on the robot.
"""


def main(argv: Optional[Sequence[str]] = None) -> int:
    """Run the program.

    Returns:
        see cli.run; 1: the rules cannot be used. 3 if it failed for another reason, so that it may
        be started again (launch/until_refused.sh).
    """
    return cli.run(_parser(), _recover, cli.of_node(argv))


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
    """Let what fails here end the program, since it may go well the next time."""
    try:
        yield
    except Exception:
        traceback.print_exc()
        sys.exit(ros_node.START_AGAIN)


def _parser() -> argparse.ArgumentParser:
    parser = cli.parser('recovery.py', __doc__, _EPILOG)
    parser.add_argument('rules', metavar='FILE', help='the rules (example: config/recovery.yaml)')
    parser.add_argument('--monitor', default='/self_awareness', metavar='NAME',
                        help='of the monitor (default: /self_awareness)')
    return parser
