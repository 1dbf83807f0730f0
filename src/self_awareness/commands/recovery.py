"""`nodes/recovery.py`: restarts what the monitor blames, by the rules of a file."""
from __future__ import annotations

import argparse
import os
import sys
from typing import Optional, Sequence

import rospy

from self_awareness.commands import cli
from self_awareness.learning.leaving import limit_goodbye
from self_awareness.recovery import history, rules
from self_awareness.recovery.node import Recovery

_EPILOG = """\
Better: roslaunch self_awareness recovery.launch rules:=FILE. config/recovery.yaml explains the
rules. Call ~hold (self_awareness/Maintenance) before you work on the robot.
"""

_DIRECTORY = '$ROS_HOME/self_awareness/$NAME'  # the monitor's default


def main(argv: Optional[Sequence[str]] = None) -> int:
    """Run the program; return its exit code (see cli.run)."""
    given = sys.argv if argv is None else ['', *argv]
    return cli.run(_parser(), _recover, rospy.myargv(given)[1:])


def _recover(arguments: argparse.Namespace) -> None:
    limit_goodbye()
    rospy.init_node('self_awareness_recovery')
    monitor = rospy.resolve_name(arguments.monitor)
    path = os.path.expanduser(arguments.rules)
    allowed = rules.load(path, monitor, rospy.get_name())
    directory = str(rospy.get_param(f'{monitor}/recorder/directory', _DIRECTORY))
    Recovery(allowed, monitor, history.beside_incidents(directory, monitor)).run()


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog='recovery.py', description=(__doc__ or '').split(': ', 1)[1].strip(), epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('rules', metavar='FILE', help='the rules (example: config/recovery.yaml)')
    parser.add_argument('--monitor', default='/self_awareness', metavar='NAME',
                        help='of the monitor (default: /self_awareness)')
    return parser
