"""A process that looks as if roslaunch had started it as a node."""
from __future__ import annotations

import signal
import subprocess
from contextlib import contextmanager
from pathlib import Path
from typing import Iterator

# As nodes do, it handles SIGTERM: the kernel ends others by it even while they are stopped.
_NODE = """
import signal, sys, time
signal.signal(signal.SIGTERM, {handler})
print("up", flush=True)
while True:
    time.sleep(0.05)
"""


@contextmanager
def launched(folder: Path, *words: str, deaf: bool = False, by: str = 'roslaunch'
             ) -> Iterator[int]:
    """Hand out the process id of a program with these arguments, below one called `by`.

    Args:
        folder: for what is started.
        words: the program's arguments.
        deaf: it does not end by SIGTERM.
        by: name of the program that starts it.
    """
    program = folder / 'node.py'
    program.write_text(_NODE.format(
        handler='signal.SIG_IGN' if deaf else 'lambda *_: sys.exit()'))
    launcher = folder / by
    launcher.write_text('#!/bin/bash\n/usr/bin/python3 "$@" &\necho $!\nwait\nwait\n')
    launcher.chmod(0o755)
    with subprocess.Popen((launcher, program, *words), stdout=subprocess.PIPE, text=True
                          ) as process:
        lines = sorted(process.stdout.readline().strip() for _ in range(2))
        pid = int(lines[0])
        try:
            yield pid
        finally:
            for each in (pid, process.pid):
                subprocess.run(('kill', f'-{signal.SIGKILL:d}', str(each)), check=False,
                               stderr=subprocess.DEVNULL)
