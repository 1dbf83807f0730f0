"""Calls to the master, to nodes and to roslaunch; each answers in time, or fails."""
from __future__ import annotations

from typing import Any, Dict, Set, Tuple
from urllib.parse import urlparse

import rosgraph
import rosgraph.network

from self_awareness.recovery.launchers import Launchers
from self_awareness.recovery.xml_rpc import NoAnswer, ask

ANSWER_S = 1.0
"""A node that is well answers sooner [s]."""
MOST_OF_NODE = 1 << 16
"""Bytes of an answer of a node."""
_MASTER_S = 5.0
_MOST_OF_MASTER = 1 << 24  # the state of a large robot
_PACKAGE = 'self_awareness/'
_FOR_ALL = {'/rosout'}
"""Topics that nobody needs."""


class NodeCalls:
    """Asks the master and nodes.

    Args:
        name: of who asks.
        within: an answer of a node has so long to come [s].
    """

    def __init__(self, name: str, within: float = ANSWER_S) -> None:
        self._name = name
        self._within = within

    def master(self, method: str, *words: Any) -> Any:
        """Call a method of the master; return the value of its answer.

        Raises:
            NoAnswer: there is none, or that of a failure.
        """
        return ask('the master', rosgraph.get_master_uri(), _MASTER_S, _MOST_OF_MASTER, method,
                   self._name, *words)

    def address(self, node: str) -> str:
        """Return the address of a node's slave API.

        Raises:
            NoAnswer: the master does not know the node, or does not answer.
        """
        return str(self.master('lookupNode', node))

    def parameter(self, name: str) -> Any:
        """Return the value of a parameter; None: there is none.

        Raises:
            NoAnswer: the master does not answer.
        """
        return self.master('getParam', name) if self.master('hasParam', name) else None

    def service(self, name: str) -> str:
        """Return the address of a service.

        Raises:
            NoAnswer: the master does not know the service, or does not answer.
        """
        return str(self.master('lookupService', name))

    def is_here(self, address: str) -> bool:
        """Return whether a node runs on this machine.

        Raises:
            NoAnswer: the address is none.
        """
        try:
            host = urlparse(address).hostname
            return host is not None and rosgraph.network.is_local_address(host)
        except ValueError as error:  # as of the host name robot..lan
            raise NoAnswer(f'{address!r} is no address ({error})') from error

    def process_id(self, node: str, address: str) -> int:
        """Return the process id of a node, as it tells it.

        Raises:
            NoAnswer: it does not answer.
        """
        pid = self._ask(node, address, 'getPid')
        if not isinstance(pid, int) or pid <= 1:
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
        publishers, subscribers, _ = self.master('getSystemState')
        types: Dict[str, str] = dict(self.master('getTopicTypes'))
        everybody = {node for _, nodes in [*publishers, *subscribers] for node in nodes}
        own = {node for topic, nodes in publishers for node in nodes
               if types.get(topic, '').startswith(_PACKAGE)}
        return everybody, own

    def listeners(self) -> Dict[str, Set[str]]:
        """Return who listens to whom now: by each node that publishes, those that subscribe.

        Raises:
            NoAnswer: the master does not answer.
        """
        publishers, subscribers, _ = self.master('getSystemState')
        hearing = {topic: set(nodes) for topic, nodes in subscribers if topic not in _FOR_ALL}
        found: Dict[str, Set[str]] = {}
        for topic, nodes in publishers:
            for node in nodes:
                found.setdefault(node, set()).update(hearing.get(topic, set()) - {node})
        return found

    def launchers(self) -> Launchers:
        """Return what the running roslaunch say of the nodes that they have started.

        Raises:
            NoAnswer: the master does not answer, or knows of no roslaunch.
        """
        addresses = self.master('getParam', '/roslaunch/uris')
        if not isinstance(addresses, dict):
            raise NoAnswer('the parameter /roslaunch/uris is none of roslaunch')
        return Launchers(str(each) for each in addresses.values())

    def _ask(self, node: str, address: str, method: str, *words: str) -> Any:
        return ask(node, address, self._within, MOST_OF_NODE, method, self._name, *words)
