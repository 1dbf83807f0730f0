"""The two pages of the evaluation, and the files of numbers: who writes what where."""
from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Callable, Dict, List, Optional, Sequence, Tuple

from self_awareness_evaluation import row_files
from self_awareness_evaluation.figures import columns, grouped
from self_awareness_evaluation.page_section import put_section
from self_awareness_evaluation.pages import written_by
from self_awareness_evaluation.rows import NORMAL, Row

RESULTS, RESEARCH = 'README.md', 'research.md'
"""The page that is read in two minutes, and the one for who wants to know more."""

FULL = 'full'
"""Folder below that of the pages for the rows of all records, which is not kept in the repository.
"""


@dataclass(frozen=True)
class Section:
    """What a measurement writes.

    Args:
        name: of the section, and of the files.
        title: above it, on a page that does not have it yet.
        pages: by page, the lines of the section.
        group: of a row in the file of figures: its name; None: there is none but all together.
    """

    name: str
    title: str
    pages: Dict[str, List[str]]
    group: Optional[Callable[[Row], str]] = None


def rows_path(folder: Path, name: str) -> Path:
    """Return where the rows of a measurement are kept."""
    return folder / FULL / f'{name}.csv'


def write(folder: Path, section: Section, rows: Sequence[Row], command: str) -> List[Path]:
    """Write a section of the pages, and the figures; return the names of the files.

    Args:
        folder: exists.
        section: see there.
        rows: that it is about.
        command: that the pages say it was written by.

    Raises:
        OSError: a file cannot be written.
    """
    figures = folder / f'{section.name}.csv'
    kinds = sorted({row.fault.partition(':')[0] for row in rows} - {NORMAL})
    table = [{**{name: getattr(of_group[0].subject, name) for name in
                 ('part', 'learning', 'system', 'change', 'budget')},
              'of': group, **columns(of_group, kinds)}
             for group, of_group in _groups(section, rows)]
    row_files.save_table(figures, table, list(table[0]))
    for page, lines in section.pages.items():
        text = '\n'.join([written_by(command), '', *lines])
        put_section(folder / page, section.name, section.title, text)
    return [rows_path(folder, section.name), figures, *(folder / page for page in section.pages)]


def _groups(section: Section, rows: Sequence[Row]) -> List[Tuple[str, List[Row]]]:
    """Return the rows of each subject, of all groups together and of each group."""
    def of(group: Callable[[Row], str]) -> List[Tuple[str, List[Row]]]:
        return [(name, of_group) for (name, _), of_group in grouped(
            rows, lambda row: (group(row), replace(row.subject, robot=''))).items()]

    return of(lambda _: 'all') + ([] if section.group is None else of(section.group))
