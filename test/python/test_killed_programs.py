"""Programs that are killed lose nothing: what they write is there whole, or as it was before.

SELF_AWARENESS_KILLS says how many times each of them is killed (scripts/kill.sh).
"""
from __future__ import annotations

import glob
import hashlib
import itertools
import os
import random
import signal
import statistics
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path
from typing import Callable, Dict, Iterator, List, NamedTuple, Optional, Tuple

import pytest
from conftest import jittery_robot, learned, take_sigint, wait_until, write_bag

from self_awareness import (EncodingRules, EventLogWriter, ResultBag, TrainedModel, read_events,
                            summarise_bag)
from self_awareness.commands import calibrate, convert, merge, score, train
from self_awareness.learning.logs import LogFolder

KILLS = int(os.environ.get('SELF_AWARENESS_KILLS', '4'))
MORE_KILLS = 100
"""Until one comes while the file is written: on a busy machine, this one may look too late."""
_TRAIN = Path(__file__).resolve().parents[2] / 'scripts' / 'train'
_PARTS = '.self_awareness_part*'
_LONGEST_S = 60.0


class Program(NamedTuple):
    """A program that is killed.

    Args:
        main: with its arguments.
        output: that it writes.
        content: what a whole output says; raises where it is not whole.
    """

    main: Callable[[List[str]], int]
    arguments: List[str]
    output: Path
    content: Callable[[Path], bytes]


def model(path: Path) -> bytes:
    return learned(TrainedModel.load(str(path)), calibrations=True)


def page(path: Path) -> bytes:
    content = path.read_bytes()
    assert content.rstrip().endswith(b'</html>')
    return content


def result_bag(path: Path) -> bytes:
    assert ResultBag.is_one(str(path))
    return path.read_bytes()


@pytest.fixture
def programs(long_bags: Tuple[str, str], evidence_model: str, robot_bags: Tuple[str, str],
             model_file: str, tmp_path: Path) -> Dict[str, Program]:
    """Return what is killed, by name."""
    def program(module, ending: str, content: Callable[[Path], bytes], *arguments: str,
                option: str = '-o') -> Program:
        output = tmp_path / f'out{ending}'
        return Program(module.main, [*arguments, option, str(output)], output, content)

    judged = [long_bags[1], '--model', evidence_model]
    return {
        'train': program(train, '.model', model, *long_bags, '--jobs', '2'),
        'calibrate': program(calibrate, '.model', model, '--model', evidence_model, '--normal',
                             long_bags[1]),
        'merge': program(merge, '.model', model, evidence_model, model_file),
        'convert': program(convert, '.bag', Path.read_bytes, *long_bags, *robot_bags),
        'score --csv': program(score, '.csv', Path.read_bytes, *judged, option='--csv'),
        'score --report': program(score, '.html', page, *judged, option='--report'),
        'score --result-bag': program(score, '.bag', result_bag, *judged, option='--result-bag')}


@pytest.fixture(autouse=True)
def inputs_stay(long_bags: Tuple[str, str], evidence_model: str, robot_bags: Tuple[str, str],
                model_file: str) -> Iterator[None]:
    def hashes() -> List[str]:
        return [hashlib.sha256(Path(path).read_bytes()).hexdigest()
                for path in (*long_bags, *robot_bags, evidence_model, model_file)]

    before = hashes()
    yield
    assert hashes() == before


def start(main: Callable[[], object]) -> int:
    """Run something in a process of its own, and in a process group; return its id."""
    pid = os.fork()
    if pid == 0:
        os.setpgid(0, 0)
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        main()
        os._exit(0)
    return pid


def kill_at(pid: int, moment: Callable[[], bool]) -> None:
    """Kill a process at a moment, if it has not ended before, and await the end of all it made."""
    deadline = time.monotonic() + _LONGEST_S
    while not moment() and os.waitid(os.P_PID, pid, os.WEXITED | os.WNOHANG | os.WNOWAIT) is None:
        assert time.monotonic() < deadline
        time.sleep(0.0002)
    os.kill(pid, signal.SIGKILL)
    os.waitpid(pid, 0)
    wait_until(lambda: not group_lives(pid), 'what it started ends', 5.0)


def group_lives(group: int) -> bool:
    try:
        os.killpg(group, 0)
    except ProcessLookupError:
        return False
    return True


def moment_of(number: int, longest_s: float, folder: Path,
              chance: random.Random) -> Callable[[], bool]:
    """Return a random moment: any one, or a little after the file begins to be written."""
    begin = time.monotonic()
    wait_s = chance.uniform(0.0, longest_s)
    if number % 2 == 0:
        return lambda: time.monotonic() - begin > wait_s
    wait_s = chance.choice([0.0, chance.uniform(0.0, 0.01), chance.uniform(0.0, 0.1)])
    written: Optional[float] = None

    def is_written() -> bool:
        nonlocal written
        if written is None and glob.glob(str(folder / _PARTS)):
            written = time.monotonic()
        return written is not None and time.monotonic() - written >= wait_s
    return is_written


@pytest.mark.parametrize('name', ['train', 'calibrate', 'merge', 'convert', 'score --csv',
                                  'score --report', 'score --result-bag'])
