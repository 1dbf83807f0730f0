#!/usr/bin/python3
"""Benchmark of whole processes: the cost of the monitor, and of others that hear the same.

Ten nodes publish at exact rates; in turn, the monitor, a bare ShapeShifter subscriber that only
counts, and `rosbag record` listen to them on a core of their own. Needs `catkin_make
live_benchmark`; runs a master of its own on the loopback interface.
"""
from __future__ import annotations

import bisect
import contextlib
import json
import re
import statistics
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Dict, Iterator, List, Tuple

import rospy
from sensor_msgs.msg import Imu

import page
from live_robot import (LOAD_CORE, Bare, Configuration, Monitor, Record, Robot, Subject, pin,
                        train, usage, write_synthetic_model)
from self_awareness import DEFAULT_WINDOW
from self_awareness.stamps import SECOND_NS
from self_awareness_evaluation.live.processes import Processes, own_master

TOPICS = {163: 15, 1000: 60, 5000: 300, 20000: 500}  # by messages a second

_WARM_UP_S = 2.0
_MODEL_S = {163: 40.0, 1000: 40.0, 5000: 90.0, 20000: 20.0}
_DETECTION_RATE = 5000
_SETTLED_S = 8.0
_LONG_S = 600.0
_WINDOW_S = DEFAULT_WINDOW / SECOND_NS
_STARTS = 5
_MANY_TYPES = 1000
_CRASHES = 5
_WITHIN_S = 120.0
_LOADED = re.compile(r'\[([0-9.]+)\]: model .* event types')
_LEVEL_ERROR = 2


@dataclass(frozen=True)
class _Benchmark:
    _folder: Path
    _processes: Processes
    _seconds: float
    _rounds: int

    def run(self) -> Dict[str, Any]:
        costs: List[Dict[str, Any]] = []
        result: Dict[str, Any] = dict(page.machine(), seconds=self._seconds,
                                      rounds=self._rounds, costs=costs)
        for rate in TOPICS:
            # What a model knows, and does not come, raises an alarm: each learns what it judges.
            models = {image: self._folder / f'{rate}_{image}.model' for image in (False, True)}
            for image, model in models.items():
                configuration = Configuration(rate, TOPICS[rate], image)
                with Robot(configuration) as robot:
                    train(self._processes, robot, _MODEL_S[rate], model)
                with Robot(configuration) as robot:
                    costs += self._costs(robot, model)
            model = models[False]
            if rate == _DETECTION_RATE:
                with Robot(Configuration(rate, TOPICS[rate], False)) as robot:
                    result['latency'] = self._latency(robot, model)
                with Robot(Configuration(rate, TOPICS[rate], False)) as robot:
                    result['latency']['connected_s'] = self._connections(robot, model)
                many = self._folder / 'many.model'
                write_synthetic_model(many, _MANY_TYPES)
                result['latency']['loaded_s'] = {TOPICS[rate]: self._loads(model),
                                                 _MANY_TYPES: self._loads(many)}
        return result

    def _costs(self, robot: Robot, model: Path) -> List[Dict[str, Any]]:
        samples: Dict[str, List[Dict[str, float]]] = {}
        monitor = Monitor(self._processes, model)
        subjects = {'bare': Bare(self._processes, self._folder, robot.topics),
                    'monitor': monitor,
                    'record': Record(self._processes, self._folder, robot.topics)}
        with contextlib.closing(monitor):
            for _ in range(self._rounds):
                for name, subject in subjects.items():
                    samples.setdefault(name, []).append(self._sample(robot, subject))
        rows = []
        for name, of_subject in samples.items():
            rows.append({
                **robot.configuration._asdict(), 'subject': name,
                **{key: statistics.median(sample[key] for sample in of_subject)
                   for key in of_subject[0]},
                'dropped': sum(sample['dropped'] for sample in of_subject),
                'samples': [sample['cpu_share'] for sample in of_subject]})
            print(json.dumps(rows[-1]), flush=True)
        return rows

    def _sample(self, robot: Robot, subject: Subject) -> Dict[str, float]:
        process = subject.start()
        robot.await_subscribers(1)
        time.sleep(1)  # the cost of connecting does not count
        robot.start(_WARM_UP_S + self._seconds + 0.2)
        time.sleep(_WARM_UP_S)
        begin, before = time.monotonic(), usage(process.pid)
        time.sleep(self._seconds)
        end, after = time.monotonic(), usage(process.pid)
        published = robot.published()
        time.sleep(0.5)  # the last window's verdict
        counted = subject.stop()
        return {'cpu_share': (after.cpu_s - before.cpu_s) / (end - begin),
                'peak_bytes': after.peak_bytes, 'published': published,
                'dropped': published - counted}

    def _latency(self, robot: Robot, model: Path) -> Dict[str, Any]:
        """Measure from a message to its window's verdict, and from a crash to the alarm."""
        alarms = []
        published: List[float] = []  # [s since 1970]
        with contextlib.closing(Monitor(self._processes, model)) as monitor:
            monitor.start()
            robot.await_subscribers(1)
            subscriber = rospy.Subscriber(  # of the node 0, which does not crash
                robot.topics[0], Imu, lambda imu: published.append(imu.header.stamp.to_sec()))
            robot.start(_LONG_S)
            time.sleep(_SETTLED_S)
            for node in range(1, 1 + _CRASHES):
                _await_quiet(monitor, 1 + 0.37 * node)  # at another moment of a window each time
                crashed = robot.crash(node)
                alarms.append(monitor.await_level(
                    'an alarm', lambda level: level == _LEVEL_ERROR, _WITHIN_S) - crashed)
                robot.restart(node, 1, _LONG_S)
            subscriber.unregister()
            verdicts = monitor.verdicts
            monitor.stop()
        result = {'rate': robot.configuration.rate, 'topics': robot.configuration.topics,
                  'alarm_s': alarms,
                  'message_s': _summary(_waits(published, verdicts)),
                  'verdict_s': _summary([heard - end for end, heard in verdicts])}
        print(json.dumps(result), flush=True)
        return result

    def _connections(self, robot: Robot, model: Path) -> List[float]:
        """Measure from the start of the process to its connection to the last topic."""
        times = []
        with contextlib.closing(Monitor(self._processes, model)) as monitor:
            for _ in range(_STARTS):
                time.sleep(2)  # the publishers notice that the last one has gone
                begin = time.time()
                monitor.start()
                robot.await_subscribers(1)
                times.append(time.time() - begin)
                monitor.stop()
        return times

    def _loads(self, model: Path) -> List[float]:
        """Measure from the start of the process until it has loaded the model."""
        times = []
        with contextlib.closing(Monitor(self._processes, model)) as monitor:
            for _ in range(_STARTS):
                begin = time.time()
                monitor.start()
                monitor.await_level('diagnostics', lambda _: True, _WITHIN_S)
                monitor.stop()  # writes the log
                log = (self._folder / 'monitor.log').read_text()
                times.append(float(_LOADED.findall(log)[-1]) - begin)
        return times


