"""What the pages say of rows: a section for each measurement."""
from __future__ import annotations

from dataclasses import replace
from operator import attrgetter
from typing import Callable, Dict, List, Sequence, Tuple

from self_awareness import Tuning
from self_awareness.reporting.text import number_of
from self_awareness_evaluation.families.kinds import FAMILIES
from self_awareness_evaluation.families.protocol import DEATH, KINDS, NEVER, SELDOM, TITLES
from self_awareness_evaluation.families.scene import (CRASH, FLOOD, HALF_RATE, LATE, MISSES, OTHER,
                                                      RESTART, SILENT, STARVED)
from self_awareness_evaluation.figures import (NONE, WITHIN_S, Cell, Found, Quiet, cells, grouped,
                                               interval, median, number, of_all, of_fault, part,
                                               percent, rate, seconds, share, table)
from self_awareness_evaluation.outages import CASES, END, OUTAGE, Case, Span
from self_awareness_evaluation.pages import RESEARCH, RESULTS, Section
from self_awareness_evaluation.records import NORMAL
from self_awareness_evaluation.rows import HOUR_S, Row
from self_awareness_evaluation.simulated import WITHIN_S as AIMED_S
from self_awareness_evaluation.variants import Variant

OWN_TITLE, FAMILIES_TITLE = 'The simulated robot', 'Robots of other kinds'
"""Above the sections, on each page."""

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

_NOTICED_S: Dict[str, float] = {'extra': 5.0, 'unknown': 5.0, **AIMED_S}
"""Faults that are a suspicion, or may be, and the time in which one is aimed at [s]."""

ALL = 'all'  # families together
_SUSPICIONS = (OTHER, NEVER)  # that are no alarms

_MOST_SOURCES = 2
_FAMILY = attrgetter('subject.family')  # of a row
_WITHIN = ' / '.join(f'{each:g}' for each in WITHIN_S)

# Of the ablation, by column.
_KINDS: Dict[str, Tuple[str, ...]] = {
    'crashes': (CRASH, 'cc1', 'cc2'), 'half rates': (HALF_RATE, 'half'),
    'late answers': (LATE, 'lat'), 'deaths when asked': (DEATH,), 'AC': (MISSES, 'ac'),
    'RS': (STARVED, 'rs'), 'all silent': (SILENT, 'silence'), 'seldom': (SELDOM,),
    'outages': (OUTAGE,), 'restarts': (RESTART,)}

_BySystem = Dict[str, List[Row]]


def simulated(rows: Sequence[Row]) -> Section:
    """Return what is written of rows of the simulated follow-me robot."""
    by_system = grouped(rows, lambda row: row.subject.system)
    subject = rows[0].subject
    seeds = [name.rpartition(' ')[2] for name in grouped(rows, lambda row: row.subject.robot)]
    told = (f'Seeds {seeds[0]} to {seeds[-1]}; learned from {subject.learning}; '
            f'{Quiet.of(rows).hours / len(by_system):.3g} h without a fault, those before the '
            'onsets included.')
    return Section('simulated', OWN_TITLE, {
        RESULTS: [told, '', *_told_in_words(by_system[subject.system])],
        RESEARCH: [told, '', *_by_fault(by_system), '', '### Who is named', '', *_named(by_system),
                   '', '### Suspicions', '', *_noticed(by_system)]})


def _told_in_words(rows: Sequence[Row]) -> List[str]:
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


def _by_fault(by_system: _BySystem) -> List[str]:
    quiet = {name: Quiet.of(rows) for name, rows in by_system.items()}
    body = [[FALSE_ALARMS, *(rate(each) for each in quiet.values())],
            ['WARN or alarm an hour',
             *(number(each.warnings_per_hour) for each in quiet.values())],
            ['components watched', *(
                f'{each.watched:.3g} of {each.components:.3g}' if each.watched >= 0.0 else NONE
                for each in (Quiet.of(of_fault(rows, NORMAL)) for rows in by_system.values()))]]
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


