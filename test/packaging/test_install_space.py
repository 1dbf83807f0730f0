"""What `install` puts into a folder works without the workspace that it comes from."""
from __future__ import annotations

import os
import signal
import subprocess
import time
from pathlib import Path
from typing import Dict, Iterator

import pytest

from conftest import ALARM, ROOT, run, run_project_of_library_page

from self_awareness_evaluation.live.processes import free_port

DEADLINE_S = 120.0
"""For a node to speak, or to end, on a busy machine too."""


@pytest.fixture(scope='module')
def devel() -> Path:
    """The devel space that the tests run in."""
    return _of_cache('CATKIN_DEVEL_PREFIX')


@pytest.fixture(scope='module')
def installed(devel: Path, tmp_path_factory: pytest.TempPathFactory) -> Dict[str, str]:
    """The environment of a user who has sourced an install space, and nothing else."""
    home = tmp_path_factory.mktemp('home')
    clean = {'HOME': str(home), 'PATH': '/usr/bin:/bin', 'LANG': 'C.UTF-8'}
    # As Debian's package tools do it: the place where files are used is not where they are put.
    run('cmake', '--build', _build(), '--target', 'install', '--', '-j2',
        env={**clean, 'DESTDIR': str(home / 'put')})
    put = home / 'put' / _of_cache('CMAKE_INSTALL_PREFIX').relative_to('/')
    prefix = put.rename(home / 'install')
    printed = run('bash', '-c', 'source "$0/setup.bash" && env -0', prefix, env=clean)
    environment = dict(entry.split('=', 1) for entry in printed.split('\0') if entry)
    assert str(devel) not in str(environment)
    environment.update(ROS_IP='127.0.0.1', ROS_MASTER_URI=f'http://127.0.0.1:{free_port()}')
    return environment


