"""Fixtures of the Python tests: real recordings, and small bags made to measure."""
from __future__ import annotations

import contextlib
import copy
import importlib
import io
import json
import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import (Any, Callable, Iterable, Iterator, NamedTuple, Optional, Sequence, Tuple,
                    Union)

import pytest
import rosbag
import rospy
from std_msgs.msg import Header, String

from self_awareness import VERSION, LimitFindings, TrainedModel, Tuning

Message = Tuple[float, str, str]
"""Stamp [s], source, topic."""


@pytest.fixture(scope='session')
def shared() -> Path:
    """The folder of vectors and real recordings, which are not part of the package."""
    folder = Path(os.environ.get('SELF_AWARENESS_SHARED',
                                 str(Path(__file__).resolve().parents[3] / 'shared')))
    if not folder.is_dir():
        pytest.skip(f'no folder {folder}; set SELF_AWARENESS_SHARED to where it is')
    return folder


@pytest.fixture
def reader(tmp_path: Path) -> Iterator[Any]:
    """Somebody who types what a page says; it ends all that was started."""
    from page_reader import Reader
    reader = Reader(tmp_path)
    yield reader
    reader.leave()


def put(bag: rosbag.Bag, source: str, topic: str, message: Any, stamp: float) -> None:
    """Write a message as `rosbag record` does, with the name of its sender.

    Args:
        source: the sender; '': it is not told.
        stamp: when it was recorded [s].
    """
    header = {'topic': topic, 'type': message._type, 'md5sum': message._md5sum,
              'message_definition': message._full_text}
    bag.write(topic, message, rospy.Time.from_sec(stamp),
              connection_header={**header, 'callerid': source} if source else header)


def write_bag(path: Path, messages: Iterable[Message], sources: bool = True,
              compression: str = rosbag.Compression.NONE, text: Optional[str] = None) -> str:
    """Write std_msgs/String messages, or std_msgs/Header ones with `text` in frame_id.

    Returns:
        the path, as the programs take it.
    """
    with rosbag.Bag(str(path), 'w', compression=compression) as bag:
        for index, (stamp, source, topic) in enumerate(messages):
            put(bag, source if sources else '', topic, String('x') if text is None
                else Header(frame_id=text.format(index)), stamp)
    return str(path)


def robot(start: float, length: float = 30.0) -> Iterable[Message]:
    """A robot of three components: a laser, what follows it after 31 ms, and a slow one beside.

    The periods are no multiples of each other, and the follower's delay varies by 6 ms.
    """
    messages = []
    for i in range(int(length / 0.05)):
        messages.append((start + 0.05 * i, '/laser', '/scan'))
        messages.append((start + 0.05 * i + 0.031 + 0.002 * (i * 7 % 4), '/slam', '/map'))
    for i in range(int((length - 0.011) / 0.37) + 1):
        messages.append((start + 0.011 + 0.37 * i, '/battery', '/charge'))
    return sorted(messages)


def jittery_robot(start: float, length: float, seed: int) -> Iterable[Message]:
    """The same robot, of which every message comes 2 ms late on the average, and some later."""
    rng = random.Random(seed)
    return sorted((stamp + rng.expovariate(500.0), source, topic)
                  for stamp, source, topic in robot(start, length))


def wait_until(condition: Callable[[], object], what: str, deadline_s: float = 60.0) -> None:
    """Return as soon as a condition holds."""
    end = time.monotonic() + deadline_s
    while not condition():
        assert time.monotonic() < end, f'{what}: not within {deadline_s} s'
        time.sleep(0.005)


