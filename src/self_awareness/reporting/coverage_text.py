"""Says by name how soon faults of each component are found, and who and what is not watched."""
from __future__ import annotations

from typing import Any, Dict, Iterable, List, Mapping, Sequence, Set, Tuple

from self_awareness import Coverage, TrainedModel
from self_awareness.reporting.text import aligned, duration, first_lines, first_of, rounded

_COLUMNS = ('component', 'speaks every', 'death found after', 'late answers')
_MOST_NAMED = 8
_MOST_LINES = 20
_MOST_ROBOTS = 5


def summarise(coverage: Sequence[Coverage]) -> List[Dict[str, Any]]:
    """Return a mapping for each component, with times in seconds; what is missing is None.

    Args:
        coverage: as TrainedModel.coverage() returns it.
    """
    return [{'component': each.component, 'period': each.period or None, 'gaps': each.gaps,
             'watched': each.is_watched, 'death_found_after': each.death_found_after,
             'found_when_asked': each.found_when_asked, 'found_after': each.found_after,
             'late_answers_from_s': each.late_answers, 'more_starts': each.more_starts or None,
             'late_answers_found': each.late_answers_found,
             'not_judged': [{'what': what, 'topic': topic, 'why': why}
                            for what, topic, why in each.blind]} for each in coverage]


def not_watched(found: Sequence[Dict[str, Any]]) -> str:
    """Return who is not watched, by name; empty: everybody is, or it is not known."""
    names = [each['component'] for each in found if not each['watched']]
    if not names:
        return ''
    return (f'{len(names)} of {len(found)} components are not watched: '
            f'{first_of(names, _MOST_NAMED)}')


def not_judged(found: Sequence[Dict[str, Any]]) -> List[str]:
    """Return what is not judged of topics that are watched otherwise, a line for each reason."""
    topics: Dict[Tuple[str, str], List[str]] = {}
    for each in found:
        for blind in each['not_judged']:
            topics.setdefault((blind['what'], blind['why']), []).append(blind['topic'])
    return [f'not watched: {what} of {first_of(names, _MOST_NAMED)}: {why}'
            for (what, why), names in topics.items()]


def table(found: Sequence[Dict[str, Any]], fewest_gaps: int) -> List[Tuple[str, ...]]:
    """Return the rows of a table, its head first; no row where nothing is known.

    Args:
        found: what summarise() returned.
        fewest_gaps: that an event type needs to be judged.
    """
    if not found:
        return []
    return [_COLUMNS, *((each['component'],
                         f'{rounded(each["period"], 3)} s' if each['period'] else '-',
                         _death(each, fewest_gaps), each['late_answers_found'] or '-')
                        for each in found)]


def lines(found: Sequence[Dict[str, Any]], fewest_gaps: int) -> List[str]:
    """Return the lines of table(), and who and what is not watched."""
    if not found:
        return []
    return [*aligned(table(found, fewest_gaps)), *filter(None, [not_watched(found)]),
            *not_judged(found)]


def unheard(publications: Iterable[Tuple[str, str]]) -> List[str]:
    """Return the names of what nobody subscribed to, as TrainedModel.unheard has it, in order."""
    return [f'{topic} on {source}' if source else topic
            for source, topic in sorted(publications, key=lambda each: (each[1], each[0]))]


def unheard_lines(names: Sequence[str]) -> List[str]:
    """Return lines below the table: what nodes published in training, and nobody subscribed to."""
    return first_lines([f'{name}: not watched, nobody subscribed in training' for name in names],
                       _MOST_LINES, ' topics that nobody subscribed to')


def of_some_robots(model: TrainedModel) -> Dict[str, Any]:
    """Return the robots of a training, if they are several, and what only some of them have, by
    component."""
    robots: Dict[str, Set[str]] = {}
    for robot, _, _, event_types in model.heard_in:
        robots.setdefault(robot, set()).update(each.component for each in event_types)
    if len(robots) < 2:
        robots = {}
    everywhere = set.intersection(*robots.values()) if robots else set()
    optional = sorted(set().union(*robots.values()) - everywhere)
    return {'robots': sorted(robots),
            'optional': {component: sorted(robot for robot, has in robots.items()
                                           if component in has) for component in optional}}


def optional_lines(summary: Mapping[str, Any]) -> List[str]:
    """Return lines below the table: what only some robots have, and nobody misses on others."""
    return first_lines(
        [f'{component}: optional, only '
         f'{first_of([robot or "(no name)" for robot in on], _MOST_ROBOTS)} of '
         f'{len(summary["robots"])} robots had it in training'
         for component, on in summary['optional'].items()],
        _MOST_LINES, ' that only some robots had')


def _death(each: Dict[str, Any], fewest_gaps: int) -> str:
    alone_s, asked_s = each['death_found_after'], each['found_when_asked']
    if each['watched']:
        return ', '.join([*([duration(alone_s)] if alone_s else []), *(
            [f'{duration(asked_s)} while what runs with it goes on']
            if asked_s and (not alone_s or asked_s < alone_s) else [])])
    if each['gaps'] < fewest_gaps:
        return f'not watched: {each["gaps"]} gaps in training, {fewest_gaps} are needed'
    return 'not watched: all of it came at one moment'
