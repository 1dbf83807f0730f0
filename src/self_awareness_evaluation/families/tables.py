"""The tables of the families as Markdown."""
from __future__ import annotations

import math
from typing import Dict, List, Optional, Sequence

from self_awareness_evaluation.families import summary
from self_awareness_evaluation.families.experiment import WITH_GRAPH, Plan, Results
from self_awareness_evaluation.families.measures import NormalRow
from self_awareness_evaluation.families.protocol import DEATH, SELDOM, Learning
from self_awareness_evaluation.families.robot import (CRASH, HALF_RATE, LATE, MISSES, RESTART,
                                                      SILENT, STARVED)
from self_awareness_evaluation.families.summary import ALL, Found, Group, Quiet
from self_awareness_evaluation.simulated.tables import percent, seconds, table

_NONE = '–'
_STARTS_OF_TABLE = 2
_STARTS_OF_LATE = 4
_MOST_SOURCES = 2
_WITHIN_S = (1.0, 5.0, 50.0)
_MORE = {'deaths of who speaks seldom': SELDOM, MISSES: MISSES, STARVED: STARVED, SILENT: SILENT}


def main_learning(plan: Plan) -> Learning:
    """Return what most columns are about: two starts, or what comes first if there are none."""
    return _learning(plan, _STARTS_OF_TABLE)


def late_learning(plan: Plan) -> Learning:
    """Return what the column of late answers is about: four starts, or the same as the others."""
    return next((each for each in plan.learnings if each.starts == _STARTS_OF_LATE),
                main_learning(plan))


def main_system(plan: Plan) -> str:
    """Return whose figures fill most columns: the detector that knows the graph, or the first."""
    return WITH_GRAPH if WITH_GRAPH in plan.systems else plan.systems[0]


def families_table(plan: Plan, results: Results) -> List[str]:
    """Return the lines of the table of all families: false alarms, and how faults are found."""
    normal = summary.groups(results.normal)
    system, learning = main_system(plan), main_learning(plan)
    others = [name for name in plan.systems if name != system]
    head = ['family', *(f'false alarms/h, {_started(plan, each)}' for each in plan.learnings),
            *(f'{name}, {_started(plan, learning)}' for name in others), 'alarm stands', 'WARN/h',
            'crash, within 1 / 5 / 50 s', 'half rate', 'late answers', 'deaths when asked',
            *_MORE, 'alarms after a restart', f'watched: {" / ".join([system, *others])}',
            'false alarms from']
    body = []
    for family in _with_all(plan.families):
        of_family = _Row(plan, results, normal, family)
        quiet = of_family.quiet(learning, system)
        half, death = (of_family.found(learning, system, kind) for kind in (HALF_RATE, DEATH))
        body.append([
            family, *(_rate(of_family.quiet(each, system)) for each in plan.learnings),
            *(_rate(of_family.quiet(learning, name)) for name in others),
            percent(quiet.standing), _number(quiet.warnings_per_hour),
            _crashes(of_family.found(learning, system, CRASH)), _found(half),
            _found(of_family.found(late_learning(plan), system, LATE)), _found(death),
            *(_found(of_family.found(learning, system, kind)) for kind in _MORE.values()),
            _after(of_family.found(learning, system, RESTART)),
            _watched(of_family, learning, [system, *others]), _sources(quiet)])
    return table(head, body)


def budgets_table(plan: Plan, results: Results) -> List[str]:
    """Return the lines of the table of budgets: what calibrations promised, and what came."""
    normal = summary.groups(results.normal)
    body = []
    for learning in plan.learnings:
        for budget in sorted(plan.budgets):
            rows = normal[Group(ALL, str(learning), main_system(plan), budget)]
            quiet = summary.quiet(rows)
            body.append([_started(plan, learning), f'{budget:g}',
                         _number(quiet.expected_per_hour), _rate(quiet),
                         percent(summary.kept(rows))])
    return table(['learned from', 'budget', 'promised', 'came', 'robots within the promise'], body)


class _Row:
    """The figures of a family."""

    def __init__(self, plan: Plan, results: Results, normal: Dict[Group, List[NormalRow]],
                 family: str) -> None:
        self._plan = plan
        self._results = results
        self._normal = normal
        self._family = family

    def quiet(self, learning: Learning, system: str) -> Quiet:
        """Return those of normal operation."""
        return summary.quiet(self._normal[self._group(learning, system)])

    def found(self, learning: Learning, system: str, kind: str) -> Found:
        """Return those of a kind of faults."""
        return summary.found(self._results.faults, self._group(learning, system), kind)

    def _group(self, learning: Learning, system: str) -> Group:
        budget: Optional[float] = self._plan.budgets[0]
        group = Group(self._family, str(learning), system, budget)
        return group if group in self._normal else Group(self._family, str(learning), system, None)


def _learning(plan: Plan, starts: int) -> Learning:
    return next((each for each in plan.learnings if each.starts == starts), plan.learnings[0])


def _started(plan: Plan, learning: Learning) -> str:
    if learning.training_s != plan.learnings[0].training_s:
        return f'{learning.starts} x {learning.training_s:g} s'
    return '1 start' if learning.starts == 1 else f'{learning.starts} starts'


def _with_all(families: Sequence[str]) -> List[str]:
    return [*families, ALL] if len(families) > 1 else list(families)


def _rate(quiet: Quiet) -> str:
    low, high = quiet.interval
    return f'{_number(quiet.per_hour)} ({_number(low)} to {_number(high)})'


def _number(value: float) -> str:
    """Return a rate with as many digits as are worth reading; a dash for NaN."""
    if math.isnan(value):
        return _NONE
    return f'{value:.0f}' if value >= 9.95 else f'{value:.2g}'


def _watched(row: _Row, learning: Learning, systems: Sequence[str]) -> str:
    """Return how many components each system watches, of how many, as means of the robots."""
    quiet = [row.quiet(learning, system) for system in systems]
    return (f'{" / ".join(_number(each.watched) for each in quiet)} of '
            f'{_number(quiet[0].components)}')


def _sources(quiet: Quiet) -> str:
    return '; '.join(f'{text} {number}' for text, number in quiet.evidence[:_MOST_SOURCES]) \
        or _NONE


def _crashes(found: Found) -> str:
    if not found.records:
        return _NONE
    shares = ' / '.join(f'{100.0 * found.within(within_s):.0f}' for within_s in _WITHIN_S)
    return f'{shares} %{_blame(found)}'


def _found(found: Found) -> str:
    if not found.records:
        return _NONE
    return f'{100.0 * found.within():.0f} %, {seconds(found.median_s)}{_blame(found)}'


def _after(found: Found) -> str:
    return f'{found.after} after {found.records}' if found.records else _NONE


def _blame(found: Found) -> str:
    return '' if math.isnan(found.first) else f', first {100.0 * found.first:.0f} %'
