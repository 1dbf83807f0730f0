"""What the pages say of rows: a section for each measurement."""
from __future__ import annotations

from dataclasses import replace
from operator import attrgetter
from typing import Callable, Dict, List, Mapping, Sequence, Tuple

from self_awareness import Tuning
from self_awareness.reporting.text import number_of
from self_awareness_evaluation.families.kinds import FAMILIES
from self_awareness_evaluation.families.protocol import DEATH, KINDS, NEVER, SELDOM, TITLES
from self_awareness_evaluation.families.scene import (CRASH, FLOOD, HALF_RATE, LATE, MISSES, OTHER,
                                                      RESTART, SILENT, STARVED)
from self_awareness_evaluation.figures import (NONE, WITHIN_S, Cell, Found, Quiet, cells, grouped,
                                               median, number, of_all, of_fault, part, percent,
                                               rate, seconds, share, table, with_interval)
from self_awareness_evaluation.outages import CASES, END, OUTAGE, Case, Span
from self_awareness_evaluation.pages import RESEARCH, RESULTS, Section
from self_awareness_evaluation.records import NORMAL
from self_awareness_evaluation.rows import HOUR_S, Row
from self_awareness_evaluation.simulated import WITHIN_S as AIMED_S
from self_awareness_evaluation.variants import Variant

OWN_TITLE, FAMILIES_TITLE = 'The simulated robot', 'Robots of other kinds'  # on each page
FALSE_ALARMS, EVERY_CRASH = 'false alarms an hour (95 %)', 'every crash'
_RIGHT_NODE = 'the right node first / at the end'

TOLD: Dict[str, str] = {  # faults that a user is told of, in words
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
    'stale:slam': 'stamps stand still'}

# Faults that are a suspicion, or may be, and the time in which one is aimed at [s].
_NOTICED_S: Dict[str, float] = {'extra': 5.0, 'unknown': 5.0, **AIMED_S}
ALL = 'all'  # families together
_SUSPICIONS = (OTHER, NEVER)  # that are no alarms
_FAMILY = attrgetter('subject.family')  # of a row
_CRASHES = f'crashes, within {" / ".join(f"{each:g}" for each in WITHIN_S)} s'

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
            f'{Quiet(rows).hours / len(by_system):.3g} h without a fault, those before the '
            'onsets included.')
    return Section('simulated', OWN_TITLE, {
        RESULTS: [told, '', *_told_in_words(by_system[subject.system])],
        RESEARCH: [told, '', *_by_fault(by_system), '', '### Who is named', '', *_named(by_system),
                   '', '### Suspicions', '', *_noticed(by_system)]})


def _told_in_words(rows: Sequence[Row]) -> List[str]:
    """Return the table of the first system, in words."""
    found = {name: Found(of_kind) for name, of_kind in _kinds(rows).items() if name in TOLD}
    return [*table(['what happens', 'alarm (95 %)', 'median', _RIGHT_NODE], [
        [TOLD[name], with_interval(each), seconds(each.median_s), _right_node(each)]
        for name, each in found.items()]), '', f'False alarms an hour: {rate(Quiet(rows))}.']


def _by_fault(by_system: _BySystem) -> List[str]:
    quiet = [Quiet(rows) for rows in by_system.values()]
    normal = [Quiet(of_fault(rows, NORMAL)) for rows in by_system.values()]
    body = [[FALSE_ALARMS, *map(rate, quiet)],
            ['WARN or alarm an hour', *(number(each.warnings_per_hour) for each in quiet)],
            ['components watched', *(
                f'{each.watched:.3g} of {each.components:.3g}' if each.watched >= 0.0 else NONE
                for each in normal)]]
    return table(['fault', *by_system], [*body, *_rows(by_system, share)])


def _named(by_system: _BySystem) -> List[str]:
    def cell(found: Found) -> str:
        return ' / '.join(part(each) for each in (found.first, found.among_three, found.at_end))
    named = [row for row in _rows(by_system, cell) if set(row[1:]) != {cell(Found([]))}]
    return ['First / among three / when the fault ends, where nobody is right if no node is '
            'guilty.', '', *table(['fault', *by_system], named)]


def _noticed(by_system: _BySystem) -> List[str]:
    body = []
    for kind, within_s in _NOTICED_S.items():
        times_s = [Found(of_fault(rows, kind)).noticed_s for rows in by_system.values()]
        if times_s[0]:
            body.append([kind, f'{within_s:g} s', *(
                f'{part((sum(time <= within_s for time in each), len(each)))}, '
                f'{seconds(median(each))}' for each in times_s)])
    return ['WARN or alarm in the time that is aimed at, and the median time to it.', '',
            *table(['fault', 'within', *by_system], body)]


def _rows(by_system: _BySystem, cell: Callable[[Found], str]) -> List[List[str]]:
    """Return a row of a table for every fault."""
    kinds = [_kinds(rows) for rows in by_system.values()]
    return [[fault, *(cell(Found(each[fault])) for each in kinds)] for fault in kinds[0]]


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
    hours = Quiet(of_fault(next(iter(by_learning.values())), NORMAL)).hours
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
    body = [[FALSE_ALARMS,
             *(rate(Quiet(of_fault(rows, NORMAL))) for rows in by_learning.values()), NONE]]
    for kind in KINDS:
        found = [_of_kind(rows, kind) for rows in by_learning.values()]
        if found[0].records:
            body.append([TITLES[kind], *(f'{with_interval(each)}, {seconds(each.median_s)}'
                                         for each in found), _right_node(found[-1])])
    named = [Found(of_fault(rows, '')).bystanders for rows in by_learning.values()]
    return [*table(['what', *(f'{started(learning)}: alarm (95 %), median'
                              for learning in by_learning), _RIGHT_NODE], body), '',
            'Alarms that name a node which has nothing to do with the fault: '
            + '; '.join(f'{some} of {all_}' for some, all_ in named) + '.']


