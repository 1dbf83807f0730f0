"""The rows of a measurement in a file that grows, so that it goes on where it was interrupted."""
from __future__ import annotations

import csv
import io
import os
import zlib
from pathlib import Path
from typing import Dict, List, Sequence

from self_awareness import METHOD, Tuning, _core
from self_awareness.output_files import replacing
from self_awareness_evaluation import row_files
from self_awareness_evaluation.rows import Row, Subject


class KeptRows:
    """Rows in a CSV file, and beside it a file of what they are of, and how much is whole.

    Args:
        path: of the CSV file; what it holds already is kept.
        plan: what decides on the rows, besides their subjects.

    Raises:
        OSError: a file cannot be read or written.
        ValueError: it holds rows of another plan or of another method, or is another file.
    """

    def __init__(self, path: Path, plan: str) -> None:
        self._path = path
        self._beside = path.with_suffix('.plan')
        self._plan = f'{_method()}\n{plan}\n'
        self._rows: Dict[Subject, List[Row]] = {}
        if not path.is_file():
            row_files.save(path, [], Row)
        else:
            self._check()
            for row in row_files.load(path, Row):
                self._rows.setdefault(row.subject, []).append(row)
        self._remember()

    def has(self, subject: Subject) -> bool:
        """Return whether all rows of a subject are there."""
        return subject in self._rows

    def of(self, subjects: Sequence[Subject]) -> List[Row]:
        """Return the rows of subjects, in the order of these."""
        return [row for subject in subjects for row in self._rows[subject]]

    def add(self, rows: Sequence[Row]) -> None:
        """Add all rows of some subjects.

        Raises:
            OSError: they cannot be written.
        """
        text = io.StringIO()
        writer = csv.DictWriter(text, row_files.columns(Row), lineterminator='\n')
        writer.writerows(row_files.flat(row) for row in rows)
        with open(self._path, 'a', encoding='utf-8', newline='') as file:
            file.write(text.getvalue())
            file.flush()
            os.fsync(file.fileno())
        self._remember()
        for row in rows:
            self._rows.setdefault(row.subject, []).append(row)

    def _check(self) -> None:
        """Check the plan, and cut off what an interrupted run left half written."""
        told = self._beside.read_text(encoding='utf-8') if self._beside.is_file() else ''
        size, _, plan = told.partition('\n')
        if plan != self._plan or not size.isdigit():
            raise ValueError(f'{self._path}: of another plan, or of another build of the method; '
                             'remove it or choose another --output')
        os.truncate(self._path, int(size))

    def _remember(self) -> None:
        """Note that the file is whole."""
        with replacing(str(self._beside)) as temporary:
            Path(temporary).write_text(f'{self._path.stat().st_size}\n{self._plan}',
                                       encoding='utf-8')


def _method() -> str:
    """Return what tells one method from another: version, numbers, and how it was built."""
    numbers = [f'{number.name}={number.default:g}' for number in Tuning.numbers()]
    build = zlib.crc32(Path(_core.__file__).read_bytes())
    return f'method {METHOD}, build {build:08x}: {" ".join([*Tuning.channels(), *numbers])}'
