"""docs/tutorial.md and docs/alarm.md: every command of them is run, in order, as it is written."""
from __future__ import annotations

import re
from pathlib import Path

from page_reader import DOCS, Reader, blocks


def test_from_nothing_to_an_alarm_and_its_report(reader: Reader) -> None:
    said = {block: reader.type(block) for block in blocks('tutorial.md')}
    by_command = {command: text for block, text in said.items() for command in block.splitlines()
                  if not command.startswith('#')}
    alarm = next(text for block, text in said.items() if 'induce' in block)
    assert 'level: 2' in alarm and '/player on ' in alarm
    scored = next(text for command, text in by_command.items() if '--report' in command)
    assert re.search(r'1\. /player ', scored)
    report = (reader.folder / 'alarm.html').read_text()
    assert '/player' in report
    results = next(text for command, text in by_command.items() if 'echo -b' in command)
    assert 'abnormal communication' in results
    learned_more = said[blocks('tutorial.md')[-1]]
    for text in ('starts of the robot: 1', 'written: better.model', 'before  robot.model'):
        assert text in learned_more


def test_the_simulated_alarm_is_as_the_page_says(reader: Reader) -> None:
    said = ''.join(reader.type(block) for block in blocks('alarm.md', '## A simulated one'))
    expected = [line for line in (DOCS / 'alarm.md').read_text(encoding='utf-8').splitlines()
                if line.startswith(('half.bag: ', '    1. /slam', '    2. /navigation',
                                    'late.bag: ', '    1. /leg_', '    2. /face_'))]
    assert len(expected) == 6
    for line in expected:
        assert line.split(', ...')[0] in said
    assert '/slam' in (reader.folder / 'half.html').read_text()


def test_the_real_alarm_is_as_the_page_says(reader: Reader, shared: Path) -> None:
    for bag in (shared / 'data' / 'wheeled_robot').glob('feb13_*.bag'):
        (reader.folder / bag.name).symlink_to(bag)
    said = ''.join(reader.type(block) for block in blocks('alarm.md', '## A real one'))
    page = (DOCS / 'alarm.md').read_text(encoding='utf-8')
    expected = re.findall(r'^(?:feb13_outage.bag: .*|    [1-4]\. /.*)$',
                          page[page.index('## A real one'):page.index('## A simulated')],
                          re.MULTILINE)
    assert len(expected) == 9
    for line in expected:
        assert line in said
