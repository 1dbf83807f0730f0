"""Pages that people write, with sections that programs write from what they measured."""
from __future__ import annotations

import os
import platform
from pathlib import Path
from typing import Any, Dict

from self_awareness.output_files import replacing


def machine() -> Dict[str, Any]:
    """Return the properties of this machine that numbers depend on."""
    return {'cores': os.cpu_count(), 'machine': platform.machine(), 'kernel': platform.release()}


def write_section(page: Path, name: str, text: str) -> None:
    """Replace the text between the markers `<!-- NAME -->` and `<!-- /NAME -->` of a page.

    Raises:
        ValueError: the page has no such section.
        OSError: the page cannot be read or written.
    """
    before, opening, rest = page.read_text(encoding='utf-8').partition(f'<!-- {name} -->')
    _, closing, after = rest.partition(f'<!-- /{name} -->')
    if not (opening and closing):
        raise ValueError(f'{page} has no section {name}')
    with replacing(str(page)) as temporary:
        Path(temporary).write_text(f'{before}{opening}\n{text}\n{closing}{after}',
                                   encoding='utf-8')


def put_section(page: Path, name: str, title: str, text: str) -> None:
    """Write a section of a page as write_section() does; a page that lacks it gets it at its end.

    Args:
        page: is made if it is not there.
        name: of the section.
        title: of the heading that it gets on a page that lacks it.
        text: of the section.

    Raises:
        OSError: the page cannot be read or written.
    """
    told = page.read_text(encoding='utf-8') if page.is_file() else '# Measured\n'
    if f'<!-- {name} -->' not in told:
        with replacing(str(page)) as temporary:
            Path(temporary).write_text(
                f'{told}\n## {title}\n\n<!-- {name} -->\n<!-- /{name} -->\n', encoding='utf-8')
    write_section(page, name, text)
