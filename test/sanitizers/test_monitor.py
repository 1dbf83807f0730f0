"""The monitor among real nodes, built or run with a tool that finds errors (scripts/sanitize.sh).

SELF_AWARENESS_TOOL names the tool, SELF_AWARENESS_BUILT_IN the workspace with the programs under
test. All others are those of the workspace whose setup.bash was sourced.
"""
from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import time
from pathlib import Path
from typing import Dict, Iterator, List

import pytest
import roslib.packages
import rospy
from live_system import MonitorListener, Process, await_condition, pid_of
from monitor_case import publishers, subscribers
from std_msgs.msg import String
from std_srvs.srv import Trigger

from self_awareness_evaluation.live.processes import free_port

TOOL = os.environ['SELF_AWARENESS_TOOL']
BUILT_IN = Path(os.environ['SELF_AWARENESS_BUILT_IN'])
RE2 = Path(__file__).with_name('re2.supp')

COMPONENTS = {'player': ('/scan', 100), 'base': ('/odom', 400), 'battery': ('/battery', 2),
              'camera': ('/image', 30), 'arm': ('/joints', 200)}
"""Topic and rate [Hz] of each."""
RECORDED_S = {'training': 20.0, 'normal': 60.0}
"""Lengths of the recordings; calibrate needs 50 s."""
SLOWLY_S = 120.0
"""Programs under a tool take their time."""
TIMES = 5
"""That the nodelet is loaded and unloaded before the alarm."""


class Programs:
    """Starts the programs under test; what the tool reports lies in a folder."""

    def __init__(self, folder: Path) -> None:
        self._reports = folder / 'reports'
        self._reports.mkdir()

    def start(self, program: str, *arguments: str, preload: str = '', **parameters: object
              ) -> Process:
        """Start one; `preload` are libraries, for a program that is not built with the tool."""
        command = [str(BUILT_IN / 'devel' / 'env.sh'), 'env']
        command += [f'{name}={os.environ.get(name, "")}:log_path={self._reports / program}'
                    for name in ('ASAN_OPTIONS', 'TSAN_OPTIONS', 'UBSAN_OPTIONS')]
        if preload:
            command.append(f'LD_PRELOAD={preload}')
        if TOOL == 'valgrind':
            command += ['valgrind', '--error-exitcode=99', '--leak-check=full',
                        '--errors-for-leak-kinds=definite', f'--suppressions={RE2}',
                        f'--log-file={self._reports / program}.%p']
        path = BUILT_IN / 'devel' / 'lib' / 'self_awareness' / program
        command.append(str(path) if path.exists() else find_program(program))
        return Process(*command, *arguments,
                       *(f'_{name}:={value}' for name, value in parameters.items()))

    def check(self, process: Process, code: int = 0) -> None:
        """End a program by SIGINT, and check its exit code and that the tool reports nothing."""
        process.send(signal.SIGINT)
        assert process.wait(SLOWLY_S) == code, process.output + self.reports()
        if TOOL != 'valgrind':  # it always writes a summary; its exit code says what it found
            assert not self.reports()

    def reports(self) -> str:
        """Return all that the tool has reported."""
        return ''.join(path.read_text(errors='replace')
                       for path in sorted(self._reports.iterdir()))


def find_program(name: str) -> str:
    """Return the path of a program of the package nodelet."""
    path, = roslib.packages.find_node('nodelet', name)
    return path


def runtime() -> str:
    """Return what a program has to load first: the sanitizer's library, and ours.

    The sanitizer knows no functions of a library that is loaded after its first report, and so
    cannot tell what is suppressed.
    """
    name = {'address': 'libasan.so', 'thread': 'libtsan.so'}[TOOL]
    sanitizer = subprocess.run(['g++', f'-print-file-name={name}'], stdout=subprocess.PIPE,
                               text=True, check=True).stdout.strip()
    return f'{sanitizer} {BUILT_IN / "devel" / "lib" / "libself_awareness_monitor.so"}'


@pytest.fixture(name='master', scope='module', autouse=True)
def _master() -> Iterator[None]:
    port = free_port()
    os.environ['ROS_MASTER_URI'] = f'http://127.0.0.1:{port}'
    with Process('roscore', '-p', str(port)) as core:
        await_condition('the master answers', lambda: core.running() and subprocess.run(
            ['rosnode', 'list'], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            check=False).returncode == 0, SLOWLY_S)
        rospy.init_node('sanitizer_test', disable_signals=True, disable_rosout=True)
        yield
        rospy.signal_shutdown('done')


@pytest.fixture(name='robot', scope='module')
def _robot() -> Iterator[Dict[str, Process]]:
    components = {name: component(name) for name in COMPONENTS}
    for topic, _ in COMPONENTS.values():
        rospy.wait_for_message(topic, String, SLOWLY_S)
    yield components
    for process in components.values():
        process.stop()


def component(name: str) -> Process:
    """Start a component of the robot."""
    topic, rate = COMPONENTS[name]
    return Process('rosrun', 'self_awareness', 'talker', f'__name:={name}',
                   f'_output:={topic}', f'_rate:={rate}', '_variation:=0.5')


