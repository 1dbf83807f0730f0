"""docs/tutorial.md and docs/alarm.md: every command of them is run, in order, as it is written."""
from __future__ import annotations

import glob
import os
import re
import signal
import socket
import subprocess
from pathlib import Path
from typing import Dict, Iterator, List

import pytest
from conftest import wait_until

DOCS = Path(__file__).resolve().parents[2] / 'docs'
BACKGROUND = '# in a terminal of its own'
WAIT = re.compile(r'# when (\S+) is there')
COMMAND_S = 300.0


def blocks(page: str, heading: str = '') -> List[str]:
    """Return the blocks of commands of a page, or of a part of it."""
    text = (DOCS / page).read_text(encoding='utf-8')
    text = text[text.index(heading):]
    text = text[:text.find('\n## ', 1)] if heading else text
    found = re.findall(r'^```\n(.*?)^```', text, re.MULTILINE | re.DOTALL)
    return [block for block in found if re.match(r'(#|roslaunch|rosrun|rostopic)', block)]


class Reader:
    """Somebody who types the commands of a page, in a folder and under a master of their own."""

    def __init__(self, folder: Path) -> None:
        with socket.socket() as free:
            free.bind(('127.0.0.1', 0))
            port = free.getsockname()[1]
        self.folder = folder
        self.environment: Dict[str, str] = {
            **os.environ, 'HOME': str(folder), 'ROS_HOME': str(folder / '.ros'),
            'ROS_IP': '127.0.0.1', 'ROS_MASTER_URI': f'http://127.0.0.1:{port}',
            'PATH': f'/usr/bin:{os.environ["PATH"]}'}
        self._terminals: List[subprocess.Popen] = []

    def type(self, block: str) -> str:
        """Type a block of commands; return what they print."""
        waits = WAIT.match(block)
        if waits is not None:
            name = waits[1].replace('~', str(self.folder))
            wait_until(lambda: glob.glob(name), name)
        if block.startswith(BACKGROUND):
            log = open(self.folder / f'terminal{len(self._terminals)}.log', 'w')
            self._terminals.append(subprocess.Popen(
                ['bash', '-c', f'exec {block.splitlines()[1]}'], cwd=self.folder,
                env=self.environment, stdout=log, stderr=subprocess.STDOUT,
                start_new_session=True))
            wait_until(self._master_answers, 'a master')
            return ''
        done = subprocess.run(['bash', '-ec', block], cwd=self.folder, env=self.environment,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                              timeout=COMMAND_S, check=False)
        assert done.returncode == 0, f'{block}\n{done.stdout}\n{self.logs()}'
        return done.stdout

    def _master_answers(self) -> bool:
        return subprocess.run(['rosparam', 'get', '/run_id'], env=self.environment,
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                              check=False).returncode == 0

    def logs(self) -> str:
        """Return the last lines of the terminals of their own."""
        return '\n'.join(f'{path.name}: {path.read_text()[-2000:]}'
                         for path in sorted(self.folder.glob('terminal*.log')))

    def leave(self) -> None:
        """Close all terminals, the last one first."""
        for terminal in reversed(self._terminals):
            os.killpg(terminal.pid, signal.SIGINT)
            try:
                terminal.wait(30)
            except subprocess.TimeoutExpired:
                os.killpg(terminal.pid, signal.SIGKILL)
                terminal.wait()


@pytest.fixture
def reader(tmp_path: Path) -> Iterator[Reader]:
    reader = Reader(tmp_path)
    yield reader
    reader.leave()


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
