#!/usr/bin/python3
"""Benchmark of `train`: on a bag with images, and on several bags with one process and with two.

Makes a bag of some 1.5 GB in a temporary folder, and runs in turn a bare `rosbag::View` iteration
in C++, `rosbag.Bag.read_messages(raw=True)` in Python, `read_events` (how `train` reads its bags),
and `train`: time, and how much they read. To measure the start of a program with its imports, it
also runs every one without work. Needs `catkin_make bags_benchmark`.

Then it makes bags of many event types, and trains on them with one process and with two, in turn.
"""
from __future__ import annotations

import json
import os
import statistics
import sys
import tempfile
from typing import Any, Dict, List, NamedTuple, Optional, Sequence

import bags_robot
import page
import timers
from programs import Usage, built, run

_SECONDS = 160.0
_SEED = 1
_JOBS = (1, 2)
_PARTS = 8
_PART_SECONDS = 120.0
_PART_TYPES = 300
_RAW = 'import sys, rosbag\nfor _ in rosbag.Bag(sys.argv[1]).read_messages(raw=True): pass'
_EVENTS = ('import sys, self_awareness as s\n'
           's.read_events(sys.argv[1], s.EncodingRules.defaults())')
_PIECE_BYTES = 1 << 20
_NAMES = {'view': '`rosbag::View`, C++', 'read_messages': '`read_messages(raw=True)`, Python',
          'read_events': '`read_events`', 'train': '`train`'}


class Program(NamedTuple):
    """A program that reads a bag, and the same program without work."""

    work: List[str]
    start: List[str]


def warm(path: str) -> None:
    """Bring a file into the page cache."""
    with open(path, 'rb') as file:
        while file.read(_PIECE_BYTES):
            pass


def programs(bag: str, model: str) -> Dict[str, Program]:
    """Return the programs to measure, by name; the others are compared with 'view'.

    Raises:
        FileNotFoundError: a program is not built.
    """
    view = built('bags_view_iteration')
    train = built('train')
    return {
        'view': Program([view, bag], [view]),
        'read_messages': Program([sys.executable, '-c', _RAW, bag],
                                 [sys.executable, '-c', 'import rosbag']),
        'read_events': Program([sys.executable, '-c', _EVENTS, bag],
                               [sys.executable, '-c', 'import self_awareness']),
        'train': Program([train, bag, '-o', model], [train, '--help']),
    }


def measure(bag: str, model: str, rounds: int) -> Dict[str, Any]:
    """Return the medians of every program, and how much it reads."""
    chosen = programs(bag, model)
    work: Dict[str, List[Usage]] = {name: [] for name in chosen}
    start: Dict[str, List[Usage]] = {name: [] for name in chosen}
    warm(bag)
    for _ in range(rounds):
        for name, program in chosen.items():
            start[name].append(run(program.start))
            work[name].append(run(program.work))
    return {name: {
        'wall_s': _median(work[name], 'wall_s'), 'start_wall_s': _median(start[name], 'wall_s'),
        'read_bytes': _median(work[name], 'read_bytes') - _median(start[name], 'read_bytes')}
            for name in chosen}


def measure_images(folder: str, seconds: float, rounds: int) -> Dict[str, Any]:
    """Make a bag with images, and measure every program on it."""
    bag = os.path.join(folder, 'robot.bag')
    print('making the bag', file=sys.stderr)
    messages = bags_robot.write(bag, seconds, _SEED)
    print('measuring', file=sys.stderr)
    result = dict(page.machine(), rounds=rounds, seconds=seconds, messages=messages,
                  bag_bytes=os.path.getsize(bag),
                  programs=measure(bag, os.path.join(folder, 'robot.model'), rounds))
    os.remove(bag)
    return result