def _right_node(found: Found) -> str:
    return f'{part(found.first)} / {part(found.at_end)}'


def _of_families(families: Sequence[str], by_learning: Dict[str, List[Row]]) -> List[str]:
    first, last = next(iter(by_learning)), list(by_learning)[-1]
    kinds = [kind for kind in KINDS if kind not in (CRASH, RESTART, FLOOD, *_SUSPICIONS)]
    body = []
    for family in [*families, ALL]:
        rows = {learning: [row for row in of_learning if family in (ALL, _FAMILY(row))]
                for learning, of_learning in by_learning.items()}
        quiet = Quiet(of_fault(rows[first], NORMAL))
        body.append({
            'family': family, **{f'false alarms/h, {started(learning)}':
                                 rate(Quiet(of_fault(of_learning, NORMAL)))
                                 for learning, of_learning in rows.items()},
            'alarm stands': percent(quiet.standing), 'WARN/h': number(quiet.warnings_per_hour),
            **{title + (f', {started(last)}' if title == TITLES[LATE] else ''): cell
               for title, cell in _faults(rows[first], kinds, rows[last]).items()},
            'watched': _watched(quiet), 'false alarms from': '; '.join(
                f'{text} {count}' for text, count in quiet.evidence[:2]) or NONE})
    return [f'Of what was learned from {started(first)}, if a column says nothing else. *First*, '
            '*end*: the right node is blamed when the alarm is raised, and when the fault ends; '
            'or nobody, where no node is guilty.', '', *_table_of(body)]


def _pooled(rows: Sequence[Row]) -> List[str]:
    """Return the table of all families together, for each system, learning and budget."""
    body = []
    for (learning, system, budget), of_subject in grouped(
            rows, lambda row: (row.subject.learning, row.subject.system, row.subject.budget)
            ).items():
        quiet = Quiet(of_fault(of_subject, NORMAL))
        body.append({
            'system': system, 'learned from': started(learning),
            'budget': NONE if budget is None else f'{budget:g}', 'false alarms/h': rate(quiet),
            'promised': number(quiet.expected), 'robots within the promise':
            percent(quiet.kept) if quiet.expected >= 0.0 else NONE,
            'WARN/h': number(quiet.warnings_per_hour), 'watched': _watched(quiet),
            **_faults(of_subject, [kind for kind in KINDS if kind not in (CRASH, RESTART)],
                      of_subject)})
    return _table_of(body)


def _table_of(rows: Sequence[Mapping[str, str]]) -> List[str]:
    """Return a table of rows, of which there is at least one, by column."""
    return table(list(rows[0]), [list(row.values()) for row in rows])


def _of_kind(rows: Sequence[Row], kind: str) -> Found:
    """Return how a kind was found; of what is no alarm, by its suspicion."""
    found = of_fault(rows, kind)
    return Found([replace(row, latency_s=row.noticed_s) for row in found]
                 if kind in _SUSPICIONS else found)


def _faults(rows: Sequence[Row], kinds: Sequence[str], late: Sequence[Row]) -> Dict[str, str]:
    """Return how faults were found, by column; late: the rows to say LATE of."""
    def told(found: Found, shares: Sequence[float], time: str) -> str:
        blame = (f', first {part(found.first)}, end {part(found.at_end)}' if found.first[1]
                 else '')
        return (f'{" / ".join(f"{100.0 * each:.0f}" for each in shares)} %{time}{blame}'
                if found.records else NONE)

    crashes = Found(of_fault(rows, CRASH))
    others = {TITLES[kind]: _of_kind(late if kind == LATE else rows, kind) for kind in kinds}
    return {_CRASHES: told(crashes, [crashes.share(each) for each in WITHIN_S], ''),
            **{title: told(each, [each.share()], f', {seconds(each.median_s)}')
               for title, each in others.items()},
            'alarms after a restart': of_all(Found(of_fault(rows, RESTART)).after, 'after')}


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
                 [[subject.robot, subject.system, *_cells(of_subject)] for subject, of_subject
                  in grouped(rows, lambda row: row.subject).items()])


def _cells(rows: Sequence[Row]) -> List[str]:
    normal = next(row for row in rows if row.fault == NORMAL)
    outage = next((row for row in rows if row.fault == OUTAGE), None)
    if normal.refused:
        return [NONE, normal.refused, *[NONE] * 4]
    told = [NONE] * 3
    if outage is not None:
        found = 'found' if outage.stood_before or outage.latency_s is not None else 'missed'
        told = [found + (', stood before' if outage.stood_before else ''),
                NONE if outage.latency_s is None else seconds(outage.latency_s),
                ', '.join(filter(None, (outage.level, outage.kind, outage.culprit))) or NONE]
    return [str(normal.watched), *told, str(normal.alarms),
            f'{normal.standing_hours * HOUR_S:.1f} of {normal.hours * HOUR_S:.1f} s']


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
