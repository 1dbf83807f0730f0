"""The launch files: their arguments are explained, and mean what who launches them means."""
from __future__ import annotations

import os
import signal
import subprocess
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Dict, Iterator, List, Tuple
from unittest import mock
from xml.etree import ElementTree

import pytest
from conftest import take_sigint
from roslaunch import arg_dump, node_args
from roslaunch.config import ROSLaunchConfig
from roslaunch.xmlloader import XmlLoader

ROOT = Path(__file__).resolve().parents[2]
FILES = sorted((ROOT / 'launch').glob('*.launch'))
LONG_S = 60


def _loaded(file: str, *arguments: str, cwd: Path = ROOT) -> ROSLaunchConfig:
    """Return what roslaunch makes of a file, for somebody in a folder."""
    config = ROSLaunchConfig()
    with mock.patch.dict(os.environ, PWD=str(cwd)):
        XmlLoader().load(str(ROOT / 'launch' / file), config, argv=list(arguments), verbose=False)
    return config


def _parameters(file: str, *arguments: str, cwd: Path = ROOT) -> Dict[str, object]:
    return {str(name): parameter.value
            for name, parameter in _loaded(file, *arguments, cwd=cwd).params.items()}


def _words(file: str, *arguments: str, cwd: Path = ROOT) -> List[str]:
    """Return the command by which the node /self_awareness is started."""
    with mock.patch.dict(os.environ, PWD=str(cwd)):
        return list(node_args.get_node_args(
            '/self_awareness', [(str(ROOT / 'launch' / file), list(arguments))]))


@pytest.mark.parametrize('path', FILES, ids=lambda path: path.name)
def test_every_argument_says_what_it_is(path: Path) -> None:
    arguments = [each for each in ElementTree.parse(str(path)).getroot().findall('arg')
                 if each.get('value') is None]
    assert arguments
    assert [each.get('name') for each in arguments if not each.get('doc')] == []
    assert {each.get('name') for each in arguments} <= set(arg_dump.get_args([str(path)]))


@pytest.mark.parametrize('given, meant', [
    ('r.model', '{cwd}/r.model'), ('/data/r.model', '/data/r.model'),
    ('~/r.model', '{home}/r.model'), ('2026', '{cwd}/2026')])
def test_a_relative_path_means_the_folder_of_who_launches(given: str, meant: str,
                                                          tmp_path: Path) -> None:
    meant = meant.format(cwd=tmp_path, home=Path.home())
    for launched in (('monitor.launch',), ('learn.launch',),
                     ('monitor.launch', 'standalone:=false')):
        parameters = _parameters(*launched, f'model:={given}', cwd=tmp_path)
        assert [parameters[name] for name in parameters if name.endswith('/model')] == [meant]
    recorder = _parameters('record.launch', f'output:={given}', cwd=tmp_path)
    assert recorder['/recorder/output'] == meant


def test_logs_and_encoding_of_the_learner_are_relative_to_the_same_folder(tmp_path: Path) -> None:
    words = _words('learn.launch', 'model:=r.model', 'encoding:=e.yaml', cwd=tmp_path)
    assert words[words.index('--logs') + 1] == f'{tmp_path}/r.model.logs'
    assert words[words.index('--encoding') + 1] == f'{tmp_path}/e.yaml'


@pytest.mark.parametrize('launched', [
    ('monitor.launch',), ('monitor.launch', 'standalone:=false'), ('learn.launch',)])
def test_no_launch_sets_parameters_of_a_monitor_that_runs(launched: Tuple[str, ...]) -> None:
    names = [name for _ in range(2) for name in _parameters(*launched)]
    assert len(names) == len(set(names)) > 0
    assert [name for name in names if name.startswith('/self_awareness/')] == []


@pytest.mark.parametrize('what, node', [('events', '/recorder'), ('event', '/recorder'),
                                        ('bags', '/record'), ('bag', '/record'), ('logs', '')])
def test_one_or_many_are_the_same_and_what_is_neither_is_told(what: str, node: str) -> None:
    if node:
        assert node in node_args.get_node_list(_loaded('record.launch', f'what:={what}'))
        return
    with pytest.raises(Exception, match='what:=logs is neither events nor bags'):
        _loaded('record.launch', f'what:={what}')


@contextmanager
def _prefixed(*command: str, **variables: str) -> Iterator[subprocess.Popen[str]]:
    with subprocess.Popen(('bash', ROOT / 'launch' / 'until_refused.sh', *command),
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                          start_new_session=True, preexec_fn=take_sigint,
                          env={**os.environ, **variables}) as node:
        try:
            yield node
        finally:
            with suppress(ProcessLookupError):
                os.killpg(node.pid, signal.SIGKILL)


@pytest.mark.parametrize('command, code', [
    ('exit 0', 0), ('exit 3', 3), ('kill -SEGV $$', 139), ('kill -KILL $$', 137)])
def test_a_node_that_did_not_refuse_may_be_started_again(command: str, code: int) -> None:
    with _prefixed('bash', '-c', command) as node:
        assert node.wait(LONG_S) == code


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
def test_a_signal_that_comes_while_the_node_is_started_is_not_lost(number: int,
                                                                   tmp_path: Path) -> None:
    slow = tmp_path / 'slow'
    slow.write_text('trap "sleep 0.2" DEBUG\n')  # before each command of the prefix
    program = 'trap "echo ended; exit 3" INT TERM; echo begun; while :; do sleep 0.05; done'
    with _prefixed('sh', '-c', program, BASH_ENV=str(slow)) as node:
        assert node.stdout.readline() == 'begun\n'
        os.kill(node.pid, number)
        assert node.wait(LONG_S) == 3


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize('code', [1, 2])
def test_a_node_that_refuses_its_parameters_is_not_started_again(code: int, number: int) -> None:
    """As long as this waits, roslaunch takes the node for alive."""
    refuses = f'echo "~alarm_of: must be at least 1" >&2; exit {code}'
    with _prefixed('bash', '-c', refuses) as node:
        assert node.stderr.readline() == '~alarm_of: must be at least 1\n'
        assert 'bash cannot run (see above), and is not started again' in node.stderr.readline()
        assert node.poll() is None
        os.killpg(node.pid, number)
        assert node.wait(LONG_S) == -number


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize('to_all', [True, False])
def test_a_node_gets_the_signal_and_its_exit_code_is_handed_on(number: int, to_all: bool) -> None:
    """Also 1, and also one that takes its time."""
    program = ('trap "sleep 0.2; echo ended; exit 1" INT TERM; echo begun; '
               'while :; do sleep 0.05; done')
    with _prefixed('bash', '-c', program) as node:
        assert node.stdout.readline() == 'begun\n'
        (os.killpg if to_all else os.kill)(node.pid, number)
        assert node.wait(LONG_S) == 1
        assert 'ended\n' in node.stdout.read()


@pytest.mark.parametrize('launched', [
    ('monitor.launch',), ('monitor.launch', 'standalone:=false'), ('learn.launch',),
    ('recovery.launch', 'name:=self_awareness')])
def test_who_is_respawned_is_started_so(launched: Tuple[str, ...]) -> None:
    words = _words(*launched)
    assert words[0] == 'bash' and words[1].endswith('/launch/until_refused.sh')
    assert os.path.isfile(words[1])