@pytest.fixture(name='programs')
def _programs(tmp_path: Path) -> Programs:
    return Programs(tmp_path)


@pytest.fixture(name='model', scope='module')
def _model(robot: Dict[str, Process], tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Record, train and calibrate; the recorder is one of the programs under test."""
    folder = tmp_path_factory.mktemp('model')
    programs = Programs(folder)
    logs = [record(programs, folder, name) for name in RECORDED_S]
    model = folder / 'model'
    run('train', str(logs[0]), '-o', str(model))
    # Limits of so short a recording are narrow; few false alarms are allowed: they are wide.
    run('calibrate', '--model', str(model), '--normal', str(logs[1]), '--budget', '0.01',
        '-o', str(model))
    return model


def record(programs: Programs, folder: Path, name: str) -> Path:
    """Record an event log while the robot runs."""
    recorder = programs.start('record_events', f'__name:={name}', output=folder / name,
                              subscribe='all')
    heard: List[float] = []
    with recorder:
        await_condition('the recorder listens', lambda: f'/{name}' in subscribers('/scan'),
                        SLOWLY_S)
        subscriber = rospy.Subscriber('/scan', String, lambda _: heard.append(time.monotonic()))
        await_condition('it has recorded', lambda: (
            len(heard) > 0 and heard[-1] - heard[0] > RECORDED_S[name]), SLOWLY_S)
        subscriber.unregister()
        programs.check(recorder)
    log, = folder.glob(f'{name}*.bag')
    return log


def run(*arguments: str) -> None:
    """Run a program of the package to its end."""
    with Process('rosrun', 'self_awareness', *arguments) as program:
        assert program.wait(SLOWLY_S) == 0, program.output


def call(service: str) -> str:
    """Call a service, which succeeds, and return its message."""
    rospy.wait_for_service(service, SLOWLY_S)
    answer = rospy.ServiceProxy(service, Trigger)()
    assert answer.success, answer.message
    return answer.message


@pytest.mark.skipif(TOOL != 'valgrind', reason='the others stand a load')
def test_start_and_stop(programs: Programs, model: Path, tmp_path: Path) -> None:
    with programs.start('self_awareness_node', '__name:=node', model=model,
                        **{'recorder/directory': str(tmp_path / 'recorder')}) as node, \
            MonitorListener('/node') as listener:
        listener.await_settled(SLOWLY_S)
        assert Path(call('/node/dump').split()[-1]).is_absolute()
        programs.check(node)


@pytest.mark.skipif(TOOL == 'valgrind', reason='too slow for a load')
def test_load_and_alarms_and_services(programs: Programs, robot: Dict[str, Process], model: Path,
                                      tmp_path: Path) -> None:
    """As a node and as a nodelet at the same time: an alarm, all services, in the alarm, too."""
    manager = programs.start('nodelet', 'manager', '__name:=manager', preload=runtime())
    node = programs.start('self_awareness_node', '__name:=node', model=model,
                          **{'recorder/directory': str(tmp_path / 'node')})
    with manager, node, MonitorListener('/node') as of_node, \
            MonitorListener('/nodelet') as of_nodelet:
        for _ in range(TIMES):
            with nodelet(model, tmp_path):
                of_nodelet.await_settled(SLOWLY_S)
                for name in ('/node', '/nodelet'):
                    call(f'{name}/reload')
                    await_condition('something is heard again, and written', lambda: (
                        rospy.ServiceProxy(f'{name}/dump', Trigger)().success), SLOWLY_S)
        with nodelet(model, tmp_path):
            for listener in (of_node, of_nodelet):
                listener.await_settled(SLOWLY_S)
            os.kill(pid_of('/player'), signal.SIGKILL)
            for listener in (of_node, of_nodelet):
                suspects = listener.await_alarm(SLOWLY_S).suspects
                assert '/player' in [suspect.source for suspect in suspects]
            for service in ('dump', 'clear', 'reload', 'reset'):
                for name in ('/node', '/nodelet'):
                    call(f'{name}/{service}')
            for listener in (of_node, of_nodelet):
                listener.await_alarm(SLOWLY_S)
        robot['player'] = component('player')
        with nodelet(model, tmp_path):
            of_nodelet.await_settled(SLOWLY_S)
        programs.check(node)
        programs.check(manager)


@contextlib.contextmanager
def nodelet(model: Path, folder: Path) -> Iterator[None]:
    """Load the monitor into the manager for the time of a with statement."""
    with Process('rosrun', 'nodelet', 'nodelet', 'load', 'self_awareness/SelfAwareness',
                 'manager', '__name:=nodelet', f'_model:={model}',
                 f'_recorder/directory:={folder / "nodelet"}'):
        await_condition('the nodelet is loaded', lambda: publishers('/nodelet/status'), SLOWLY_S)
        yield
    await_condition('it is unloaded', lambda: not publishers('/nodelet/status'), SLOWLY_S)