def take_sigint() -> None:
    """Let Ctrl-C end the process that calls this: who runs the tests may ignore it."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def run(program: Any, arguments: Sequence[str], code: int = 0) -> Tuple[str, str]:
    """Run a program (its module) in this process; return its output, and its errors.

    Args:
        code: that it must exit with.
    """
    with contextlib.redirect_stdout(io.StringIO()) as out, \
            contextlib.redirect_stderr(io.StringIO()) as err:
        assert program.main(arguments) == code, err.getvalue()
    return out.getvalue(), err.getvalue()


def printed_by(program: Any, arguments: Sequence[str]) -> str:
    """Run a program that must succeed, and return what it prints."""
    return run(program, arguments)[0]


def error_of(program: Any, arguments: Sequence[str]) -> str:
    """Run a program that must fail, and return the one line that it says."""
    name = program.__name__.rpartition('.')[2]
    error = run(program, arguments, 1)[1]
    line, = (line for line in error.splitlines() if not line.startswith(f'{name}: warning: '))
    assert line.startswith(f'{name}: error: '), error
    return line


def learned(model: TrainedModel, calibrations: bool = False) -> bytes:
    """Return all that a file says of a model but when it was made; of limits only if asked for."""
    model = copy.copy(model)
    if not calibrations:
        model.paper_calibration = model.calibration = None
        model.findings = LimitFindings()  # what limits are made of
    limits = model.calibration
    if limits is not None:
        limits.stamp = 0
        model.calibration = limits
    state = model.__getstate__()
    stamp = state.index(VERSION.encode()) + len(VERSION)  # it follows, 7 bits in a byte
    end = next(at for at in range(stamp, len(state)) if state[at] < 0x80) + 1
    return state[:stamp] + state[end:]


@pytest.fixture
def make_bag(tmp_path: Path) -> Callable[..., str]:
    """Return a function (name, messages, **options of write_bag) that writes a bag."""
    def make(name: str, messages: Iterable[Message], **options: Any) -> str:
        return write_bag(tmp_path / name, messages, **options)
    return make


@pytest.fixture(scope='session')
def robot_bags(tmp_path_factory: pytest.TempPathFactory) -> Tuple[str, str]:
    """Two recordings of the robot in normal operation."""
    folder = tmp_path_factory.mktemp('robot')
    return (write_bag(folder / 'first.bag', robot(1000.0)),
            write_bag(folder / 'second.bag', robot(2000.033)))


def trained(bags: Iterable[Union[str, Path]], path: Path, *options: str) -> TrainedModel:
    """Let `train` write a model; return it."""
    from self_awareness.commands import train
    assert train.main([*map(str, bags), '-o', str(path), *options]) == 0
    return TrainedModel.load(str(path))


def train_tuned(bags: Sequence[str], path: Path, detector: str = 'evidence',
                **numbers: float) -> str:
    """Train with other numbers of the method, which no program does; return the model's path."""
    from self_awareness.parts import BagPart
    from self_awareness.training import many_bags
    tuning = Tuning()
    for name, value in numbers.items():
        tuning.set(name, value)
    trained = many_bags.train([BagPart(bag) for bag in bags],
                              many_bags.Counting(detector=detector, tuning=tuning))
    trained.model.save(str(path))
    return str(path)


@pytest.fixture(scope='session')
def model_file(robot_bags: Tuple[str, str], tmp_path_factory: pytest.TempPathFactory) -> str:
    """A model trained on the first recording of the robot."""
    from self_awareness.commands import train
    path = str(tmp_path_factory.mktemp('model') / 'robot.model')
    assert train.main([robot_bags[0], '--detector', 'both', '-o', path]) == 0
    return path


@pytest.fixture(scope='session')
def long_bags(tmp_path_factory: pytest.TempPathFactory) -> Tuple[str, str]:
    """Two recordings of the robot that last long enough to find limits of the evidence."""
    folder = tmp_path_factory.mktemp('long')
    return (write_bag(folder / 'monday.bag', jittery_robot(10000.0, 120.0, 1)),
            write_bag(folder / 'tuesday.bag', jittery_robot(20000.0, 120.0, 2)))


