"""Calls to nodes, the master and roslaunch, with made-up ones on the loopback interface."""
from __future__ import annotations

import gzip
import socket
import threading
import time
from contextlib import ExitStack, contextmanager
from typing import Any, Callable, Dict, Iterator, Sequence
from xmlrpc.server import SimpleXMLRPCServer

import pytest

from self_awareness.recovery.node_calls import ANSWER_S, MOST_OF_NODE, Launchers, NodeCalls
from self_awareness.recovery.xml_rpc import NoAnswer

CALLS = NodeCalls('/test')


@contextmanager
def serving(**methods: Callable[..., Any]) -> Iterator[str]:
    """Hand out the address of a server with these methods."""
    with SimpleXMLRPCServer(('127.0.0.1', 0), logRequests=False) as server:
        for name, method in methods.items():
            server.register_function(method, name)
        thread = threading.Thread(target=server.serve_forever, args=(0.01,))
        thread.start()
        try:
            yield f'http://127.0.0.1:{server.server_address[1]}/'
        finally:
            server.shutdown()
            thread.join()


@pytest.fixture
def master(monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[..., None]]:
    """What starts a master with these methods."""
    with ExitStack() as stack:
        yield lambda **methods: monkeypatch.setenv('ROS_MASTER_URI', stack.enter_context(
            serving(**methods)))


def test_a_node_is_asked_in_the_name_of_the_recovery() -> None:
    told = []

    def shutdown(*words: str) -> Any:
        told.append(words)
        return 1, '', 0

    with serving(getPid=lambda name: (1, name, 42), shutdown=shutdown) as address:
        assert CALLS.process_id('/player', address) == 42
        CALLS.shut_down('/player', address, 'why')
        assert CALLS.is_here(address)
    assert told == [('/test', 'why')]


@pytest.mark.parametrize('answer', [(0, 'no such', 0), (-1, 'error', 0), 'text', (1, 'too few'),
                                    (1, '', 'no number')])
def test_an_answer_that_is_none_is_told(answer: Any) -> None:
    with serving(getPid=lambda name: answer) as address:
        with pytest.raises(NoAnswer, match='/player'):
            CALLS.process_id('/player', address)


def test_who_does_not_answer_is_not_waited_for() -> None:
    with socket.socket() as mute:
        mute.bind(('127.0.0.1', 0))
        mute.listen(5)
        address = f'http://127.0.0.1:{mute.getsockname()[1]}/'
        began = time.monotonic()
        with pytest.raises(NoAnswer, match='/player does not answer'):
            CALLS.process_id('/player', address)
        assert time.monotonic() - began < 10.0 * ANSWER_S
    with pytest.raises(NoAnswer, match='/player does not answer'):
        CALLS.process_id('/player', address)


def test_a_long_answer_is_read_to_its_end(master: Callable[..., None]) -> None:
    types = [[f'/topic_{number}', 'std_msgs/Empty'] for number in range(5000)]
    master(getSystemState=lambda name: (1, '', [[], [[name, ['/a']] for name, _ in types], []]),
           getTopicTypes=lambda name: (1, '', types))
    assert CALLS.robot() == ({'/a'}, set())


@contextmanager
def saying(*parts: bytes, pause: float = 0.0) -> Iterator[str]:
    """Hand out the address of a server that answers with these, one after the other."""
    with socket.socket() as server:
        server.bind(('127.0.0.1', 0))
        server.listen(5)

        def run() -> None:
            with server.accept()[0] as connection:
                connection.recv(1 << 16)
                try:
                    for part in parts:
                        connection.sendall(part)
                        time.sleep(pause)
                except OSError:
                    pass  # who has heard enough hangs up

        thread = threading.Thread(target=run)
        thread.start()
        yield f'http://127.0.0.1:{server.getsockname()[1]}/'
        thread.join()


_HEAD = b'HTTP/1.0 200 OK\r\nContent-Type: text/xml\r\n'
_DROPS = [b' '] * 600  # all of them take a minute
_WITHOUT_END = [b' ' * MOST_OF_NODE] * 100


@pytest.mark.parametrize('head, parts, pause', [
    (_HEAD, _DROPS, 0.1), (_HEAD + b'\r\n', _DROPS, 0.1),
    (_HEAD + b'X: ', _WITHOUT_END, 0.0), (_HEAD + b'\r\n', _WITHOUT_END, 0.0),
    (_HEAD + b'Content-Length: 999999999\r\n\r\n', _WITHOUT_END, 0.0),
    (_HEAD + b'Content-Encoding: gzip\r\n\r\n', [gzip.compress(b' ' * 10_000_000)], 0.0)])
def test_an_answer_may_be_neither_slow_nor_long_nor_compressed(
        head: bytes, parts: Sequence[bytes], pause: float) -> None:
    began = time.monotonic()
    with saying(head, *parts, pause=pause) as address:
        with pytest.raises(NoAnswer, match='/player does not answer'):
            CALLS.process_id('/player', address)
    assert time.monotonic() - began < 20.0 * ANSWER_S


