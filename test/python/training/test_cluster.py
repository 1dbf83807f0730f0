"""Training on a real cluster of dask.distributed, on loopback."""
from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from contextlib import closing
from pathlib import Path
from typing import Dict, Iterator, List, Optional

import numpy as np
import pytest
from conftest import error_of, jittery_robot, learned, trained, wait_until, write_bag

from self_awareness import TrainedModel, workers
from self_awareness.commands import train

distributed = pytest.importorskip(
    'distributed', reason='dask.distributed (python3-distributed) is not installed')

SCRIPT = Path(__file__).resolve().parents[3] / 'scripts' / 'train'
DEADLINE_S = 60.0


class Cluster:
    """A scheduler and workers, each a process of its own."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.workers: Dict[str, subprocess.Popen] = {}
        self._processes: List[subprocess.Popen] = []
        self._file = folder / 'scheduler.json'
        self.scheduler = self._start('scheduler', '--port', '0', '--scheduler-file',
                                     str(self._file))
        wait_until(self._written, 'the scheduler starts')
        self.address = json.loads(self._file.read_text())['address']
        self.client = distributed.Client(self.address, set_as_default=False)

    def add_worker(self, name: str, path: Optional[str] = None) -> None:
        """Start a worker, with one thread; return when it works.

        Args:
            name: of the worker.
            path: where it looks for Python modules; None: where this process does.
        """
        self.workers[name] = self._start(
            'worker', self.address, '--name', name, '--nthreads', '1', '--no-nanny',
            '--local-directory', str(self.folder / name), '--worker-port', '0', path=path)
        wait_until(lambda: self.address_of(name), f'worker {name} starts')
        # The scheduler knows it before it takes tasks: who is stopped then never gets one.
        self.client.submit(int, workers=[self.address_of(name)], pure=False).result(DEADLINE_S)

    def address_of(self, name: str) -> str:
        """Return where a worker listens; '': it is not there."""
        workers = self.client.scheduler_info()['workers']
        return next((address for address, worker in workers.items() if worker['name'] == name),
                    '')

    def close(self) -> None:
        """End all processes."""
        self.client.close()
        for process in self._processes:
            process.kill()
            process.wait()

    def _start(self, kind: str, *arguments: str, path: Optional[str] = None) -> subprocess.Popen:
        environment = dict(os.environ) if path is None else {**os.environ, 'PYTHONPATH': path}
        process = subprocess.Popen(
            [sys.executable, '-m', f'distributed.cli.dask_{kind}', *arguments, '--host',
             '127.0.0.1', '--no-dashboard'], cwd=str(self.folder), env=environment,
            stderr=subprocess.DEVNULL)
        self._processes.append(process)
        return process

    def _written(self) -> bool:
        try:
            return bool(json.loads(self._file.read_text()))
        except (FileNotFoundError, json.JSONDecodeError):
            return False


@pytest.fixture(name='cluster')
def _cluster(tmp_path: Path) -> Iterator[Cluster]:
    cluster = Cluster(tmp_path)
    try:
        yield cluster
    finally:
        cluster.close()


@pytest.fixture(scope='module', name='bags')
def _bags(tmp_path_factory: pytest.TempPathFactory) -> List[str]:
    folder = tmp_path_factory.mktemp('bags')
    return [write_bag(folder / f'{index}.bag', jittery_robot(1000.0 * index, 40.0, index))
            for index in range(1, 10)]


@pytest.fixture(scope='module', name='expected')
def _expected(bags: List[str], tmp_path_factory: pytest.TempPathFactory) -> TrainedModel:
    return trained(bags, tmp_path_factory.mktemp('expected') / 'm', '--jobs', '1')


def started(cluster: Cluster, arguments: List[str], output: Path,
            cwd: Optional[Path] = None) -> subprocess.Popen:
    """Start a training on the cluster, which writes the model m in a folder."""
    return subprocess.Popen([sys.executable, str(SCRIPT), *arguments, '-o', str(output / 'm'),
                             '--details', '--scheduler', cluster.address], cwd=cwd,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def test_a_worker_is_killed_and_the_result_is_right(cluster: Cluster, bags: List[str],
                                                    expected: TrainedModel,
                                                    tmp_path: Path) -> None:
    cluster.add_worker('other')
    victim, process = cluster.address_of('other'), cluster.workers['other']
    # What it gets it will never finish; the scheduler cannot know. As long as it is alone, it gets
    # the first task: between two, the scheduler of Debian 11 may give all to the one that is done.
    os.kill(process.pid, signal.SIGSTOP)
    missing = str(tmp_path / 'missing.bag')
    names = [Path(bag).name for bag in bags]  # the workers are in other folders
    training = started(cluster, [missing, *names, '--skip-bad'], tmp_path, Path(bags[0]).parent)
    wait_until(lambda: cluster.client.processing()[victim], 'the worker gets a task')
    lost = cluster.client.processing()[victim]
    cluster.add_worker('one')
    os.kill(process.pid, signal.SIGKILL)
    out, err = training.communicate(timeout=DEADLINE_S)
    assert training.returncode == 0, err
    assert err.splitlines() == [f'train: warning: skipped: {missing}: no such file']
    assert lost and not cluster.address_of('other') and cluster.address_of('one')
    with closing(workers.Cluster(cluster.address)) as one_worker:
        assert one_worker.batches(len(bags)) == 2, 'sums are made on the cluster'
    told = [line.split(': ')[0] for line in out.splitlines()]
    assert [each for each in told if each in bags] == bags
    model = TrainedModel.load(str(tmp_path / 'm'))
    assert np.isfinite(model.calibration.limits).any()
    assert learned(model, calibrations=True) == learned(expected, calibrations=True)


def test_workers_without_the_package_are_told(cluster: Cluster, bags: List[str],
                                              tmp_path: Path) -> None:
    cluster.add_worker('one', path='')
    arguments = [*bags, '-o', str(tmp_path / 'm'), '--scheduler', cluster.address]
    error = error_of(train, arguments)
    assert error.startswith(f'train: error: --scheduler {cluster.address}: its workers lack')
    assert "No module named 'self_awareness'" in error and 'setup.bash' in error


def test_a_scheduler_that_dies_is_told(cluster: Cluster, bags: List[str], tmp_path: Path) -> None:
    cluster.add_worker('one')
    victim = cluster.address_of('one')
    training = started(cluster, bags, tmp_path)
    wait_until(lambda: cluster.client.processing()[victim], 'the worker gets a task')
    cluster.scheduler.kill()
    _, err = training.communicate(timeout=DEADLINE_S)
    assert training.returncode == 1
    assert err.startswith(f'train: error: --scheduler {cluster.address}: the connection was lost')
    assert err.count('\n') == 1, err
    assert not (tmp_path / 'm').exists()


def test_nobody_at_the_address(bags: List[str], tmp_path: Path, monkeypatch) -> None:
    monkeypatch.setattr('self_awareness.workers._CONNECT_S', 1.0)
    for address in ('127.0.0.1:1', 'tcp://127.0.0.1:1', 'nonsense://x', 'none'):
        error = error_of(train, [*bags, '-o', str(tmp_path / 'm'), '--scheduler', address])
        assert error.startswith(f'train: error: --scheduler {address}: no scheduler'), error


def test_without_dask_its_package_is_named(bags: List[str], tmp_path: Path, monkeypatch) -> None:
    monkeypatch.setitem(sys.modules, 'distributed', None)
    assert 'python3-distributed' in error_of(
        train, [*bags, '-o', str(tmp_path / 'm'), '--scheduler', '127.0.0.1:1'])
