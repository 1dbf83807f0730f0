"""docs/tutorial.md: every command of it is run, in order, as it is written."""
from __future__ import annotations

import re

from page_reader import Reader, blocks, types


@types('tutorial.md')
def test_from_nothing_to_an_alarm_and_its_report(reader: Reader) -> None:
    said = {block: reader.type(block) for block in blocks('tutorial.md')}
    by_command = {command: text for block, text in said.items() for command in block.splitlines()
                  if not command.startswith('#')}
    alarm = next(text for block, text in said.items() if 'induce' in block)
    assert 'level: 2' in alarm and '/player (/' in alarm
    scored = next(text for command, text in by_command.items() if '--report' in command)
    assert re.search(r'1\. /player ', scored)
    report = (reader.folder / 'alarm.html').read_text()
    assert '/player' in report
    results = next(text for command, text in by_command.items() if 'echo -b' in command)
    assert 'stopped sending at' in results
    assert '/player' in by_command['rosrun self_awareness info robot.model --details']
