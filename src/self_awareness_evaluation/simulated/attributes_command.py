"""`evaluate attributes`: its arguments, and what it does."""
from __future__ import annotations

import argparse

from self_awareness.commands import cli
from self_awareness_evaluation import options
from self_awareness_evaluation.simulated import attributes_report, experiment
from self_awareness_evaluation.simulated.records import WITHIN_S
from self_awareness_follow_me.scenario import load_scenario

SYSTEMS = (attributes_report.SYSTEM, 'timestamps', 'sizes', 'gaps', 'frequency_learned')


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    parser.set_defaults(work=_work)
    options.add_output(parser, 'the page and the CSV file')
    parser.add_argument('--seeds', type=cli.count, default=10, metavar='N',
                        help='number of repetitions, each with the next seed (default: 10)')
    parser.add_argument('--seed', type=int, default=1, help='the first seed (default: 1)')
    options.add_jobs(parser, 'seeds at a time')


def _work(arguments: argparse.Namespace, command: str) -> None:
    plan = experiment.Plan(SYSTEMS, tuple(WITHIN_S),
                           tuple(range(arguments.seed, arguments.seed + arguments.seeds)),
                           training_share=0.0)
    arguments.output.mkdir(parents=True, exist_ok=True)
    results = experiment.run(plan, load_scenario(), arguments.jobs)
    for path in attributes_report.write(arguments.output, plan, results.rows, command):
        print(f'written: {path}')