def _waits(published: List[float], verdicts: List[Tuple[float, float]]) -> List[float]:
    """Return the times from each message until the verdict on its window was heard [s]."""
    ends = [end for end, _ in verdicts]
    waits = []
    for stamp in published:
        window = bisect.bisect_right(ends, stamp)
        if window < len(ends) and ends[window] - stamp <= _WINDOW_S:  # else it was settling
            waits.append(verdicts[window][1] - stamp)
    return waits


def _summary(seconds: List[float]) -> Dict[str, float]:
    return {'median': statistics.median(seconds), 'most': max(seconds), 'number': len(seconds)}


def _await_quiet(monitor: Monitor, seconds: float) -> None:
    """Wait until there is no alarm, and no new one comes for so long."""
    # On a machine that is busy with something else, a suspicion may stand at any time.
    while True:
        monitor.await_level('no alarm', lambda level: level < _LEVEL_ERROR, _WITHIN_S)
        time.sleep(seconds)
        if monitor.level < _LEVEL_ERROR:
            return


def markdown(result: Dict[str, Any]) -> str:
    """Return the section of docs/performance.md."""
    return '\n'.join([*_costs(result), '', *_latency(result['latency'])])


def _costs(result: Dict[str, Any]) -> Iterator[str]:
    yield '| messages/s | topics | bare | `rosbag record` | monitor | / bare | MB |'
    yield '|--:' * 7 + '|'
    configurations: Dict[Tuple[int, int, bool], Dict[str, Dict[str, Any]]] = {}
    for row in result['costs']:
        key = (row['rate'], row['topics'], row['image'])
        configurations.setdefault(key, {})[row['subject']] = row
    for rate, topics in dict.fromkeys(key[:2] for key in configurations):
        rows = [configurations[key] for key in sorted(configurations) if key[:2] == (rate, topics)]
        cells = ['; '.join(f'{100 * row[name]["cpu_share"]:.1f}' for row in rows)
                 for name in ('bare', 'record', 'monitor')]
        cells.append('; '.join(f'{row["monitor"]["cpu_share"] / row["bare"]["cpu_share"]:.2f}'
                               for row in rows))
        cells.append('; '.join(f'{row["monitor"]["peak_bytes"] / 1e6:.0f}' for row in rows))
        yield f'| {rate:,} | {topics} | {" | ".join(cells)} |'
    dropped = sum(row['dropped'] for row in result['costs'] if row['subject'] == 'monitor')
    yield ''
    yield f'Missed by the monitor: {dropped:.0f}.'


def _latency(latency: Dict[str, Any]) -> Iterator[str]:
    yield f'At {latency["rate"]:,} messages/s on {latency["topics"]} topics, median (at most):'
    yield ''
    for what, key in (('message to the verdict on its window', 'message_s'),
                      ('end of a window to its verdict', 'verdict_s')):
        yield f'- {what}: {_ms(latency[key]["median"])} ({_ms(latency[key]["most"])})'
    types, loaded_s = list(latency['loaded_s'].items())[-1]
    for what, seconds in (('`kill -9` to the alarm', latency['alarm_s']),
                          ('start until connected', latency['connected_s']),
                          (f'start until a model of {types} types is loaded', loaded_s)):
        yield f'- {what}: {_ms(statistics.median(seconds))} ({_ms(max(seconds))})'


def _ms(seconds: float) -> str:
    return f'{1000 * seconds:.3g} ms' if seconds < 1 else f'{seconds:.2f} s'


def main() -> None:
    """Run the benchmark."""
    parser = page.parser('live', __doc__)
    parser.add_argument('--seconds', type=float, default=10.0, help='of each measurement')
    parser.add_argument('--rounds', type=int, default=3, help='of all subjects, in turn')
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(dir='/dev/shm') as name:
        folder = Path(name)
        with own_master(folder, 'benchmark', pin(LOAD_CORE)) as processes:
            result = _Benchmark(folder, processes, arguments.seconds, arguments.rounds).run()
    page.publish('live', result, markdown(result), arguments.output)


if __name__ == '__main__':
    main()
