"""The commands `live`, `nodes`, `soak` and `recovery` of `evaluate`: a plan and a page each."""
from __future__ import annotations

import argparse
import contextlib
import signal
import tempfile
import time
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Callable, Iterator, List, Optional, Sequence

from self_awareness import progress
from self_awareness.commands import cli
from self_awareness_evaluation import options, row_files
from self_awareness_evaluation.live import tables
from self_awareness_evaluation.live.rows import Row
from self_awareness_evaluation.page_section import machine, write_section
from self_awareness_evaluation.pages import written_by
from self_awareness_evaluation.records import Learning

if TYPE_CHECKING:  # ROS is imported only where a session runs
    from self_awareness_evaluation.live.processes import Processes
    from self_awareness_evaluation.live.session import Plan


def add(parts: Any) -> None:
    """Add the four commands to the subparsers of `evaluate`."""
    live = parts.add_parser(
        'live', help='the follow-me robot as 15 processes, and the monitor',
        description='Starts master and robot, records, trains and calibrates, starts the monitor, '
        'and induces fault after fault in rounds; a round takes about 5 minutes. Other systems '
        'judge the recording of it afterwards.')
    live.set_defaults(work=_live)
    options.add_output(live, 'the page and the CSV file')
    live.add_argument('--rounds', type=cli.count, default=5, metavar='N',
                      help='how often each fault is induced (default: 5)')
    _add_learning(live, Learning(3, 60.0, 1, 240.0))

    nodes = parts.add_parser(
        'nodes', help='a system of nodes of Debian packages, and the monitor',
        description='Starts the nodes several times and records them, trains and calibrates, '
        'starts them once more, with the monitor, watches them undisturbed, and then breaks one '
        'after the other; with the default options, this takes an hour and a half. '
        'scripts/packaged_nodes_env.sh installs the nodes and runs this.')
    nodes.set_defaults(work=_nodes)
    options.add_output(nodes, 'the page and the CSV file')
    _add_minutes(nodes, 'normal operation that is watched')
    nodes.add_argument('--burst-minutes', type=options.minutes, default=20.0, metavar='MIN',
                       help='the same after that, beside short bursts of foreign load '
                       '(default: 20)')
    _add_learning(nodes, Learning(3, 150.0, 1, 250.0))

    soak = parts.add_parser(
        'soak', help='the follow-me robot at 10 times its speed, and the monitor, for an hour',
        description='Records, trains and calibrates on several starts of the fast robot, starts '
        'the monitor, and lets faults drawn by the seed hit the robot. It fails if one is missed, '
        'if an alarm comes without one, or if the memory of the monitor grows. scripts/soak.sh '
        'runs this.')
    soak.set_defaults(work=_soak)
    _add_at_random(soak, 'how long the monitor runs')
    _add_learning(soak, Learning(4, 90.0, 4, 120.0))

    recovery = parts.add_parser(
        'recovery', help='the same robot with a recovery: what hangs, and what is restarted',
        description='Lets the laser driver hang again and again, then faults at random hit the '
        'robot. It fails if the driver is not back in time, or if a healthy node is restarted. '
        'scripts/recovery.sh runs this.')
    recovery.set_defaults(work=_recovery)
    recovery.add_argument('--times', type=cli.count, default=20, metavar='N',
                          help='that the laser driver hangs (default: 20)')
    _add_at_random(recovery, 'of faults at random after that')
    _add_learning(recovery, Learning(2, 90.0, 1, 90.0))


def _add_at_random(parser: argparse.ArgumentParser, minutes: str) -> None:
    parser.add_argument('-o', '--output', type=Path, default=Path('docs'), metavar='DIR',
                        help='folder of reliability.md, whose section is written (default: docs)')
    _add_minutes(parser, minutes)
    parser.add_argument('--seed', type=cli.count, default=1,
                        help='of the faults and the robot (default: 1)')


def _add_minutes(parser: argparse.ArgumentParser, what: str) -> None:
    parser.add_argument('--minutes', type=options.minutes, default=60.0, metavar='MIN',
                        help=f'{what} (default: 60)')


def _add_learning(parser: argparse.ArgumentParser, default: Learning) -> None:
    """Add the options that say what is recorded to learn from, and where."""
    parser.add_argument('--starts', type=cli.count, default=default.starts, metavar='N',
                        help=f'starts of the robot to learn from (default: {default.starts})')
    parser.add_argument('--training', type=options.calibration_s, default=default.training_s,
                        metavar='S', help='length of the recording of each of them [s] '
                        f'(default: {default.training_s:g})')
    parser.add_argument('--calibrations', type=cli.count, default=default.calibrations,
                        metavar='N', help='further starts that the limits are found by '
                        f'(default: {default.calibrations})')
    parser.add_argument('--calibration', type=options.calibration_s,
                        default=default.calibration_s, metavar='S', help='length of the '
                        f'recording of each of them [s] (default: {default.calibration_s:g})')
    parser.add_argument('--recordings', type=Path, metavar='DIR',
                        help='folder to keep recordings, model and logs in; recordings of normal '
                        'operation that it holds already are used again (default: all are removed '
                        'at the end)')


