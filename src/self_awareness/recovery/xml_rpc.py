"""XML-RPC calls whose whole answer is bounded, in time and in bytes."""
from __future__ import annotations

import http.client
import socket
import time
from typing import Any
from xml.parsers.expat import ExpatError
from xmlrpc.client import Error as XmlRpcError
from xmlrpc.client import ServerProxy, Transport


class NoAnswer(Exception):
    """Somebody cannot be asked; the message says why."""


def ask(whom: str, address: str, within: float, most: int, method: str, *words: Any) -> Any:
    """Call a method of ROS's XML-RPC interfaces; return the value of its answer.

    Looking up the name of a host may take longer.

    Args:
        whom: is asked, for messages.
        address: of the server.
        within: the whole answer has so long to come [s].
        most: bytes of an answer, with its headers.
        method, words: what is called.

    Raises:
        NoAnswer: there is none in time, it is too long, or is that of a failure.
    """
    try:
        with ServerProxy(address, transport=_Bounded(within, most)) as server:
            code, text, value = getattr(server, method)(*words)
    except (OSError, http.client.HTTPException, XmlRpcError, ExpatError, ValueError, TypeError,
            LookupError) as error:
        raise NoAnswer(f'{whom} does not answer ({error})') from error
    if code != 1:
        raise NoAnswer(f'{whom} says: {text}')
    return value


class _Socket(socket.socket):
    """Reads until a deadline (steady [s]), and a number of bytes at most."""

    deadline = 0.0
    left = 0

    def recv_into(self, *arguments: Any) -> int:
        self.settimeout(_time_to(self.deadline))
        number = super().recv_into(*arguments)
        self.left -= number
        if self.left < 0:
            raise OSError('its answer is too long')
        return number


class _Connection(http.client.HTTPConnection):

    def __init__(self, host: Any, deadline: float, most: int) -> None:
        super().__init__(host, timeout=_time_to(deadline))
        self._deadline = deadline
        self._most = most

    def connect(self) -> None:
        super().connect()
        bounded = _Socket(fileno=self.sock.detach())
        bounded.deadline, bounded.left = self._deadline, self._most
        bounded.settimeout(_time_to(self._deadline))
        self.sock = bounded


class _Bounded(Transport):
    """For one call."""

    # What is compressed may become any size. So it is not wanted, nor unpacked if it comes anyway.
    accept_gzip_encoding = False

    def __init__(self, within: float, most: int) -> None:
        super().__init__()
        self._deadline = time.monotonic() + within
        self._most = most

    def request(self, *arguments: Any, **keywords: Any) -> Any:
        return self.single_request(*arguments, **keywords)  # a second attempt would take longer

    def make_connection(self, host: Any) -> http.client.HTTPConnection:
        name, self._extra_headers, _ = self.get_host_info(host)
        connection = _Connection(name, self._deadline, self._most)
        self._connection = host, connection  # to be closed by close()
        return connection

    def parse_response(self, response: Any) -> Any:
        parser, unmarshaller = self.getparser()
        parser.feed(response.read())
        parser.close()
        return unmarshaller.close()


def _time_to(deadline: float) -> float:
    left = deadline - time.monotonic()
    if left <= 0.0:
        raise socket.timeout('timed out')
    return left
