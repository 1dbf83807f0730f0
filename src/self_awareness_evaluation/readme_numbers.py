"""The measured numbers of the README: each is a cell of a table that a measurement wrote."""
from __future__ import annotations

from pathlib import Path
from typing import List, NamedTuple

from self_awareness_evaluation.pages import RESEARCH
from self_awareness_evaluation.sections import families, own_robot

SECTION = 'measured'  # name of the README's section that holds them
PAGE = f'evaluation/{RESEARCH}'  # where they are, from the folder of all pages


class Number(NamedTuple):
    """A row of the README's table: what it is in words, and the heading above the table, the first
    cell of the row and the column of its cell."""

    what: str
    heading: str
    row: str
    column: str


NUMBERS = [
    *(Number(what, own_robot.TITLE, fault, 'evidence') for fault, what in own_robot.TOLD.items()),
    Number('false alarms an hour (95 %)', own_robot.TITLE, own_robot.FALSE_ALARMS, 'evidence'),
    Number('the same, on robots of other kinds, learned from 4 starts', families.TITLE,
           families.ALL, 'false alarms/h, 4 starts'),
]


def section(docs: Path) -> str:
    """Return the README's section: what was measured, as the page says it."""
    page = (docs / PAGE).read_text(encoding='utf-8')
    return '\n'.join(['| what | runs with an alarm, median time to it |', '|---|---|',
                      *(f'| {each.what} | {cell(page, each)} |' for each in NUMBERS)])


def cell(page: str, number: Number) -> str:
    """Return a cell of the first table below a heading of a page; raise ValueError without one."""
    _, found, below = page.partition(f'\n## {number.heading}\n')
    if not found:
        raise ValueError(f'{PAGE}: no heading {number.heading!r}')
    table: List[List[str]] = []
    for line in below.split('\n'):
        if line.startswith('|'):
            table.append([each.strip() for each in line.strip('|').split('|')])
        elif table:
            break
    if not table or number.column not in table[0]:
        raise ValueError(f'{PAGE}: no column {number.column!r} in the table of '
                         f'{number.heading!r}')
    for row in table[1:]:
        if row[0] == number.row:
            return row[table[0].index(number.column)]
    raise ValueError(f'{PAGE}: no row {number.row!r} in the table of {number.heading!r}')
