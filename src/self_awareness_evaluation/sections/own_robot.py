"""What the pages say of the simulated follow-me robot."""
from __future__ import annotations

from typing import Callable, Dict, List, Sequence

from self_awareness_evaluation.figures import (NONE, Found, Quiet, grouped, interval, median,
                                               normal, number, of_fault, part, percent, rate,
                                               seconds, share, table)
from self_awareness_evaluation.pages import RESEARCH, RESULTS, Section
from self_awareness_evaluation.records import NORMAL
from self_awareness_evaluation.rows import Row
from self_awareness_evaluation.simulated import WITHIN_S

NAME = 'simulated'
TITLE = 'The simulated robot'  # above the section, on each page

FALSE_ALARMS = 'false alarms an hour (95 %)'
EVERY_CRASH = 'every crash'

TOLD: Dict[str, str] = {
    'crash:motors': 'a node dies (86 Hz)',
    'crash:face_detection': 'a node dies (often silent)',
    EVERY_CRASH: 'any node dies',
    'silence': 'all nodes fall silent',
    'rs': 'other programs take the CPU',
    'half:player': 'a node sends at half its rate',
    'double:gaze_control': 'a node sends at double its rate',
    'lat': 'a node answers 60 ms later (subscribers known)',
    'order': 'a node publishes two topics in another order',
    'ac': 'the clock of a computer drifts now and then',
    'stale:slam': 'stamps stand still',
}
"""Faults that a user is told of, in words."""

_NOTICED_S: Dict[str, float] = {'extra': 5.0, 'unknown': 5.0, **WITHIN_S}
"""Faults that are a suspicion, or may be, and the time in which one is aimed at [s]."""

_BySystem = Dict[str, List[Row]]


def section(rows: Sequence[Row]) -> Section:
    """Return what is written of rows."""
    by_system = grouped(rows, lambda row: row.subject.system)
    subject = rows[0].subject
    seeds = [name.rpartition(' ')[2] for name in grouped(rows, lambda row: row.subject.robot)]
    told = (f'Seeds {seeds[0]} to {seeds[-1]}; learned from {subject.learning}; '
            f'{Quiet.of(rows).hours / len(by_system):.3g} h without a fault, those before the '
            'onsets included.')
    return Section(NAME, TITLE, {
        RESULTS: [told, '', *_results(by_system[subject.system])],
        RESEARCH: [told, '', *_found(by_system), '', '### Who is named', '', *_named(by_system),
                   '', '### Suspicions', '', *_noticed(by_system)]})


def _results(rows: Sequence[Row]) -> List[str]:
    """Return the table of the first system, in words."""
    body = []
    for name, of_kind in _kinds(rows).items():
        if name in TOLD:
            found = Found.of(of_kind)
            body.append([TOLD[name], f'{percent(found.share())} ({interval(found)})',
                         seconds(found.median_s), f'{part(found.first)} / {part(found.at_end)}'])
    return [*table(['what happens', 'alarm (95 %)', 'median', 'the right node first / at the end'],
                   body), '',
            f'False alarms an hour: {rate(Quiet.of(rows))}.']


def _found(by_system: _BySystem) -> List[str]:
    quiet = {name: Quiet.of(rows) for name, rows in by_system.items()}
    body = [[FALSE_ALARMS, *(rate(each) for each in quiet.values())],
            ['WARN or alarm an hour',
             *(number(each.warnings_per_hour) for each in quiet.values())],
            ['components watched', *(
                f'{each.watched:.3g} of {each.components:.3g}' if each.watched >= 0.0 else NONE
                for each in (Quiet.of(normal(rows)) for rows in by_system.values()))]]
    return table(['fault', *by_system], [*body, *_rows(by_system, share)])


def _named(by_system: _BySystem) -> List[str]:
    def cell(found: Found) -> str:
        return ' / '.join(part(each) for each in (found.first, found.among_three, found.at_end))
    named = [row for row in _rows(by_system, cell) if set(row[1:]) != {cell(Found.of([]))}]
    return ['First / among three / when the fault ends, where nobody is right if no node is '
            'guilty.', '', *table(['fault', *by_system], named)]


def _noticed(by_system: _BySystem) -> List[str]:
    body = []
    for kind, within_s in _NOTICED_S.items():
        found = [Found.of(of_fault(rows, kind)) for rows in by_system.values()]
        if found[0].records:
            in_time = [sum(each_s <= within_s for each_s in each.noticed_s) for each in found]
            body.append([kind, f'{within_s:g} s', *(
                f'{part((number_of, each.records))}, {seconds(median(each.noticed_s))}'
                for number_of, each in zip(in_time, found))])
    return ['WARN or alarm in the time that is aimed at, and the median time to it.', '',
            *table(['fault', 'within', *by_system], body)]


def _rows(by_system: _BySystem, cell: Callable[[Found], str]) -> List[List[str]]:
    """Return a row of a table for every fault."""
    kinds = {name: _kinds(rows) for name, rows in by_system.items()}
    return [[fault, *(cell(Found.of(of_system[fault])) for of_system in kinds.values())]
            for fault in next(iter(kinds.values()))]


def _kinds(rows: Sequence[Row]) -> Dict[str, List[Row]]:
    """Return the rows by fault, and those of all crashes."""
    found = grouped((row for row in rows if row.fault != NORMAL), lambda row: row.fault)
    crashes = of_fault(rows, 'crash')
    return {**found, EVERY_CRASH: crashes} if crashes else found
