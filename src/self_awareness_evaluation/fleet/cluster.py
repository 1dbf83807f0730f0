"""A cluster of dask.distributed on this machine, as docs/fleet.md starts one on several."""
from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import time
from contextlib import ExitStack, closing, contextmanager
from pathlib import Path
from typing import Iterator

from self_awareness.workers import Cluster, Workers

_STARTS_WITHIN_S = 60.0
_LOOKS_EVERY_S = 0.1


@contextmanager
def cluster_here(processes: int) -> Iterator[Workers]:
    """Start a scheduler and so many workers of one thread, and end them.

    Raises:
        ValueError: dask.distributed is not installed, or the scheduler does not start.
    """
    with tempfile.TemporaryDirectory() as name, ExitStack() as running:
        folder = Path(name)
        file = folder / 'scheduler.json'
        scheduler = running.enter_context(_process(
            folder, 'scheduler', '--port', '0', '--scheduler-file', str(file)))
        address = _address(file, scheduler, folder / 'scheduler.log')
        for number in range(processes):
            running.enter_context(_process(
                folder, 'worker', address, '--nthreads', '1', '--no-nanny', '--worker-port', '0',
                '--local-directory', str(folder / f'{number}')))
        yield running.enter_context(closing(Cluster(address)))


@contextmanager
def _process(folder: Path, kind: str, *arguments: str) -> Iterator[subprocess.Popen]:
    with open(folder / f'{kind}.log', 'ab') as log:
        process = subprocess.Popen(
            [sys.executable, '-m', f'distributed.cli.dask_{kind}', *arguments, '--host',
             '127.0.0.1', '--no-dashboard'], cwd=folder, stdout=log, stderr=log)
    try:
        yield process
    finally:
        process.kill()  # nothing that it holds is wanted any more
        process.wait()


def _address(file: Path, scheduler: subprocess.Popen, log: Path) -> str:
    """Return where a scheduler listens, by the file that it writes.

    Raises:
        ValueError: it does not.
    """
    end = time.monotonic() + _STARTS_WITHIN_S
    while time.monotonic() < end and scheduler.poll() is None:
        try:
            return str(json.loads(file.read_text(encoding='utf-8'))['address'])
        except (FileNotFoundError, json.JSONDecodeError):  # it is not there yet, or not whole
            time.sleep(_LOOKS_EVERY_S)
    said = log.read_text(encoding='utf-8', errors='replace').strip().split('\n')[-1]
    raise ValueError(f'--dask: the scheduler of dask.distributed does not start ({said}); its '
                     'package is python3-distributed')
