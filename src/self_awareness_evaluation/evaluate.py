"""`rosrun self_awareness evaluate`: measures detectors on faults that are known, side by side."""
from __future__ import annotations

import argparse
import contextlib
import shlex
import signal
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Iterator, Optional, Sequence

from self_awareness.commands import cli
from self_awareness_evaluation import compare, offline, options, pages, readme_numbers
from self_awareness_evaluation.page_section import write_section
from self_awareness_evaluation.recovery import arguments as recovery_arguments

if TYPE_CHECKING:
    from self_awareness_evaluation.nodes import session as nodes_session


def main(argv: Optional[Sequence[str]] = None) -> int:
    """Run the program; return its exit code (see cli.run)."""
    given = sys.argv[1:] if argv is None else argv
    command = f'rosrun self_awareness evaluate {shlex.join(given)}'
    return cli.run(parser(), lambda arguments: arguments.work(arguments, command), argv)


def _live(arguments: argparse.Namespace, command: str) -> None:
    # ROS is imported only here and in _nodes: the other parts do not need it.
    from self_awareness_evaluation.live import evaluation, session
    _clean_up_when_terminated()
    plan = session.SessionPlan(arguments.rounds, arguments.training, arguments.calibration,
                               arguments.normal)
    arguments.output.mkdir(parents=True, exist_ok=True)
    with _folder(arguments.recordings) as folder:
        paths = evaluation.evaluate(plan, folder, arguments.output, command)
    for path in paths:
        print(f'written: {path}')


def _nodes(arguments: argparse.Namespace, command: str) -> None:
    from self_awareness_evaluation.nodes import evaluation
    _clean_up_when_terminated()
    arguments.output.mkdir(parents=True, exist_ok=True)
    with _folder(arguments.recordings) as folder:
        paths = evaluation.evaluate(nodes_plan(arguments), folder, arguments.output, command)
    for path in paths:
        print(f'written: {path}')


def _soak(arguments: argparse.Namespace, command: str) -> None:
    from self_awareness_evaluation.soak import evaluation
    from self_awareness_evaluation.soak.session import SoakPlan
    _clean_up_when_terminated()
    plan = SoakPlan(arguments.minutes, arguments.seed, arguments.speed, arguments.starts,
                    arguments.training, arguments.calibrations, arguments.calibration,
                    arguments.budget)
    with _folder(arguments.recordings) as folder:
        paths = evaluation.evaluate(plan, folder, arguments.output, command)
    for path in paths:
        print(f'written: {path}')


def _recovery(arguments: argparse.Namespace, command: str) -> None:
    from self_awareness_evaluation.recovery import report as recovery_report
    from self_awareness_evaluation.recovery import session
    _clean_up_when_terminated()
    plan = session.RecoveryPlan(arguments.times, arguments.minutes, arguments.seed,
                                arguments.speed, arguments.training)
    with _folder(arguments.recordings) as folder:
        recovered = session.run(plan, folder)
    print(f'written: {recovery_report.write(arguments.output, plan, recovered, command)}')
    failures = recovery_report.failures(recovered)
    if failures:
        raise ValueError('; '.join(failures))


def _compare(arguments: argparse.Namespace, command: str) -> None:
    arguments.output.mkdir(parents=True, exist_ok=True)
    written = compare.write(arguments.output, arguments.before, arguments.after, command)
    print(f'written: {written}')


def _pages(arguments: argparse.Namespace, command: str) -> None:
    del command
    print('\n'.join(pages.check(arguments.docs)))


def _numbers(arguments: argparse.Namespace, command: str) -> None:
    del command
    write_section(arguments.readme, readme_numbers.SECTION, readme_numbers.section(arguments.docs))
    print(f'written: {arguments.readme}')


def nodes_plan(arguments: argparse.Namespace) -> nodes_session.SessionPlan:
    """Return the plan that the arguments of `nodes` ask for."""
    from self_awareness_evaluation.nodes.session import SessionPlan
    return SessionPlan(arguments.starts, arguments.training, arguments.calibrations,
                       arguments.calibration, arguments.minutes, arguments.burst_minutes)


def _clean_up_when_terminated() -> None:
    """Let a termination clean up like Ctrl-C, which shells let be ignored in the background."""
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.default_int_handler)


@contextlib.contextmanager
def _folder(given: Optional[Path]) -> Iterator[Path]:
    """Return the folder for recordings and logs; a temporary one is removed at the end."""
    if given is None:
        with tempfile.TemporaryDirectory() as temporary:
            yield Path(temporary)
        return
    given.mkdir(parents=True, exist_ok=True)
    if any(given.glob('session*')):
        raise ValueError(f'--recordings {given}: holds a session already; name another folder')
    yield given.resolve()


