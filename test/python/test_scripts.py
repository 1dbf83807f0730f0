"""Scripts of developers: what they say, start and leave behind."""
from __future__ import annotations

import configparser
import os
import re
import shutil
import signal
import subprocess
import threading
import time
from contextlib import contextmanager
from pathlib import Path
from typing import Dict, Iterator, List

import pytest
from conftest import take_sigint

PROGRAM = Path(__file__).parents[1] / 'count_results.py'
PASSED = '<testsuite tests="1"><testcase classname="a" name="b"/></testsuite>'
FAILED = ('<testsuite tests="1"><testcase classname="a" name="c"><error type="IndexError">no such '
          'index\n  File "a.py"</error></testcase></testsuite>')


@pytest.mark.parametrize('files, kinds, code, told', [
    ({'gtest-a': PASSED, 'pytest-b': PASSED}, ['gtest', 'pytest'], 0,
     '2 passed, 0 failed, 0 skipped\n'),
    ({'gtest-a': PASSED, 'pytest-b': FAILED}, [], 1,
     'FAILED: a c: IndexError no such index\n1 passed, 1 failed, 0 skipped\n'),
    ({'gtest-a': PASSED}, ['gtest', 'pytest'], 1,
     'FAILED: pytest: no results\n1 passed, 1 failed, 0 skipped\n'),
    ({'rosunit-a': '<testsuite tests="3"><testcase classname="a" name="b" time="2.25"/>'
      '<testcase classname="a" name="c" time="0.9"/><testcase classname="a" name="d" time="70"/>'
      '<system-out>once more: the machine stood still for 2.0 s</system-out></testsuite>'}, [], 0,
     '  70.0 s  a d\n   2.2 s  a b\n1 tests had a second try: the machine disturbed them\n'
     '3 passed, 0 failed, 0 skipped\n'),
    ({}, [], 1, '0 passed, 0 failed, 0 skipped\n')])
def test_what_passed_and_failed_is_counted(tmp_path: Path, files: dict, kinds: list, code: int,
                                           told: str) -> None:
    for name, text in files.items():
        (tmp_path / f'{name}.xml').write_text(text)
    done = subprocess.run([str(PROGRAM), str(tmp_path), *kinds], stdout=subprocess.PIPE,
                          universal_newlines=True)
    assert (done.returncode, done.stdout) == (code, told)


ROOT = Path(__file__).resolve().parents[2]
LONG_S = 60


def run(script: str, folder: Path) -> subprocess.CompletedProcess:
    """Run a script as demo.sh begins."""
    head = f'set -euo pipefail\nout={folder}\nsource {ROOT}/scripts/processes.sh\n'
    return subprocess.run(['bash', '-c', f'{head}trap stop_all EXIT\n{script}'], check=False,
                          capture_output=True, text=True, timeout=LONG_S / 2)


@pytest.mark.parametrize('waiting', [f'await {LONG_S} "it answers" false',
                                     f'sleep {LONG_S} & watch $!'])
def test_the_last_lines_are_shown_at_once(waiting: str, tmp_path: Path) -> None:
    begin = time.monotonic()
    done = run(f'start lasting.log sleep {LONG_S}\n'
               'start robot.log bash -c "seq 100; echo no such package; exit 3"\n'
               f'{waiting}\necho not reached', tmp_path)
    assert time.monotonic() - begin < LONG_S / 4
    assert done.returncode == 1 and done.stdout == ''
    error, *lines = done.stderr.splitlines()
    assert error == ('demo: error: a process ended by itself; the end of '
                     f'{tmp_path}/robot.log:')
    assert lines[-2:] == ['100', 'no such package'] and len(lines) == 20


@pytest.mark.parametrize('time_of_many', range(20))
def test_what_was_started_ends_with_the_script(time_of_many: int, tmp_path: Path) -> None:
    """Also what was started a moment ago, and is not yet what it shall be."""
    done = run(f'start a.log sleep {LONG_S}\necho ${{!started[@]}}\nsleep {LONG_S} & echo $!',
               tmp_path)
    assert done.returncode == 0
    started, other = map(int, done.stdout.split())
    for pid in (started, other):
        assert not Path(f'/proc/{pid}').exists(), time_of_many


