"""`evaluate compare`: writes a page that sets two folders of results side by side."""
from __future__ import annotations

import argparse
from pathlib import Path
from typing import List

from self_awareness.output_files import replacing
from self_awareness_evaluation import options
from self_awareness_evaluation.compare import results, tables
from self_awareness_evaluation.compare.results import Measured
from self_awareness_evaluation.pages import written_by

NAME = 'before_after'

_INTRODUCTION = """\
# Before and after

{written}

What two versions of the detector say of the same records: same commands, same seeds. A cell with
one value is the same in both; else it is before → **after**. Counts are of records; the time is
the median latency of all of them, and is left out where fewer than half were found.
"""


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of `evaluate compare`."""
    parser.set_defaults(work=_compare)
    options.add_output(parser, 'the page')
    for name, told in (('before', 'of the one version'), ('after', 'of the other')):
        parser.add_argument(name, type=Path, metavar=name.upper(),
                            help=f'folder of the results {told}, or of folders with them')


def _compare(arguments: argparse.Namespace, command: str) -> None:
    text = page(arguments.before, arguments.after, command)
    arguments.output.mkdir(parents=True, exist_ok=True)
    path = arguments.output / f'{NAME}.md'
    with replacing(str(path)) as temporary:
        Path(temporary).write_text(text, encoding='utf-8')
    print(f'written: {path}')


def page(before: Path, after: Path, command: str) -> str:
    """Return the page.

    Raises:
        ValueError: a folder holds no results, or the two were measured by other commands.
        OSError: a folder or a file cannot be read.
    """
    lines = [_INTRODUCTION.format(written=written_by(command))]
    names = results.folders(before)
    missing = sorted(set(names) ^ set(results.folders(after)))
    if missing:
        raise ValueError(f'{missing[0]}: only one of {before} and {after} has results there; '
                         'run the same commands for both')
    for name in names:
        one, other = results.read(before / name), results.read(after / name)
        if one.commands != other.commands:
            differing = next(pair for pair in zip([*one.commands, ''], [*other.commands, ''])
                             if pair[0] != pair[1])
            raise ValueError(f'{before / name} was written by "{differing[0]}", and '
                             f'{after / name} by "{differing[1]}"; run the same commands')
        lines += _section(one, other)
    return '\n'.join(lines)


def _section(before: Measured, after: Measured) -> List[str]:
    lines = ['## Of the commands', '', *(f'    {command}' for command in before.commands), '',
             'Rows that are the same to the last digit:', '', *tables.same_rows(before, after),
             '']
    for title, rows, part in (('Families of robots', before.normal, tables.families),
                              ('The simulated robot', before.simulated, tables.simulated),
                              ('Recordings', before.recordings, tables.recordings)):
        if rows:
            lines += [f'### {title}', '', *part(before, after), '']
    return lines
