"""scripts/test_platform.sh, and what the pages say of the platforms."""
from __future__ import annotations

import configparser
import os
import re
import shutil
import signal
import subprocess
import threading
from contextlib import contextmanager
from pathlib import Path
from typing import Dict, Iterator, List

import pytest

ROOT = Path(__file__).resolve().parents[2]
SCRIPT = ROOT / 'scripts' / 'test_platform.sh'
RELEASES = ('trixie', 'bookworm', 'bullseye', 'noetic')
LONG_S = 60


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


def _take_sigint() -> None:
    """Undo what a shell does to all that it starts in its background: bash could not trap it."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


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
            env=_environment(debian), preexec_fn=_take_sigint, start_new_session=True)) as script:
        assert script.stdout is not None
        begun = 'begun\n' in iter(script.stdout.readline, '')
        inside = _inside(debian)
        script.send_signal(number)
        assert script.wait() == code
    assert begun and len(inside) == 2
    assert _inside(debian) == []
    assert str(debian) not in Path('/proc/self/mounts').read_text(encoding='utf-8')


@needs_root
def test_the_command_takes_sigint_and_its_exit_code_is_handed_on(debian: Path) -> None:
    done = _run(debian, 'bash -c "kill -INT \\$\\$; echo igno""red"; exit 7')
    assert done.returncode == 7, done.stderr
    assert 'ignored\n' not in done.stdout


@needs_root
def test_the_checkout_is_a_copy_and_the_recordings_can_be_read(debian: Path) -> None:
    done = _run(debian, 'read -r line < ../shared/recording && echo "$PWD: $line"; : > new;'
                        ': > ../shared/recording || echo "not written"')
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
