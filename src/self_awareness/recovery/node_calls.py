"""Calls to the master and to the slave API of nodes; each answers in time, or fails."""
from __future__ import annotations

import http.client
from typing import Any, Dict, Set, Tuple
from urllib.parse import urlparse
from xml.parsers.expat import ExpatError
from xmlrpc.client import Error as XmlRpcError
from xmlrpc.client import ServerProxy, Transport

import rosgraph
import rosgraph.network

ANSWER_S = 1.0
"""A node that is well answers sooner [s]."""
_PACKAGE = 'self_awareness/'


class NoAnswer(Exception):
    """A node or the master cannot be asked; the message says why."""


class _Hasty(Transport):
    """Gives up after ANSWER_S."""

    def make_connection(self, host: Any) -> http.client.HTTPConnection:
        connection = super().make_connection(host)
        connection.timeout = ANSWER_S
        return connection


class NodeCalls:
    """Asks the master and nodes.

    Args:
        name: of who asks.
    """

    def __init__(self, name: str) -> None:
        self._name = name

    def address(self, node: str) -> str:
        """Return the address of a node's slave API.

        Raises:
            NoAnswer: the master does not know the node, or does not answer.
        """
        return str(self._ask_master('lookupNode', node))

    def is_here(self, address: str) -> bool:
        """Return whether a node runs on this machine."""
        host = urlparse(address).hostname
        return host is not None and rosgraph.network.is_local_address(host)

    def process_id(self, node: str, address: str) -> int:
        """Return the process id of a node, as it tells it.

        Raises:
            NoAnswer: it does not answer.
        """
        pid = self._ask(node, address, 'getPid')
        if not isinstance(pid, int):
            raise NoAnswer(f'{node} does not tell its process id')
        return pid

    def shut_down(self, node: str, address: str, reason: str) -> None:
        """Ask a node to end.

        Raises:
            NoAnswer: it does not answer.
        """
        self._ask(node, address, 'shutdown', reason)

    def robot(self) -> Tuple[Set[str], Set[str]]:
        """Return all nodes that publish or subscribe, and those of them that are of this package.

        Monitors and recorders of any name are known by the types of what they publish.

        Raises:
            NoAnswer: the master does not answer.
        """
        publishers, subscribers, _ = self._ask_master('getSystemState')
        types: Dict[str, str] = dict(self._ask_master('getTopicTypes'))
        everybody = {node for _, nodes in [*publishers, *subscribers] for node in nodes}
        own = {node for topic, nodes in publishers for node in nodes
               if types.get(topic, '').startswith(_PACKAGE)}
        return everybody, own

    def _ask_master(self, method: str, *words: str) -> Any:
        return self._ask('the master', rosgraph.get_master_uri(), method, *words)

    def _ask(self, whom: str, address: str, method: str, *words: str) -> Any:
        try:
            with ServerProxy(address, transport=_Hasty()) as server:
                code, text, value = getattr(server, method)(self._name, *words)
        except (OSError, http.client.HTTPException, XmlRpcError, ExpatError, ValueError,
                TypeError) as error:
            raise NoAnswer(f'{whom} does not answer ({error})') from error
        if code != 1:
            raise NoAnswer(f'{whom} says: {text}')
        return value
