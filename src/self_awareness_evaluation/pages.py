"""The pages that measurements write: by which command, and with which version of the method."""
from __future__ import annotations

import json
import re
from dataclasses import dataclass
from pathlib import Path
from typing import List, Optional

from self_awareness import METHOD

_WRITTEN = re.compile(r'^Written by `(?P<command>.+?)`( on [\d-]+)?'
                      r'(, method (?P<method>\d+))?; do not edit', re.MULTILINE)


@dataclass(frozen=True)
class Written:
    """A page, or a section of one, that a command wrote.

    Args:
        page: as a path from the folder of all pages.
        command: that wrote it.
        method: version of the method that was measured; None: of before versions were told.
    """

    page: str
    command: str
    method: Optional[int]

    @property
    def is_old(self) -> bool:
        """Whether another method was measured than that of this version."""
        return self.method != METHOD


def written_by(command: str, date: str = '') -> str:
    """Return the line by which a page says where it comes from.

    Args:
        command: that writes it.
        date: of the measurement; empty: it does not matter, as in simulated time.
    """
    return (f'Written by `{command}`' + (f' on {date}' if date else '')
            + f', method {METHOD}; do not edit.')


def written(text: str, page: str = '') -> List[Written]:
    """Return what commands wrote of a page."""
    return [Written(page, found['command'], int(found['method']) if found['method'] else None)
            for found in _WRITTEN.finditer(text)]


def find(docs: Path) -> List[Written]:
    """Return all that commands wrote in a folder and those below it.

    Raises:
        OSError: a page cannot be read.
        ValueError: a file of numbers is no JSON.
    """
    found = [each for path in sorted(docs.rglob('*.md'))
             for each in written(path.read_text(encoding='utf-8'), str(path.relative_to(docs)))]
    for path in sorted(docs.glob('performance/*.json')):
        method = json.loads(path.read_text(encoding='utf-8')).get('method')
        found.append(Written(str(path.relative_to(docs)), f'scripts/benchmark {path.stem}',
                             method))
    return found


def check(docs: Path) -> List[str]:
    """Return a line for each page.

    Raises:
        OSError: a page cannot be read.
        ValueError: no command wrote a page there, or a file of numbers is no JSON.
    """
    found = find(docs)
    if not found:
        raise ValueError(f'{docs}: holds no page that `evaluate` wrote')
    lines = []
    for each in found:
        method = 'an older method' if each.method is None else f'method {each.method}'
        lines.append(f'{"old" if each.is_old else "ok "}  {each.page}: {method}'
                     + (f'; measure it again: {each.command}' if each.is_old else ''))
    return lines