def families(rows: Sequence[Row]) -> Section:
    """Return what is written of rows of families; the first system and budget are those of most
    figures."""
    main = rows[0].subject
    by_learning = grouped((row for row in rows if (row.subject.system, row.subject.budget)
                           == (main.system, main.budget)), lambda row: row.subject.learning)
    names = list(grouped(rows, _FAMILY))
    seeds = grouped(rows, lambda row: row.subject.robot.rpartition(' ')[2])
    hours = Quiet.of(of_fault(next(iter(by_learning.values())), NORMAL)).hours
    told = (f'{len(names)} families, seeds {", ".join(seeds)}, {hours:.3g} h of normal '
            f'operation; learned from {" and from ".join(by_learning)}.')
    return Section('families', FAMILIES_TITLE, {
        RESULTS: [told, '', *_results(by_learning)],
        RESEARCH: [told, '', *_of_families(names, by_learning), '', '### All together', '',
                   *_pooled(rows), '',
                   *(f'- `{name}`: {FAMILIES[name].told}' for name in names)]}, _FAMILY)


def started(learning: str) -> str:
    """Return what was learned from in two words."""
    return number_of(int(learning.partition(' ')[0]), 'start')


def _results(by_learning: Dict[str, List[Row]]) -> List[str]:
    """Return the table of all families together, in words; who is named, by the last learning."""
    body = [['false alarms an hour (95 %)',
             *(rate(Quiet.of(of_fault(rows, NORMAL))) for rows in by_learning.values()), NONE]]
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
        rows = {learning: [row for row in of_learning if family in (ALL, _FAMILY(row))]
                for learning, of_learning in by_learning.items()}
        quiet = Quiet.of(of_fault(rows[first], NORMAL))
        body.append([
            family, *(rate(Quiet.of(of_fault(each, NORMAL))) for each in rows.values()),
            percent(quiet.standing), number(quiet.warnings_per_hour),
            _crashes(rows[first]), *(_found(rows[last if kind == LATE else first], kind)
                                     for kind in kinds),
            of_all(Found.of(of_fault(rows[first], RESTART)).after, 'after'), _watched(quiet),
            '; '.join(f'{text} {count}' for text, count in quiet.evidence[:_MOST_SOURCES])
            or NONE])
    return [f'Of what was learned from {started(first)}, if a column says nothing else. *First*, '
            '*end*: the right node is blamed when the alarm is raised, and when the fault ends; '
            'or nobody, where no node is guilty.', '', *table(head, body)]


def _pooled(rows: Sequence[Row]) -> List[str]:
    """Return the table of all families together, for each system, learning and budget."""
    body = []
    for (learning, system, budget), of_subject in grouped(
            rows, lambda row: (row.subject.learning, row.subject.system, row.subject.budget)
            ).items():
        quiet = Quiet.of(of_fault(of_subject, NORMAL))
        body.append([
            system, started(learning), NONE if budget is None else f'{budget:g}', rate(quiet),
            number(quiet.expected), percent(quiet.kept) if quiet.expected >= 0.0 else NONE,
            number(quiet.warnings_per_hour), _watched(quiet), _crashes(of_subject),
            *(_found(of_subject, kind) for kind in KINDS if kind not in (CRASH, RESTART)),
            of_all(Found.of(of_fault(of_subject, RESTART)).after, 'after')])
    return table(['system', 'learned from', 'budget', 'false alarms/h', 'promised',
                  'robots within the promise', 'WARN/h', 'watched',
                  f'crashes, within {_WITHIN} s',
                  *(TITLES[kind] for kind in KINDS if kind not in (CRASH, RESTART)),
                  'alarms after a restart'], body)


def _of_kind(rows: Sequence[Row], kind: str) -> Found:
    """Return how a kind was found; of what is no alarm, by its suspicion."""
    found = Found.of(of_fault(rows, kind))
    return replace(found, latencies_s=found.noticed_s) if kind in _SUSPICIONS else found


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


def _watched(quiet: Quiet) -> str:
    return f'{number(quiet.watched)} of {number(quiet.components)}'


def recordings(rows: Sequence[Row]) -> Section:
    """Return what is written of rows of real robots; the first system is the one that a user is
    told of."""
    first = [row for row in rows if row.subject.system == rows[0].subject.system]
    return Section('recordings', 'Recordings of real robots', {
        RESULTS: _table(first),
        RESEARCH: [*(_told(case) for case in CASES), '', *_table(rows)]},
        lambda row: row.subject.robot)


