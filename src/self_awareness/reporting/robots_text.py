"""Says by name which components only some robots have: on the others, nobody misses them."""
from __future__ import annotations

from typing import Any, Dict, List, Mapping, Set

_MOST_NAMED = 20
_MOST_ROBOTS = 5


def summarise(robots: Mapping[str, Set[str]]) -> Dict[str, Any]:
    """Return the robots of a training, and what only some of them have, by component.

    Args:
        robots: components by robot, as TrainedModel.robots has them.
    """
    everywhere = set.intersection(*robots.values()) if robots else set()
    optional = sorted(set().union(*robots.values()) - everywhere)
    return {'robots': sorted(robots),
            'optional': {component: sorted(robot for robot, has in robots.items()
                                           if component in has) for component in optional}}


def lines(summary: Dict[str, Any]) -> List[str]:
    """Return lines below the table of who is watched: a component in each, and how many more."""
    optional = summary['optional']
    more = len(optional) - _MOST_NAMED
    return [f'{component}: optional, only {_names(on)} of {len(summary["robots"])} robots '
            'had it in training'
            for component, on in list(optional.items())[:_MOST_NAMED]
            ] + ([f'and {more} more that only some robots had'] if more > 0 else [])


def _names(robots: List[str]) -> str:
    named = [robot or '(no name)' for robot in robots[:_MOST_ROBOTS]]
    more = len(robots) - len(named)
    return ', '.join(named) + (f' and {more} more' if more > 0 else '')