@pytest.mark.parametrize('address', ['http://robot..lan:1/', 'http://[1/', 'no address', ''])
def test_an_address_that_is_none_is_no_answer(address: str) -> None:
    with pytest.raises(NoAnswer, match='/player does not answer'):
        CALLS.process_id('/player', address)
    try:
        assert not CALLS.is_here(address)
    except NoAnswer as error:
        assert 'is no address' in str(error)


def test_parameters_and_services_are_those_of_the_master(master: Callable[..., None]) -> None:
    master(hasParam=lambda name, key: (1, '', key == '/a'),
           getParam=lambda name, key: (1, '', 'value'),
           lookupService=lambda name, service: (
               (1, '', 'rosrpc://here:1') if service == '/reset' else (-1, 'no provider', '')))
    assert (CALLS.parameter('/a'), CALLS.parameter('/b')) == ('value', None)
    assert CALLS.service('/reset') == 'rosrpc://here:1'
    with pytest.raises(NoAnswer, match='no provider'):
        CALLS.service('/rest')


def test_the_master_tells_who_listens_to_whom_and_who_is_of_this_package(
        master: Callable[..., None]) -> None:
    """Monitors and recorders are known by what they publish."""
    state = [[['/scan', ['/player']], ['/map', ['/slam']], ['/rosout', ['/player', '/slam']],
              ['/w/status', ['/watch']], ['/odd', ['/base', '/watch']]],
             [['/scan', ['/slam', '/player']], ['/rosout', ['/rosout']]], []]
    types = [['/scan', 'sensor_msgs/LaserScan'], ['/w/status', 'self_awareness/SelfAwareness']]
    master(getSystemState=lambda name: (1, '', state), getTopicTypes=lambda name: (1, '', types),
           lookupNode=lambda name, node: (-1, f'unknown node {node}', ''))
    assert CALLS.listeners() == {'/player': {'/slam'}, '/slam': set(), '/watch': set(),
                                 '/base': set()}
    assert CALLS.robot() == ({'/player', '/watch', '/base', '/slam', '/rosout'}, {'/watch'})
    with pytest.raises(NoAnswer, match='the master says: unknown node /gone'):
        CALLS.address('/gone')


@contextmanager
def roslaunch(children: Sequence[str] = (), **changed: Any) -> Iterator[str]:
    """Hand out the address of one that has started /robot/player-one as process 42."""
    info: Dict[str, Any] = {'pid': 42, 'respawn': True, 'required': False, **changed}
    with serving(list_processes=lambda: (1, '', [[['robot/player-one-3', 1], ['rosout-1', 1]],
                                                 [['dead-2', 1]]]),
                 process_info=lambda name: (1, '', info) if name == 'robot/player-one-3'
                 else (-1, 'no process by that name', {}),
                 list_children=lambda: (1, '', list(children))) as address:
        yield address


NODE = '/robot/player-one'
GONE = 'http://127.0.0.1:1/'


def test_who_is_respawned_may_be_stopped() -> None:
    with roslaunch() as address:
        assert Launchers([address]).why_not(NODE, {41, 42}) == ''
        assert Launchers([GONE, address]).why_not(NODE, None) == ''


@pytest.mark.parametrize('changed, why', [
    ({'respawn': False}, 'not respawn="true"'), ({'required': True}, 'required="true"'),
    ({'respawn': 'yes'}, 'not respawn="true"'), ({'required': 0}, 'required="true"'),
    ({'pid': 43}, 'started by no roslaunch')])
def test_others_may_not(changed: Any, why: str) -> None:
    with roslaunch(**changed) as address:
        assert why in Launchers([address]).why_not(NODE, {41, 42})


def test_who_no_roslaunch_knows_may_not_be_stopped() -> None:
    with roslaunch() as address:
        assert 'started by no roslaunch' in Launchers([address]).why_not('/player', {42})
        assert 'started by no roslaunch' in Launchers([address]).why_not('/dead', {42})
    assert f'({GONE} does not answer)' in Launchers([GONE]).why_not(NODE, {42})


def test_nodes_on_other_machines_are_those_of_another_roslaunch() -> None:
    with roslaunch(respawn=False) as child, roslaunch([child, GONE], pid=43) as parent:
        assert 'not respawn' in Launchers([parent]).why_not(NODE, {42})
        assert 'not respawn' in Launchers([parent]).why_not(NODE, None), 'it may be either'


def test_the_master_knows_where_they_are(master: Callable[..., None]) -> None:
    with roslaunch() as address:
        for uris, found in (({'host__1': address}, True), ({}, False)):
            master(getParam=lambda name, key: (1, '', uris))
            assert (CALLS.launchers().why_not(NODE, {42}) == '') == found
    master(getParam=lambda name, key: (-1, 'not set', 0))
    with pytest.raises(NoAnswer, match='not set'):
        CALLS.launchers()
