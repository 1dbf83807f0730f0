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
import random
import statistics
import sys
import tempfile
from typing import Any, Dict, Iterator, List, NamedTuple, Sequence, Tuple

import genpy
import rosbag
from geometry_msgs.msg import PoseWithCovarianceStamped, TwistStamped
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Log
from sensor_msgs.msg import BatteryState, CameraInfo, Image, Imu, JointState, MagneticField, Range

import page
import timers
from page import Usage, built, run_program

_SECONDS = 160.0  # 10 MB each
_SEED = 1
_JOBS = (1, 2)
_PARTS = 8
_PART_SECONDS = 120.0
_PART_TYPES = 300
_RAW = 'import sys, rosbag\nfor _ in rosbag.Bag(sys.argv[1]).read_messages(raw=True): pass'
_EVENTS = ('import sys, self_awareness as s\n'
           's.read_events(sys.argv[1], s.EncodingRules.defaults())')
_PIECE_BYTES = 1 << 20
_START_S = 1_600_000_000
_IMAGE = Image(height=480, width=640, encoding='rgb8', step=1920)
_IMAGE_BYTES = _IMAGE.step * _IMAGE.height
_LOG_EVERY_S = 2.0
_SHORTEST_STEP_S = 1e-5  # between two messages of one topic
_NAMES = {'view': '`rosbag::View`, C++', 'read_messages': '`read_messages(raw=True)`, Python',
          'read_events': '`read_events`', 'train': '`train`'}


def warm(path: str) -> None:
    """Bring a file into the page cache."""
    with open(path, 'rb') as file:
        while file.read(_PIECE_BYTES):
            pass


def programs(bag: str, model: str) -> Dict[str, Tuple[List[str], List[str]]]:
    """Return the programs to measure, by name, each with work and without; the others are compared
    with 'view'.

    Raises:
        FileNotFoundError: a program is not built.
    """
    view, train, python = built('bags_view_iteration'), built('train'), [sys.executable, '-c']
    return {'view': ([view, bag], [view]),
            'read_messages': ([*python, _RAW, bag], [*python, 'import rosbag']),
            'read_events': ([*python, _EVENTS, bag], [*python, 'import self_awareness']),
            'train': ([train, bag, '-o', model], [train, '--help'])}


def measure(bag: str, model: str, rounds: int) -> Dict[str, Any]:
    """Return the medians of every program, and how much it reads."""
    chosen = programs(bag, model)
    work, start = ({name: [] for name in chosen} for _ in range(2))
    warm(bag)
    for _ in range(rounds):
        for name, (with_work, without) in chosen.items():
            start[name].append(run_program(without))
            work[name].append(run_program(with_work))
    return {name: {
        'wall_s': _median(work[name], 'wall_s'), 'start_wall_s': _median(start[name], 'wall_s'),
        'read_bytes': _median(work[name], 'read_bytes') - _median(start[name], 'read_bytes')}
            for name in chosen}


def measure_images(folder: str, rounds: int) -> Dict[str, Any]:
    """Make a bag with images, and measure every program on it."""
    bag = os.path.join(folder, 'robot.bag')
    print('making the bag', file=sys.stderr)
    messages = _write(bag, _SECONDS, _SEED)
    print('measuring', file=sys.stderr)
    result = dict(page.machine(), rounds=rounds, seconds=_SECONDS, messages=messages,
                  bag_bytes=os.path.getsize(bag),
                  programs=measure(bag, os.path.join(folder, 'robot.model'), rounds))
    os.remove(bag)
    return result


def measure_jobs(folder: str, rounds: int) -> Dict[str, Any]:
    """Make bags of many event types; return medians by --jobs."""
    print('making the bags', file=sys.stderr)
    bags, messages = timers.write(folder, _PARTS, _PART_TYPES, _PART_SECONDS)
    for bag in bags:
        warm(bag)
    print('measuring', file=sys.stderr)
    usages: Dict[int, List[Usage]] = {jobs: [] for jobs in _JOBS}
    for _ in range(rounds):
        for jobs, of_jobs in usages.items():
            of_jobs.append(run_program([built('train'), *bags, '-o', os.path.join(folder, 'm'),
                                        '--jobs', str(jobs)]))
    return dict(page.machine(), rounds=rounds, seconds=_PART_SECONDS, bags=_PARTS,
                types=_PART_TYPES, messages=messages,
                jobs={str(jobs): {'wall_s': _median(of_jobs, 'wall_s')}
                      for jobs, of_jobs in usages.items()})


def markdown(result: Dict[str, Any]) -> str:
    """Return the section of docs/performance.md, with a line on --jobs if it was measured."""
    programs = result['programs']
    size = result['bag_bytes']
    return '\n'.join([
        f'{size / 1e9:.2f} GB with images, {result["messages"]:,} messages, in the page cache; in '
        'brackets, times `rosbag::View`.', '',
        '| | whole process | without start | read |', '|---|--:|--:|--:|', *(
            f'| {_NAMES[name]} | {_time(programs, name, False)} | {_time(programs, name, True)} '
            f'| {100 * program["read_bytes"] / size:.1f} % |'
            for name, program in programs.items()),
        *(['', _jobs(result['jobs'])] if 'jobs' in result else [])])


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


