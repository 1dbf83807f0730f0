"""The arguments of `evaluate recovery`."""
from __future__ import annotations

import argparse
from pathlib import Path

from self_awareness.commands import cli
from self_awareness_evaluation import options


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    parser.add_argument('-o', '--output', type=Path, default=Path('docs'), metavar='DIR',
                        help='folder of reliability.md, whose section is written (default: docs)')
    parser.add_argument('--times', type=cli.count, default=20, metavar='N',
                        help='that the laser driver hangs (default: 20)')
    parser.add_argument('--minutes', type=options.minutes, default=60.0, metavar='MIN',
                        help='of faults at random after that (default: 60)')
    parser.add_argument('--seed', type=cli.count, default=1, help='of the faults and the robot '
                        '(default: 1)')
    parser.add_argument('--speed', type=cli.above_zero('a factor of the speed'), default=10.0,
                        metavar='N', help='times the usual speed of the robot (default: 10)')
    parser.add_argument('--training', type=options.calibration_s, default=90.0, metavar='S',
                        help='length of each of three recordings to learn from [s] (default: 90)')