def _live(arguments: argparse.Namespace, command: str) -> None:
    from self_awareness_evaluation.live import offline, plans
    rows = _session(arguments, 'live.csv', partial(plans.live, arguments.rounds),
                    offline.judge)
    write(arguments, 'live.md', 'live', command, rows, tables.of_live(rows))


def _nodes(arguments: argparse.Namespace, command: str) -> None:
    from self_awareness_evaluation.live import plans
    rows = _session(arguments, 'nodes.csv', partial(plans.nodes, arguments.minutes,
                                                    arguments.burst_minutes))
    write(arguments, 'nodes.md', 'nodes', command, rows, tables.of_nodes(rows))


def _soak(arguments: argparse.Namespace, command: str) -> None:
    from self_awareness_evaluation.live import plans, reliability
    rows = _session(arguments, 'reliability/soak.csv',
                    partial(plans.soak, arguments.minutes, arguments.seed))
    lines, wrong = reliability.of_soak(rows)
    write(arguments, 'reliability.md', 'soak', command, rows, lines, wrong)


def _recovery(arguments: argparse.Namespace, command: str) -> None:
    from self_awareness_evaluation.live import plans, reliability
    rows = _session(arguments, 'reliability/recovery.csv', partial(
        plans.with_recovery, arguments.times, arguments.minutes, arguments.seed))
    lines, wrong = reliability.of_recovery(rows)
    write(arguments, 'reliability.md', 'recovery', command, rows, lines, wrong)


def _session(arguments: argparse.Namespace, csv: str,
             plan: 'Callable[[Learning, Path, Processes], Plan]',
             afterwards: Callable[[List[Row], Path], List[Row]] = lambda *_: []) -> List[Row]:
    """Run a session; return its rows, which are saved after each of them."""
    from self_awareness_evaluation.live import session
    from self_awareness_evaluation.live.master import own_master
    path = arguments.output / csv
    rows: List[Row] = []

    def told(row: Row) -> None:
        rows.append(row)
        row_files.save(path, rows, Row)
        progress.say(f'  {row.brief}')

    for number in (signal.SIGINT, signal.SIGTERM):
        # A termination cleans up like Ctrl-C, which shells let be ignored in the background.
        signal.signal(number, signal.default_int_handler)
    path.parent.mkdir(parents=True, exist_ok=True)
    with _folder(arguments.recordings) as folder:
        with own_master(folder) as processes:
            stretches = session.run(plan(_learning(arguments), folder, processes), folder,
                                    processes, told)
        rows += afterwards(stretches, folder)
    row_files.save(path, rows, Row)
    print(f'written: {path}')
    return rows


def write(arguments: argparse.Namespace, page: str, section: str, command: str,
          rows: Sequence[Row], lines: Sequence[str], wrong: Sequence[str] = ()) -> None:
    """Write the section of a page, which is made if it is not there.

    Args:
        arguments: of the command.
        page, section: their names.
        command: that the section says it was written by.
        rows: of the session.
        lines: of the section.
        wrong: what was not as it should be.

    Raises:
        ValueError: not all was as it should be; the message says what was wrong.
    """
    path = arguments.output / page
    if not path.exists():
        path.write_text(f'<!-- {section} -->\n<!-- /{section} -->\n', encoding='utf-8')
    write_section(path, section, '\n'.join([
        _header(command, _learning(arguments), rows), '', *lines,
        *(['', *(f'- {each}' for each in wrong)] if wrong else [])]))
    print(f'written: {path}')
    if wrong:
        raise ValueError('; '.join(wrong))


def _header(command: str, learning: Learning, rows: Sequence[Row]) -> str:
    """Return the first line of a section."""
    loads = [row.load for row in rows if row.load]
    return (f'{written_by(command, time.strftime("%Y-%m-%d", time.gmtime()))} Learned from '
            f'{learning.starts} x {learning.training_s:g} s, limits by {learning.calibrations} x '
            f'{learning.calibration_s:g} s, each of another start. {machine()["cores"]} cores '
            f'({machine()["machine"]}), load average {min(loads, default=0.0):.1f} to '
            f'{max(loads, default=0.0):.1f}, that of the robot included.')


def _learning(arguments: argparse.Namespace) -> Learning:
    return Learning(arguments.starts, arguments.training, arguments.calibrations,
                    arguments.calibration)


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
