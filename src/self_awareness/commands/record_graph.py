"""`rosrun self_awareness record_graph`: writes who listens to whom beside bags that are recorded.
"""
from __future__ import annotations

import argparse
import glob
import os
import time
from typing import Set

from self_awareness.commands import cli
from self_awareness.training import robot_graph
from self_awareness.training.robot_graph import RobotGraph, graph_file

_PERIOD_S = 1.0

_EPILOG = """\
Run it while `rosbag record --output-prefix PREFIX` (or --output-name) runs; record.launch does.
End it by Ctrl-C. A bag does not say who subscribes; train finds the file PREFIX...graph.yaml by
itself if it lies beside the bag. Only the master is asked, once a second; no node notices.
"""


def _record(arguments: argparse.Namespace) -> None:
    folder = os.path.dirname(arguments.prefix) or os.curdir
    if not os.path.isdir(folder):
        raise ValueError(f'{folder}: there is no such folder, so rosbag cannot record there; make '
                         f"it, and start again: mkdir -p '{folder}'")
    complete: Set[str] = set()  # files that hold all that is known
    graph = RobotGraph()
    unanswered = ''  # why the master was not heard the last time
    while True:
        try:
            if graph.add(robot_graph.fetch()):
                complete.clear()
            unanswered = ''
        except ValueError as error:  # it may come back, and rosbag waits for it, too
            if str(error) != unanswered:
                cli.warn('record_graph', f'{error} (who subscribes to what is written once it '
                         'answers)')
            unanswered = str(error)
        bags = glob.glob(f'{glob.escape(arguments.prefix)}*.bag.active')
        for path in {graph_file(bag) for bag in bags} - complete:
            graph.save(path)
            complete.add(path)
        time.sleep(_PERIOD_S)


def _arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('prefix', metavar='PREFIX',
                        help='beginning of the paths of the bags, as rosbag record was told')


main = cli.Program('record_graph', __doc__, _EPILOG, _arguments, _record, is_node=True)
