"""Tables of rows as CSV files, for other programs, too; some grow while it is measured."""
from __future__ import annotations

import csv
import os
import zlib
from dataclasses import MISSING, Field, fields, is_dataclass
from pathlib import Path
from typing import Any, Dict, List, Sequence, Type, TypeVar, Union, get_args, get_origin, \
    get_type_hints

from self_awareness import METHOD, Tuning, _core
from self_awareness.output_files import replacing, save_table
from self_awareness_evaluation.rows import Row, Subject

_Row = TypeVar('_Row')

_BETWEEN = '; '


def columns(row_type: type) -> List[str]:
    """Return the columns of a dataclass: its fields, those of a field that is one itself, too."""
    hints = get_type_hints(row_type)
    found: List[str] = []
    for field in fields(row_type):
        kind = hints[field.name]
        found += (columns(kind) if isinstance(kind, type) and is_dataclass(kind)
                  else [field.name])
    return found


def flat(row: Any) -> Dict[str, Any]:
    """Return a row by column; tuples become one text."""
    found: Dict[str, Any] = {}
    for field in fields(row):
        value = getattr(row, field.name)
        if is_dataclass(value):
            found.update(flat(value))
        else:
            found[field.name] = _BETWEEN.join(value) if isinstance(value, tuple) else value
    return found


def save(path: Path, rows: Sequence[_Row], row_type: Type[_Row]) -> None:
    """Write rows, a whole file or none."""
    save_table(str(path), columns(row_type), [list(flat(row).values()) for row in rows])


def load(path: Path, row_type: Type[_Row]) -> List[_Row]:
    """Read what save() wrote. Columns that are not known are skipped.

    Raises:
        ValueError: it is not such a table; names the file and the line.
    """
    with open(path, encoding='utf-8', newline='') as file:
        reader = csv.DictReader(file)
        rows = []
        for cells in reader:
            try:
                rows.append(_row(cells, row_type))
            except ValueError as error:
                raise ValueError(f'{path}, line {reader.line_num}: {error}') from None
    return rows


def _row(cells: Dict[str, str], row_type: Type[_Row]) -> _Row:
    hints = get_type_hints(row_type)
    dataclass_type: Any = row_type
    return row_type(**{field.name: _field(cells, field, hints[field.name])
                       for field in fields(dataclass_type)})


def _field(cells: Dict[str, str], field: Field, kind: Any) -> Any:
    if is_dataclass(kind) and isinstance(kind, type):
        return _row(cells, kind)
    text = cells.get(field.name)
    if text is None:
        if field.default is MISSING:
            raise ValueError(f'there is no {field.name}')
        return field.default
    return _parsed(field.name, text, kind)


def _parsed(name: str, text: str, kind: Any) -> Any:
    if get_origin(kind) is Union:  # Optional
        return _parsed(name, text, get_args(kind)[0]) if text else None
    if get_origin(kind) is tuple:
        return tuple(text.split(_BETWEEN)) if text else ()
    if kind is bool:
        if text not in ('True', 'False'):
            raise ValueError(f'{name} is {text!r}, not True or False')
        return text == 'True'
    try:
        return kind(text)
    except ValueError:
        raise ValueError(f'{name} is {text!r}, no number') from None


class KeptRows:
    """Rows in a CSV file, and beside it a file of what they are of, and how much is whole.

    Args:
        path: of the CSV file; what it holds already is kept.
        plan: what decides on the rows, besides their subjects.

    Raises:
        ValueError: it holds rows of another plan or of another method, or is another file.
    """

    def __init__(self, path: Path, plan: str) -> None:
        self._path = path
        self._beside = path.with_suffix('.plan')
        self._plan = f'{_method()}\n{plan}\n'
        self._rows: Dict[Subject, List[Row]] = {}
        if path.is_file():
            self._check()
        else:
            save(path, [], Row)
        self._remember(load(path, Row))

    def has(self, subject: Subject) -> bool:
        """Return whether all rows of a subject are there."""
        return subject in self._rows

    def of(self, subjects: Sequence[Subject]) -> List[Row]:
        """Return the rows of subjects, in the order of these."""
        return [row for subject in subjects for row in self._rows[subject]]

    def add(self, rows: Sequence[Row]) -> None:
        """Add all rows of some subjects."""
        with open(self._path, 'a', encoding='utf-8', newline='') as file:
            csv.writer(file, lineterminator='\n').writerows(
                flat(row).values() for row in rows)
            file.flush()
            os.fsync(file.fileno())
        self._remember(rows)

    def _check(self) -> None:
        """Check the plan, and cut off what an interrupted run left half written."""
        told = self._beside.read_text(encoding='utf-8') if self._beside.is_file() else ''
        size, _, plan = told.partition('\n')
        if plan != self._plan or not size.isdigit():
            raise ValueError(f'{self._path}: of another plan, or of another build of the method; '
                             'remove it or choose another --output')
        os.truncate(self._path, int(size))

    def _remember(self, rows: Sequence[Row]) -> None:
        """Note rows that the file has, and that it is whole."""
        for row in rows:
            self._rows.setdefault(row.subject, []).append(row)
        with replacing(str(self._beside)) as temporary:
            Path(temporary).write_text(f'{self._path.stat().st_size}\n{self._plan}',
                                       encoding='utf-8')


def _method() -> str:
    """Return what tells one method from another: version, numbers, and how it was built."""
    numbers = [f'{number.name}={number.default:g}' for number in Tuning.numbers()]
    build = zlib.crc32(Path(_core.__file__).read_bytes())
    return f'method {METHOD}, build {build:08x}: {" ".join([*Tuning.channels(), *numbers])}'