@pytest.fixture(scope='module')
def recordings(installed: Dict[str, str], tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with recordings of the simulated robot: normal_1 to normal_3, cc1_4."""
    folder = tmp_path_factory.mktemp('recordings')
    for options in (('--runs', 3), ('--seed', 4, '--fault', 'cc1@60')):
        _program(installed, 'simulate', '-o', folder, '--duration', 90, *options)
    return folder


@pytest.fixture(scope='module')
def model(installed: Dict[str, str], recordings: Path) -> Path:
    """A model of the simulated robot, with limits."""
    path = recordings / 'robot.model'
    _program(installed, 'train', recordings / 'normal_1.bag', recordings / 'normal_2.bag',
             '-o', path)
    _program(installed, 'calibrate', '--model', path, '--normal', recordings / 'normal_3.bag',
             '-o', path)
    return path


def test_ros_finds_the_package_and_python_its_module_there(installed: Dict[str, str]) -> None:
    prefix = Path(installed['HOME']) / 'install'
    assert Path(run('rospack', 'find', 'self_awareness', env=installed).strip()) == (
        prefix / 'share' / 'self_awareness')
    printed = run('/usr/bin/python3', '-c', 'import self_awareness; print(self_awareness.__file__,'
                  ' self_awareness._core.__file__)', env=installed)
    for module in printed.split():
        assert prefix in Path(module).parents


def test_rosrun_offers_programs_and_nothing_of_the_developers(installed: Dict[str, str]) -> None:
    """As its completion finds them."""
    folders = run('catkin_find', '--without-underlays', '--libexec', '--share', 'self_awareness',
                  env=installed).split()
    offered = {path.name for folder in folders for path in Path(folder).rglob('*')
               if path.is_file() and os.access(path, os.X_OK)}
    assert offered == {'calibrate', 'component', 'convert', 'diff', 'incidents', 'induce', 'info',
                       'learn', 'learn_more', 'merge', 'only_one', 'record_events',
                       'record_graph', 'recovery.py', 'score', 'self_awareness_node',
                       'simulate', 'top', 'train'}


def test_no_text_that_is_installed_names_the_workspace(installed: Dict[str, str],
                                                       devel: Path) -> None:
    texts = {path: path.read_bytes() for path in (Path(installed['HOME']) / 'install').rglob('*')
             if path.is_file()}
    places = [str(place).encode() for place in (devel, _build(), ROOT)]
    assert [path for path, text in texts.items()
            if b'\0' not in text and any(place in text for place in places)] == []


def test_the_programs_name_who_died_and_write_pages(installed: Dict[str, str], model: Path,
                                                    tmp_path: Path) -> None:
    """Pages need files beside the Python modules."""
    bag = model.parent / 'cc1_4.bag'
    printed = _program(installed, 'score', '--model', model, bag, '--report',
                       tmp_path / 'report.html')
    assert '1. /player' in printed[printed.index('  60.'):], printed
    _program(installed, 'diff', model, f'{bag}@62', '--html', tmp_path / 'diff.html')
    assert '/player (/scan) stopped sending' in (tmp_path / 'report.html').read_text()
    assert '/player' in (tmp_path / 'diff.html').read_text()


@pytest.mark.parametrize('standalone', ('true', 'false'))
def test_the_monitor_speaks(installed: Dict[str, str], model: Path, standalone: str,
                            master: None, tmp_path: Path) -> None:
    with open(tmp_path / 'log', 'w', encoding='utf-8') as log:
        launched = subprocess.Popen(
            ('roslaunch', '--wait', 'self_awareness', 'monitor.launch', f'model:={model}',
             f'standalone:={standalone}'), env=installed, stdout=log, stderr=subprocess.STDOUT)
    try:
        # The updater of the diagnostics speaks before the monitor does.
        printed = run('rostopic', 'echo', '-n', 1, '/diagnostics', '--filter',
                      'any(s.name == "self_awareness: communication" for s in m.status)',
                      env=installed, timeout_s=DEADLINE_S)
        assert 'waiting for the first message' in printed, printed
    except subprocess.TimeoutExpired:
        pytest.fail((tmp_path / 'log').read_text(encoding='utf-8'))
    finally:
        _end(launched)


@pytest.fixture
def master(installed: Dict[str, str]) -> Iterator[None]:
    """A master of the test's own."""
    port = installed['ROS_MASTER_URI'].rsplit(':', 1)[1]
    roscore = subprocess.Popen(('roscore', '-p', port), env=installed, stdout=subprocess.DEVNULL)
    try:
        deadline = time.monotonic() + DEADLINE_S
        while subprocess.run(('rosparam', 'get', '/run_id'), env=installed,
                             stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode:
            assert time.monotonic() < deadline, 'no answer from the master'
        yield
    finally:
        _end(roscore)


def test_a_catkin_package_links_the_library(installed: Dict[str, str], tmp_path: Path) -> None:
    printed = run_project_of_library_page(tmp_path, 'find_package(catkin',
                                          '-DPYTHON_EXECUTABLE=/usr/bin/python3', env=installed)
    assert ALARM.fullmatch(printed), printed


def _program(environment: Dict[str, str], *words: object) -> str:
    return run('rosrun', 'self_awareness', *words, env=environment)


def _end(process: subprocess.Popen) -> None:
    process.send_signal(signal.SIGINT)
    process.wait(timeout=DEADLINE_S)


def _build() -> Path:
    """Return the build folder of the workspace; `make run_tests` in it says where it is."""
    build = os.environ.get('SELF_AWARENESS_BUILD')
    if build is None:
        pytest.skip('set SELF_AWARENESS_BUILD to the build folder of the catkin workspace')
    return Path(build)


def _of_cache(variable: str) -> Path:
    lines = (_build() / 'CMakeCache.txt').read_text(encoding='utf-8').splitlines()
    value, = [line.split('=', 1)[1] for line in lines if line.startswith(f'{variable}:')]
    return Path(value)
