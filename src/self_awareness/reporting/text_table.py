"""Tables of plain text."""
from __future__ import annotations

from typing import List, Sequence


def aligned(rows: Sequence[Sequence[str]]) -> List[str]:
    """Return a line for each row, its cells in columns; all rows have as many, there is one."""
    widths = [max(map(len, column)) for column in zip(*rows)]
    return ['  '.join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip()
            for row in rows]