def parser() -> argparse.ArgumentParser:
    """Return what parses the arguments."""
    parser = argparse.ArgumentParser(
        prog='evaluate', description=__doc__.split(': ', 1)[1])
    parts = parser.add_subparsers(metavar='PART', required=True)
    offline.add(parts)
    compared = parts.add_parser(
        'compare', help='two versions side by side, by what the same commands measured',
        description='Writes a page about two folders that families, simulated, ablation or '
        'recordings wrote to with -o, in two versions of this package.')
    compared.set_defaults(work=_compare)
    options.add_output(compared, 'the page')
    for name, told in (('before', 'of the one version'), ('after', 'of the other')):
        compared.add_argument(name, type=Path, metavar=name.upper(),
                              help=f'folder of the results {told}, or of folders with them')
    _add_live(parts.add_parser(
        'live', help='the follow-me robot as 15 processes, and the monitor',
        description='Starts master and robot, records, trains and calibrates, starts the monitor, '
        'and induces fault after fault in rounds; a round takes about 5 minutes. Other systems '
        'judge the recording of it afterwards.'))
    _add_nodes(parts.add_parser(
        'nodes', help='a system of nodes of Debian packages, and the monitor',
        description='Starts the nodes several times and records them, trains and calibrates, '
        'starts them once more, with the monitor, watches them undisturbed, and then breaks one '
        'after the other; with the default options, this takes an hour and a half. '
        'scripts/packaged_nodes_env.sh installs the nodes and runs this.'))
    _add_soak(parts.add_parser(
        'soak', help='the follow-me robot at 10 times its speed, and the monitor, for an hour',
        description='Records, trains and calibrates on several starts of the fast robot, starts '
        'the monitor, and lets faults drawn by the seed hit the robot. It fails if one is missed, '
        'if an alarm comes without one, or if the memory of the monitor grows. scripts/soak.sh '
        'runs this.'))
    recovery = parts.add_parser(
        'recovery', help='the same robot with a recovery: what hangs, and what is restarted',
        description='Lets the laser driver hang again and again, then faults at random hit the '
        'robot. It fails if the driver is not back in time, or if a healthy node is restarted. '
        'scripts/recovery.sh runs this.')
    recovery.set_defaults(work=_recovery)
    recovery_arguments.add(recovery)
    _add_folder(recovery)
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


def _add_live(parser: argparse.ArgumentParser) -> None:
    parser.set_defaults(work=_live)
    options.add_output(parser, 'the page, the CSV file and the plot')
    parser.add_argument('--rounds', type=cli.count, default=5, metavar='N',
                        help='how often each fault is induced (default: 5)')
    parser.add_argument('--training', type=options.calibration_s, nargs='+',
                        default=(60.0, 60.0, 60.0), metavar='S',
                        help='lengths of the recordings to learn from [s], each of another start '
                        'of the robot (default: 60 60 60)')
    parser.add_argument('--calibration', type=options.calibration_s, default=240.0,
                        metavar='S', help='length of the recording that the limits are found by '
                        '[s] (default: 240)')
    parser.add_argument('--normal', type=options.calibration_s, default=20.0, metavar='S',
                        help='normal operation in each round [s] (default: 20)')
    _add_folder(parser)


def _add_folder(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('--recordings', type=Path, metavar='DIR',
                        help='folder to keep recordings, model and logs in; recordings of normal '
                        'operation that it holds already are used again (default: all are removed '
                        'at the end)')


def _add_nodes(parser: argparse.ArgumentParser) -> None:
    parser.set_defaults(work=_nodes)
    options.add_output(parser, 'the page and the CSV file')
    parser.add_argument('--starts', type=cli.count, default=3, metavar='N',
                        help='starts of the nodes to learn from (default: 3)')
    parser.add_argument('--training', type=options.calibration_s, default=150.0, metavar='S',
                        help='length of the recording of each of them [s] (default: 150)')
    parser.add_argument('--calibrations', type=cli.count, default=1, metavar='N',
                        help='further starts that the limits are found by (default: 1)')
    parser.add_argument('--calibration', type=options.calibration_s, default=250.0,
                        metavar='S', help='length of the recording of each of them [s] '
                        '(default: 250)')
    parser.add_argument('--minutes', type=options.minutes, default=60.0, metavar='MIN',
                        help='normal operation that is watched (default: 60)')
    parser.add_argument('--burst-minutes', type=options.minutes, default=20.0, metavar='MIN',
                        help='the same after that, beside short bursts of foreign load '
                        '(default: 20)')
    _add_folder(parser)


def _add_soak(parser: argparse.ArgumentParser) -> None:
    parser.set_defaults(work=_soak)
    parser.add_argument('-o', '--output', type=Path, default=Path('docs'), metavar='DIR',
                        help='folder of reliability.md, whose section is written (default: docs)')
    parser.add_argument('--minutes', type=options.minutes, default=60.0, metavar='MIN',
                        help='how long the monitor runs (default: 60)')
    parser.add_argument('--seed', type=cli.count, default=1, help='of the faults and the robot '
                        '(default: 1)')
    parser.add_argument('--speed', type=cli.above_zero('a factor of the speed'), default=10.0,
                        metavar='N', help='times the usual speed of the robot (default: 10)')
    parser.add_argument('--starts', type=cli.count, default=4, metavar='N',
                        help='starts of the robot to learn from (default: 4)')
    parser.add_argument('--training', type=options.calibration_s, default=90.0, metavar='S',
                        help='length of the recording of each of them [s] (default: 90)')
    parser.add_argument('--calibrations', type=cli.count, default=4, metavar='N',
                        help='further starts that the limits are found by (default: 4)')
    parser.add_argument('--calibration', type=options.calibration_s, default=120.0,
                        metavar='S', help='length of the recording of each of them [s] '
                        '(default: 120)')
    parser.add_argument('--budget', type=cli.budget, default=0.1, metavar='B',
                        help='false alarms an hour that the limits allow (default: 0.1)')
    _add_folder(parser)