def test_a_killed_program_leaves_a_whole_file(name: str, programs: Dict[str, Program],
                                              capfd) -> None:
    program, chance = programs[name], random.Random(name)
    begin = time.monotonic()
    assert program.main(program.arguments) == 0
    longest_s = time.monotonic() - begin
    expected = program.content(program.output)
    killed_while_writing = 0
    for number in itertools.count():
        if number >= KILLS and killed_while_writing > 0:
            break
        assert number < KILLS + MORE_KILLS, 'never killed while it writes'
        if number % 4 < 2:  # there may be no file of before
            program.output.unlink()
        pid = start(lambda: program.main(program.arguments))
        kill_at(pid, moment_of(number, longest_s, program.output.parent, chance))
        killed_while_writing += bool(glob.glob(str(program.output.parent / _PARTS)))
        if program.output.exists():
            assert program.content(program.output) == expected
        else:
            assert number % 4 < 2
            assert program.main(program.arguments) == 0  # the next start works
            assert program.content(program.output) == expected
        assert 'Traceback' not in capfd.readouterr().err
    assert program.main(program.arguments) == 0
    assert program.content(program.output) == expected
    assert os.listdir(program.output.parent) == [program.output.name]


def test_a_killed_recorder_keeps_what_it_has_heard(tmp_path: Path) -> None:
    chance = random.Random(1)
    times = [1.0 + 0.01 * i for i in range(20_000)]
    bag = write_bag(tmp_path / 'heard', [(stamp, '/a', '/b') for stamp in times])
    stamps = read_events(bag, EncodingRules.defaults()).stamps
    logs = LogFolder(str(tmp_path / 'logs'), EncodingRules.defaults())
    for number in range(KILLS):
        path = Path(logs.path) / f'{number}.bag'
        active = Path(f'{path}.active')
        bytes_there = chance.choice([0, chance.randrange(5000), chance.randrange(60_000)])

        def record() -> None:
            EventLogWriter(str(active)).add_bag(bag, EncodingRules.defaults())

        kill_at(start(record),
                lambda: active.exists() and active.stat().st_size >= bytes_there)
        logs.mend()
        logs.look()
        if any(log.part.path == str(path) for log in logs.logs):
            summary = summarise_bag(str(path), 0)
            found = read_events(str(path), EncodingRules.defaults(), recording=0).stamps
            assert len(found) == summary.messages
            assert found.tolist() == stamps[:len(found)].tolist()


@pytest.fixture(scope='module')
def four_bags(tmp_path_factory: pytest.TempPathFactory) -> List[str]:
    folder = tmp_path_factory.mktemp('four')
    return [write_bag(folder / f'{number}.bag', jittery_robot(10000.0 * number, 100.0, number))
            for number in range(1, 5)]


def training(bags: List[str], output: Path) -> subprocess.Popen:
    """Start a training in two processes, and return when both work."""
    process = subprocess.Popen(
        [sys.executable, str(_TRAIN), *bags, '--jobs', '2', '--detector', 'both', '-o',
         str(output)], start_new_session=True, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
        text=True,
        preexec_fn=take_sigint)
    wait_until(lambda: len(children(process.pid)) == 2 or process.poll() is not None,
               'two processes work')
    return process


def children(pid: int) -> List[int]:
    try:
        return [int(child) for child in
                Path(f'/proc/{pid}/task/{pid}/children').read_text().split()]
    except FileNotFoundError:
        return []


def test_ctrl_c_ends_a_training_within_two_seconds(four_bags: List[str], tmp_path: Path) -> None:
    chance = random.Random(2)
    output, ended_after_s = tmp_path / 'm', []
    with training(four_bags, output) as process:
        begin = time.monotonic()
        wait_until(lambda: not children(process.pid), 'the work is done')
        whole_s = time.monotonic() - begin
        process.communicate()
    for number in itertools.count():
        if len(ended_after_s) >= max(KILLS // 4, 3):
            break
        assert number < MORE_KILLS, 'it ends by itself before each signal'
        with training(four_bags, output) as process:
            time.sleep(chance.uniform(0.0, whole_s))  # any moment of the work
            begin = time.monotonic()
            with suppress(ProcessLookupError):  # it has ended
                if number % 3 == 2:
                    process.send_signal(signal.SIGINT)
                else:  # as a terminal does
                    os.killpg(process.pid, signal.SIGINT)
            _, said = process.communicate(timeout=10.0)
            if process.returncode != 0:
                ended_after_s.append(time.monotonic() - begin)
        # At its very end, Python does not look at signals any more: they end it.
        assert process.returncode in (130, 0, -signal.SIGINT), said
        assert said == ''
        wait_until(lambda: not group_lives(process.pid), 'all processes end', 2.0)
        assert model(output)
    print('ended after [s]:', *(f'{time_s:.2f}' for time_s in ended_after_s))
    # Not the longest: a machine that stands still for a moment is no fault of the program.
    assert statistics.median(ended_after_s) < 2.0


def test_ctrl_c_says_nothing_where_an_object_is_destroyed() -> None:
    program = """
import argparse, signal, sys
from self_awareness.commands import cli

class Destroyed:
    def __del__(self):
        signal.raise_signal(signal.SIGINT)

def work(_):
    Destroyed()
    print('it went on')

sys.exit(cli.run(argparse.ArgumentParser(), work, None))
"""
    done = subprocess.run(
        [sys.executable, '-c', program], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        check=False, preexec_fn=take_sigint)
    assert (done.returncode, done.stdout, done.stderr) == (130, '', '')
