"""Calls to nodes and the master, with made-up ones on the loopback interface."""
from __future__ import annotations

import socket
import threading
import time
from contextlib import contextmanager
from typing import Any, Callable, Iterator
from xmlrpc.server import SimpleXMLRPCServer

import pytest

from self_awareness.recovery.node_calls import ANSWER_S, NoAnswer, NodeCalls

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
        began = time.monotonic()
        with pytest.raises(NoAnswer, match='/player does not answer'):
            CALLS.process_id('/player', f'http://127.0.0.1:{mute.getsockname()[1]}/')
        assert time.monotonic() - began < 10.0 * ANSWER_S
        address = f'http://127.0.0.1:{mute.getsockname()[1]}/'
    with pytest.raises(NoAnswer, match='/player does not answer'):
        CALLS.process_id('/player', address)


def test_monitors_and_recorders_are_known_by_what_they_publish(
        monkeypatch: pytest.MonkeyPatch) -> None:
    state = [[['/scan', ['/player']], ['/w/status', ['/watch']], ['/odd', ['/base', '/watch']]],
             [['/scan', ['/slam']]], []]
    types = [['/scan', 'sensor_msgs/LaserScan'], ['/w/status', 'self_awareness/SelfAwareness']]
    with serving(getSystemState=lambda name: (1, '', state), getTopicTypes=lambda name: (
            1, '', types), lookupNode=lambda name, node: (-1, f'unknown node {node}', '')) as uri:
        monkeypatch.setenv('ROS_MASTER_URI', uri)
        assert CALLS.robot() == ({'/player', '/watch', '/base', '/slam'}, {'/watch'})
        with pytest.raises(NoAnswer, match='the master says: unknown node /gone'):
            CALLS.address('/gone')
