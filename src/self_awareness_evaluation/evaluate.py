"""`rosrun self_awareness evaluate`: measures detectors on faults that are known, side by side."""
from __future__ import annotations

import argparse
import shlex
import sys
from pathlib import Path
from typing import Optional, Sequence

from self_awareness.calibration.limits import BUDGET
from self_awareness.commands import cli
from self_awareness_evaluation import catalogue, options, pages, readme_numbers, tunings
from self_awareness_evaluation.ablation import command as ablation
from self_awareness_evaluation.compare import report as compare
from self_awareness_evaluation.families import experiment as families, report as families_report
from self_awareness_evaluation.families.kinds import FAMILIES
from self_awareness_evaluation.families.protocol import KINDS, Learning
from self_awareness_evaluation.fleet import command as fleet
from self_awareness_evaluation.live import command as live
from self_awareness_evaluation.modes import command as modes
from self_awareness_evaluation.page_section import write_section
from self_awareness_evaluation.recordings import outages, report as recordings_report
from self_awareness_evaluation.simulated import attributes_command, experiment, report
from self_awareness_evaluation.simulated.experiment import Plan
from self_awareness_evaluation.simulated.records import default_faults
from self_awareness_follow_me.faults import effect_of
from self_awareness_follow_me.scenario import load_scenario

_SHORT = Learning(2, 30.0, 1, 60.0)
_FAULTS = tuple(kind.split()[0] for kind in KINDS)

_EPILOG = """\
scikit-learn and hmmlearn, which three of the peers need, are no part of the package:
  scripts/evaluation_env.sh rosrun self_awareness evaluate simulated
installs them where they are missing, and runs this.
"""


def main(argv: Optional[Sequence[str]] = None) -> int:
    """Run the program; return its exit code (see cli.run)."""
    given = sys.argv[1:] if argv is None else argv
    command = f'rosrun self_awareness evaluate {shlex.join(given)}'
    return cli.run(parser(), lambda arguments: arguments.work(arguments, command), argv)


def _simulated(arguments: argparse.Namespace, command: str) -> None:
    systems = tuple(name for name in arguments.systems if name not in arguments.without_systems)
    if not systems:
        raise ValueError('--without-systems: no system is left to evaluate')
    catalogue.check_libraries(systems)
    tuning = tunings.of(arguments)
    tunings.check_used(tuning, systems)
    scenario = load_scenario()
    faults = tuple(arguments.faults or default_faults(scenario))
    for kind in faults:
        effect_of(scenario, kind)
    plan = Plan(systems, faults,
                tuple(range(arguments.seed, arguments.seed + arguments.seeds)),
                arguments.calibration, arguments.training_share, tuning)
    arguments.output.mkdir(parents=True, exist_ok=True)
    results = experiment.run(plan, scenario, arguments.jobs)
    for path in report.write(arguments.output, plan, results, command):
        print(f'written: {path}')


def _recordings(arguments: argparse.Namespace, command: str) -> None:
    rows = outages.evaluate(arguments.data, tunings.of(arguments))
    arguments.output.mkdir(parents=True, exist_ok=True)
    for path in recordings_report.write(arguments.output, rows, command):
        print(f'written: {path}')


def _families(arguments: argparse.Namespace, command: str) -> None:
    learnings = [Learning.of(starts, arguments.training, arguments.calibration)
                 for starts in arguments.starts]
    if arguments.short:
        learnings.append(_SHORT)
    plan = families.Plan(
        tuple(arguments.families), tuple(range(arguments.seed, arguments.seed + arguments.robots)),
        tuple(learnings), tuple(arguments.systems), tuple(arguments.budgets), arguments.hours,
        tuple(kind for kind in KINDS if kind.split()[0] in arguments.faults),
        tunings.of(arguments))
    catalogue.check_libraries(plan.systems)
    tunings.check_used(plan.tuning, plan.systems)
    arguments.output.mkdir(parents=True, exist_ok=True)
    results = families.run(plan, arguments.jobs)
    for path in families_report.write(arguments.output, plan, results, command):
        print(f'written: {path}')


def _pages(arguments: argparse.Namespace, command: str) -> None:
    del command
    print('\n'.join(pages.check(arguments.docs)))


def _numbers(arguments: argparse.Namespace, command: str) -> None:
    del command
    write_section(arguments.readme, readme_numbers.SECTION, readme_numbers.section(arguments.docs))
    print(f'written: {arguments.readme}')


