"""Writes the tables of docs/performance.md from the JSON files of measurements."""
from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any, Callable, Dict, Optional

from self_awareness import METHOD
from self_awareness_evaluation.pages import machine, write_section

__all__ = ['machine', 'parser', 'publish', 'run']

_DOCS = Path(__file__).resolve().parents[1] / 'docs'


def publish(name: str, result: Dict[str, Any], text: str, docs: Path) -> None:
    """Write performance/NAME.json and the section NAME of performance.md.

    Raises:
        ValueError: the page has no such section; the JSON file is written anyway.
    """
    (docs / 'performance').mkdir(parents=True, exist_ok=True)
    numbers = {'method': METHOD, **result}
    (docs / 'performance' / f'{name}.json').write_text(json.dumps(numbers, indent=1) + '\n')
    write_section(docs / 'performance.md', name, text)


def parser(name: str, about: Optional[str]) -> argparse.ArgumentParser:
    """Return a parser that knows where results go; about: docstring of the benchmark."""
    made = argparse.ArgumentParser(prog=f'benchmark {name}', description=about)
    made.add_argument('--output', type=Path, default=_DOCS, metavar='FOLDER',
                      help=f'for performance/{name}.json and performance.md (default: docs)')
    return made


def run(name: str, about: Optional[str], measure: Callable[[], Dict[str, Any]],
        markdown: Callable[[Dict[str, Any]], str]) -> None:
    """Run a benchmark without further options, and write its results."""
    arguments = parser(name, about).parse_args()
    result = measure()
    publish(name, result, markdown(result), arguments.output)
