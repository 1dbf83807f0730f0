"""Before and after as tables in Markdown: one value where both say the same, else both."""
from __future__ import annotations

from typing import Callable, Dict, Hashable, List, Sequence, Tuple, TypeVar

from self_awareness import DEFAULT_WINDOW
from self_awareness.evaluation.compare.results import Measured
from self_awareness.evaluation.families.measures import FaultRow, NormalRow
from self_awareness.evaluation.families.protocol import DEATH, KINDS
from self_awareness.evaluation.families.robot import CRASH, HALF_RATE, LATE
from self_awareness.evaluation.recordings.outages import OutageRow
from self_awareness.evaluation.simulated import measures, summary
from self_awareness.evaluation.simulated.tables import table
from self_awareness.evaluation.tally import NONE, Tally, alarms
from self_awareness.stamps import SECOND_NS

_Row = TypeVar('_Row')
_Part = Callable[[Measured], str]

_CRASH_S = (1.0, 5.0, 50.0)
_SOON_S = 5.0
_HOUR_S = 3600.0


def sentences(before: Measured, after: Measured) -> List[str]:
    """Return how many rows are the same to the last digit."""
    told = []
    for name, ours, theirs in (
            ('families, normal operation', before.normal, after.normal),
            ('families, faults', before.faults, after.faults),
            ('simulated robot', before.simulated, after.simulated),
            ('recordings', before.recordings, after.recordings)):
        if ours or theirs:
            same = sum(one == other for one, other in zip(ours, theirs))
            told.append(f'- {name}: {same} of {max(len(ours), len(theirs))}')
    return told


def families(before: Measured, after: Measured) -> List[str]:
    """Return the lines of the tables of the families: all together, and each."""
    subjects = _keys(before.normal, after.normal,
                     lambda row: (row.subject.learning, row.subject.system, row.subject.budget))
    lines = table(['', *(f'{system}, {learning}, budget {budget}'
                         for learning, system, budget in subjects)],
                  [[told, *(_both(before, after, lambda each, part=part, subject=subject:
                                  part(_normal(each, subject), _faults(each, subject)))
                            for subject in subjects)] for told, part in _OF_FAMILIES])
    names = _keys(before.normal, after.normal, lambda row: row.subject.family)
    if len(names) == 1:
        return lines
    body = [[family, subject[0], *(
        _both(before, after, lambda each, part=part: part(_normal(each, subject, family),
                                                          _faults(each, subject, family)))
        for _, part in _OF_A_FAMILY)] for subject in subjects for family in names]
    return [*lines, '', *table(['family', 'learned from', *(told for told, _ in _OF_A_FAMILY)],
                               body)]


def simulated(before: Measured, after: Measured) -> List[str]:
    """Return the lines of the table of the simulated robot."""
    subjects = _keys(before.simulated, after.simulated,
                     lambda row: (row.system, row.training_share))
    kinds = [kind for kind in _keys(before.simulated, after.simulated, lambda row: row.record)
             if kind != measures.NORMAL]
    parts: List[Tuple[str, Callable[[Sequence[measures.Row]], str]]] = [
        ('false alarms', lambda rows: _false(rows)),
        ('WARN', lambda rows: alarms(sum(row.false_suspicions for row in rows), _hours(rows))),
        ('every crash within 1 / 5 / 50 s', lambda rows: _found(rows, 'crash').found(*_CRASH_S)),
        ('guilty first, every crash', lambda rows: _found(rows, 'crash').named_first)]
    parts += [(kind, lambda rows, kind=kind: _found(rows, kind).found()) for kind in kinds]
    parts += [(f'guilty first, {kind}', lambda rows, kind=kind: _found(rows, kind).named_first)
              for kind in kinds if not kind.startswith('crash:')]
    return table(['', *(f'{system}, {100.0 * share:g} % of the training'
                        for system, share in subjects)],
                 [[told, *(_both(before, after, lambda each, part=part, subject=subject: part(
                     [row for row in each.simulated
                      if (row.system, row.training_share) == subject]))
                     for subject in subjects)] for told, part in parts])


