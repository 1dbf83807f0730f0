"""What the benchmark of bags found, as JSON and as a section of docs/performance.md."""
from __future__ import annotations

import json
import os
import platform
import re
from pathlib import Path
from typing import Any, Dict

_BEGIN, _END = '<!-- bags -->', '<!-- /bags -->'
_TITLE = '# Performance\n'
_HEADING = '\n## Bags\n\n'
_NAMES = {'view': '`rosbag::View`, C++', 'read_messages': '`read_messages(raw=True)`, Python',
          'train': '`train`'}


def write(result: Dict[str, Any], folder: Path) -> None:
    """Write performance/bags.json, and the section between the markers of performance.md."""
    (folder / 'performance').mkdir(parents=True, exist_ok=True)
    (folder / 'performance' / 'bags.json').write_text(json.dumps(result, indent=1) + '\n')
    page = folder / 'performance.md'
    text = page.read_text() if page.exists() else _TITLE
    if _BEGIN not in text:
        text += f'{_HEADING}{_BEGIN}\n{_END}\n'
    section = f'{_BEGIN}\n{markdown(result)}{_END}'
    page.write_text(re.sub(f'{_BEGIN}.*{_END}', lambda _: section, text, flags=re.DOTALL))


def machine() -> Dict[str, Any]:
    """Return what the numbers depend on."""
    return {'cores': os.cpu_count(), 'machine': platform.machine(), 'kernel': platform.release()}


def markdown(result: Dict[str, Any]) -> str:
    """Return the table."""
    view = result['programs']['view']
    size = result['bag_bytes']
    lines = [
        f'A bag of {size / 1e9:.2f} GB, {result["messages"]:,} messages of eight nodes in '
        f'{result["seconds"]:g} s, images among them; in the page cache, median of '
        f'{result["rounds"]} runs in turn. The work alone is the whole process without its start '
        'and imports. Read of the bag: by read(2), and from the disk when no cache holds it.',
        '',
        '| | whole process s | / View | work alone s | / View | CPU s | / View | read | from disk |',
        '|---' + '|--:' * 8 + '|']
    for name, program in result['programs'].items():
        lines.append(
            f'| {_NAMES[name]} | {program["wall_s"]:.3f} '
            f'| {program["wall_s"] / view["wall_s"]:.2f} | {_work(program):.3f} '
            f'| {_work(program) / _work(view):.2f} | {program["cpu_s"]:.3f} '
            f'| {program["cpu_s"] / view["cpu_s"]:.2f} '
            f'| {100 * program["read_bytes"] / size:.2f} % '
            f'| {100 * program["cold_disk_bytes"] / size:.2f} % |')
    return '\n'.join(lines) + '\n'


def _work(program: Dict[str, Any]) -> float:
    return program['wall_s'] - program['start_wall_s']
