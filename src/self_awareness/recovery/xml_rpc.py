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
        with closing(_Connection(url.netloc, time.monotonic() + within, most)) as connection:
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


class _Connection(HTTPConnection):

    def __init__(self, host: str, deadline: float, most: int) -> None:
        super().__init__(host, timeout=_time_to(deadline))
        self._deadline = deadline
        self._most = most

    def connect(self) -> None:
        super().connect()
        bounded = _Socket(fileno=self.sock.detach())
        bounded.deadline, bounded.left = self._deadline, self._most
        bounded.settimeout(_time_to(self._deadline))
        self.sock = bounded


def _time_to(deadline: float) -> float:
    left = deadline - time.monotonic()
    if left <= 0.0:
        raise socket.timeout('timed out')
    return left