@pytest.fixture(scope='session')
def evidence_model(long_bags: Tuple[str, str], tmp_path_factory: pytest.TempPathFactory) -> str:
    """A model trained on the first of them, with limits found on the second."""
    from self_awareness.commands import calibrate, train
    path = str(tmp_path_factory.mktemp('evidence') / 'robot.model')
    assert train.main([long_bags[0], '--detector', 'both', '-o', path]) == 0
    assert calibrate.main(['--model', path, '--normal', long_bags[1], '-o', path]) == 0
    return path


class Cases(NamedTuple):
    """The robot of the cases.

    Args:
        folder: of the cases.
        robot: the module that makes it.
        model: trained on four of its recordings, calibrated on two.
    """

    folder: Path
    robot: Any
    model: str

    def make(self, name: str, out: Path) -> Path:
        """Write the bags of a case, but for the normal ones; return where they are."""
        subprocess.run([sys.executable, str(self.folder / name / 'make.py')], check=True,
                       env={**os.environ, 'OUT': str(out), 'SKIP_NORMAL': '1',
                            'PYTHONDONTWRITEBYTECODE': '1'}, stdout=subprocess.DEVNULL)
        return out


@pytest.fixture(scope='session')
def cases(shared: Path, tmp_path_factory: pytest.TempPathFactory) -> Cases:
    """The robot of ../shared/cases, and a model of it."""
    from self_awareness.commands import calibrate, train
    folder = shared / 'cases'
    if not (folder / 'lib' / 'robot.py').is_file():
        pytest.skip(f'no folder {folder}')
    out = tmp_path_factory.mktemp('normal')
    sys.path.insert(0, str(folder / 'lib'))
    try:
        robot = importlib.import_module('robot')
    finally:
        sys.path.pop(0)
    normal = [str(out / f'n{seed}.bag') for seed in range(1, 7)]
    for seed, path in enumerate(normal, 1):
        robot.standard(seed, 120).write(path)
    model = str(out / 'm')
    assert train.main([*normal[:4], '-o', model]) == 0
    assert calibrate.main(['--model', model, '--normal', *normal[4:], '-o', model]) == 0
    return Cases(folder, robot, model)


@pytest.fixture
def scored(cases: Cases, tmp_path: Path) -> Callable[[str], Any]:
    """Return a function that scores a bag, and returns what is said of it, everywhere alike."""
    from one_voice import check

    from self_awareness.commands import score

    def scored(bag: str) -> Any:
        said, page, results = (tmp_path / name for name in ('said.json', 'r.html', 'results.bag'))
        with contextlib.redirect_stdout(io.StringIO()) as out:
            assert score.main([bag, '--model', cases.model, '--json', str(said), '--report',
                               str(page), '--result-bag', str(results)]) == 0
        print(out.getvalue(), end='')
        recordings = json.loads(said.read_text('utf-8'))['recordings']
        check(recordings[0], results, page, out.getvalue())
        return recordings
    return scored


@pytest.fixture
def of_its_own_robot(cases: Cases, tmp_path: Path) -> Callable[..., Any]:
    """Return a function that says what is said of a recording of a case with its own robot."""
    from self_awareness.commands import calibrate, score, train

    def of_its_own_robot(case: str, judged: str) -> Any:
        subprocess.run(
            [sys.executable, '-B', str(cases.folder / case / 'make.py')], check=True,
            stdout=subprocess.DEVNULL, env={**os.environ, 'OUT': str(tmp_path)})
        bags = [str(tmp_path / f'n{place}.bag') for place in range(1, 7)]
        model, said = str(tmp_path / 'm'), tmp_path / 'said.json'
        assert train.main([*bags[:4], '-o', model]) == 0
        assert calibrate.main(['--model', model, '--normal', *bags[4:], '-o', model]) == 0
        assert score.main([str(tmp_path / judged), '--model', model, '--json', str(said)]) == 0
        recording, = json.loads(said.read_text('utf-8'))['recordings']
        return recording
    return of_its_own_robot
