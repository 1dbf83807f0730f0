"""Who publishes to whom near the suspects of an alarm, and where each node is drawn."""
from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from itertools import zip_longest
from typing import Dict, Iterable, List, Mapping, Sequence, Set, Tuple

MOST_NODES = 30
"""Nodes that are drawn, at most so many."""

ROOT, VICTIM, OTHER = 'root', 'victim', 'other'
"""What a node is: the first suspect, another suspect, or a neighbour of them."""

_FARTHEST = 2
_SWEEPS = 4

Edge = Tuple[str, str, str]
"""Publisher, topic, subscriber."""


@dataclass(frozen=True)
class Node:
    """A node of the graph; it is drawn in a layer, from left to right, at a place in it."""

    name: str
    role: str
    layer: int
    place: float


@dataclass(frozen=True)
class Connection:
    """All topics from one node to another."""

    publisher: str
    subscriber: str
    topics: List[str]


@dataclass(frozen=True)
class Neighbourhood:
    """What is drawn of the graph; `left_out` nodes of it are not."""

    nodes: List[Node]
    connections: List[Connection]
    left_out: int


def neighbourhood(edges: Iterable[Edge], suspects: Sequence[str]) -> Neighbourhood:
    """Return the part of a graph that lies near the suspects.

    Args:
        edges: of the graph.
        suspects: nodes; the first one is the root. Those that are not in the graph are left out.
    """
    topics: Dict[Tuple[str, str], List[str]] = defaultdict(list)
    for publisher, topic, subscriber in sorted(edges):
        if publisher != subscriber:
            topics[publisher, subscriber].append(topic)
    beside: Dict[str, List[str]] = defaultdict(list)
    for publisher, subscriber in topics:  # publishers first: one of them may be the cause
        beside[subscriber].append(publisher)
    for publisher, subscriber in topics:
        beside[publisher].append(subscriber)
    inside = [name for name in dict.fromkeys(suspects) if name in beside]
    kept = _nearest(beside, inside)
    links = {pair: names for pair, names in topics.items() if set(pair) <= set(kept)}
    placed = _places(kept, list(links))
    roles = {name: VICTIM for name in inside}
    roles.update({name: ROOT for name in suspects[:1]})
    nodes = [Node(name, roles.get(name, OTHER), *placed[name]) for name in kept]
    return Neighbourhood(nodes, [Connection(*pair, names) for pair, names in links.items()],
                         len(beside) - len(kept) if kept else 0)


def _nearest(beside: Mapping[str, Sequence[str]], start: Sequence[str]) -> List[str]:
    kept = list(start[:MOST_NODES])
    ring = kept
    for _ in range(_FARTHEST):
        in_turn = zip_longest(*[beside[name] for name in ring])  # nobody takes all the room
        following = dict.fromkeys(name for each in in_turn for name in each if name is not None)
        ring = [name for name in following if name not in kept][:MOST_NODES - len(kept)]
        kept = kept + ring
    return kept


def _places(names: Sequence[str], links: Sequence[Tuple[str, str]]) -> Dict[str,
                                                                            Tuple[int, float]]:
    """Return layer and place of each node: publishers to the left of their subscribers.

    A connection that closes a loop goes back. In a layer, nodes stand near those that they are
    connected to (the barycentre method of Sugiyama, Tagawa and Toda, 1981).
    """
    followers = _without_loops(names, links)
    layer = {name: 0 for name in names}
    for name in _in_order(names, followers):
        for follower in followers[name]:
            layer[follower] = max(layer[follower], layer[name] + 1)
    layers: Dict[int, List[str]] = defaultdict(list)
    for name in names:
        layers[layer[name]].append(name)
    beside: Dict[str, Set[str]] = defaultdict(set)
    for publisher, subscriber in links:
        beside[publisher].add(subscriber)
        beside[subscriber].add(publisher)
    place = _spread(layers)
    for _ in range(_SWEEPS):
        for members in layers.values():
            members.sort(key=lambda name: _mean([place[other] for other in beside[name]],
                                                place[name]))
        place = _spread(layers)
    return {name: (layer[name], place[name]) for name in names}


def _without_loops(names: Sequence[str],
                   links: Sequence[Tuple[str, str]]) -> Dict[str, List[str]]:
    """Return the followers of each node, without the connections that close a loop."""
    all_followers: Dict[str, List[str]] = {name: [] for name in names}
    for publisher, subscriber in links:
        all_followers[publisher].append(subscriber)
    followers: Dict[str, List[str]] = {name: [] for name in names}
    done: Set[str] = set()
    for start in names:
        way = [(start, iter(all_followers[start]))] if start not in done else []
        open_nodes = {start}
        while way:
            name, rest = way[-1]
            follower = next(rest, None)
            if follower is None:
                way.pop()
                open_nodes.discard(name)
                done.add(name)
            elif follower not in open_nodes:
                followers[name].append(follower)
                if follower not in done:
                    open_nodes.add(follower)
                    way.append((follower, iter(all_followers[follower])))
    return followers


def _in_order(names: Sequence[str], followers: Mapping[str, Sequence[str]]) -> List[str]:
    """Return the nodes of a graph without loops, each before its followers."""
    waits = {name: 0 for name in names}
    for each in followers.values():
        for follower in each:
            waits[follower] += 1
    ready = [name for name in names if waits[name] == 0]
    for name in ready:  # grows meanwhile
        for follower in followers[name]:
            waits[follower] -= 1
            if waits[follower] == 0:
                ready.append(follower)
    return ready


def _spread(layers: Mapping[int, Sequence[str]]) -> Dict[str, float]:
    """Return places from 0 to 1, evenly spread in each layer."""
    return {name: (index + 0.5) / len(members)
            for members in layers.values() for index, name in enumerate(members)}


def _mean(values: Sequence[float], otherwise: float) -> float:
    return sum(values) / len(values) if values else otherwise
