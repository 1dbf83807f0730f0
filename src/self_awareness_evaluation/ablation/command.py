"""`evaluate ablation`: its arguments, and what it does."""
from __future__ import annotations

import argparse
from pathlib import Path
from typing import Tuple

from self_awareness import Tuning
from self_awareness.commands import cli
from self_awareness_evaluation import options
from self_awareness_evaluation.ablation import experiment, report
from self_awareness_evaluation.ablation.bench import Plan
from self_awareness_evaluation.ablation.variants import KINDS, variants
from self_awareness_evaluation.families.experiment import check_hours
from self_awareness_evaluation.families.kinds import FAMILIES
from self_awareness_evaluation.families.protocol import Learning
from self_awareness_evaluation.recordings import outages

_FAMILIES = ('timers', 'wireless', 'jittery', 'wander', 'day_night', 'stalled_loops',
             'driving_docked', 'events_only', 'bursty')


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    parser.set_defaults(work=_work)
    options.add_output(parser, 'the page, the CSV file and, in the folder '
                       f'{report.FULL}, the rows of all records, from which an interrupted run '
                       'goes on,')
    parser.add_argument('--families', nargs='+', choices=FAMILIES, default=_FAMILIES,
                        metavar='FAMILY', help='robots of these: '
                        f'{", ".join(FAMILIES)} (default: {" ".join(_FAMILIES)})')
    parser.add_argument('--seeds', type=cli.count, default=1, metavar='N',
                        help='robots of each family, each with the next seed (default: 1)')
    parser.add_argument('--own-seeds', type=cli.count, default=3, metavar='N',
                        help='the same for the records of the own robot (default: 3)')
    parser.add_argument('--seed', type=cli.count, default=1, help='the first seed (default: 1)')
    parser.add_argument('--starts', type=options.starts, nargs='+', default=[2, 4], metavar='N',
                        help='starts to train on, for one robot after the other in turn; half as '
                        'many, but one at least, are calibrated on (default: 2 4)')
    parser.add_argument('--training', type=options.calibration_s, default=150.0, metavar='S',
                        help='length of a recording to train on [s] (default: 150)')
    parser.add_argument('--calibration', type=options.calibration_s, default=150.0, metavar='S',
                        help='length of one to calibrate on [s] (default: 150)')
    parser.add_argument('--hours', type=options.hours, default=1.0, metavar='H',
                        help='normal operation that is watched, for each robot of a family '
                        '(default: 1)')
    parser.add_argument('--faults', type=cli.count, default=4, metavar='N',
                        help='faults of every kind, for each of them (default: 4)')
    parser.add_argument('--data', type=Path, metavar='DIR', help='the folder of the recordings of '
                        'real robots (default: without them)')
    parser.add_argument('--channels', nargs='*', metavar='CHANNEL',
                        help='leave out these in turn, none if no name follows: '
                        f'{", ".join(Tuning.channels())} (default: all)')
    parser.add_argument('--numbers', nargs='*', metavar='NAME',
                        help='change these in turn, none if no name follows; `info --tuning` '
                        'lists them (default: all)')
    parser.add_argument('--kinds', nargs='+', choices=KINDS, default=KINDS, metavar='KIND',
                        help=f'variants of these only: {", ".join(KINDS)}, where a rule is '
                        'switched off by a number (default: all)')
    options.add_jobs(parser, 'variants at a time')


def _work(arguments: argparse.Namespace, command: str) -> None:
    chosen = variants(arguments.channels, arguments.numbers, arguments.kinds)
    check_hours(arguments.families, arguments.hours)
    if arguments.data is not None:
        outages.check_data(arguments.data)
    plan = Plan(
        tuple(arguments.families), _seeds(arguments.seed, arguments.seeds),
        _seeds(arguments.seed, arguments.own_seeds),
        tuple(Learning.of(starts, arguments.training, arguments.calibration)
              for starts in arguments.starts),
        arguments.hours, arguments.faults, arguments.data)
    full = arguments.output / report.FULL
    full.mkdir(parents=True, exist_ok=True)
    results = experiment.run(plan, chosen, full / f'{report.NAME}.csv', arguments.jobs)
    for path in report.write(arguments.output, plan, results, command):
        print(f'written: {path}')


def _seeds(first: int, number: int) -> Tuple[int, ...]:
    return tuple(range(first, first + number))
