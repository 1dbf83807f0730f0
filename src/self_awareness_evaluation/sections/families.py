"""What the pages say of the families of robots."""
from __future__ import annotations

from dataclasses import replace
from typing import Dict, List, Sequence

from self_awareness.reporting.text import number_of
from self_awareness_evaluation.families.kinds import FAMILIES
from self_awareness_evaluation.families.protocol import KINDS, NEVER, TITLES
from self_awareness_evaluation.families.scene import CRASH, FLOOD, LATE, OTHER, RESTART
from self_awareness_evaluation.figures import (NONE, WITHIN_S, Found, Quiet, grouped, interval,
                                               normal, number, of_fault, part, percent, rate,
                                               seconds, table)
from self_awareness_evaluation.pages import RESEARCH, RESULTS, Section
from self_awareness_evaluation.rows import Row

NAME = 'families'
TITLE = 'Robots of other kinds'  # above the section, on each page

ALL = 'all'

_SUSPICIONS = (OTHER, NEVER)  # that are no alarms

_MOST_SOURCES = 2
_WITHIN = ' / '.join(f'{each:g}' for each in WITHIN_S)


def section(rows: Sequence[Row]) -> Section:
    """Return what is written of rows; the first system and budget are those of most figures."""
    main = rows[0].subject
    by_learning = grouped((row for row in rows if (row.subject.system, row.subject.budget)
                           == (main.system, main.budget)), lambda row: row.subject.learning)
    families = list(grouped(rows, _family))
    seeds = grouped(rows, lambda row: row.subject.robot.rpartition(' ')[2])
    hours = Quiet.of(normal(next(iter(by_learning.values())))).hours
    told = (f'{len(families)} families, seeds {", ".join(seeds)}, {hours:.3g} h of normal '
            f'operation; learned from {" and from ".join(by_learning)}.')
    return Section(NAME, TITLE, {
        RESULTS: [told, '', *_results(by_learning)],
        RESEARCH: [told, '', *_of_families(families, by_learning), '', '### All together', '',
                   *_pooled(rows), '',
                   *(f'- `{name}`: {FAMILIES[name].told}' for name in families)]}, _family)


def started(learning: str) -> str:
    """Return what was learned from in two words."""
    return number_of(int(learning.partition(' ')[0]), 'start')


def _results(by_learning: Dict[str, List[Row]]) -> List[str]:
    """Return the table of all families together, in words; who is named, by the last learning."""
    body = [['false alarms an hour (95 %)',
             *(rate(Quiet.of(normal(rows))) for rows in by_learning.values()), NONE]]
    for kind in KINDS:
        found = [_of_kind(rows, kind) for rows in by_learning.values()]
        if found[0].records:
            body.append([TITLES[kind], *(
                f'{percent(each.share())} ({interval(each)}), {seconds(each.median_s)}'
                for each in found), f'{part(found[-1].first)} / {part(found[-1].at_end)}'])
    named = [Found.of(of_fault(rows, '')).bystanders for rows in by_learning.values()]
    return [*table(['what', *(f'{started(learning)}: alarm (95 %), median'
                              for learning in by_learning), 'the right node first / at the end'],
                   body), '', 'Alarms that name a node which has nothing to do with the fault: '
            + '; '.join(f'{some} of {all_}' for some, all_ in named) + '.']


def _of_families(families: Sequence[str], by_learning: Dict[str, List[Row]]) -> List[str]:
    first, last = next(iter(by_learning)), list(by_learning)[-1]
    kinds = [kind for kind in KINDS if kind not in (CRASH, RESTART, FLOOD, *_SUSPICIONS)]
    head = ['family', *(f'false alarms/h, {started(each)}' for each in by_learning),
            'alarm stands', 'WARN/h', f'crashes, within {_WITHIN} s',
            *(f'{TITLES[kind]}, {started(last)}' if kind == LATE else TITLES[kind]
              for kind in kinds), 'alarms after a restart', 'watched', 'false alarms from']
    body = []
    for family in [*families, ALL]:
        rows = {learning: [row for row in of_learning if family in (ALL, _family(row))]
                for learning, of_learning in by_learning.items()}
        quiet = Quiet.of(normal(rows[first]))
        body.append([
            family, *(rate(Quiet.of(normal(each))) for each in rows.values()),
            percent(quiet.standing), number(quiet.warnings_per_hour),
            _crashes(rows[first]), *(_found(rows[last if kind == LATE else first], kind)
                                     for kind in kinds),
            _after(rows[first]), _watched(quiet), _sources(quiet)])
    return [f'Of what was learned from {started(first)}, if a column says nothing else. *First*, '
            '*end*: the right node is blamed when the alarm is raised, and when the fault ends; '
            'or nobody, where no node is guilty.', '', *table(head, body)]


def _pooled(rows: Sequence[Row]) -> List[str]:
    """Return the table of all families together, for each system, learning and budget."""
    body = []
    for (learning, system, budget), of_subject in grouped(
            rows, lambda row: (row.subject.learning, row.subject.system, row.subject.budget)
            ).items():
        quiet = Quiet.of(normal(of_subject))
        body.append([
            system, started(learning), NONE if budget is None else f'{budget:g}', rate(quiet),
            number(quiet.expected), percent(quiet.kept) if quiet.expected >= 0.0 else NONE,
            number(quiet.warnings_per_hour), _watched(quiet), _crashes(of_subject),
            *(_found(of_subject, kind) for kind in KINDS if kind not in (CRASH, RESTART)),
            _after(of_subject)])
    return table(['system', 'learned from', 'budget', 'false alarms/h', 'promised',
                  'robots within the promise', 'WARN/h', 'watched',
                  f'crashes, within {_WITHIN} s',
                  *(TITLES[kind] for kind in KINDS if kind not in (CRASH, RESTART)),
                  'alarms after a restart'], body)


def _of_kind(rows: Sequence[Row], kind: str) -> Found:
    """Return how a kind was found; of what is no alarm, by its suspicion."""
    found = Found.of(of_fault(rows, kind))
    return replace(found, latencies_s=found.noticed_s) if kind in _SUSPICIONS else found


def _family(row: Row) -> str:
    return row.subject.family


def _crashes(rows: Sequence[Row]) -> str:
    found = Found.of(of_fault(rows, CRASH))
    told = ' / '.join(f'{100.0 * found.share(each):.0f}' for each in WITHIN_S)
    return f'{told} %{_blame(found)}' if found.records else NONE


def _found(rows: Sequence[Row], kind: str) -> str:
    found = _of_kind(rows, kind)
    if not found.records:
        return NONE
    return f'{100.0 * found.share():.0f} %, {seconds(found.median_s)}{_blame(found)}'


def _blame(found: Found) -> str:
    if not found.first[1]:
        return ''
    return f', first {part(found.first)}, end {part(found.at_end)}'


def _after(rows: Sequence[Row]) -> str:
    count, records = Found.of(of_fault(rows, RESTART)).after
    return f'{count} after {records}' if records else NONE


def _watched(quiet: Quiet) -> str:
    return f'{number(quiet.watched)} of {number(quiet.components)}'


def _sources(quiet: Quiet) -> str:
    return '; '.join(f'{text} {count}' for text, count in quiet.evidence[:_MOST_SOURCES]) or NONE
