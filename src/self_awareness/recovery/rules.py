"""Reads the rules of a recovery: config/recovery.yaml is an example (docs/recovery.md)."""
from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass
from typing import Mapping, Tuple, Union

from self_awareness import yaml_file
from self_awareness.recovery.history import MOST
from self_awareness.yaml_section import Section, shown

KINDS = ('silent', 'topic silent', 'unanswered', 'slow', 'fast', 'late', 'early', 'out of order',
         'never came', 'stale', 'lossy', 'other size', 'stuck')
"""Of incidents that blame a component of the robot, as SelfAwareness.msg has them."""

MOST_STOPPED = 5  # nodes that a step may stop: it mends a part of the robot

BLAME_NOBODY = ('busy machine', 'all silent', 'two senders', 'slower clock')
"""Of incidents: there is nothing to repair."""

_DAY_S = 86400.0
_LONGEST_GRACE_S = 60.0
_NAME = re.compile(r'(/[A-Za-z][A-Za-z0-9_]*)+')
_OF_ROS = {'/rosout': "it is ROS's own", '/master': 'it is the master',
           '/roscore': 'it is the master', '/rosapi': 'others talk to the robot by it'}


@dataclass(frozen=True)
class Call:
    """A step: a service of type std_srvs/Trigger is called."""

    service: str

    def __str__(self) -> str:
        return f'call {self.service}'


@dataclass(frozen=True)
class Stop:
    """A step: nodes are stopped, one after the other, so that roslaunch starts them again."""

    nodes: Tuple[str, ...]

    def __str__(self) -> str:
        return f'stop {", ".join(self.nodes)}'


Step = Union[Call, Stop]


@dataclass(frozen=True)
class Rule:
    """What is done about some kinds (of KINDS) of incidents that blame one component.

    The steps follow each other, until one has helped.
    """

    component: str
    kinds: Tuple[str, ...]
    steps: Tuple[Step, ...]


@dataclass(frozen=True)
class Rules:
    """All that a recovery may do."""

    rules: Tuple[Rule, ...]  # no two fit the same incident
    # An alarm stands for so long before the first step; what is gone for as long is healed [s].
    delay: float = 5.0
    # A first step has so long to help; each further one of the incident twice as long as the one
    # before [s].
    wait: float = 20.0
    grace: float = 3.0  # a node has so long to end, before the next way to stop it [s]
    limit: int = 3  # most steps in an hour, for each rule
    limit_of_all: int = 6  # most steps in an hour, of all rules together
    dry_run: bool = False  # nothing is done, but said

    @property
    def nodes(self) -> Tuple[str, ...]:
        """All nodes that may be stopped, each once."""
        return tuple(dict.fromkeys(node for rule in self.rules for step in rule.steps
                                   if isinstance(step, Stop) for node in step.nodes))


def load(path: str, monitor: str, recovery: str) -> Rules:
    """Return the rules of a file, which may stop neither monitor nor recovery (full names).

    Raises:
        OSError: the file cannot be read.
        SectionError: it cannot be used; the message names the file, the key and the way out.
        ValueError: it is no YAML.
    """
    data = yaml_file.load(path)
    untouchable = {**_OF_ROS, monitor: 'it is the monitor',
                   f'{monitor}_manager': "it is the monitor's nodelet manager",
                   recovery: 'it is the recovery itself'}
    default = Rules(())
    with Section({} if data is None else data, path) as section:
        read = Rules(
            delay=section.number('delay', 0.0, _DAY_S, default.delay),
            wait=section.number('wait', 1.0, _DAY_S, default.wait),
            grace=section.number('grace', 0.1, _LONGEST_GRACE_S, default.grace),
            limit=section.integer('limit', 1, default.limit, MOST),
            limit_of_all=section.integer('limit_of_all', 1, default.limit_of_all, MOST),
            dry_run=section.boolean('dry_run', default.dry_run),
            rules=tuple(_rule(each, untouchable) for each in section.sections('rules')))
        taken = Counter((rule.component, kind) for rule in read.rules for kind in rule.kinds)
        for (component, kind), number in taken.items():
            if number > 1:
                section.fail('rules', f'two rules for {component} {kind}; give their steps in one '
                             'rule')
    return read


def _rule(section: Section, untouchable: Mapping[str, str]) -> Rule:
    with section:
        component = _name(section, 'component', section.text('component'))
        kinds = section.texts('kinds')
        for kind in kinds:
            if kind in BLAME_NOBODY:
                section.fail('kinds', f'{kind!r} blames no component, so that there is nothing to '
                             'repair; remove it')
            if kind not in KINDS:
                section.fail('kinds', f'{shown(kind)} is not a kind; choose from '
                             f'{", ".join(KINDS)}')
        return Rule(component, tuple(dict.fromkeys(kinds)), tuple(
            _step(each, untouchable) for each in section.sections('steps')))


def _step(section: Section, untouchable: Mapping[str, str]) -> Step:
    with section:
        if ('call' in section) == ('stop' in section):
            section.fail('call', 'a step either calls a service or stops nodes: give call or stop')
        if 'call' in section:
            service = _name(section, 'call', section.text('call'))
            for node, why in untouchable.items():
                if service.startswith(f'{node}/'):
                    section.fail('call', f'{service} may not be called: {why}; remove it')
            return Call(service)
        nodes = section.texts('stop')
        for node in nodes:
            _name(section, 'stop', node)
            if node in untouchable:
                section.fail('stop', f'{node} may not be stopped: {untouchable[node]}; remove it')
        if len(set(nodes)) < len(nodes):
            section.fail('stop', 'a node is there twice; name each once')
        if len(nodes) > MOST_STOPPED:
            section.fail('stop', f'{len(nodes)} nodes; a step may stop at most {MOST_STOPPED}: it '
                         'is to mend a part of the robot, never all of it')
        return Stop(tuple(nodes))


def _name(section: Section, key: str, name: str) -> str:
    if not _NAME.fullmatch(name):
        section.fail(key, f'{shown(name)} is no full name, as /player is, and patterns are not '
                     'allowed')
    return name
