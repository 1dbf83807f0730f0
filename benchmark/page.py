"""What benchmarks share: they write docs/performance.md and the JSON files of its tables, and run
programs to their end."""
from __future__ import annotations

import argparse
import json
import os
import subprocess
import time
from pathlib import Path
from typing import Any, Callable, Dict, NamedTuple, Optional, Sequence

from self_awareness import METHOD
from self_awareness_evaluation.pages import machine, write_section

__all__ = ['Usage', 'built', 'machine', 'parser', 'publish', 'run', 'run_program']

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


class Usage(NamedTuple):
    """What a process used, in all its threads."""

    wall_s: float
    peak_bytes: int  # the most of its memory that was resident
    read_bytes: int  # by read(2), from any file


def run_program(command: Sequence[str]) -> Usage:
    """Run a program to its end.

    Raises:
        RuntimeError: the program failed.
    """
    begin = time.perf_counter()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)  # keeps the counts of the process
    wall = time.perf_counter() - begin
    io = dict(line.split(': ') for line in
              Path(f'/proc/{process.pid}/io').read_text().splitlines())
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = status
    if status != 0:
        raise RuntimeError(f'{" ".join(command)} failed')
    return Usage(wall, 1024 * usage.ru_maxrss, int(io['rchar']))


def built(name: str) -> str:
    """Return the path of a program of this package.

    Raises:
        FileNotFoundError: it is not built, or its workspace is not sourced.
    """
    for prefix in os.environ.get('CMAKE_PREFIX_PATH', '').split(':'):
        path = Path(prefix) / 'lib' / 'self_awareness' / name
        if os.access(path, os.X_OK):
            return str(path)
    raise FileNotFoundError(f'{name} is not built, or its workspace not sourced')
