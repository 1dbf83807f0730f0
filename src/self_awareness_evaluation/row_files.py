"""Tables of rows as CSV files: what is measured is written so that another program can read it."""
from __future__ import annotations

import csv
from dataclasses import MISSING, Field, fields, is_dataclass
from pathlib import Path
from typing import Any, Dict, List, Sequence, Type, TypeVar, Union, get_args, get_origin, \
    get_type_hints

from self_awareness.output_files import replacing

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
    """Write rows, a whole file or none.

    Raises:
        OSError: it cannot be written.
    """
    save_table(path, [flat(row) for row in rows], columns(row_type))


def save_table(path: Path, rows: Sequence[Dict[str, Any]], head: Sequence[str]) -> None:
    """Write rows given by column, a whole file or none.

    Raises:
        OSError: it cannot be written.
    """
    with replacing(str(path)) as temporary:
        with open(temporary, 'w', encoding='utf-8', newline='') as file:
            writer = csv.DictWriter(file, head, lineterminator='\n')
            writer.writeheader()
            writer.writerows(rows)


def load(path: Path, row_type: Type[_Row]) -> List[_Row]:
    """Read what save() wrote. Columns that are not known are skipped.

    Raises:
        OSError: it cannot be read.
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
