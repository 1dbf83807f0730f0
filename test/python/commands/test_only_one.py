"""A node of a name that is taken; test/two_monitors.test has the real ones."""
from __future__ import annotations

import os
from typing import Any, Dict, List, Tuple

import pytest

from self_awareness.commands import only_one
from self_awareness.recovery import node_calls
from self_awareness.recovery.xml_rpc import NoAnswer

COMMAND = ('--parameters', 'launched', 'nodelet/nodelet', 'manager', '__name:=watch')


class Master:
    """Answers as a master, and as the node /watch, until it is asked what it `hangs` at."""

    def __init__(self, hangs: str = '', pid: Any = None) -> None:
        self._hangs = hangs
        self._pid = pid
        self.parameters: Dict[str, Any] = {'/launched': {'model': '/m', 'recorder': {'files': 5}}}
        self.started: List[str] = []

    def ask(self, whom: str, address: str, within: float, most: int, method: str,
            *words: Any) -> Any:
        if whom == '/watch':
            if self._pid is None:
                raise NoAnswer('/watch does not answer')
            return self._pid
        if method == self._hangs:
            self._hangs = 'getPid hasParam setParam'
        if method in self._hangs:
            raise NoAnswer('the master does not answer (timed out)')
        return getattr(self, f'_{method}')(*words[1:])

    def _getPid(self) -> int:  # noqa: N802
        return 1

    def _lookupNode(self, name: str) -> str:  # noqa: N802
        return 'http://192.0.2.1:5/'

    def _hasParam(self, key: str) -> bool:  # noqa: N802
        return key in self.parameters

    def _getParam(self, key: str) -> Any:  # noqa: N802
        if key not in self.parameters:
            raise NoAnswer(f'the master says: {key} is not set')
        return self.parameters[key]

    def _setParam(self, key: str, value: Any) -> None:  # noqa: N802
        self.parameters[key] = value

    def _deleteParam(self, key: str) -> None:  # noqa: N802
        del self.parameters[key]

    def execv(self, path: str, words: List[str]) -> None:
        self.started = [os.path.basename(path), *words[1:]]


def run(master: Master, monkeypatch: pytest.MonkeyPatch) -> int:
    monkeypatch.setattr(node_calls, 'ask', master.ask)
    monkeypatch.setattr(os, 'execv', master.execv)
    monkeypatch.delenv('ROS_NAMESPACE', raising=False)
    return only_one.main(COMMAND)


def test_parameters_become_those_of_the_node(monkeypatch: pytest.MonkeyPatch) -> None:
    master = Master()
    assert run(master, monkeypatch) == 0
    assert master.started == ['nodelet', 'manager', '__name:=watch']
    own = {'/watch/model': '/m', '/watch/recorder/files': 5}
    assert master.parameters == own
    assert run(master, monkeypatch) == 0  # respawned: there are none, and that is all right
    assert master.parameters == own


def test_a_taken_name_is_told_and_the_parameters_are_dropped(
        monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    master = Master(pid=7)
    assert run(master, monkeypatch) == 1
    said = capsys.readouterr().err
    assert said.startswith('only_one: error: /watch runs already (pid 7 on 192.0.2.1): ')
    assert said.count('\n') == 1
    assert (master.started, master.parameters) == ([], {})


@pytest.mark.parametrize('hangs', ['lookupNode', 'getParam', 'setParam'])
def test_a_master_that_hangs_is_no_refusal(hangs: str, monkeypatch: pytest.MonkeyPatch,
                                           capsys: pytest.CaptureFixture[str]) -> None:
    """roslaunch starts it again, and all parameters are still there."""
    master = Master(hangs)
    expected: Tuple[int, List[str]] = (3, [])
    assert (run(master, monkeypatch), master.started) == expected
    assert 'only_one: error: the master does not answer' in capsys.readouterr().err
    assert '/launched' in master.parameters