def main() -> None:
    """Run the benchmark."""
    parser = page.parser('bags', __doc__.split('\n', 1)[0])
    parser.add_argument('--rounds', type=int, default=11, metavar='N',
                        help='runs of every program, in turn (default: 11)')
    parser.add_argument('--only', choices=('images', 'jobs'),
                        help='measure one part again; the other one stays as bags.json has it')
    arguments = parser.parse_args()
    before = arguments.output / 'performance' / 'bags.json'
    result: Dict[str, Any] = json.loads(before.read_text()) if arguments.only else {}
    with tempfile.TemporaryDirectory() as folder:
        if arguments.only != 'jobs':
            result.update(measure_images(folder, arguments.rounds))
        if arguments.only != 'images':
            result['jobs'] = measure_jobs(folder, arguments.rounds)
    page.publish('bags', result, markdown(result), arguments.output)
    print(markdown(result))


class _Topic(NamedTuple):
    """What a node publishes each `every` of its cycles, `delay` [s] after the cycle's start."""

    name: str
    kind: Any
    every: int = 1
    delay: float = 0.0


_NODES: Dict[str, Tuple[float, List[_Topic]]] = {
    '/camera': (10.0, [_Topic('/camera/image_raw', _IMAGE),
                       _Topic('/camera/camera_info', CameraInfo(D=[0.0] * 5), 1, 0.0005),
                       _Topic('/camera/temperature', BatteryState(), 10, 0.001)]),
    '/imu': (200.0, [_Topic('/imu/data', Imu()), _Topic('/imu/mag', MagneticField(), 4, 0.0004),
                     _Topic('/imu/raw', Imu(), 1, 0.0002)]),
    '/base': (100.0, [_Topic('/odom', Odometry()), _Topic('/joint_states', JointState(), 1, 0.001),
                      _Topic('/battery', BatteryState(), 100, 0.002),
                      _Topic('/wheel_speed', TwistStamped(), 1, 0.0005)]),
    '/sonar': (40.0, [_Topic(f'/sonar/{i}', Range(), 1, 0.002 * i) for i in range(6)]),
    '/filter': (100.0, [_Topic('/filter/pose', PoseWithCovarianceStamped()),
                        _Topic('/filter/twist', TwistStamped(), 1, 0.0003),
                        _Topic('/filter/odom', Odometry(), 2, 0.0006)]),
    '/planner': (20.0, [_Topic('/plan/twist', TwistStamped()),
                        _Topic('/plan/goal', PoseWithCovarianceStamped(), 40, 0.003),
                        _Topic('/plan/state', JointState(), 2, 0.001)]),
    '/arm': (50.0, [_Topic('/arm/joint_states', JointState(position=[0.0] * 6)),
                    _Topic('/arm/wrench', TwistStamped(), 1, 0.0008),
                    _Topic('/arm/goal', JointState(position=[0.0] * 6), 5, 0.002)]),
    '/guard': (25.0, [_Topic('/guard/twist', TwistStamped()),
                      _Topic('/guard/range', Range(), 1, 0.004),
                      _Topic('/guard/state', BatteryState(), 25, 0.001)]),
}
"""Cycles a second and topics, by node; every node also logs from time to time."""


def _write(path: str, seconds: float, seed: int) -> int:
    """Write the bag with images, uncompressed, with rosbag's default size of chunks; return the
    number of messages."""
    rng = random.Random(seed)
    pixels = rng.getrandbits(8 * _IMAGE_BYTES).to_bytes(_IMAGE_BYTES, 'little')
    messages = sorted(_messages(seconds, rng), key=lambda message: message[0])
    with rosbag.Bag(path, 'w') as bag:
        for stamp, node, topic, kind in messages:
            time = genpy.Time.from_sec(stamp)
            if kind is _IMAGE:
                kind.data = pixels
            bag.write(topic, kind, time, connection_header={
                'topic': topic, 'callerid': node, 'type': kind._type, 'md5sum': kind._md5sum,
                'message_definition': kind._full_text, 'latching': '0'})
    return len(messages)


def _messages(seconds: float, rng: random.Random) -> Iterator[Tuple[float, str, str, Any]]:
    for node, (rate, topics) in _NODES.items():
        stamp = _START_S + rng.random()
        cycle = 0
        while stamp < _START_S + seconds:
            for topic in topics:
                if cycle % topic.every == 0:
                    delay = topic.delay * rng.uniform(0.5, 1.5)
                    yield stamp + delay, node, topic.name, topic.kind
            cycle += 1
            stamp += max(rng.gauss(1.0, 0.03) / rate, _SHORTEST_STEP_S)
        stamp = _START_S + rng.expovariate(1.0 / _LOG_EVERY_S)
        log = Log(level=Log.INFO, name=node, msg='nothing out of the ordinary', line=42)
        while stamp < _START_S + seconds:
            yield stamp, node, '/rosout', log
            stamp += rng.expovariate(1.0 / _LOG_EVERY_S)


def _median(usages: Sequence[Usage], field: str) -> float:
    return statistics.median(getattr(usage, field) for usage in usages)


if __name__ == '__main__':
    main()
