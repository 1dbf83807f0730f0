"""Calls to nodes and the master, with made-up ones on the loopback interface."""
from __future__ import annotations

import gzip
import socket
import threading
import time
from contextlib import ExitStack, contextmanager
from typing import Any, Callable, Iterator
from xmlrpc.server import SimpleXMLRPCServer

import pytest

from self_awareness.recovery.node_calls import ANSWER_S, MOST_OF_NODE, NodeCalls
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


@pytest.mark.parametrize('head', [_HEAD, _HEAD + b'\r\n'])
def test_who_answers_drop_by_drop_is_not_waited_for(head: bytes) -> None:
    began = time.monotonic()
    with pytest.raises(NoAnswer, match='/player does not answer'):
        with saying(head, *([b' '] * 600), pause=0.1) as address:
            try:
                CALLS.process_id('/player', address)
            finally:
                took = time.monotonic() - began
    assert took < 20.0 * ANSWER_S, 'all of it takes a minute'


@pytest.mark.parametrize('head', [_HEAD + b'X: ', _HEAD + b'\r\n',
                                  _HEAD + b'Content-Length: 999999999\r\n\r\n'])
def test_an_answer_without_an_end_is_not_read(head: bytes) -> None:
    with saying(head, *([b' ' * MOST_OF_NODE] * 100)) as address:
        with pytest.raises(NoAnswer, match='/player does not answer'):
            CALLS.process_id('/player', address)


def test_what_is_compressed_is_no_answer() -> None:
    packed = gzip.compress(b' ' * 10_000_000)
    with saying(_HEAD + b'Content-Encoding: gzip\r\n\r\n' + packed) as address:
        with pytest.raises(NoAnswer, match='/player does not answer'):
            CALLS.process_id('/player', address)


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
