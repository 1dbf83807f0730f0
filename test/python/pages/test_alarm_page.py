"""docs/alarm.md: every command of it is run, in order, as it is written."""
from __future__ import annotations

import re
from pathlib import Path

from page_reader import DOCS, Reader, blocks, types


@types('alarm.md', 2, 3)
def test_the_simulated_alarm_is_as_the_page_says(reader: Reader) -> None:
    said = ''.join(reader.type(block) for block in blocks('alarm.md', '## A simulated one'))
    expected = [line for line in (DOCS / 'alarm.md').read_text(encoding='utf-8').splitlines()
                if line.startswith(('half.bag: ', '  /slam', '    1. /slam', '    2. /navigation',
                                    'late.bag: ', '  /leg_', '    1. /leg_', '    since 32'))]
    assert len(expected) == 8
    for line in expected:
        assert line.split(', ...')[0] in said
    assert '/slam' in (reader.folder / 'half.html').read_text()


@types('alarm.md', 1)
def test_the_real_alarm_is_as_the_page_says(reader: Reader, shared: Path) -> None:
    for bag in (shared / 'data' / 'wheeled_robot').glob('feb13_*.bag'):
        (reader.folder / bag.name).symlink_to(bag)
    said = ''.join(reader.type(block) for block in blocks('alarm.md', '## A real one'))
    page = (DOCS / 'alarm.md').read_text(encoding='utf-8')
    expected = re.findall(r'^(?:feb13_outage.bag: .*|  /.*|    (?:[1-4]\.|since \S+ s) /.*)$',
                          page[page.index('## A real one'):page.index('## A simulated')],
                          re.MULTILINE)
    assert len(expected) == 5
    for line in expected:
        assert line in said
