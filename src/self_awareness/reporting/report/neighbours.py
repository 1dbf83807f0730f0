"""Who publishes to whom near the cause of an incident, drawn by dot of Graphviz."""
from __future__ import annotations

import re
import subprocess
from collections import Counter, defaultdict, deque
from dataclasses import dataclass
from typing import Dict, Iterable, List, Mapping, Sequence, Set, Tuple

from self_awareness.reporting.text import first_lines

MOST_NODES = 14  # nodes that are drawn, at most so many: what a phone can show
MOST_TOPICS = 2  # topics that are named at a connection, at most so many

ROOT, VICTIM, OTHER = 'root', 'victim', 'other'
"""What a node is: the first suspect, another suspect, or a neighbour of them."""

_FEWEST_HEARD, _NEARLY_ALL = 5, 0.8
_LOG_TOPICS = ('/rosout', '/rosout_agg')
_LONGEST_LINE = 16
_TIMEOUT_S = 20

Edge = Tuple[str, str, str]  # publisher, topic, subscriber


@dataclass(frozen=True)
class Neighbourhood:
    """What is drawn of a graph."""

    roles: Dict[str, str]  # of the nodes, by name, the most important first
    topics: Dict[Tuple[str, str], List[str]]  # by publisher and subscriber
    left_out: int  # number of nodes that are farther away
    listeners: List[str]  # nodes that hear nearly everybody, and are left out


def neighbourhood(edges: Iterable[Edge], suspects: Sequence[str]) -> Neighbourhood:
    """Return the part of a graph that lies near the suspects.

    Kept are the first suspect, the shortest ways from it to the others, and who publishes to it or
    hears it. Listeners to nearly everybody, such as recorders, are not: all nodes would be near.

    Args:
        edges: of the graph.
        suspects: nodes; the first one is the root. Those that are not in the graph are left out.
    """
    topics: Dict[Tuple[str, str], List[str]] = defaultdict(list)
    for publisher, topic, subscriber in sorted(edges):
        if publisher != subscriber and topic not in _LOG_TOPICS:
            topics[publisher, subscriber].append(topic)
    listeners = _listeners(topics, suspects)
    topics = {pair: names for pair, names in topics.items() if pair[1] not in listeners}
    beside: Dict[str, List[str]] = defaultdict(list)
    for publisher, subscriber in topics:  # publishers first: one of them may be the cause
        beside[subscriber].append(publisher)
    for publisher, subscriber in topics:
        beside[publisher].append(subscriber)
    inside = [name for name in dict.fromkeys(suspects) if name in beside]
    kept = _near(beside, inside)
    roles = {name: OTHER for name in kept}
    roles.update({name: VICTIM for name in inside if name in roles})
    roles.update({name: ROOT for name in suspects[:1] if name in roles})
    return Neighbourhood(roles, {pair: names for pair, names in topics.items()
                                 if set(pair) <= set(kept)},
                         len(beside) - len(kept) if kept else 0, sorted(listeners))


def draw(shown: Neighbourhood) -> str:
    """Return a neighbourhood as an element of a page (SVG); its style is in page.css.

    Messages go down or to the right, as takes less width: a phone has little.

    Raises:
        OSError: dot fails.
    """
    return min((_drawn(shown, direction) for direction in ('TB', 'LR')),
               key=lambda svg: int(re.findall(r'<svg width="(\d+)pt"', svg)[0]))


def _drawn(shown: Neighbourhood, direction: str) -> str:
    try:
        done = subprocess.run(('dot', '-Tsvg', f'-Grankdir={direction}'),
                              input=_dot(shown).encode(), check=True,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=_TIMEOUT_S)
    except subprocess.SubprocessError as error:
        raise OSError(f'dot cannot draw who publishes to whom: {error}') from error
    svg = done.stdout.decode('utf-8')
    # Several in a page have the same ids, and nothing needs them.
    return re.sub(r' id="[^"]*"', '', svg[svg.index('<svg'):])


def _listeners(topics: Mapping[Tuple[str, str], Sequence[str]],
               suspects: Sequence[str]) -> Set[str]:
    """Return who hears nearly everybody, and is no suspect."""
    publishers = {publisher for publisher, _ in topics}
    heard = Counter(subscriber for _, subscriber in topics)
    return {name for name, number in heard.items()
            if number >= max(_FEWEST_HEARD, _NEARLY_ALL * len(publishers - {name}))
            and name not in suspects}


def _near(beside: Mapping[str, Sequence[str]], inside: Sequence[str]) -> List[str]:
    if not inside:
        return []
    # Breadth first: by whom each node was reached on a shortest way from the root.
    reached_by = {inside[0]: inside[0]}
    waiting = deque(inside[:1])
    while waiting:
        name = waiting.popleft()
        for other in beside[name]:
            if other not in reached_by:
                reached_by[other] = name
                waiting.append(other)
    kept = dict.fromkeys(inside[:1])
    for suspect in inside[1:]:
        way = [suspect]
        while way[-1] in reached_by and way[-1] not in kept:
            way.append(reached_by[way[-1]])
        if len(set(kept) | set(way)) <= MOST_NODES:
            kept.update(dict.fromkeys(way))
    for name in beside[inside[0]]:
        if len(kept) < MOST_NODES:
            kept[name] = None
    return list(kept)


def _dot(shown: Neighbourhood) -> str:
    numbers = {name: f'n{number}' for number, name in enumerate(shown.roles)}
    lines = ['digraph {', 'bgcolor=transparent; nodesep=0.15; ranksep=0.3;',
             'node [shape=box, fontname="sans-serif", fontsize=12, height=0.3, '
             'margin="0.08,0.04"];',
             'edge [fontname="sans-serif", fontsize=9, arrowsize=0.6];']
    for name, role in shown.roles.items():
        lines.append(f'{numbers[name]} [label={_quoted(_in_lines(name))}, class={role}];')
    for (publisher, subscriber), topics in shown.topics.items():
        label = first_lines([_in_lines(topic) for topic in topics], MOST_TOPICS)
        lines.append(f'{numbers[publisher]} -> {numbers[subscriber]} '
                     f'[label={_quoted(chr(10).join(label))}];')
    return '\n'.join([*lines, '}'])


def _in_lines(name: str) -> str:
    """Return a name in lines that break before a slash."""
    lines = ['']
    for number, part in enumerate(name.split('/')):
        part = part if number == 0 else f'/{part}'
        if lines[-1] and len(lines[-1] + part) > _LONGEST_LINE:
            lines.append('')
        lines[-1] += part
    return '\n'.join(lines)


def _quoted(text: str) -> str:
    """Return a text as dot shows it as it is: it has escapes and entities of its own."""
    escapes = str.maketrans({'\\': r'\\', '"': r'\"', '&': '&amp;', '\n': r'\n'})
    return f'"{text.translate(escapes)}"'
