"""The page docs/performance.md, whose tables are written from the JSON files of measurements."""
from __future__ import annotations

from pathlib import Path
from typing import List, Sequence


def table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Return a Markdown table."""
    lines: List[Sequence[str]] = [head, ['---'] + ['---:'] * (len(head) - 1), *rows]
    return '\n'.join('| ' + ' | '.join(line) + ' |' for line in lines)


def write_section(page: Path, name: str, text: str) -> None:
    """Replace what stands between the markers `<!-- NAME -->` and `<!-- /NAME -->` of the page.

    :raise ValueError: if the page does not have each of them once
    """
    before, opening, rest = page.read_text().partition(f'<!-- {name} -->')
    _, closing, after = rest.partition(f'<!-- /{name} -->')
    if not (opening and closing):
        raise ValueError(f'{page} has no section {name}')
    page.write_text(f'{before}{opening}\n{text}\n{closing}{after}')
