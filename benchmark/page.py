"""Writes the tables of docs/performance.md from the JSON files of measurements."""
from __future__ import annotations

import json
from pathlib import Path
from typing import Any, Dict, List, Sequence

from self_awareness import METHOD
from self_awareness_evaluation.page_section import machine, write_section

__all__ = ['machine', 'publish', 'table']


def publish(name: str, result: Dict[str, Any], text: str, docs: Path) -> None:
    """Write performance/NAME.json and the section NAME of performance.md.

    Raises:
        ValueError: the page has no such section; the JSON file is written anyway.
    """
    (docs / 'performance').mkdir(parents=True, exist_ok=True)
    numbers = {'method': METHOD, **result}
    (docs / 'performance' / f'{name}.json').write_text(json.dumps(numbers, indent=1) + '\n')
    write_section(docs / 'performance.md', name, text)


def table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Return a Markdown table."""
    lines: List[Sequence[str]] = [head, ['---'] + ['---:'] * (len(head) - 1), *rows]
    return '\n'.join('| ' + ' | '.join(line) + ' |' for line in lines)
