"""What the running roslaunch say of nodes: which of them they would start again."""
from __future__ import annotations

from typing import Any, Dict, Iterable, List, Optional, Set, Tuple

from self_awareness.recovery.xml_rpc import NoAnswer, ask

_WITHIN_S = 3.0
_MOST = 1 << 22  # bytes; with the whole environment of a node
_MOST_MACHINES = 100


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
            return (f'{node} is not respawn="true" in its launch file: it would stay dead')
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
        infos = []
        for address, name in self._started.get(node, ()):
            try:
                info = _ask(address, 'process_info', name)
            except NoAnswer:
                continue
            if isinstance(info, dict):
                infos.append(info)
        return infos


def _ask(address: str, method: str, *words: str) -> Any:
    return ask('a roslaunch', address, _WITHIN_S, _MOST, method, *words)
