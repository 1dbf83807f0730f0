"""`rosrun self_awareness evaluate`: measures detectors on faults that are known, side by side."""
from __future__ import annotations

import argparse
import re
import shlex
import sys
from pathlib import Path
from typing import NamedTuple, Optional, Sequence

from self_awareness.commands import cli
from self_awareness_evaluation import offline, options, pages, sections
from self_awareness_evaluation.live import command as live

SECTION = 'measured'  # the README's section with the numbers that were measured
PAGE = f'evaluation/{pages.RESEARCH}'  # whose tables have them, from the folder of all pages


class Number(NamedTuple):
    """A row of the README's table, and where its cell is."""

    what: str  # it is, in words
    heading: str  # above the table
    row: str  # its first cell
    column: str


NUMBERS = [
    *(Number(what, sections.OWN_TITLE, fault, 'evidence')
      for fault, what in sections.TOLD.items()),
    Number(sections.FALSE_ALARMS, sections.OWN_TITLE, sections.FALSE_ALARMS, 'evidence'),
    Number('the same, on robots of other kinds, learned from 4 starts', sections.FAMILIES_TITLE,
           sections.ALL, 'false alarms/h, 4 starts')]


def main(argv: Optional[Sequence[str]] = None) -> int:
    """Run the program; return its exit code (see cli.run)."""
    given = sys.argv[1:] if argv is None else argv
    command = f'rosrun self_awareness evaluate {shlex.join(given)}'
    return cli.run(parser(), lambda arguments: arguments.work(arguments, command), argv)


def measured(docs: Path) -> str:
    """Return the README's section: what was measured, as the page says it."""
    page = (docs / PAGE).read_text(encoding='utf-8')
    return '\n'.join(['| what | runs with an alarm, median time to it |', '|---|---|',
                      *(f'| {each.what} | {cell(page, each)} |' for each in NUMBERS)])


def cell(page: str, number: Number) -> str:
    """Return a cell of the first table below a heading of a page; raise ValueError without one."""
    _, found, below = page.partition(f'\n## {number.heading}\n')
    if not found:
        raise ValueError(f'{PAGE}: no heading {number.heading!r}')
    table = re.search(r'^\|.*(\n\|.*)*', below, re.MULTILINE)
    head, *body = ([each.strip() for each in line.strip('|').split('|')]
                   for line in (table[0] if table else '').split('\n'))
    if number.column not in head:
        raise ValueError(f'{PAGE}: no column {number.column!r} in the table of {number.heading!r}')
    for row in body:
        if row[0] == number.row:
            return row[head.index(number.column)]
    raise ValueError(f'{PAGE}: no row {number.row!r} in the table of {number.heading!r}')


def _pages(arguments: argparse.Namespace, _: str) -> None:
    print('\n'.join(pages.check(arguments.docs)))


def _numbers(arguments: argparse.Namespace, _: str) -> None:
    pages.write_section(arguments.readme, SECTION, measured(arguments.docs))
    print(f'written: {arguments.readme}')


def parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog='evaluate', description=__doc__.split(': ', 1)[1])
    parts = parser.add_subparsers(metavar='PART', required=True)
    offline.add(parts)
    pages.add_compare(parts)
    live.add(parts)
    listed = parts.add_parser(
        'pages', help='which pages were measured with an older method',
        description='Lists the pages that a measurement wrote, with the version of the method, '
        'and the command that measures those of an older method again.')
    numbers = parts.add_parser(
        'numbers', help='copy the numbers of the README out of these pages',
        description='Writes the measured numbers of the README again. They are cells of the '
        'tables of the pages; src/self_awareness_evaluation/evaluate.py says which.')
    for each, work in ((listed, _pages), (numbers, _numbers)):
        each.set_defaults(work=work)
        options.add(each, '--docs', Path, Path('docs'), 'DIR', 'folder of the pages')
    options.add(numbers, '--readme', Path, Path('README.md'), 'FILE', 'the README')
    return parser