def parser() -> argparse.ArgumentParser:
    """Return what parses the arguments."""
    parser = argparse.ArgumentParser(
        prog='evaluate', description=__doc__.split(': ', 1)[1], epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter)
    parts = parser.add_subparsers(metavar='PART', required=True)
    _add_simulated(parts.add_parser(
        'simulated', help='the simulated follow-me robot, in simulated time',
        description='Every system learns from the same records of the simulated robot, and judges '
        'the same normal operation and the same faults, once for every seed.'))
    attributes_command.add(parts.add_parser(
        'attributes', help='the same robot: faults that neither silence nor timing tells',
        description='Old stamps, lost, empty and repeated messages, and a missing subscription, '
        'beside monitors of stamps and sizes, as in simulated.'))
    _add_families(parts.add_parser(
        'families', help='simulated robots as different as possible, drawn by seed',
        description='Every system learns from few starts of each robot and from many, watches '
        'hours of normal operation in others, and judges every component\'s faults.'))
    _add_recordings(parts.add_parser(
        'recordings', help='recordings of real robots that others made',
        description='The outages in recordings of real robots, and false alarms on them.'))
    ablation.add(parts.add_parser(
        'ablation', help='what each part of the evidence detector buys',
        description='Leaves out channel after channel, switches off rule after rule, halves and '
        'doubles number after number, and judges the same robots and recordings each time. What '
        'is done is kept: the same command goes on where it was interrupted.'))
    fleet.add(parts.add_parser(
        'fleet', help='robots of one make: learned on some, watching another',
        description='Two models of a robot that is watched for hours and whose components crash '
        'in turn: one is learned on other robots of its make, one on as many recordings of its '
        'own.'))
    modes.add(parts.add_parser(
        'modes', help='robots that do something only at times: one model for all, or one a mode',
        description='All that a robot needs in a mode dies in it. A model that was learned in all '
        'modes judges that, beside one that was learned in this mode alone.'))
    compare.add(parts.add_parser(
        'compare', help='two versions side by side, by what the same commands measured',
        description='Writes a page about two folders that families, simulated or recordings wrote '
        'to with -o, in two versions of this package.'))
    live.add(parts)
    _add_pages(parts.add_parser(
        'pages', help='which pages were measured with an older method',
        description='Lists the pages that a measurement wrote, with the version of the method, '
        'and the command that measures those of an older method again.'))
    _add_numbers(parts.add_parser(
        'numbers', help='copy the numbers of the README out of these pages',
        description='Writes the measured numbers of the README again. They are cells of the '
        'tables of the pages; src/self_awareness_evaluation/readme_numbers.py says which.'))
    return parser


def _add_pages(parser: argparse.ArgumentParser) -> None:
    parser.set_defaults(work=_pages)
    parser.add_argument('--docs', type=Path, default=Path('docs'), metavar='DIR',
                        help='folder of the pages (default: docs)')


def _add_numbers(parser: argparse.ArgumentParser) -> None:
    _add_pages(parser)
    parser.set_defaults(work=_numbers)
    parser.add_argument('--readme', type=Path, default=Path('README.md'), metavar='FILE',
                        help='the README (default: README.md)')


def _add_recordings(parser: argparse.ArgumentParser) -> None:
    parser.set_defaults(work=_recordings)
    options.add_output(parser, 'the page and the CSV file')
    parser.add_argument('--data', type=Path, required=True, metavar='DIR',
                        help='the folder of the recordings')
    tunings.add(parser)


def _add_simulated(parser: argparse.ArgumentParser) -> None:
    parser.set_defaults(work=_simulated)
    options.add_output(
        parser, f'the page, the plots and, in the folder {report.FULL}, all numbers')
    parser.add_argument('--seeds', type=cli.count, default=20, metavar='N',
                        help='number of repetitions, each with the next seed (default: 20)')
    parser.add_argument('--seed', type=int, default=1, help='the first seed (default: 1)')
    parser.add_argument('--calibration', type=options.calibration_s, default=600.0,
                        metavar='S', help='length of the record that the threshold is chosen by '
                        '[s]; the paper has 100 (default: 600)')
    parser.add_argument('--training-share', type=options.share, default=0.1, metavar='SHARE',
                        help='learn once from all of the training records, and once from this '
                        'first share of them; 0: only from all (default: 0.1)')
    parser.add_argument('--systems', nargs='+', choices=catalogue.NAMES, default=catalogue.NAMES,
                        metavar='SYSTEM', help='evaluate these only: '
                        f'{", ".join(catalogue.NAMES)} (default: all)')
    parser.add_argument('--without-systems', nargs='+', choices=catalogue.NAMES, default=[],
                        metavar='SYSTEM', help='leave these out')
    tunings.add(parser)
    parser.add_argument('--faults', nargs='+', metavar='FAULT',
                        help='kinds of faults (default: all, and every regular component crashed '
                        'in turn)')
    options.add_jobs(parser, 'seeds at a time')


def _add_families(parser: argparse.ArgumentParser) -> None:
    parser.set_defaults(work=_families)
    options.add_output(
        parser, f'the page, its figures and, in the folder {report.FULL}, all numbers')
    options.add_robots(parser, list(FAMILIES))
    parser.add_argument('--starts', type=options.starts, nargs='+', default=[1, 2, 4, 8],
                        metavar='N', help='starts to train on, in turn; half as many, but one at '
                        'least, are calibrated on (default: 1 2 4 8)')
    parser.add_argument('--training', type=options.calibration_s, default=150.0, metavar='S',
                        help='length of a recording to train on [s] (default: 150)')
    parser.add_argument('--calibration', type=options.calibration_s, default=150.0,
                        metavar='S', help='length of one to calibrate on [s] (default: 150)')
    parser.add_argument('--short', action='store_true', help=f'learn from {_SHORT} as well')
    parser.add_argument('--hours', type=options.hours, default=2.0, metavar='H',
                        help='normal operation that is watched, for each robot (default: 2)')
    parser.add_argument('--budgets', type=options.budget, nargs='+', default=[BUDGET],
                        metavar='B', help='false alarms an hour that limits are made for, in '
                        f'turn; faults are judged with the first (default: {BUDGET:g})')
    parser.add_argument('--systems', nargs='+', choices=catalogue.NAMES,
                        default=families.SYSTEMS, metavar='SYSTEM',
                        help=f'evaluate these: {", ".join(catalogue.NAMES)} '
                        f'(default: {" ".join(families.SYSTEMS)})')
    tunings.add(parser)
    parser.add_argument('--faults', nargs='*', choices=_FAULTS, default=_FAULTS, metavar='FAULT',
                        help=f'kinds of faults: {", ".join(_FAULTS)}; none at all if no name '
                        'follows (default: all)')
    options.add_jobs(parser, 'robots at a time')
