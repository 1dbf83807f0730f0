"""The commands `live`, `nodes`, `soak` and `recovery` of `evaluate`: a plan and a page each."""
from __future__ import annotations

import argparse
import contextlib
import signal
import tempfile
import time
from pathlib import Path
from typing import Any, Iterator, List, Optional, Sequence

from self_awareness import progress
from self_awareness.commands import cli
from self_awareness_evaluation import options
from self_awareness_evaluation.live.rows import Row, of_faults, of_recovery, of_soak
from self_awareness_evaluation.pages import RESULTS, machine, write_section, written_by
from self_awareness_evaluation.records import Learning
from self_awareness_evaluation.rows import save

RELIABILITY = 'reliability/README.md'  # the page of soak and recovery, in the folder of the pages


def add(parts: Any) -> None:
    minutes = options.within(1.2, 60_000.0, 'minutes')
    live = parts.add_parser(
        'live', help='the follow-me robot as 15 processes, and the monitor',
        description='Starts master and robot, records, trains and calibrates, starts the monitor, '
        'and induces fault after fault in rounds; a round takes about 5 minutes.')
    options.add(live, '--rounds', cli.count, 5, 'N', 'how often each fault is induced')
    _add_session(live, 'live', Learning(3, 60.0, 1, 240.0))

    nodes = parts.add_parser(
        'nodes', help='a system of nodes of Debian packages, and the monitor',
        description='Starts the nodes several times and records them, trains and calibrates, '
        'starts them once more, with the monitor, watches them undisturbed, and then breaks one '
        'after the other; with the default options, this takes an hour and a half. '
        'scripts/packaged_nodes_env.sh installs the nodes and runs this.')
    options.add(nodes, '--minutes', minutes, 60.0, 'MIN', 'normal operation that is watched')
    options.add(nodes, '--burst-minutes', minutes, 20.0, 'MIN',
                'the same after that, beside short bursts of foreign load')
    _add_session(nodes, 'nodes', Learning(3, 150.0, 1, 250.0))

    soak = parts.add_parser(
        'soak', help='the follow-me robot at 10 times its speed, and the monitor, for an hour',
        description='Records, trains and calibrates on several starts of the fast robot, starts '
        'the monitor, and lets faults drawn by the seed hit the robot. It fails if one is missed, '
        'if an alarm comes without one, or if the memory of the monitor grows. scripts/soak.sh '
        'runs this.')
    options.add(soak, '--minutes', minutes, 60.0, 'MIN', 'how long the monitor runs')
    options.add(soak, '--seed', cli.count, 1, 'N', 'of the faults and the robot')
    _add_session(soak, 'soak', Learning(4, 90.0, 4, 120.0), 'docs', RELIABILITY)

    recovery = parts.add_parser(
        'recovery', help='the same robot with a recovery: what hangs, and what is restarted',
        description='Lets the laser driver hang again and again, then faults at random hit the '
        'robot. It fails if the driver is not back in time, or if a healthy node is restarted. '
        'scripts/recovery.sh runs this.')
    options.add(recovery, '--times', cli.count, 20, 'N', 'that the laser driver hangs')
    options.add(recovery, '--minutes', minutes, 60.0, 'MIN', 'of faults at random after that')
    options.add(recovery, '--seed', cli.count, 1, 'N', 'of the faults and the robot')
    _add_session(recovery, 'recovery', Learning(2, 90.0, 1, 90.0), 'docs', RELIABILITY)


def _add_session(parser: argparse.ArgumentParser, name: str, learning: Learning,
                 folder: str = 'docs/evaluation', page: str = RESULTS) -> None:
    """Add where all goes: the page lies in the folder; learning: what is learned from."""
    parser.set_defaults(work=_run, name=name, page=page, learning=learning)
    options.add_output(parser, f'the section {name} of {page} and the CSV file', folder)
    parser.add_argument('--recordings', type=Path, metavar='DIR',
                        help='folder to keep recordings, model and logs in; recordings of normal '
                        'operation that it holds already are used again (default: all are removed '
                        'at the end)')


def _run(arguments: argparse.Namespace, command: str) -> None:
    """Run a session, whose rows are saved after each of them, and write its section."""
    # ROS is imported only where a session runs.
    from self_awareness_evaluation.live import plans, session
    from self_awareness_evaluation.live.processes import own_master
    planned, told = {'live': (plans.live, of_faults),
                     'nodes': (plans.nodes, of_faults),
                     'soak': (plans.soak, of_soak),
                     'recovery': (plans.with_recovery, of_recovery)}[arguments.name]
    path = (arguments.output / arguments.page).with_name(f'{arguments.name}.csv')
    rows: List[Row] = []

    def keep(row: Row) -> None:
        rows.append(row)
        save(path, rows, Row)
        progress.say('  ' + ' '.join(filter(None, (
            row.fault, row.node, row.void, row.said, row.note))))

    for number in (signal.SIGINT, signal.SIGTERM):
        # A termination cleans up like Ctrl-C, which shells let be ignored in the background.
        signal.signal(number, signal.default_int_handler)
    path.parent.mkdir(parents=True, exist_ok=True)
    with _folder(arguments.recordings) as folder, own_master(folder, 'evaluate') as processes:
        session.run(planned(arguments, arguments.learning, folder, processes), folder,
                    processes, keep)
    print(f'written: {path}')
    write(arguments, command, rows, *told(rows))


def write(arguments: argparse.Namespace, command: str, rows: Sequence[Row], lines: Sequence[str],
          wrong: Sequence[str]) -> None:
    """Write the section of a page, which is made if it is not there; raise ValueError with what
    was not as it should be, if anything was."""
    path = arguments.output / arguments.page
    loads = [row.load for row in rows if row.load]
    learning = arguments.learning
    write_section(path, arguments.name, '\n'.join([
        f'{written_by(command, time.strftime("%Y-%m-%d", time.gmtime()))} Learned from '
        f'{learning.starts} x {learning.training_s:g} s, limits by {learning.calibrations} x '
        f'{learning.calibration_s:g} s, each of another start. {machine()["cores"]} cores '
        f'({machine()["machine"]}), load average {min(loads, default=0.0):.1f} to '
        f'{max(loads, default=0.0):.1f}, that of the robot included.', '', *lines,
        *(['', *(f'- {each}' for each in wrong)] if wrong else [])]), arguments.name)
    print(f'written: {path}')
    if wrong:
        raise ValueError('; '.join(wrong))


@contextlib.contextmanager
def _folder(given: Optional[Path]) -> Iterator[Path]:
    """Return the folder for recordings and logs; a temporary one is removed at the end."""
    if given is None:
        with tempfile.TemporaryDirectory() as temporary:
            yield Path(temporary)
    else:
        given.mkdir(parents=True, exist_ok=True)
        yield given.resolve()
