"""Pages with sections that commands write: what, where, and with which version of the method."""
from __future__ import annotations

import json
import os
import platform
import re
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Callable, Dict, List, Optional, Sequence, Tuple

from self_awareness import METHOD
from self_awareness.output_files import replacing, save_table
from self_awareness_evaluation.figures import columns, grouped
from self_awareness_evaluation.rows import NORMAL, Row

RESULTS, RESEARCH = 'README.md', 'research.md'
"""The page that is read in two minutes, and the one for who wants to know more."""

FULL = 'full'
"""Folder below that of the pages for the rows of all records, which is not kept in the repository.
"""

_WRITTEN = re.compile(r'^Written by `(?P<command>.+?)`( on [\d-]+)?'
                      r'(, method (?P<method>\d+))?; do not edit', re.MULTILINE)


def machine() -> Dict[str, Any]:
    """Return the properties of this machine that numbers depend on."""
    return {'cores': os.cpu_count(), 'machine': platform.machine(), 'kernel': platform.release()}


def write_section(page: Path, name: str, text: str, title: str = '') -> None:
    """Replace the text between the markers `<!-- NAME -->` and `<!-- /NAME -->` of a page.

    A page that is not there is made, and one without the section gets it at its end, below a
    title if there is one.

    Raises:
        ValueError: the page has no such section, and there is no title.
        OSError: the page cannot be read or written.
    """
    told = '# Measured\n' if title and not page.is_file() else page.read_text(encoding='utf-8')
    if title and f'<!-- {name} -->' not in told:
        told += f'\n## {title}\n\n<!-- {name} -->\n<!-- /{name} -->\n'
    before, opening, rest = told.partition(f'<!-- {name} -->')
    _, closing, after = rest.partition(f'<!-- /{name} -->')
    if not (opening and closing):
        raise ValueError(f'{page} has no section {name}')
    with replacing(str(page)) as temporary:
        Path(temporary).write_text(f'{before}{opening}\n{text}\n{closing}{after}',
                                   encoding='utf-8')


@dataclass(frozen=True)
class Section:
    """What a measurement writes."""

    name: str  # of the section, and of the files
    title: str  # above it, on a page that does not have it yet
    pages: Dict[str, List[str]]  # by page, the lines of the section
    # Of a row in the file of figures: its name; None: there is none but all together.
    group: Optional[Callable[[Row], str]] = None


def rows_path(folder: Path, name: str) -> Path:
    """Return where the rows of a measurement are kept."""
    return folder / FULL / f'{name}.csv'


def write(folder: Path, section: Section, rows: Sequence[Row], command: str) -> List[Path]:
    """Write a section of the pages, and the figures; return the names of the files."""
    figures = folder / f'{section.name}.csv'
    kinds = sorted({row.fault.partition(':')[0] for row in rows} - {NORMAL})
    table = [{**{name: getattr(of_group[0].subject, name) for name in
                 ('part', 'learning', 'system', 'change', 'budget')},
              'of': group, **columns(of_group, kinds)}
             for group, of_group in _groups(section, rows)]
    save_table(str(figures), list(table[0]), [list(each.values()) for each in table])
    for page, lines in section.pages.items():
        text = '\n'.join([written_by(command), '', *lines])
        write_section(folder / page, section.name, text, section.title)
    return [rows_path(folder, section.name), figures, *(folder / page for page in section.pages)]


def _groups(section: Section, rows: Sequence[Row]) -> List[Tuple[str, List[Row]]]:
    """Return the rows of each subject, of all groups together and of each group."""
    def of(group: Callable[[Row], str]) -> List[Tuple[str, List[Row]]]:
        return [(name, of_group) for (name, _), of_group in grouped(
            rows, lambda row: (group(row), replace(row.subject, robot=''))).items()]

    return of(lambda _: 'all') + ([] if section.group is None else of(section.group))


@dataclass(frozen=True)
class Written:
    """A page, or a section of one: its path from the folder of all, the command that wrote it, and
    the version of the method that was measured; None: of before versions were told."""

    page: str
    command: str
    method: Optional[int]

    @property
    def is_old(self) -> bool:
        """Whether another method was measured than that of this version."""
        return self.method != METHOD


def written_by(command: str, date: str = '') -> str:
    """Return the line by which a page says what wrote it, and when, if that matters."""
    return (f'Written by `{command}`' + (f' on {date}' if date else '')
            + f', method {METHOD}; do not edit.')


def written(text: str, page: str = '') -> List[Written]:
    """Return what commands wrote of a page."""
    return [Written(page, found['command'], int(found['method']) if found['method'] else None)
            for found in _WRITTEN.finditer(text)]


def find(docs: Path) -> List[Written]:
    """Return all that commands wrote in a folder and those below it."""
    found = [each for path in sorted(docs.rglob('*.md'))
             for each in written(path.read_text(encoding='utf-8'), str(path.relative_to(docs)))]
    return found + [Written(str(path.relative_to(docs)), f'scripts/benchmark {path.stem}',
                            json.loads(path.read_text(encoding='utf-8')).get('method'))
                    for path in sorted(docs.glob('performance/*.json'))]


def check(docs: Path) -> List[str]:
    """Return a line for each page.

    Raises:
        ValueError: no command wrote a page there.
    """
    found = find(docs)
    if not found:
        raise ValueError(f'{docs}: holds no page that `evaluate` wrote')
    return [f'{"old" if each.is_old else "ok "}  {each.page}: '
            + ('an older method' if each.method is None else f'method {each.method}')
            + (f'; measure it again: {each.command}' if each.is_old else '') for each in found]
