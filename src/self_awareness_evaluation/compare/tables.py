"""Before and after as tables in Markdown: one value where both say the same, else both."""
from __future__ import annotations

from typing import Any, Callable, List, Optional, Sequence, Tuple, TypeVar, Union

from self_awareness import DEFAULT_WINDOW
from self_awareness.stamps import SECOND_NS
from self_awareness_evaluation.compare.results import Measured
from self_awareness_evaluation.families.measures import FaultRow, NormalRow
from self_awareness_evaluation.families.protocol import DEATH, KINDS, SELDOM
from self_awareness_evaluation.families.robot import (CRASH, HALF_RATE, LATE, MISSES, SILENT,
                                                      STARVED)
from self_awareness_evaluation.recordings.outages import OutageRow
from self_awareness_evaluation.simulated import measures, summary
from self_awareness_evaluation.simulated.tables import table
from self_awareness_evaluation.tally import NONE, Tally, alarms

_Row = TypeVar('_Row')
_Subject = Tuple[str, str, Optional[float]]  # learning, system, budget
_FamilyPart = Callable[[Sequence[NormalRow], Sequence[FaultRow]], str]
_SimulatedPart = Callable[[Sequence[measures.Row]], str]

_CRASH_S = (1.0, 5.0, 50.0)
_SOON_S = 5.0
_HOUR_S = 3600.0


def same_rows(before: Measured, after: Measured) -> List[str]:
    """Return lines that say how many rows are the same to the last digit."""
    parts: List[Tuple[str, Sequence[Any], Sequence[Any]]] = [
        ('families, normal operation', before.normal, after.normal),
        ('families, faults', before.faults, after.faults),
        ('simulated robot', before.simulated, after.simulated),
        ('recordings', before.recordings, after.recordings)]
    return [f'- {name}: {sum(one == other for one, other in zip(ours, theirs))} of '
            f'{max(len(ours), len(theirs))}' for name, ours, theirs in parts if ours or theirs]


def families(before: Measured, after: Measured) -> List[str]:
    """Return the lines of the tables of the families: all together, and each."""
    subjects = _keys([*before.normal, *after.normal], _subject)
    pooled = [_family_cells(before, after, subject, [part for _, part in _OF_FAMILIES])
              for subject in subjects]
    lines = table(['', *(_told(subject) for subject in subjects)],
                  [[told, *cells] for (told, _), *cells in zip(_OF_FAMILIES, *pooled)])
    names = _keys([*before.normal, *after.normal], lambda row: row.subject.family)
    body = [[family, _told(subject), *_family_cells(
        before, after, subject, [part for _, part in _OF_A_FAMILY], family)]
        for subject in subjects for family in names]
    return [*lines, '', *table(['family', 'learned from', *(told for told, _ in _OF_A_FAMILY)],
                               body)]


def simulated(before: Measured, after: Measured) -> List[str]:
    """Return the lines of the table of the simulated robot."""
    rows = [*before.simulated, *after.simulated]
    subjects = _keys(rows, lambda row: (row.system, row.training_share))
    kinds = [kind for kind in _keys(rows, lambda row: row.record) if kind != measures.NORMAL]
    parts = [*_OF_SIMULATED, *((kind, _fault(kind)) for kind in kinds),
             *((f'guilty first, {kind}', _fault_first(kind)) for kind in kinds
               if not kind.startswith('crash:'))]
    columns = []
    for subject in subjects:
        ours, theirs = ([row for row in each.simulated
                         if (row.system, row.training_share) == subject]
                        for each in (before, after))
        columns.append([_both(part(ours), part(theirs)) for _, part in parts])
    return table(['', *(f'{system}, {100.0 * share:g} % of the training'
                        for system, share in subjects)],
                 [[told, *cells] for (told, _), *cells in zip(parts, *columns)])


def recordings(before: Measured, after: Measured) -> List[str]:
    """Return the lines of the table of the recordings of real robots."""
    ours, theirs = ({(row.recording, row.system): row for row in each.recordings}
                    for each in (before, after))
    body = []
    for name in dict.fromkeys([*ours, *theirs]):
        pair = [each.get(name) for each in (ours, theirs)]
        body.append([*name, *(_both(*(NONE if row is None else part(row) for row in pair))
                              for _, part in _OF_A_RECORDING)])
    return table(['recording', 'system', *(told for told, _ in _OF_A_RECORDING)], body)


def _both(before: str, after: str) -> str:
    return before if before == after else f'{before} → **{after}**'


def _keys(rows: Sequence[_Row], key: Callable[[_Row], Any]) -> List[Any]:
    return list(dict.fromkeys(key(row) for row in rows))


def _subject(row: Union[NormalRow, FaultRow]) -> _Subject:
    return row.subject.learning, row.subject.system, row.subject.budget


def _told(subject: _Subject) -> str:
    learning, system, budget = subject
    return f'{system}, {learning}' + ('' if budget is None else f', budget {budget:g}')


