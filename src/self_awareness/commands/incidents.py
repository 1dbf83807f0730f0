"""`rosrun self_awareness incidents`: shows the last incidents of the monitors of this machine."""
from __future__ import annotations

import argparse
import glob
import os
from typing import List, Sequence

from self_awareness import KeptIncident, read_incidents
from self_awareness.commands import cli
from self_awareness.recovery import history
from self_awareness.recovery.history import Action
from self_awareness.reporting import incidents_text

_EPILOG = """\
A monitor keeps its last 100 incidents in NAME.incidents beside the flight recorder's files, also
while it does not run. Near misses are suspicions that became no alarm.
"""


def _incidents(arguments: argparse.Namespace) -> None:
    found = [(path, [each for each in _read(path) if arguments.id in (None, each.id)],
              _actions(path)) for path in arguments.file or _files()]
    if arguments.id is not None and not any(kept for _, kept, _ in found):
        raise ValueError(f'no incident {arguments.id} in '
                         f'{", ".join(path for path, _, _ in found)}')
    if arguments.json:
        cli.print_values([{'file': path, **incidents_text.as_values(each, actions)}
                          for path, kept, actions in found for each in kept])
        return
    for path, kept, actions in found:
        if arguments.id is None:
            _print_list(path, kept, actions, arguments.near_misses)
        else:
            for each in kept:
                cli.print_lines(incidents_text.details(each, actions))


def _print_list(path: str, kept: List[KeptIncident], actions: Sequence[Action],
                near_misses: bool) -> None:
    shown = [each for each in kept if near_misses or each.level == 'ERROR']
    is_open = sum(not each.over for each in shown)
    print(f'{path}: incidents: {len(shown)}, open: {is_open}')
    if shown:
        cli.print_lines(f'  {line}' for line in incidents_text.table(shown, actions))
    if len(shown) < len(kept):
        print(f'  besides, components with near misses only: {len(kept) - len(shown)} '
              '(--near-misses)')


def _files() -> List[str]:
    """Return the files of all monitors, where they are by default.

    Raises:
        ValueError: there is none.
    """
    home = os.environ.get('ROS_HOME') or os.path.expanduser('~/.ros')
    pattern = os.path.join(glob.escape(home), 'self_awareness', '*', '*.incidents')
    found = sorted(glob.glob(pattern))
    if not found:
        raise ValueError(f'no monitor of this machine has had an incident ({pattern}); if '
                         '~recorder/directory is set, name its file by --file')
    return found


def _read(path: str) -> List[KeptIncident]:
    kept = read_incidents(path)
    if kept is None:
        raise ValueError(f'{path}: there is no such file; a monitor writes it with its first '
                         'incident')
    return kept


def _actions(incidents: str) -> Sequence[Action]:
    """Return what a recovery has done about the incidents of a file."""
    path = os.path.splitext(incidents)[0] + history.ENDING
    try:
        return history.load(path).actions
    except (OSError, ValueError) as error:
        cli.warn('incidents', f'what the recovery has done is not shown: {error}')
        return ()


def _arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('id', type=int, nargs='?', metavar='ID',
                        help='show all of this one, and how to make its report')
    parser.add_argument('--file', action='append', metavar='FILE',
                        help='read this file of a monitor; may be given several times (default: '
                             'those of all monitors, in ROS_HOME)')
    parser.add_argument('--near-misses', action='store_true',
                        help='list also components with near misses only')
    parser.add_argument('--json', action='store_true',
                        help='print all of them as JSON, with near misses')


main = cli.Program('incidents', __doc__, _EPILOG, _arguments, _incidents)
