"""The measured numbers of the README: each is a cell of a table that a measurement wrote."""
from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Dict, List

from self_awareness_evaluation.sections import families, own_robot
from self_awareness_evaluation.sections.page import RESEARCH

SECTION = 'measured'
"""Name of the README's section that holds them."""

_SYSTEM = 'evidence'
_PAGE = f'evaluation/{RESEARCH}'
_OWN = own_robot.TITLE
_FAMILIES = families.TITLE


@dataclass(frozen=True)
class Number:
    """A row of the README's table.

    Args:
        what: it is, in words.
        page: from the folder of all pages.
        heading: above the table; empty: of the page's first table.
        row: first cell of its row.
        column: of its cell.
    """

    what: str
    page: str
    heading: str
    row: str
    column: str


NUMBERS = [
    *(Number(what, _PAGE, _OWN, fault, _SYSTEM) for fault, what in own_robot.TOLD.items()),
    Number('false alarms an hour (95 %)', _PAGE, _OWN, own_robot.FALSE_ALARMS, _SYSTEM),
    Number('the same, on robots of other kinds, learned from 4 starts', _PAGE, _FAMILIES,
           families.ALL, 'false alarms/h, 4 starts'),
]


def section(docs: Path) -> str:
    """Return the README's section: what was measured, as the pages say it.

    Raises:
        OSError: a page cannot be read.
        ValueError: a page has no such table, row or column; names them.
    """
    pages: Dict[str, str] = {}
    lines = ['| what | runs with an alarm, median time to it |', '|---|---|']
    for number in NUMBERS:
        if number.page not in pages:
            pages[number.page] = (docs / number.page).read_text(encoding='utf-8')
        lines.append(f'| {number.what} | {cell(pages[number.page], number)} |')
    return '\n'.join(lines)


def cell(page: str, number: Number) -> str:
    """Return a cell of a page's table.

    Raises:
        ValueError: the page has no such table, row or column; names them.
    """
    if number.heading:
        _, found, page = page.partition(f'\n## {number.heading}\n')
        if not found:
            raise ValueError(f'{number.page}: no heading {number.heading!r}')
    table = _first_table(page)
    if not table or number.column not in table[0]:
        raise ValueError(f'{number.page}: no column {number.column!r} in the table of '
                         f'{number.heading or "the page"!r}')
    for row in table[1:]:
        if row[0] == number.row:
            return row[table[0].index(number.column)]
    raise ValueError(f'{number.page}: no row {number.row!r} in the table of '
                     f'{number.heading or "the page"!r}')


def _first_table(page: str) -> List[List[str]]:
    rows = []
    for line in page.split('\n'):
        if line.startswith('|'):
            rows.append([each.strip() for each in line.strip('|').split('|')])
        elif rows:
            break
    return rows