def measure_jobs(folder: str, seconds: float, rounds: int) -> Dict[str, Any]:
    """Make bags of many event types, of so many seconds each; return medians by --jobs."""
    print('making the bags', file=sys.stderr)
    bags, messages = timers.write(folder, _PARTS, _PART_TYPES, seconds)
    for bag in bags:
        warm(bag)
    print('measuring', file=sys.stderr)
    usages: Dict[int, List[Usage]] = {jobs: [] for jobs in _JOBS}
    for _ in range(rounds):
        for jobs, of_jobs in usages.items():
            of_jobs.append(run([built('train'), *bags, '-o', os.path.join(folder, 'm'),
                                '--jobs', str(jobs)]))
    return dict(page.machine(), rounds=rounds, seconds=seconds, bags=_PARTS,
                types=_PART_TYPES, messages=messages,
                jobs={str(jobs): {'wall_s': _median(of_jobs, 'wall_s')}
                      for jobs, of_jobs in usages.items()})


def markdown(result: Dict[str, Any]) -> str:
    """Return the section of docs/performance.md, with a line on --jobs if it was measured."""
    programs = result['programs']
    size = result['bag_bytes']
    lines = [
        f'{size / 1e9:.2f} GB with images, {result["messages"]:,} messages, in the page cache; in '
        'brackets, times `rosbag::View`.', '',
        '| | whole process | without start | read |', '|---|--:|--:|--:|']
    for name, program in programs.items():
        lines.append(f'| {_NAMES[name]} | {_time(programs, name, False)} '
                     f'| {_time(programs, name, True)} '
                     f'| {100 * program["read_bytes"] / size:.1f} % |')
    return '\n'.join(lines) + (f'\n\n{_jobs(result["jobs"])}' if 'jobs' in result else '')


def _jobs(result: Dict[str, Any]) -> str:
    alone = result['jobs']['1']['wall_s']
    return (f'`train` on {result["bags"]} bags of {result["types"]} event types, '
            f'{result["messages"]:,} messages, {result["cores"]} cores: ' + ', '.join(
                f'`--jobs {jobs}` {usage["wall_s"]:.2f} s ({alone / usage["wall_s"]:.2f})'
                for jobs, usage in result['jobs'].items()) + '.')


def _time(programs: Dict[str, Any], name: str, alone: bool) -> str:
    def of(program: Dict[str, float]) -> float:
        return program['wall_s'] - (program['start_wall_s'] if alone else 0.0)
    seconds = of(programs[name])
    return f'{seconds:.2f} s ({seconds / of(programs["view"]):.2f})'


def main(argv: Optional[Sequence[str]] = None) -> int:
    """Run the benchmark; return the exit code."""
    parser = page.parser('bags', __doc__.split('\n', 1)[0])
    parser.add_argument('--seconds', type=float, default=_SECONDS, metavar='S',
                        help=f'of the bag with images, 10 MB each (default: {_SECONDS:g})')
    parser.add_argument('--rounds', type=int, default=11, metavar='N',
                        help='runs of every program, in turn (default: 11)')
    parser.add_argument('--folder', default=tempfile.gettempdir(), metavar='DIR',
                        help='where the bag is made (default: %(default)s)')
    parser.add_argument('--only', choices=('images', 'jobs'),
                        help='measure one part again; the other one stays as bags.json has it')
    parser.add_argument('--part-seconds', type=float, default=_PART_SECONDS, metavar='S',
                        help=f'of each bag for --jobs (default: {_PART_SECONDS:g})')
    arguments = parser.parse_args(argv)
    result: Dict[str, Any] = {}
    if arguments.only is not None:
        result = json.loads((arguments.output / 'performance' / 'bags.json').read_text())
    with tempfile.TemporaryDirectory(dir=arguments.folder) as folder:
        if arguments.only != 'jobs':
            result.update(measure_images(folder, arguments.seconds, arguments.rounds))
        if arguments.only != 'images':
            result['jobs'] = measure_jobs(folder, arguments.part_seconds, arguments.rounds)
    page.publish('bags', result, markdown(result), arguments.output)
    print(markdown(result))
    return 0


def _median(usages: Sequence[Usage], field: str) -> float:
    return statistics.median(getattr(usage, field) for usage in usages)


if __name__ == '__main__':
    sys.exit(main())
