"""Who publishes and who subscribes to what in a robot, and the file that says so beside a bag.

The blame needs it to tell roots from victims.
"""
from __future__ import annotations

import os
from dataclasses import dataclass, field
from typing import Any, Dict, Iterable, Set, Tuple
from xmlrpc.client import Fault, MultiCall

from self_awareness import (EncodingRules, FileVersion, TrainedModel, host_in, is_own_type,
                            printable, resolved_name, unheard_publications, yaml_file)
from self_awareness.output_files import replacing
from self_awareness.yaml_section import Section

_Nodes = Dict[str, Set[str]]

_HEADER = """\
# Who published and who subscribed to what, by topic, as the robot's master knew it.
"""
_VERSION = 'version'
"""Key of what the file says of its version (docs/monitor.md); no topic is called so."""

_HOSTS = 'hosts'  # key of the computers of nodes; no topic is called so either

_MOST_FORMAT = (1 << 32) - 1
_CALLER_ID = '/train'


@dataclass
class RobotGraph:
    """Who publishes and who subscribes to what, by topic; nodes by their full names."""

    publishers: _Nodes = field(default_factory=dict)
    subscribers: _Nodes = field(default_factory=dict)
    # Computers of nodes, by their names or addresses; those that are known.
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

    def add_to(self, model: TrainedModel, encoding: EncodingRules) -> None:
        """Let a model know it, too, by the names that the encoding gives."""
        model.graph = model.graph | self.edges(encoding)
        model.hosts = self.hosts_of_sources(encoding)
        model.unheard = self.unheard(encoding)

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
        section = Section(content, path)
        newer = _format(section) > FileVersion.of_graph().format
        graph = cls(hosts=section.texts_by_key(_HOSTS) if _HOSTS in section else {})
        for topic in content:
            if topic in (_VERSION, _HOSTS) or newer and not str(topic).startswith('/'):
                continue  # also what this version does not know
            nodes = section.section(topic)
            name = resolved_name(str(topic))
            graph.publishers.setdefault(name, set()).update(nodes.texts('publishers', fewest=0))
            graph.subscribers.setdefault(name, set()).update(nodes.texts('subscribers', fewest=0))
        return graph


def fetch() -> RobotGraph:
    """Ask the master, and nobody else: no node sees that somebody asks.

    Nodes of this package look at the robot, and are left out.

    Raises:
        ValueError: no master answers.
    """
    # Imported here: it takes long, and few trainings ask for the graph.
    import rosgraph

    try:
        master = rosgraph.Master(_CALLER_ID)
        state, types = master.getSystemState(), dict(master.getTopicTypes())
        ours = {node for topic, nodes in state[0] for node in nodes
                if is_own_type(types.get(topic, ''))}
        publishers, subscribers = (
            [(topic, set(nodes) - ours) for topic, nodes in nodes_of] for nodes_of in state[:2])
        hosts = _hosts(master, {node for _, nodes in publishers for node in nodes})
    except (OSError, rosgraph.MasterException) as error:
        raise ValueError(f'no master at {rosgraph.get_master_uri()}: is the robot running, and is '
                         'ROS_MASTER_URI right?') from error
    return RobotGraph(_by_topic(publishers), _by_topic(subscribers), hosts)


def _hosts(master: Any, nodes: Iterable[str]) -> Dict[str, str]:
    """Return the computers of nodes, those that the master knows; all of them in one call."""
    known = sorted(nodes)
    calls: Any = MultiCall(master.handle)
    for node in known:
        calls.lookupNode(_CALLER_ID, node)
    try:
        answers = list(calls()) if known else []
    except Fault:  # a master that answers one call at a time
        return {}
    return {printable(node): host for node, (code, _, uri) in zip(known, answers)
            for host in [host_in(uri) if code == 1 else ''] if host}


def _by_topic(state: Any) -> Dict[str, Set[str]]:
    return {printable(topic): {printable(node) for node in nodes} for topic, nodes in state
            if nodes}


def graph_file(bag: str) -> str:
    """Return the name of the file with the graph of the robot that a bag is a recording of.

    Args:
        bag: NAME.bag, or NAME.bag.active while it is written.
    """
    for end in ('.active', '.bag'):
        bag = bag[:-len(end)] if bag.endswith(end) else bag
    return f'{bag}.graph.yaml'


def _format(section: Section) -> int:
    """Return the format of a file by what it says of its version; 1: release 0.1.0 wrote it.

    Raises:
        ValueError: this version of the package does not understand it, or it says nothing.
    """
    if _VERSION not in section:
        return 1
    version = section.section(_VERSION)
    number, oldest_reader = (version.integer(key, 1, high=_MOST_FORMAT)
                             for key in ('format', 'oldest_reader'))
    problem = FileVersion.why_graph_too_new(number, oldest_reader,
                                            version.text('package', '.*', 'None'))
    if problem:
        section.fail(_VERSION, problem)
    return int(number)