def _family_cells(before: Measured, after: Measured, subject: _Subject,
                  parts: Sequence[_FamilyPart], family: str = '') -> List[str]:
    """Return what parts of a table say of a subject on a family; empty: on all together."""
    sides = [([row for row in each.normal if _is_of(row, subject, family)],
              [row for row in each.faults if _is_of(row, subject, family)])
             for each in (before, after)]
    return [_both(*(part(normal, faults) for normal, faults in sides)) for part in parts]


def _is_of(row: Union[NormalRow, FaultRow], subject: _Subject, family: str) -> bool:
    return _subject(row) == subject and family in ('', row.subject.family)


def _quiet(normal: Sequence[NormalRow], _: Sequence[FaultRow]) -> str:
    return alarms(sum(row.alarms for row in normal), sum(row.hours for row in normal))


def _warned(normal: Sequence[NormalRow], _: Sequence[FaultRow]) -> str:
    return alarms(sum(row.warnings for row in normal), sum(row.hours for row in normal))


def _stands(normal: Sequence[NormalRow], _: Sequence[FaultRow]) -> str:
    return f'{60.0 * sum(row.standing_hours for row in normal):.3g} min'


def _kind(kind: str, *within_s: float) -> _FamilyPart:
    return lambda _, faults: Tally.of(
        (row.latency_s, row.first) for row in faults if row.kind == kind).found(*within_s)


def _first(kind: str) -> _FamilyPart:
    return lambda _, faults: Tally.of((row.latency_s, row.first) for row in faults
                                      if kind in ('', row.kind)).named_first


def _after(_: Sequence[NormalRow], faults: Sequence[FaultRow]) -> str:
    known = [row.after for row in faults if row.after is not None]
    return f'{sum(known)} after {len(known)}' if known else NONE


def _among_three(_: Sequence[NormalRow], faults: Sequence[FaultRow]) -> str:
    return Tally.of((row.latency_s, row.among_three) for row in faults).named_first


_OF_FAMILIES: Sequence[Tuple[str, _FamilyPart]] = (
    ('false alarms', _quiet), ('alarm stands in normal operation', _stands), ('WARN', _warned),
    ('crashes within 1 / 5 / 50 s', _kind(CRASH, *_CRASH_S)),
    *((f'{kind}, found', _kind(kind)) for kind in KINDS[1:]),
    *((f'{kind}, within 5 s', _kind(kind, _SOON_S)) for kind in KINDS[1:]),
    *((f'guilty first, {kind}', _first(kind)) for kind in KINDS),
    ('alarms after a restart', _after),
    ('guilty first, all', _first('')), ('guilty among three, all', _among_three))

_OF_A_FAMILY: Sequence[Tuple[str, _FamilyPart]] = (
    ('false alarms', _quiet), ('WARN', _warned),
    ('crashes within 1 / 5 / 50 s', _kind(CRASH, *_CRASH_S)), ('half rates', _kind(HALF_RATE)),
    ('late answers', _kind(LATE)), ('deaths when asked, within 5 s', _kind(DEATH, _SOON_S)),
    ('deaths of who speaks seldom', _kind(SELDOM)), (MISSES, _kind(MISSES)),
    (STARVED, _kind(STARVED)), (SILENT, _kind(SILENT)), ('alarms after a restart', _after),
    ('guilty first', _first('')))


def _alarms(rows: Sequence[measures.Row]) -> str:
    return alarms(sum(row.false_alarms for row in rows), _hours(rows))


def _suspicions(rows: Sequence[measures.Row]) -> str:
    return alarms(sum(row.false_suspicions for row in rows), _hours(rows))


def _hours(rows: Sequence[measures.Row]) -> float:
    return sum(row.normal_windows for row in rows) * DEFAULT_WINDOW / SECOND_NS / _HOUR_S


def _fault(kind: str, *within_s: float) -> _SimulatedPart:
    return lambda rows: _tally(rows, kind).found(*within_s)


def _fault_first(kind: str) -> _SimulatedPart:
    return lambda rows: _tally(rows, kind).named_first


def _tally(rows: Sequence[measures.Row], kind: str) -> Tally:
    return Tally.of((row.latency_s, row.top1) for row in summary.of_fault(rows, kind))


_OF_SIMULATED: Sequence[Tuple[str, _SimulatedPart]] = (
    ('false alarms', _alarms), ('WARN', _suspicions),
    ('every crash within 1 / 5 / 50 s', _fault('crash', *_CRASH_S)),
    ('guilty first, every crash', _fault_first('crash')))


def _outage(row: OutageRow) -> str:
    if row.outage_found is None:
        return NONE
    found = 'missed' if row.latency_s is None else f'{row.latency_s:.2f} s'
    return f'{found}, stood before' if row.stood_before else found


_OF_A_RECORDING: Sequence[Tuple[str, Callable[[OutageRow], str]]] = (
    ('watched', lambda row: str(row.watched)), ('outage', _outage),
    ('false alarms', lambda row: str(row.false_alarms)),
    ('alarm stands in normal operation', lambda row: f'{row.false_s:.2f} s'))
