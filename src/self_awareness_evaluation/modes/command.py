"""`evaluate modes`: its arguments, and what it does."""
from __future__ import annotations

import argparse

from self_awareness_evaluation import options
from self_awareness_evaluation.families.protocol import Learning
from self_awareness_evaluation.families.report import FULL
from self_awareness_evaluation.modes import experiment, report


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    parser.set_defaults(work=_work)
    options.add_output(parser, f'the page and, in the folder {FULL}, all rows')
    options.add_robots(parser, experiment.FAMILIES)
    parser.add_argument('--starts', type=options.starts, default=4, metavar='N',
                        help='starts to train on; half as many, but one at least, are calibrated '
                        'on (default: 4)')
    parser.add_argument('--recorded', type=options.calibration_s, default=600.0, metavar='S',
                        help='length of the recording of each start [s] (default: 600)')
    parser.add_argument('--hours', type=options.hours, default=6.0, metavar='H',
                        help='normal operation that is watched, for each robot (default: 6)')
    options.add_jobs(parser, 'robots at a time')


def _work(arguments: argparse.Namespace, command: str) -> None:
    plan = experiment.Plan(
        tuple(arguments.families), tuple(range(arguments.seed, arguments.seed + arguments.robots)),
        Learning.of(arguments.starts, arguments.recorded, arguments.recorded), arguments.hours)
    arguments.output.mkdir(parents=True, exist_ok=True)
    results = experiment.run(plan, arguments.jobs)
    for path in report.write(arguments.output, plan, results, command):
        print(f'written: {path}')