def _table(rows: Sequence[Row]) -> List[str]:
    return table(['recording', 'system', 'watched', 'outage', 'latency', 'at its end',
                  'false alarms', 'alarm stood in normal operation'],
                 [_cells(of_subject) for of_subject in
                  grouped(rows, lambda row: row.subject).values()])


def _cells(rows: Sequence[Row]) -> List[str]:
    normal = next(row for row in rows if row.fault == NORMAL)
    outage = next((row for row in rows if row.fault == OUTAGE), None)
    subject = normal.subject
    if normal.refused:
        return [subject.robot, subject.system, NONE, normal.refused, *[NONE] * 4]
    told, latency, at_end = NONE, NONE, NONE
    if outage is not None:
        told = 'found' if outage.stood_before or outage.latency_s is not None else 'missed'
        told += ', stood before' if outage.stood_before else ''
        latency = NONE if outage.latency_s is None else seconds(outage.latency_s)
        at_end = ', '.join(each for each in (outage.level, outage.kind, outage.culprit)
                           if each) or NONE
    return [subject.robot, subject.system, str(normal.watched), told, latency, at_end,
            str(normal.alarms), f'{normal.standing_hours * HOUR_S:.1f} of '
            f'{normal.hours * HOUR_S:.1f} s']


def _told(case: Case) -> str:
    outage = 'no outage' if case.outage is None else f'outage {_spans([case.outage])}'
    return (f'- {case.name}: from `{case.training}` and `{case.calibration}`; judged '
            f'`{case.judged}`: {outage}, normal {_spans(case.normal)}')


def _spans(spans: Sequence[Span]) -> str:
    return ' and '.join(f'from {start:g} s on' if end == END else f'{start:g} to {end:g} s'
                        for start, end in spans)


def ablation(rows: Sequence[Row], variants: Sequence[Variant]) -> Section:
    """Return what is written of rows of the method with one thing changed after the other;
    variants: that judged, the method as it is first."""
    of_changes = grouped(rows, lambda row: row.subject.change)
    found = {variant: cells(of_changes[variant.change], _KINDS) for variant in variants}
    default = found[variants[0]]
    robots = ', '.join(grouped(rows, lambda row: f'`{row.subject.robot}`'))
    lines = [f'Of {robots}.', '', '### Channels and rules', '', *table(['', *default], [
        [variant.change or 'as it is', *(
            f'**{of_variant[title].text}**' if of_variant[title].differs(default[title])
            else of_variant[title].text for title in default)]
        for variant, of_variant in found.items() if not variant.is_number])]
    if any(variant.is_number for variant in variants):
        lines += ['', '### Numbers', '', *_numbers_table(found)]
    refused = {f'- {row.subject.change or "as it is"}: {row.subject.robot}: {row.refused}'
               for row in rows if row.refused}
    if refused:
        lines += ['', '### Without limits', '', *sorted(refused)]
    return Section('ablation', 'What each part of the method buys', {RESEARCH: lines})


def _numbers_table(found: Dict[Variant, Dict[str, Cell]]) -> List[str]:
    """Return the table of the numbers that matter, and a sentence about the others."""
    default = next(iter(found.values()))
    changed: Dict[str, List[Tuple[float, str]]] = {}
    for variant, of_variant in found.items():
        if variant.is_number:
            name, _, value = variant.change.partition('=')
            changed.setdefault(name, []).append((float(value), ', '.join(
                f'{title} {of_variant[title].text}' for title in default
                if of_variant[title].differs(default[title]))))
    body, same = [], []
    for each in Tuning.numbers():
        told = changed.get(each.name, [])
        if any(text for _, text in told):
            body.append([f'`{each.name}`', f'{each.default:g} {each.unit}'.strip(), *(
                '; '.join(f'{value:g}: {text or NONE}' for value, text in told
                          if (value < each.default) == is_less) or NONE
                for is_less in (True, False))])
        elif told:
            same.append(f'`{each.name}` ({", ".join(f"{value:g}" for value, _ in told)})')
    lines = table(['number', 'value', 'half', 'double'], body)
    return [*lines, '', f'Changed nothing: {", ".join(same)}.'] if same else lines
