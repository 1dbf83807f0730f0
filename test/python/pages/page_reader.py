"""Runs what a page of the documentation tells its reader to type."""
from __future__ import annotations

import functools
import glob
import os
import random
import re
import signal
import subprocess
from pathlib import Path
from typing import Any, Callable, Dict, List, Set

from conftest import wait_until, write_bag

from self_awareness_evaluation.live.processes import free_port

DOCS = Path(__file__).resolve().parents[3] / 'docs'
README = '../README.md'
COMMAND = re.compile(r'# |(?:(?:ros|dask-|catkin_)\w+|apt|bash|c[dp]|cmake|git|pip3?|python3|'
                     r'source|sudo|scripts/\S+)\s')
BACKGROUND = '# in a terminal of its own'
WAIT = re.compile(r'# when (\S+) is there')
COMMAND_S = 300.0
NODES = (('/camera', '/image', 12.5), ('/base', '/odom', 10.0))
"""Of the robot of the pages' bags: name, topic and rate [Hz]."""
LENGTH_S = 120.0
TYPED: Set[str] = set()
"""The blocks that tests type, as far as their modules are imported."""


def blocks(page: str, heading: str = '') -> List[str]:
    """Return the blocks of commands of a page, or of a part of it."""
    text = (DOCS / page).read_text(encoding='utf-8')
    text = text[text.index(heading):]
    text = text[:text.find('\n## ', 1)] if heading else text
    found = re.findall(r'^```(\w*)\n(.*?)^```', text, re.MULTILINE | re.DOTALL)
    return [block for language, block in found
            if language in ('', 'bash', 'sh') and COMMAND.match(block)]


def types(page: str, *numbers: int) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Name the blocks of a page that a test types, none: all; it fails if it omits a line."""
    chosen = [block for number, block in enumerate(blocks(page))
              if number in numbers or not numbers]
    TYPED.update(chosen)

    def decorate(test: Callable[..., None]) -> Callable[..., None]:
        @functools.wraps(test)
        def complete(**fixtures: Any) -> None:
            test(**fixtures)
            left = [line for block in chosen for line in block.splitlines()
                    if line not in fixtures['reader'].typed]
            assert not left, f'{page}: not typed: {left}'
        return complete
    return decorate


def write_recording(path: Path, start: float, prefix: str = '') -> None:
    """Write a bag of the nodes, whose periods vary by 30 %."""
    rng = random.Random(start)
    messages = []
    for source, topic, rate in NODES:
        stamp = start
        while stamp < start + LENGTH_S:
            messages.append((stamp, prefix + source, prefix + topic))
            stamp += rng.uniform(0.7, 1.3) / rate
    path.parent.mkdir(parents=True, exist_ok=True)
    write_bag(path, sorted(messages))


class Reader:
    """Somebody who types the commands of a page, in a folder and under a master of their own."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.typed = ''
        self.environment: Dict[str, str] = {
            **os.environ, 'HOME': str(folder), 'ROS_HOME': str(folder / '.ros'),
            'ROS_IP': '127.0.0.1', 'ROS_MASTER_URI': f'http://127.0.0.1:{free_port()}',
            'PATH': f'/usr/bin:{os.environ["PATH"]}'}
        self._terminals: List[subprocess.Popen] = []

    def type(self, block: str) -> str:
        """Type a block of commands; return what they print. /data is in the reader's folder."""
        self.typed += block
        block = re.sub('(?<=[ =])/data/', f'{self.folder}/data/', block)
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

    def launch(self, command: str, service: str) -> None:
        """Type a command in a terminal of its own; return when its service is there."""
        self.type(f'{BACKGROUND}\n{command}')
        self.type(f'until rosservice type {service}; do sleep 0.1; done')

    def learn(self) -> None:
        """Make a model of the robot of the bags."""
        for number in range(2):
            write_recording(self.folder / f'{number}.bag', 1000.0 * (number + 1))
        self.type('rosrun self_awareness train 0.bag 1.bag -o robot.model')

    def kill_last(self) -> None:
        """Kill what runs in the terminal that was opened last."""
        terminal = self._terminals.pop()
        os.killpg(terminal.pid, signal.SIGKILL)
        terminal.wait()

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
