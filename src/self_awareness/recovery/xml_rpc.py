"""XML-RPC calls whose whole answer is bounded, in time and in bytes."""
from __future__ import annotations

import socket
import time
from contextlib import closing
from http.client import HTTPConnection, HTTPException
from typing import Any
from urllib.parse import urlparse
from xml.parsers.expat import ExpatError
from xmlrpc.client import Error as XmlRpcError
from xmlrpc.client import dumps, loads


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
        url = urlparse(address)
        if url.scheme != 'http' or not url.hostname:
            raise ValueError(f'{address!r} is no address')
        with closing(HTTPConnection(url.netloc, timeout=within)) as connection:
            deadline = time.monotonic() + within
            connection.connect()
            connection.sock = _Bounded(connection.sock, deadline, most)
            connection.request('POST', url.path or '/', dumps(words, method).encode(),
                               {'Content-Type': 'text/xml'})
            response = connection.getresponse()
            if response.status != 200:
                raise OSError(f'{response.status} {response.reason}')
            # What is compressed may become any size. It is not unpacked, and so no answer.
            answer: Any = loads(response.read().decode())
            ((code, text, value),), _ = answer
    except (OSError, HTTPException, XmlRpcError, ExpatError, ValueError, TypeError,
            LookupError) as error:
        raise NoAnswer(f'{whom} does not answer ({error})') from error
    if code != 1:
        raise NoAnswer(f'{whom} says: {text}')
    return value


class _Bounded(socket.socket):
    """Takes the place of a socket; reads until a deadline (steady [s]), and so much at most."""

    def __init__(self, connected: socket.socket, deadline: float, most: int) -> None:
        super().__init__(fileno=connected.detach())
        self._deadline = deadline
        self._left = most
        self._set_timeout()

    def recv_into(self, *arguments: Any) -> int:
        self._set_timeout()
        number = super().recv_into(*arguments)
        self._left -= number
        if self._left < 0:
            raise OSError('its answer is too long')
        return number

    def _set_timeout(self) -> None:
        left = self._deadline - time.monotonic()
        if left <= 0.0:
            raise socket.timeout('timed out')
        self.settimeout(left)