def test_it_waits_while_all_run(tmp_path: Path) -> None:
    done = run(f'start a.log sleep {LONG_S}\n(sleep 0.5; touch {tmp_path}/done) &\n'
               f'await {LONG_S} "a file" test -e {tmp_path}/done\n'
               'bash -c "exit 7" & code=0; watch $! || code=$?; echo $code', tmp_path)
    assert (done.returncode, done.stdout, done.stderr) == (0, '7\n', '')


def test_what_does_not_come_is_told(tmp_path: Path) -> None:
    done = run(f'start a.log sleep {LONG_S}\nawait 1 "the master answers" false', tmp_path)
    assert done.returncode == 1
    assert 'not within 1 s: the master answers' in done.stderr


def test_a_build_shows_how_far_it_is_while_it_goes_on(tmp_path: Path) -> None:
    make = ('echo "-- Configuring done"; for i in $(seq 0 3 99); do '
            'printf "[%3d%%] Building CXX object a.o\\n" $i; done; echo "[100%] Built target a"; '
            f'source {ROOT}/scripts/prepare.sh; say_time Building $((SECONDS - 125))')
    done = run(f'({make}; until [ -e {tmp_path}/seen ]; do sleep 0.1; done)'
               f' | progress_of_make | (read -r first; touch {tmp_path}/seen; echo "$first"; cat)',
               tmp_path)
    assert done.stdout.splitlines() == [f'{percent} % built' for percent in (
        0, 6, 12, 15, 21, 27, 30, 36, 42, 45, 51, 57, 60, 66, 72, 75, 81, 87, 90, 96, 100)
    ] + ['Building took 2 min 5 s']


SCRIPT = ROOT / 'scripts' / 'test_platform.sh'
RELEASES = ('trixie', 'bookworm', 'bullseye', 'noetic')


def _can_unshare() -> bool:
    return os.geteuid() == 0 and not subprocess.run(
        ('unshare', '--mount', '--pid', '--mount-proc', '--fork', 'true'),
        stderr=subprocess.DEVNULL).returncode


needs_root = pytest.mark.skipif(not _can_unshare(), reason='only root can mount')


@pytest.fixture
def debian(tmp_path: Path) -> Path:
    """A folder with what the script takes for a Debian that it has made: a shell, and `sleep`."""
    folder = tmp_path / 'self_awareness' / 'bookworm'
    for name in ('dev', 'etc', 'proc', 'root'):
        (folder / name).mkdir(parents=True)
    programs = ['/bin/bash', '/usr/bin/env', '/usr/bin/sleep']
    linked = subprocess.run(('ldd', *programs), stdout=subprocess.PIPE, text=True, check=True)
    for path in {*programs, *re.findall(r'(/\S+) \(0x', linked.stdout)}:
        (folder / path[1:]).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(path, folder / path[1:])
    (folder / 'complete').touch()
    return folder


def _environment(debian: Path) -> Dict[str, str]:
    shared = debian.parents[1] / 'shared'
    shared.mkdir(exist_ok=True)
    (shared / 'recording').write_text('a robot\n', encoding='utf-8')
    return {**os.environ, 'XDG_CACHE_HOME': str(debian.parents[1]),
            'SELF_AWARENESS_SHARED': str(shared)}


