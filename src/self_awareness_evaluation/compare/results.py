"""What the commands of an evaluation left in a folder."""
from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import List, Type, TypeVar

from self_awareness_evaluation import pages, row_files
from self_awareness_evaluation.families import measures, report as families_report
from self_awareness_evaluation.recordings import report as recordings_report
from self_awareness_evaluation.recordings.outages import OutageRow
from self_awareness_evaluation.simulated import report as simulated_report
from self_awareness_evaluation.simulated.measures import Row

_Row = TypeVar('_Row')

_FOLDERS = re.compile(r' (-o|--output|--data)[ =]\S+')


@dataclass(frozen=True)
class Measured:
    """What a folder holds; an empty list: that part was not run.

    Args:
        normal, faults: of the families.
        simulated: of the simulated robot.
        recordings: of real robots.
        commands: that wrote it all, without the folders.
    """

    normal: List[measures.NormalRow]
    faults: List[measures.FaultRow]
    simulated: List[Row]
    recordings: List[OutageRow]
    commands: List[str]

    def __bool__(self) -> bool:
        return bool(self.normal or self.simulated or self.recordings)


def folders(top: Path) -> List[str]:
    """Return the folder and those in it that hold results, as paths from it.

    Raises:
        ValueError: there is none.
        OSError: it cannot be read.
    """
    found = [name for name in ('.', *sorted(path.name for path in top.iterdir() if path.is_dir()))
             if read(top / name)]
    if not found:
        raise ValueError(f'{top}: holds no results; name a folder that `evaluate families`, '
                         '`simulated` or `recordings` wrote to (-o)')
    return found


def read(folder: Path) -> Measured:
    """Return what a folder holds.

    Raises:
        OSError: a file cannot be read.
        ValueError: a file is not what it should be.
    """
    families, simulated = families_report.NAME, simulated_report.NAME
    full = folder / families_report.FULL
    return Measured(
        _rows(full / f'{families}_normal.csv', measures.NormalRow),
        _rows(full / f'{families}_faults.csv', measures.FaultRow),
        _rows(folder / simulated_report.FULL / f'{simulated}.csv', Row),
        _rows(folder / f'{recordings_report.NAME}.csv', OutageRow),
        [command for name in (families, simulated, recordings_report.NAME)
         for command in _command(folder / f'{name}.md')])


def _rows(path: Path, row_type: Type[_Row]) -> List[_Row]:
    return row_files.load(path, row_type) if path.is_file() else []


def _command(page: Path) -> List[str]:
    found = pages.written(page.read_text(encoding='utf-8')) if page.is_file() else []
    return [_FOLDERS.sub('', each.command) for each in found]
