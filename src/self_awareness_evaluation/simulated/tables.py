"""The tables of the evaluation as Markdown: the targets, every fault, false alarms and latency."""
from __future__ import annotations

import math
from typing import Callable, Dict, List, NamedTuple, Sequence

from self_awareness_evaluation.simulated import summary
from self_awareness_evaluation.simulated.measures import NORMAL, Row
from self_awareness_evaluation.simulated.records import WITHIN_S
from self_awareness_evaluation.simulated.summary import Measure
from self_awareness_evaluation.simulated.tradeoff import TradeOff

RowsBySystem = Dict[str, List[Row]]

Cell = Callable[[Sequence[Row]], str]
"""What a table says of one system and one fault, by its rows."""

_NONE = '–'


def percent(value: float) -> str:
    """Return a share in percent; a dash for NaN."""
    return _NONE if math.isnan(value) else f'{100.0 * value:.3g} %'


def seconds(value: float) -> str:
    """Return a time [s]; a dash for NaN, and for what never happened."""
    return f'{value:.2f} s' if math.isfinite(value) else _NONE


class _Target(NamedTuple):
    quantity: str
    target: str
    measured: Cell


def _of(kind: str, measure: Measure, form: Callable[[float], str]) -> Callable[..., str]:
    def measured(rows: Sequence[Row]) -> str:
        of_kind = summary.of_fault(rows, kind)
        return form(measure(of_kind)) if of_kind else _NONE
    return measured


def _false_alarms(rows: Sequence[Row]) -> str:
    alarms = summary.false_alarms(rows)
    low, high = alarms.interval
    return f'{alarms.per_hour:.2f} ({low:.2f} to {high:.2f})'


def _false_suspicions(rows: Sequence[Row]) -> str:
    return f'{summary.false_suspicions(rows).per_hour:.2f}'


def _watched(rows: Sequence[Row]) -> str:
    watched, components = summary.watched(rows)
    return _NONE if math.isnan(watched) else f'{watched:.3g} of {components:.3g}'


def _median(rows: Sequence[Row]) -> float:
    return summary.latency(rows, 0.5)


def _noticed_within(within_s: float) -> Measure:
    return lambda rows: summary.noticed(rows, within_s)


_noticed_soon = _noticed_within(5.0)


def _within(within_s: float) -> Measure:
    return lambda rows: summary.found(rows, within_s)


_TARGETS = (
    _Target('normal windows called abnormal (FPR)', '<= 0.2 %',
            lambda rows: percent(summary.false_positive_rate(summary.normal(rows)))),
    _Target('false alarms an hour', '< 1', lambda rows: _false_alarms(summary.normal(rows))),
    _Target('the same, with the time before the faults', '< 1', _false_alarms),
    _Target('suspicions (WARN) or alarms an hour, in all of it', '', _false_suspicions),
    _Target('components watched', 'all', lambda rows: _watched(summary.normal(rows))),
    *(_Target(f'suspicion (WARN) or alarm within 5 s, {kind}', '',
              _of(kind, _noticed_soon, percent)) for kind in ('extra', 'unknown')),
    *(_Target(f'windows missed after the alarm, {kind}', target,
              _of(kind, summary.missed_after_alarm, percent))
      for kind, target in (('cc1', '0 %'), ('cc2', '0 %'), ('rs', '<= 1 %'))),
    *(_Target(f'median latency, {kind}', target, _of(kind, _median, seconds))
      for kind, target in (('cc1', '0.3 s'), ('cc2', '0.5 s'), ('rs', '2 s'), ('ac', '30 s'),
                           ('lat', '2 s'))),
    _Target('windows missed, lat', '<= 3 %', _of('lat', summary.missed, percent)),
    *(_Target(f'crashes found within {within_s:g} s', target,
              _of('crash', _within(within_s), percent))
      for within_s, target in ((1.0, '70 %'), (5.0, '95 %'), (50.0, '100 %'))),
    _Target('guilty first, crashes', '>= 95 %', _of('crash', summary.guilty_first, percent)),
    _Target('guilty among three, crashes', '100 %',
            _of('crash', summary.guilty_among_three, percent)),
    _Target('guilty first, lat', '>= 80 %', _of('lat', summary.guilty_first, percent)),
    *(_Target(f'suspicion (WARN) or alarm within {within_s:g} s, {kind}', '100 %',
              _of(kind, _noticed_within(within_s), percent))
      for kind, within_s in WITHIN_S.items()),
)


