"""`evaluate fleet`: its arguments, and what it does."""
from __future__ import annotations

import argparse
from contextlib import closing
from typing import ContextManager

from self_awareness.calibration.limits import BUDGET
from self_awareness.commands import cli
from self_awareness.workers import Workers, on_this_machine
from self_awareness_evaluation import options
from self_awareness_evaluation.fleet import experiment, report
from self_awareness_evaluation.fleet.cluster import cluster_here
from self_awareness_evaluation.fleet.make import MOST_ROBOTS


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    parser.set_defaults(work=_work)
    options.add_output(parser, 'the page and the CSV files')
    parser.add_argument('--makes', type=cli.count, default=3, metavar='N',
                        help='makes of robots, each with the next seed (default: 3)')
    parser.add_argument('--seed', type=cli.count, default=1, help='the first seed (default: 1)')
    parser.add_argument('--robots', type=cli.count, default=20, metavar='N',
                        help='robots of a make that are learned on; one more is watched '
                        '(default: 20)')
    parser.add_argument('--starts', type=cli.count, default=2, metavar='N',
                        help='starts of each to train on (default: 2)')
    parser.add_argument('--calibrations', type=cli.count, default=1, metavar='N',
                        help='further starts of each to calibrate on (default: 1)')
    parser.add_argument('--recorded', type=options.calibration_s, default=150.0, metavar='S',
                        help='length of the recording of each start [s] (default: 150)')
    parser.add_argument('--hours', type=options.hours, default=10.0, metavar='H',
                        help='normal operation that is watched, of each make (default: 10)')
    parser.add_argument('--budget', type=options.budget, default=BUDGET, metavar='B',
                        help='false alarms an hour that limits are made for '
                        f'(default: {BUDGET:g})')
    options.add_jobs(parser, 'processes that count and judge')
    parser.add_argument('--dask', action='store_true', help='they are the workers of a cluster of '
                        'dask.distributed that is started on this machine; the results are the '
                        'same')


def _work(arguments: argparse.Namespace, command: str) -> None:
    most = MOST_ROBOTS // max(arguments.starts, arguments.calibrations)
    if arguments.robots > most:
        raise ValueError(f'--robots {arguments.robots}: of so many starts each, no more than '
                         f'{most}')
    plan = experiment.Plan(
        tuple(range(arguments.seed, arguments.seed + arguments.makes)), arguments.robots,
        arguments.starts, arguments.calibrations, arguments.recorded, arguments.hours,
        arguments.budget, arguments.jobs, arguments.dask)
    arguments.output.mkdir(parents=True, exist_ok=True)
    with _workers(plan) as workers:
        results = experiment.run(plan, workers)
    for path in report.write(arguments.output, plan, results, command):
        print(f'written: {path}')


def _workers(plan: experiment.Plan) -> ContextManager[Workers]:
    return cluster_here(plan.jobs) if plan.dask else closing(on_this_machine(plan.jobs))
