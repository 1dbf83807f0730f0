"""Writes the tables of docs/performance.md from the JSON files of measurements."""
from __future__ import annotations

import json
import os
import platform
from pathlib import Path
from typing import Any, Dict, List, Sequence


def machine() -> Dict[str, Any]:
    """Return the properties of this machine that the numbers depend on."""
    return {'cores': os.cpu_count(), 'machine': platform.machine(), 'kernel': platform.release()}


def publish(name: str, result: Dict[str, Any], text: str, docs: Path) -> None:
    """Write performance/NAME.json and the section NAME of performance.md.

    Raises:
        ValueError: the page has no such section; the JSON file is written anyway.
    """
    (docs / 'performance').mkdir(parents=True, exist_ok=True)
    (docs / 'performance' / f'{name}.json').write_text(json.dumps(result, indent=1) + '\n')
    write_section(docs / 'performance.md', name, text)


def table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Return a Markdown table."""
    lines: List[Sequence[str]] = [head, ['---'] + ['---:'] * (len(head) - 1), *rows]
    return '\n'.join('| ' + ' | '.join(line) + ' |' for line in lines)


def write_section(page: Path, name: str, text: str) -> None:
    """Replace the text between the markers `<!-- NAME -->` and `<!-- /NAME -->` of the page.

    Raises:
        ValueError: the page has no such section.
    """
    before, opening, rest = page.read_text().partition(f'<!-- {name} -->')
    _, closing, after = rest.partition(f'<!-- /{name} -->')
    if not (opening and closing):
        raise ValueError(f'{page} has no section {name}')
    page.write_text(f'{before}{opening}\n{text}\n{closing}{after}')
