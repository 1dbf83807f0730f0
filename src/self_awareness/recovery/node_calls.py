"""Calls to the master, to nodes and to roslaunch; each answers in time, or fails."""
from __future__ import annotations

from contextlib import suppress
from typing import Any, Dict, Iterable, List, Optional, Set, Tuple
from urllib.parse import urlparse

import rosgraph
import rosgraph.network

from self_awareness import is_own_type
from self_awareness.recovery.xml_rpc import NoAnswer, ask

ANSWER_S = 1.0  # a node that is well answers sooner [s]
MOST_OF_NODE = 1 << 16  # bytes of an answer of a node
_MASTER_S = 5.0
_MOST_OF_MASTER = 1 << 24  # the state of a large robot
_ROSLAUNCH_S = 3.0
_MOST_OF_ROSLAUNCH = 1 << 22  # with the whole environment of a node
_MOST_MACHINES = 100
_FOR_ALL = {'/rosout'}  # topics that nobody needs


class Launchers:
    """Asks the roslaunch programs, and those that they have started on other machines.

    Those that do not answer may have ended long ago: their addresses stay at the master.

    Args:
        addresses: of their servers, as the parameters /roslaunch/uris say.
    """

    def __init__(self, addresses: Iterable[str]) -> None:
        self._started: Dict[str, List[Tuple[str, str]]] = {}  # by node: server, name of process
        self._silent: List[str] = []
        seen: Set[str] = set()
        left = list(addresses)
        while left and len(seen) < _MOST_MACHINES:
            address = left.pop()
            if address not in seen:
                seen.add(address)
                left += self._add(address)

    def why_not(self, node: str, pids: Optional[Set[int]]) -> str:
        """Return why the end of a node would not be followed by its start; empty: it would be.

        Args:
            node: its full name.
            pids: its process and those that it was started by; None: it is on another machine.
        """
        found = [info for info in self._infos(node) if pids is None or info.get('pid') in pids]
        if not found:
            silent = f' ({", ".join(self._silent)} does not answer)' if self._silent else ''
            return f'{node} is started by no roslaunch that answers: it would stay dead{silent}'
        if any(info.get('required') is not False for info in found):
            return f'{node} is required="true" in its launch file: the robot would end with it'
        if any(info.get('respawn') is not True for info in found):
            return f'{node} is not respawn="true" in its launch file: it would stay dead'
        return ''

    def _add(self, address: str) -> List[str]:
        """Learn of the nodes of a server; return the addresses of further ones."""
        try:
            running, _ = _ask(address, 'list_processes')
            for name, _ in running:
                # roslaunch calls its processes robot1/player-3.
                node = '/' + str(name).rpartition('-')[0]
                self._started.setdefault(node, []).append((address, str(name)))
        except (NoAnswer, TypeError, ValueError):
            self._silent.append(address)
            return []
        try:
            return [str(each) for each in _ask(address, 'list_children')]
        except (NoAnswer, TypeError):  # only the one that starts others has the method
            return []

    def _infos(self, node: str) -> List[Dict[str, Any]]:
        infos: List[Any] = []
        for address, name in self._started.get(node, ()):
            with suppress(NoAnswer):
                infos.append(_ask(address, 'process_info', name))
        return [info for info in infos if isinstance(info, dict)]


def _ask(address: str, method: str, *words: str) -> Any:
    return ask('a roslaunch', address, _ROSLAUNCH_S, _MOST_OF_ROSLAUNCH, method, *words)


class NodeCalls:
    """Asks the master and nodes; raises NoAnswer if one does not answer, or tells of a failure.

    Args:
        name: of who asks.
        within: an answer of a node has so long to come [s].
    """

    def __init__(self, name: str, within: float = ANSWER_S) -> None:
        self._name = name
        self._within = within

    def master(self, method: str, *words: Any) -> Any:
        """Call a method of the master; return the value of its answer."""
        return ask('the master', rosgraph.get_master_uri(), _MASTER_S, _MOST_OF_MASTER, method,
                   self._name, *words)

    def address(self, node: str) -> str:
        """Return the address of the slave API of a node that the master knows."""
        return str(self.master('lookupNode', node))

    def parameter(self, name: str) -> Any:
        """Return the value of a parameter; None: there is none."""
        return self.master('getParam', name) if self.master('hasParam', name) else None

    def service(self, name: str) -> str:
        """Return the address of a service that the master knows."""
        return str(self.master('lookupService', name))

    def is_here(self, address: str) -> bool:
        """Return whether a node runs on this machine; NoAnswer: its address is none."""
        try:
            host = urlparse(address).hostname
            return host is not None and rosgraph.network.is_local_address(host)
        except ValueError as error:  # as of the host name robot..lan
            raise NoAnswer(f'{address!r} is no address ({error})') from error

    def process_id(self, node: str, address: str) -> int:
        """Return the process id of a node, as it tells it."""
        pid = self._ask(node, address, 'getPid')
        if not isinstance(pid, int) or pid <= 1:
            raise NoAnswer(f'{node} does not tell its process id')
        return pid

    def shut_down(self, node: str, address: str, reason: str) -> None:
        """Ask a node to end."""
        self._ask(node, address, 'shutdown', reason)

    def robot(self) -> Tuple[Set[str], Set[str]]:
        """Return all nodes that publish or subscribe, and those of them that are of this package.

        Monitors and recorders of any name are known by the types of what they publish.
        """
        publishers, subscribers, _ = self.master('getSystemState')
        types: Dict[str, str] = dict(self.master('getTopicTypes'))
        everybody = {node for _, nodes in [*publishers, *subscribers] for node in nodes}
        own = {node for topic, nodes in publishers for node in nodes
               if is_own_type(types.get(topic, ''))}
        return everybody, own

    def listeners(self) -> Dict[str, Set[str]]:
        """Return who listens to whom now: by each node that publishes, those that subscribe."""
        publishers, subscribers, _ = self.master('getSystemState')
        hearing = {topic: set(nodes) for topic, nodes in subscribers if topic not in _FOR_ALL}
        found: Dict[str, Set[str]] = {}
        for topic, nodes in publishers:
            for node in nodes:
                found.setdefault(node, set()).update(hearing.get(topic, set()) - {node})
        return found

    def launchers(self) -> Launchers:
        """Return what the running roslaunch say of the nodes that they have started."""
        addresses = self.master('getParam', '/roslaunch/uris')
        if not isinstance(addresses, dict):
            raise NoAnswer('the parameter /roslaunch/uris is none of roslaunch')
        return Launchers(str(each) for each in addresses.values())

    def _ask(self, node: str, address: str, method: str, *words: str) -> Any:
        return ask(node, address, self._within, MOST_OF_NODE, method, self._name, *words)
