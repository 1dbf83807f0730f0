"""The robot of the live benchmark: ten nodes that publish, and a model of them."""
from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import time
from pathlib import Path
from typing import IO, List, NamedTuple, Sequence

import numpy as np

from self_awareness import (EncodingRules, EventType, Calibration, EvidenceModel,
                            Learner, TrainedModel)
from self_awareness.stamps import SECOND_NS
from self_awareness_evaluation.live.processes import Processes

NODES = 10
IMAGE_TOPIC = '/camera/image'
FULL_HD_BYTES = 1920 * 1080 * 3
LOAD_CORE = 1  # core of the publishers, the master and this program
SUBJECT_CORE = 0  # core of the program that is measured; nothing else runs on it

_PROGRAM = 'live_load'
_TRAINING_WITHIN_S = 900.0
_NEVER_REACHED = 1e6
_SYNTHETIC_EVENTS = 300
_SYNTHETIC_START_S = 1_600_000_000
_TINY_IMAGE_BYTES = 3  # training needs no payload


class Configuration(NamedTuple):
    """How much is published."""

    rate: int
    """Messages a second, without the images."""
    topics: int
    image: bool
    """Whether 30 full HD images a second are published, too."""


def pin(core: int, *command: str) -> List[str]:
    """Return the command as it runs on one core."""
    return ['taskset', '-c', str(core), *command]


class Robot:
    """The publishers of one configuration. As a context manager, it ends them."""

    def __init__(self, configuration: Configuration) -> None:
        self.configuration = configuration
        counts = [len(range(node, configuration.topics, NODES)) for node in range(NODES)]
        self._counts = [count for count in counts if count > 0]
        self._nodes = [self._start(node) for node in range(len(self._counts))]

    def _start(self, node: int) -> subprocess.Popen:
        rate = self.configuration.rate / self.configuration.topics
        command = pin(LOAD_CORE, 'rosrun', 'self_awareness', _PROGRAM, _prefix(node),
                      str(self._counts[node]), repr(rate), str(node + 1))
        if node == 0 and self.configuration.image:
            command.append(IMAGE_TOPIC)
        return subprocess.Popen([*command, f'__name:={self.node_name(node)}'],
                                stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
                                bufsize=1, start_new_session=True)

    def __enter__(self) -> Robot:
        return self

    def __exit__(self, *_: object) -> None:
        for node in self._nodes:
            _kill(node)

    @property
    def topics(self) -> List[str]:
        """All topics, the image's last, if there is one."""
        numbers = [f'{_prefix(node)}{i}' for node, count in enumerate(self._counts)
                   for i in range(count)]
        return numbers + ([IMAGE_TOPIC] if self.configuration.image else [])

    @staticmethod
    def node_name(node: int) -> str:
        """Return the name of a node, without its slash."""
        return f'component_{node}'

    def await_subscribers(self, count: int) -> None:
        """Wait until every topic has so many subscribers."""
        self._tell(f'await {count}')
        self._answers()

    def start(self, seconds: float, image_bytes: int = FULL_HD_BYTES) -> None:
        """Let all nodes publish for so long, images, if there are any, of that size; `published`
        waits for the end."""
        self._tell(f'publish {seconds} {image_bytes if self.configuration.image else 0}')

    def published(self) -> int:
        """Wait until all have published; return the number of messages."""
        return sum(int(answer) for answer in self._answers())

    def crash(self, node: int) -> float:
        """Kill one node; return when [s since 1970]."""
        stamp = time.time()
        _kill(self._nodes[node])
        return stamp

    def restart(self, node: int, subscribers: int, seconds: float) -> None:
        """Start a crashed node again, and let it publish."""
        self._nodes[node] = self._start(node)
        _write(self._nodes[node].stdin, f'await {subscribers}')
        _read(self._nodes[node].stdout)
        _write(self._nodes[node].stdin, f'publish {seconds} 0')

    def _tell(self, command: str) -> None:
        for node in self._nodes:
            _write(node.stdin, command)

    def _answers(self) -> List[str]:
        return [_read(node.stdout) for node in self._nodes]


def train(processes: Processes, robot: Robot, seconds: float, model: Path) -> None:
    """Record the robot for so long and learn a model from it.

    Where the recording is too short to find limits, there are some that are never reached: to
    judge by them takes the same work.
    """
    bag = model.with_suffix('.bag')
    recorder = processes.start('record', *record_command(bag, robot.topics))
    robot.await_subscribers(1)
    robot.start(seconds, _TINY_IMAGE_BYTES)
    robot.published()
    processes.end(recorder)
    processes.run('train', _TRAINING_WITHIN_S, 'rosrun', 'self_awareness', 'train', str(bag),
                  '--start', '1', '-o', str(model))
    bag.unlink()
    trained = TrainedModel.load(str(model))
    if trained.calibration is None:
        judge_without_alarms(trained)
        trained.save(str(model))


def judge_without_alarms(model: TrainedModel) -> None:
    """Give a model limits that are never reached."""
    calibration = Calibration()
    calibration.limits = [_NEVER_REACHED] * len(EvidenceModel(model).tracks)
    model.calibration = calibration


def write_synthetic_model(model: Path, types: int) -> None:
    """Write a model of so many event types, each 16 times a second."""
    rng = np.random.default_rng(1)
    period = SECOND_NS // 16
    ticks = np.arange(_SYNTHETIC_EVENTS)[:, None] * period
    stamps = ticks + rng.integers(0, period, types) + rng.integers(0, period // 50, (
        _SYNTHETIC_EVENTS, types))
    order = np.argsort(stamps, axis=None, kind='stable')
    learner = Learner(encoding=EncodingRules.defaults(), paper=True)
    learner.count(
        [EventType(f'/{Robot.node_name(i % NODES)}', f'/topic_{i}', 'std_msgs/String')
         for i in range(types)],
        stamps.ravel()[order] + _SYNTHETIC_START_S * SECOND_NS, order % types)
    learner.model().save(str(model))


def record_command(bag: Path, topics: Sequence[str]) -> List[str]:
    """Return the command that records topics in a bag."""
    # The command `rosbag record` would add a Python process that only waits.
    return ['rosrun', 'rosbag', 'record', '-b', '0', '--tcpnodelay', '-O', str(bag), *topics]


def _prefix(node: int) -> str:
    return f'/component_{node}/data_'


def _write(stream: IO[str], command: str) -> None:
    stream.write(command + '\n')
    stream.flush()


def _read(stream: IO[str]) -> str:
    line = stream.readline()
    if not line:
        raise RuntimeError('a node of the load ended')
    return line


def _kill(process: subprocess.Popen) -> None:
    with contextlib.suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()
