#!/usr/bin/python3
"""Benchmark of `train` on a bag with images, beside programs that only iterate over it.

Makes a bag of some 1.5 GB in a temporary folder, and runs in turn a bare `rosbag::View` iteration
in C++, `rosbag.Bag.read_messages(raw=True)` in Python, `read_events` (how `train` reads its bags),
and `train`: time, CPU time, and what they read of the bag. Every program is run without work as
well: its start, with its imports, is told apart. Needs `catkin_make bags_benchmark`.
"""
from __future__ import annotations

import argparse
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any, Dict, List, NamedTuple, Optional, Sequence

import bags_report
import bags_robot
import page

_DOCS = Path(__file__).resolve().parents[1] / 'docs'
_SECONDS = 160.0
_SEED = 1
_RAW = 'import sys, rosbag\nfor _ in rosbag.Bag(sys.argv[1]).read_messages(raw=True): pass'
_EVENTS = ('import sys, self_awareness as s\n'
           's.read_events(sys.argv[1], s.EncodingRules.defaults())')
_PIECE_BYTES = 1 << 20


class Program(NamedTuple):
    """Something that goes through a bag, and the same program without work."""

    work: List[str]
    start: List[str]


class Usage(NamedTuple):
    """What a process used; all threads together."""

    wall_s: float
    cpu_s: float
    read_bytes: int
    """By read(2), from whatever file."""
    disk_bytes: int
    """From the disk."""


def run(command: Sequence[str]) -> Usage:
    """Run a program to its end.

    Raises:
        RuntimeError: it failed.
    """
    begin = time.perf_counter()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)  # the process's counts are kept
    wall = time.perf_counter() - begin
    io = dict(line.split(': ') for line in
              Path(f'/proc/{process.pid}/io').read_text().splitlines())
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = status
    if status != 0:
        raise RuntimeError(f'{" ".join(command)} failed')
    return Usage(wall, usage.ru_utime + usage.ru_stime, int(io['rchar']), int(io['read_bytes']))


def forget(path: str) -> None:
    """Take a file out of the page cache."""
    with open(path, 'rb') as file:
        os.fsync(file.fileno())
        os.posix_fadvise(file.fileno(), 0, 0, os.POSIX_FADV_DONTNEED)


def warm(path: str) -> None:
    """Bring a file into the page cache."""
    with open(path, 'rb') as file:
        while file.read(_PIECE_BYTES):
            pass


def programs(bag: str, model: str) -> Dict[str, Program]:
    """Return what is measured, by name; 'view' is what the others are compared with.

    Raises:
        FileNotFoundError: it is not built.
    """
    view = _built('bags_view_iteration')
    train = _built('train')
    return {
        'view': Program([view, bag], [view]),
        'read_messages': Program([sys.executable, '-c', _RAW, bag],
                                 [sys.executable, '-c', 'import rosbag']),
        'read_events': Program([sys.executable, '-c', _EVENTS, bag],
                               [sys.executable, '-c', 'import self_awareness']),
        'train': Program([train, bag, '-o', model], [train, '--help']),
    }


def measure(bag: str, model: str, rounds: int) -> Dict[str, Any]:
    """Return the medians of every program, and what it reads of a bag that no cache holds."""
    chosen = programs(bag, model)
    work: Dict[str, List[Usage]] = {name: [] for name in chosen}
    start: Dict[str, List[Usage]] = {name: [] for name in chosen}
    warm(bag)
    for _ in range(rounds):
        for name, program in chosen.items():
            start[name].append(run(program.start))
            work[name].append(run(program.work))
    result = {}
    for name, program in chosen.items():
        forget(bag)
        cold = run(program.work)
        result[name] = {
            'wall_s': _median(work[name], 'wall_s'),
            'cpu_s': _median(work[name], 'cpu_s'),
            'start_wall_s': _median(start[name], 'wall_s'),
            'start_cpu_s': _median(start[name], 'cpu_s'),
            'read_bytes': _median(work[name], 'read_bytes') - _median(start[name], 'read_bytes'),
            'cold_disk_bytes': cold.disk_bytes,
            'cold_wall_s': cold.wall_s,
        }
    return result


def main(argv: Optional[Sequence[str]] = None) -> int:
    """Run the benchmark; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.split('\n', 1)[0])
    parser.add_argument('--seconds', type=float, default=_SECONDS, metavar='S',
                        help=f'of the recording, 10 MB each (default: {_SECONDS:g})')
    parser.add_argument('--rounds', type=int, default=11, metavar='N',
                        help='runs of every program, in turn (default: 11)')
    parser.add_argument('--folder', default=tempfile.gettempdir(), metavar='DIR',
                        help='where the bag is made (default: %(default)s)')
    parser.add_argument('--output', type=Path, default=_DOCS, metavar='DIR',
                        help='where performance.md and performance/bags.json are (default: docs)')
    arguments = parser.parse_args(argv)
    with tempfile.TemporaryDirectory(dir=arguments.folder) as folder:
        bag = os.path.join(folder, 'robot.bag')
        print('making the bag', file=sys.stderr)
        messages = bags_robot.write(bag, arguments.seconds, _SEED)
        print('measuring', file=sys.stderr)
        result = dict(page.machine(), rounds=arguments.rounds, seconds=arguments.seconds,
                      messages=messages, bag_bytes=os.path.getsize(bag),
                      programs=measure(bag, os.path.join(folder, 'robot.model'),
                                       arguments.rounds))
    page.publish('bags', result, bags_report.markdown(result), arguments.output)
    print(bags_report.markdown(result))
    return 0


def _built(name: str) -> str:
    for folder in os.environ.get('CMAKE_PREFIX_PATH', '').split(':'):
        path = os.path.join(folder, 'lib', 'self_awareness', name)
        if os.access(path, os.X_OK):
            return path
    raise FileNotFoundError(f'{name} is not built, or its workspace not sourced: catkin_make '
                            'bags_benchmark')


def _median(usages: Sequence[Usage], field: str) -> float:
    return statistics.median(getattr(usage, field) for usage in usages)


if __name__ == '__main__':
    sys.exit(main())