def _run(debian: Path, command: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run((SCRIPT, 'bookworm', 'bash', '-c', command), stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True, env=_environment(debian),
                          timeout=LONG_S)


def _inside(debian: Path) -> List[str]:
    """Return the processes whose root the folder is."""
    found = []
    for path in Path('/proc').glob('[0-9]*/root'):
        try:
            root = os.readlink(path)
        except OSError:  # it has ended
            continue
        found += [path.parent.name] if root == str(debian) else []
    return found


@contextmanager
def _ended_in_time(script: subprocess.Popen[str]) -> Iterator[subprocess.Popen[str]]:
    """Kill the session of a script after LONG_S, whatever is waited for meanwhile."""
    limit = threading.Timer(LONG_S, os.killpg, (script.pid, signal.SIGKILL))
    limit.start()
    try:
        with script:
            yield script
    finally:
        limit.cancel()


@needs_root
@pytest.mark.parametrize('number, code', [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_signal_leaves_nothing_running_and_nothing_mounted(number: int, code: int,
                                                             debian: Path) -> None:
    stubborn = 'trap "" INT TERM; sleep 1000 & echo begun; sleep 1000'
    with _ended_in_time(subprocess.Popen(
            (SCRIPT, 'bookworm', 'bash', '-c', stubborn), stdout=subprocess.PIPE, text=True,
            env=_environment(debian), preexec_fn=take_sigint, start_new_session=True)) as script:
        assert script.stdout is not None
        begun = 'begun\n' in iter(script.stdout.readline, '')
        inside = _inside(debian)
        script.send_signal(number)
        assert script.wait() == code
    assert begun and len(inside) == 2
    assert _inside(debian) == []
    assert str(debian) not in Path('/proc/self/mounts').read_text(encoding='utf-8')


@needs_root
def test_a_command_runs_in_a_copy_reads_the_recordings_and_hands_its_exit_code_on(
        debian: Path) -> None:
    done = _run(debian, 'read -r line < ../shared/recording && echo "$PWD: $line"; : > new;'
                        ': > ../shared/recording || echo "not written";'
                        'bash -c "kill -INT \\$\\$; echo igno""red"; exit 7')
    assert done.returncode == 7, done.stderr
    assert 'ignored\n' not in done.stdout
    assert '/root/self_awareness: a robot\n' in done.stdout
    assert 'not written\n' in done.stdout
    assert not (ROOT / 'new').exists()


@needs_root
def test_who_is_not_root_is_told_at_once(debian: Path) -> None:
    done = subprocess.run(('unshare', '--user', SCRIPT, 'bookworm', 'true'),
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                          env=_environment(debian), timeout=LONG_S)
    assert (done.returncode, done.stdout) == (1, '')
    assert 'only root' in done.stderr and f'sudo {SCRIPT} bookworm true' in done.stderr


@pytest.mark.parametrize('arguments', [(), ('sid',), ('--help',)])
def test_other_releases_are_wrong_usage(arguments: List[str]) -> None:
    done = subprocess.run((SCRIPT, *arguments), stdout=subprocess.PIPE, text=True, timeout=LONG_S)
    assert done.returncode == 2
    assert all(release in done.stdout for release in RELEASES)


def _text(name: str) -> str:
    return (ROOT / name).read_text(encoding='utf-8')


def _table() -> str:
    return _text('docs/developers.md').partition('## Platforms')[2].partition('\n## ')[0]


def test_the_pages_agree_on_what_is_tried() -> None:
    """The page of developers has the table; others name no other versions."""
    for release in RELEASES:
        assert f'`scripts/test_platform.sh {release}`' in _table()
    for page in ('README.md', 'docs/library.md', 'CONTRIBUTING.md'):
        assert 'developers.md#platforms' in _text(page), page


def test_the_oldest_versions_are_the_same_everywhere() -> None:
    table = _table()
    script = _text('scripts/near_noetic.sh')
    config = configparser.ConfigParser()
    config.read(str(ROOT / 'setup.cfg'))
    python = config['mypy']['python_version']
    assert f'--target={python}-' in script and f'| Python | {python}' in table
    wheels = script.partition('wheels=(')[2].partition(')')[0]
    for wheel in re.findall(r'[\w-]+==[\w.]+', wheels):
        name, version = wheel.split('==')
        row, = re.findall(rf'^\| {name} \|.*$', table, re.MULTILINE | re.IGNORECASE)
        assert version in row
    cmake = re.search(r'cmake==(\d+\.\d+)', script)
    assert cmake is not None
    for lists in ('CMakeLists.txt', 'src/core/CMakeLists.txt'):
        assert f'cmake_minimum_required(VERSION {cmake[1]})' in _text(lists)
    assert f'CMake {cmake[1]}' in _text('docs/library.md')
    assert 'g++ 9' in _text('docs/library.md') and 'g++-9' in script
