"""Who publishes and who subscribes to what in a robot, and the file that says so beside a bag."""
from __future__ import annotations

import os
from dataclasses import dataclass, field
from typing import Any, Dict, Iterable, Set, Tuple

from self_awareness import (EncodingRules, FileVersion, resolved_name, unheard_publications,
                            yaml_file)
from self_awareness.output_files import replacing

_Nodes = Dict[str, Set[str]]

_HEADER = """\
# Who published and who subscribed to what, by topic, as the robot's master knew it.
"""
_VERSION = 'version'
"""Key of what the file says of its version (docs/monitor.md); no topic is called so."""

_HOSTS = 'hosts'
"""Key of the computers of nodes; no topic is called so either."""

_FIRST = {'format': 1, 'oldest_reader': 1}
"""Of a file that does not say: release 0.1.0 wrote it."""


@dataclass
class RobotGraph:
    """Who publishes and who subscribes to what, by topic; nodes by their full names.

    Args:
        publishers, subscribers: by topic.
        hosts: computers of nodes, by their names or addresses; those that are known.
    """

    publishers: _Nodes = field(default_factory=dict)
    subscribers: _Nodes = field(default_factory=dict)
    hosts: Dict[str, str] = field(default_factory=dict)

    def add(self, other: RobotGraph) -> bool:
        """Add what another graph knows; return whether it is new."""
        news = any(self.hosts.get(node) != host for node, host in other.hosts.items())
        self.hosts.update(other.hosts)
        for mine, theirs in ((self.publishers, other.publishers),
                             (self.subscribers, other.subscribers)):
            for topic, nodes in theirs.items():
                known = mine.setdefault(topic, set())
                news = news or not nodes <= known
                known |= nodes
        return news

    def edges(self, encoding: EncodingRules) -> Set[Tuple[str, str, str]]:
        """Return (publisher, topic, subscriber), as in TrainedModel.graph: by the names that the
        encoding gives them."""
        scopes = encoding.scopes_of(set(self.publishers))
        sources = encoding.sources_of(set().union(*self.publishers.values(),
                                                  *self.subscribers.values()))
        return {(sources[publisher], scopes[topic], sources[subscriber])
                for topic, nodes in self.publishers.items() for publisher in nodes
                for subscriber in self.subscribers.get(topic, ())}

    def hosts_of_sources(self, encoding: EncodingRules) -> Dict[str, str]:
        """Return the computers of nodes, as in TrainedModel.hosts."""
        sources = encoding.sources_of(set(self.hosts))
        found: Dict[str, Set[str]] = {}
        for node, host in self.hosts.items():
            found.setdefault(sources[node], set()).add(host)
        return {source: hosts.pop() if len(hosts) == 1 else '' for source, hosts in found.items()}

    def unheard(self, encoding: EncodingRules) -> Set[Tuple[str, str]]:
        """Return what no node of the robot subscribes to, as in TrainedModel.unheard."""
        return unheard_publications(encoding, self.publishers, self.subscribers)

    def save(self, path: str) -> None:
        """Write a file that load() reads."""
        import yaml

        topics = sorted(set(self.publishers) | set(self.subscribers))
        content = {topic: {'publishers': sorted(self.publishers.get(topic, ())),
                           'subscribers': sorted(self.subscribers.get(topic, ()))}
                   for topic in topics}
        ours = FileVersion.of_graph()
        version = {_VERSION: {'format': ours.format, 'oldest_reader': ours.oldest_reader,
                              'package': ours.package}}
        with replacing(path) as temporary, open(temporary, 'w', encoding='utf-8') as file:
            file.write(_HEADER)
            yaml.safe_dump(version, file, default_flow_style=None)
            if self.hosts:
                yaml.safe_dump({_HOSTS: self.hosts}, file, default_flow_style=False)
            if content:
                yaml.safe_dump(content, file, default_flow_style=None, width=1000)

    @classmethod
    def beside(cls, bags: Iterable[str]) -> RobotGraph:
        """Return what the files beside the bags of one recording say; of most, there is none.

        Raises:
            OSError, ValueError: as load().
        """
        graph = cls()
        for path in filter(os.path.exists, map(graph_file, bags)):
            graph.add(cls.load(path))
        return graph

    @classmethod
    def load(cls, path: str) -> RobotGraph:
        """Read a file of any version.

        Raises:
            OSError: it cannot be read.
            ValueError: it does not hold a graph, or is too new; the message names the file.
        """
        content = yaml_file.load(path)
        if not isinstance(content, dict):
            raise ValueError(f'{path}: expected topics, each with publishers and subscribers')
        newer = _format(path, content.pop(_VERSION, _FIRST)) > FileVersion.of_graph().format
        graph = cls(hosts=_hosts(path, content.pop(_HOSTS, {})))
        for topic, nodes in content.items():
            if newer and not str(topic).startswith('/'):
                continue  # what this version does not know
            publishers, subscribers = (_nodes(path, topic, nodes, key)
                                       for key in ('publishers', 'subscribers'))
            name = resolved_name(topic)
            graph.publishers.setdefault(name, set()).update(publishers)
            graph.subscribers.setdefault(name, set()).update(subscribers)
        return graph


def graph_file(bag: str) -> str:
    """Return the name of the file with the graph of the robot that a bag is a recording of.

    Args:
        bag: NAME.bag, or NAME.bag.active while it is written.
    """
    for end in ('.active', '.bag'):
        bag = bag[:-len(end)] if bag.endswith(end) else bag
    return f'{bag}.graph.yaml'


def _format(path: str, version: Any) -> int:
    """Return the format of a file by what it says of its version.

    Raises:
        ValueError: this version of the package does not understand it, or it says nothing.
    """
    says: Dict[Any, Any] = version if isinstance(version, dict) else {}
    number: Any = says.get('format')
    oldest_reader: Any = says.get('oldest_reader')
    if not all(type(each) is int and 0 < each < 1 << 32 for each in (number, oldest_reader)):
        raise ValueError(f'{path}: expected {_VERSION} with format and oldest_reader')
    problem = FileVersion.why_graph_too_new(number, oldest_reader, str(says.get('package')))
    if problem:
        raise ValueError(f'{path}: {problem}')
    return number


def _hosts(path: str, hosts: Any) -> Dict[str, str]:
    if not isinstance(hosts, dict) or not all(
            isinstance(name, str) for pair in hosts.items() for name in pair):
        raise ValueError(f'{path}: {_HOSTS}: expected the computers of nodes')
    return dict(hosts)


def _nodes(path: str, topic: Any, nodes: Any, key: str) -> Set[str]:
    names: Any = nodes.get(key) if isinstance(nodes, dict) else None
    if not isinstance(topic, str) or not isinstance(names, list) or not all(
            isinstance(name, str) for name in names):
        raise ValueError(f'{path}: {topic}: expected {key} with a list of nodes')
    return set(names)
