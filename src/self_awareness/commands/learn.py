"""`rosrun self_awareness learn`: learns a running robot, and goes on as its monitor."""
from __future__ import annotations

import argparse
import os
import sys
from typing import List, Optional, Sequence

import rospy

from self_awareness import EncodingRules, encoding_file
from self_awareness.calibration import limits
from self_awareness.calibration.heads_and_tails import START_UP_S
from self_awareness.commands import cli, ros_node
from self_awareness.learning import programs
from self_awareness.learning.node import LearningNode, Plan
from self_awareness.learning.recorder import RecorderCrash
from self_awareness.output_files import MODEL, check_outputs

_MONITOR = 'self_awareness_node'

_EPILOG = """\
Better: roslaunch self_awareness learn.launch model:=FILE. The parameter ~model names the file of
the model. If it is there already, this is the monitor at once. Call ~finish (std_srvs/Trigger) to
end the recording early. If it is started again, it goes on with the logs that are there.
"""


def main(argv: Optional[Sequence[str]] = None) -> int:
    """Run the program; return its exit code.

    Returns:
        See cli.run; 3 if it could go on with what it has, once it is started again.
    """
    try:
        return _PROGRAM(argv)
    except RecorderCrash as crash:
        print(f'learn: error: {crash}', file=sys.stderr)
        return ros_node.START_AGAIN


def _learn(arguments: argparse.Namespace) -> None:
    ros_node.limit_goodbye()
    ros_node.begin('self_awareness')
    model = str(rospy.get_param('~model', ''))
    if os.path.exists(model):
        rospy.loginfo('%s is there: this is the monitor; remove it to learn again', model)
    else:
        if not LearningNode(_plan(arguments, model)).run():
            return
        rospy.loginfo('%s is learned: this is the monitor from now on', model)
    _become_monitor()


def _plan(arguments: argparse.Namespace, model: str) -> Plan:
    if not model:
        raise ValueError('the parameter ~model is not set: which file is the model to be?')
    check_outputs([(model, MODEL)], [])
    encoding = without(rospy.get_name(), encoding_file.load(arguments.encoding)
                       if arguments.encoding else EncodingRules.defaults())
    return Plan(model, arguments.logs or f'{model}.logs', arguments.hours, arguments.start_up,
                arguments.budget, encoding, arguments.subscribe)


def without(node: str, encoding: EncodingRules) -> EncodingRules:
    """Return an encoding by which what a node sends is no event.

    The monitor will have this name, and does not listen to itself.
    """
    if node not in encoding.exclude_sources and encoding.includes_source(node):
        encoding.exclude_sources += [node]  # a regular expression: no name has special characters
    return encoding


def _become_monitor() -> None:
    """Replace this process, so that who started it, and its name, stay the same."""
    monitor = programs.executable(_MONITOR)
    remapped: List[str] = [each for each in sys.argv[1:] if ':=' in each]
    if not any(each.startswith('__name:=') for each in remapped):
        remapped.append(f'__name:={os.path.basename(rospy.get_name())}')
    rospy.signal_shutdown('this is the monitor now')
    sys.stdout.flush()
    sys.stderr.flush()
    os.execv(monitor, [monitor, *remapped])


def _arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('--hours', type=cli.above_zero('hours'), default=2.0, metavar='N',
                        help='of recordings to learn from, more than 0 (default: 2)')
    parser.add_argument('--logs', metavar='FOLDER',
                        help='of the event logs that are recorded (default: MODEL.logs)')
    parser.add_argument('--start-up', type=cli.offset, default=START_UP_S, metavar='S',
                        help='leave out so much after each start of the robot, in s (default: '
                             f'{START_UP_S:g})')
    parser.add_argument('--budget', type=cli.budget, default=limits.BUDGET, metavar='N',
                        help='false alarms an hour that the limits allow (default: '
                             f'{limits.BUDGET:g})')
    parser.add_argument('--encoding', metavar='FILE',
                        help='how messages become events (example: config/encoding.yaml)')
    parser.add_argument('--subscribe', choices=('used', 'all'), default='used',
                        help='used: only topics that a node of the robot (not a tool) subscribes '
                             'to; all: every topic, which may start publishers that work only for '
                             'subscribers (default: used)')


_PROGRAM = cli.Program('learn', __doc__, _EPILOG, _arguments, _learn, is_node=True)
