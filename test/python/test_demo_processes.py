"""scripts/processes.sh: a process of the demo that ends by itself ends the demo, and says why."""
from __future__ import annotations

import subprocess
import time
from pathlib import Path

import pytest

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