def _alarm(rows: Sequence[Row]) -> str:
    found = summary.found(rows)
    return f'{percent(found)}, {seconds(_median(rows))}' if found else _NONE


def _latencies(rows: Sequence[Row]) -> str:
    return f'{seconds(_median(rows))} / {seconds(summary.latency(rows, 0.95))}'


def _blame(rows: Sequence[Row]) -> str:
    return f'{percent(summary.guilty_first(rows))} / {percent(summary.guilty_among_three(rows))}'


def _auc(rows: Sequence[Row]) -> str:
    return f'{summary.auc(rows):.3f}'


class _FaultTable(NamedTuple):
    title: str
    cell: Cell


_FAULT_TABLES = (
    _FaultTable('Records in which the alarm was raised',
                lambda rows: percent(summary.found(rows))),
    _FaultTable('Records with a suspicion (WARN) or the alarm within 5 s',
                lambda rows: percent(_noticed_soon(rows))),
    _FaultTable('Latency: median / 95 %', _latencies),
    _FaultTable('Windows missed after the onset: no alarm stands, and the bare verdict is normal '
                '(FNR)', lambda rows: percent(summary.missed(rows))),
    _FaultTable('Windows missed after the onset by the bare verdict',
                lambda rows: percent(summary.missed_raw(rows))),
    _FaultTable('Windows without standing alarm after the alarm\'s first one',
                lambda rows: percent(summary.missed_after_alarm(rows))),
    _FaultTable('AUC of windows', _auc),
    _FaultTable('Alarms that blame a guilty source first / among the first three', _blame),
)

_LATENCIES_S = (0.3, 0.4, 0.5, 0.7, 1.0, 2.0)


def targets(rows: RowsBySystem) -> List[str]:
    """Return the lines of the table of the targets, with what every system reaches."""
    return table(['', 'target', *rows],
                 [[target.quantity, target.target,
                   *(target.measured(of_system) for of_system in rows.values())]
                  for target in _TARGETS])


def alarms(rows: RowsBySystem) -> List[str]:
    """Return the lines of a table of how many faults were found, and how fast."""
    return _fault_table(rows, _kinds(rows), _alarm)


def blame(rows: RowsBySystem) -> List[str]:
    """Return the lines of a table of who was blamed; all crashes are one row."""
    guilty = [kind for kind in _kinds(rows) if not kind.startswith('crash:')
              and any(row.top1 is not None for of_system in rows.values()
                      for row in summary.of_fault(of_system, kind))]
    return _fault_table(rows, guilty, _blame)


def faults(rows: RowsBySystem) -> List[str]:
    """Return the lines of a table for every quantity, with a row for every fault."""
    lines: List[str] = []
    for fault_table in _FAULT_TABLES:
        lines += [f'### {fault_table.title}', '',
                  *_fault_table(rows, _kinds(rows), fault_table.cell), '']
    return lines[:-1]


def trade_offs(by_system: Dict[str, List[TradeOff]]) -> List[str]:
    """Return the lines of the table of false alarms at equal latency."""
    points = {name: summary.operating_points(part) for name, part in by_system.items()}
    return table(['median latency at most', *points],
                 [[seconds(within_s),
                   *(_rate(summary.false_alarms_at(of_system, within_s))
                     for of_system in points.values())] for within_s in _LATENCIES_S])


def table(head: Sequence[str], body: Sequence[Sequence[str]]) -> List[str]:
    """Return the lines of a Markdown table."""
    return [f'| {" | ".join(row)} |' for row in (head, ['---'] * len(head), *body)]


def _kinds(rows: RowsBySystem) -> List[str]:
    """Return the faults that there are rows of, and `crash` for all crashes."""
    kinds = list(dict.fromkeys(row.record for of_system in rows.values() for row in of_system
                               if row.record != NORMAL))
    if any(kind.startswith('crash:') for kind in kinds):
        kinds.append('crash')
    return kinds


def _fault_table(rows: RowsBySystem, kinds: Sequence[str], cell: Cell) -> List[str]:
    return table(['fault', *rows],
                 [['every crash' if kind == 'crash' else kind,
                   *(cell(summary.of_fault(of_system, kind)) for of_system in rows.values())]
                  for kind in kinds])


def _rate(value: float) -> str:
    return _NONE if math.isnan(value) else f'{value:.2f}'