def recordings(before: Measured, after: Measured) -> List[str]:
    """Return the lines of the table of the recordings of real robots."""
    names = _keys(before.recordings, after.recordings, lambda row: (row.recording, row.system))
    return table(['recording', 'system', *(told for told, _ in _OF_A_RECORDING)],
                 [[*name, *(_both(before, after, lambda each, part=part, name=name: ' and '.join(
                     part(row) for row in each.recordings
                     if (row.recording, row.system) == name) or NONE)
                     for _, part in _OF_A_RECORDING)] for name in names])


def _both(before: Measured, after: Measured, part: _Part) -> str:
    one, other = part(before), part(after)
    return one if one == other else f'{one} → **{other}**'


def _keys(before: Sequence[_Row], after: Sequence[_Row],
          key: Callable[[_Row], Hashable]) -> List:
    found: Dict[Hashable, None] = dict.fromkeys(key(row) for row in (*before, *after))
    return list(found)


def _normal(each: Measured, subject: Tuple, family: str = '') -> List[NormalRow]:
    return [row for row in each.normal if _is_of(row, subject, family)]


def _faults(each: Measured, subject: Tuple, family: str = '') -> List[FaultRow]:
    return [row for row in each.faults if _is_of(row, subject, family)]


def _is_of(row, subject: Tuple, family: str) -> bool:
    of = row.subject
    return (of.learning, of.system, of.budget) == subject and family in ('', of.family)


def _quiet(normal: Sequence[NormalRow], _: Sequence[FaultRow]) -> str:
    return alarms(sum(row.alarms for row in normal), sum(row.hours for row in normal))


def _warned(normal: Sequence[NormalRow], _: Sequence[FaultRow]) -> str:
    return alarms(sum(row.warnings for row in normal), sum(row.hours for row in normal))


def _stands(normal: Sequence[NormalRow], _: Sequence[FaultRow]) -> str:
    return f'{60.0 * sum(row.standing_hours for row in normal):.3g} min'


def _kind(kind: str, *within_s: float) -> Callable[..., str]:
    return lambda _, faults: Tally.of(
        (row.latency_s, row.first) for row in faults if row.kind == kind).found(*within_s)


def _first(kind: str) -> Callable[..., str]:
    return lambda _, faults: Tally.of((row.latency_s, row.first) for row in faults
                                      if kind in ('', row.kind)).named_first


def _among_three(_: Sequence[NormalRow], faults: Sequence[FaultRow]) -> str:
    return Tally.of((row.latency_s, row.among_three) for row in faults).named_first


_OF_FAMILIES = (
    ('false alarms', _quiet), ('alarm stands in normal operation', _stands), ('WARN', _warned),
    ('crashes within 1 / 5 / 50 s', _kind(CRASH, *_CRASH_S)),
    *((f'{kind}, found', _kind(kind)) for kind in KINDS[1:]),
    *((f'{kind}, within 5 s', _kind(kind, _SOON_S)) for kind in KINDS[1:]),
    *((f'guilty first, {kind}', _first(kind)) for kind in KINDS),
    ('guilty first, all', _first('')), ('guilty among three, all', _among_three))

_OF_A_FAMILY = (
    ('false alarms', _quiet), ('WARN', _warned),
    ('crashes within 1 / 5 / 50 s', _kind(CRASH, *_CRASH_S)), ('half rates', _kind(HALF_RATE)),
    ('late answers', _kind(LATE)), ('deaths when asked', _kind(DEATH)),
    ('guilty first', _first('')))


def _hours(rows: Sequence[measures.Row]) -> float:
    return sum(row.normal_windows for row in rows) * DEFAULT_WINDOW / SECOND_NS / _HOUR_S


def _false(rows: Sequence[measures.Row]) -> str:
    return alarms(sum(row.false_alarms for row in rows), _hours(rows))


def _found(rows: Sequence[measures.Row], kind: str) -> Tally:
    return Tally.of((row.latency_s, row.top1) for row in summary.of_fault(rows, kind))


def _outage(row: OutageRow) -> str:
    if row.outage_found is None:
        return NONE
    found = 'missed' if row.latency_s is None else f'{row.latency_s:.2f} s'
    return f'{found}, stood before' if row.stood_before else found


_OF_A_RECORDING: Tuple[Tuple[str, Callable[[OutageRow], str]], ...] = (
    ('watched', lambda row: str(row.watched)), ('outage', _outage),
    ('false alarms', lambda row: str(row.false_alarms)),
    ('alarm stands in normal operation', lambda row: f'{row.false_s:.2f} s'))
