"""`rosrun self_awareness evaluate`: measures detectors on faults that are known, side by side."""
from __future__ import annotations

import argparse
import os
import shlex
import sys
from pathlib import Path
from typing import Optional, Sequence

from self_awareness import follow_me
from self_awareness.commands import cli
from self_awareness.evaluation import (catalogue, experiment, real_recordings,
                                       real_recordings_report, report, simulated_records)
from self_awareness.evaluation.experiment import Plan
from self_awareness.follow_me_faults import effect_of

_EPILOG = """\
scikit-learn and hmmlearn, which three of the peers need, are no part of the package:
  scripts/evaluation_env.sh rosrun self_awareness evaluate simulated
installs them where they are missing, and runs this.
"""


def main(argv: Optional[Sequence[str]] = None) -> int:
    """Run the program; return its exit code (see cli.run)."""
    given = sys.argv[1:] if argv is None else argv
    command = f'rosrun self_awareness evaluate {shlex.join(given)}'
    return cli.run(_parser(), lambda arguments: arguments.work(arguments, command), argv)


def _simulated(arguments: argparse.Namespace, command: str) -> None:
    systems = tuple(name for name in arguments.systems if name not in arguments.without)
    if not systems:
        raise ValueError('--without: no system is left to evaluate')
    catalogue.check_libraries(systems)
    scenario = follow_me.load()
    faults = tuple(arguments.faults or simulated_records.default_faults(scenario))
    for kind in faults:
        effect_of(scenario, kind)
    plan = Plan(systems, faults,
                tuple(range(arguments.seed, arguments.seed + arguments.seeds)),
                arguments.calibration, arguments.training_share)
    arguments.output.mkdir(parents=True, exist_ok=True)
    results = experiment.run(plan, scenario, arguments.jobs)
    for path in report.write(arguments.output, plan, results, command):
        print(f'written: {path}')


def _recordings(arguments: argparse.Namespace, command: str) -> None:
    rows = real_recordings.evaluate(arguments.data)
    arguments.output.mkdir(parents=True, exist_ok=True)
    for path in real_recordings_report.write(arguments.output, rows, command):
        print(f'written: {path}')


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog='evaluate', description=__doc__.split(': ', 1)[1], epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter)
    parts = parser.add_subparsers(metavar='PART', required=True)
    _add_simulated(parts.add_parser(
        'simulated', help='the simulated follow-me robot, in simulated time',
        description='Every system learns from the same records of the simulated robot, and judges '
        'the same normal operation and the same faults, once for every seed.'))
    _add_recordings(parts.add_parser(
        'recordings', help='recordings of real robots that others made',
        description='The outages in recordings of real robots, and false alarms on them.'))
    return parser


def _add_output(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('-o', '--output', type=Path, default=Path('docs/evaluation'),
                        metavar='DIR', help='where the page, the CSV file and the plots go '
                        '(default: docs/evaluation)')


def _add_recordings(parser: argparse.ArgumentParser) -> None:
    parser.set_defaults(work=_recordings)
    _add_output(parser)
    parser.add_argument('--data', type=Path, required=True, metavar='DIR',
                        help='the folder of the recordings')


def _add_simulated(parser: argparse.ArgumentParser) -> None:
    parser.set_defaults(work=_simulated)
    _add_output(parser)
    parser.add_argument('--seeds', type=cli.checked(_positive), default=20, metavar='N',
                        help='number of repetitions, each with the next seed (default: 20)')
    parser.add_argument('--seed', type=int, default=1, help='the first seed (default: 1)')
    parser.add_argument('--calibration', type=cli.checked(_calibration_s), default=600.0,
                        metavar='S', help='length of the record that the threshold is chosen by '
                        '[s]; the paper has 100 (default: 600)')
    parser.add_argument('--training-share', type=cli.checked(_share), default=0.1, metavar='SHARE',
                        help='besides all of the training records, learn from their first share, '
                        'too; 0: do not (default: 0.1)')
    parser.add_argument('--systems', nargs='+', choices=catalogue.NAMES, default=catalogue.NAMES,
                        metavar='SYSTEM', help='evaluate these only: '
                        f'{", ".join(catalogue.NAMES)} (default: all)')
    parser.add_argument('--without', nargs='+', choices=catalogue.NAMES, default=[],
                        metavar='SYSTEM', help='leave these out')
    parser.add_argument('--faults', nargs='+', metavar='FAULT',
                        help='kinds of faults (default: all, and every regular component crashed '
                        'in turn)')
    parser.add_argument('--jobs', type=cli.checked(_positive), default=os.cpu_count(), metavar='N',
                        help='seeds at a time (default: as many as there are cores)')


def _positive(text: str) -> int:
    if not text.isdecimal() or int(text) < 1:
        raise ValueError(f'expected a number from 1 on, not {text!r}')
    return int(text)


def _calibration_s(text: str) -> float:
    value = float(text)
    if not 10.0 <= value <= 86400.0:
        raise ValueError(f'expected seconds from 10 to 86400, not {text}')
    return value


def _share(text: str) -> float:
    value = float(text)
    if not 0.0 <= value < 1.0:
        raise ValueError(f'expected a share from 0 to less than 1, not {text}')
    return value
