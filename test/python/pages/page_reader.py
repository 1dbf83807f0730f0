"""Runs what a page of the documentation tells its reader to type."""
from __future__ import annotations

import glob
import os
import re
import signal
import socket
import subprocess
from pathlib import Path
from typing import Dict, List

from conftest import wait_until

DOCS = Path(__file__).resolve().parents[3] / 'docs'
BACKGROUND = '# in a terminal of its own'
WAIT = re.compile(r'# when (\S+) is there')
COMMAND_S = 300.0


def blocks(page: str, heading: str = '') -> List[str]:
    """Return the blocks of commands of a page, or of a part of it."""
    text = (DOCS / page).read_text(encoding='utf-8')
    text = text[text.index(heading):]
    text = text[:text.find('\n## ', 1)] if heading else text
    found = re.findall(r'^```\n(.*?)^```', text, re.MULTILINE | re.DOTALL)
    return [block for block in found if re.match(r'#|roslaunch|rosrun|rosservice|rostopic', block)]


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
