"""The tables of `live` and `nodes`, by their rows."""
from __future__ import annotations

import math
from collections import Counter
from statistics import median_low
from typing import Callable, List, Optional, Sequence

from self_awareness.calibration import confidence
from self_awareness_evaluation.live.measures import SEPARATOR
from self_awareness_evaluation.live.rows import MONITOR, Row
from self_awareness_evaluation.records import NORMAL
from self_awareness_evaluation.tables import table

Tables = Callable[[Sequence[Row]], List[str]]
"""The lines of a section of a page, by rows."""

_NONE = '–'


def of_live(rows: Sequence[Row]) -> List[str]:
    """Return the tables of several rounds of the same faults, judged by several systems."""
    systems = list(dict.fromkeys(row.system for row in rows))
    kinds = list(dict.fromkeys(row.fault for row in rows if row.is_fault))

    def of(system: str, fault: str) -> List[Row]:
        return [row for row in rows
                if (row.system, row.fault) == (system, fault) and not row.void]

    lines = ['## Alarms', '', 'Raised, of those that count; median latency (smallest to '
             'largest).', '',
             *table(['fault', 'lasts', f'{MONITOR}: WARN', *systems],
                    [[kind, f'{next(row.lasted_s for row in rows if row.fault == kind):.0f} s',
                      _latencies([row.suspicion_s for row in of(MONITOR, kind)]),
                      *(_latencies([row.latency_s for row in of(name, kind)])
                        for name in systems)] for kind in kinds])]
    lines += ['', '## Blame', '', 'Alarms that blame a guilty source first / among the first '
              'three; – where no source is guilty, or no alarm was raised.', '',
              *table(['fault', *systems, f'first evidence of {MONITOR}'],
                     [[kind, *(_blame(of(name, kind)) for name in systems),
                       '; '.join(dict.fromkeys(row.evidence for row in of(MONITOR, kind)
                                               if row.evidence))] for kind in kinds])]
    lines += ['', '## False alarms', '', *(_false_alarms(name, of(name, NORMAL))
                                           for name in systems), '',
              'That is little: to say that there is less than one an hour takes '
              f'{confidence.poisson_rate(0, 1.0)[1]:.1f} h without one. Simulated time tells '
              'more.']
    lines += ['', '## Components watched', '', *(_watched(of(name, NORMAL)[0])
                                                 for name in systems)]
    remarks = [f'- {row.system}, round {row.round}, {row.fault}: '
               + '; '.join(filter(None, (row.void and f'void: {row.void}', row.note)))
               for row in rows if row.void or (row.note and row.system == MONITOR)]
    return [*lines, '', '## Void samples, and what did not go as planned', '',
            *(remarks or ['Nothing.'])]


def of_nodes(rows: Sequence[Row]) -> List[str]:
    """Return the table of normal operation, by its names, and of one fault after the other."""
    quiet = [row for row in rows if row.is_normal]
    lines = [f'The model watches {row.watched} of {row.components} components.'
             for row in quiet[:1]]
    lines += ['', *table(
        ['', 'lasted', 'WARN', 'ERROR', 'guilty first', 'cleared', 'what the monitor said'],
        [*(_quiet(kind, [row for row in quiet if row.fault == kind])
           for kind in dict.fromkeys(row.fault for row in quiet)),
         *(_fault(row) for row in rows if row.is_fault)])]
    notes = [f'- {_name(row)}: {row.note}' for row in rows if row.note]
    return [*lines, '', 'What did not go as planned:', '', *notes] if notes else lines


def _latencies(values: Sequence[Optional[float]]) -> str:
    raised = [value for value in values if value is not None]
    text = f'{len(raised)} of {len(values)}'
    if not raised:
        return text
    median = median_low(math.inf if value is None else value for value in values)
    typical = f'{median:.2f} s' if median < math.inf else _NONE
    return f'{text}, {typical} ({min(raised):.2f} to {max(raised):.2f})'


def _blame(rows: Sequence[Row]) -> str:
    blamed = [row for row in rows if row.first is not None]
    if not blamed:
        return _NONE
    return (f'{100.0 * sum(bool(row.first) for row in blamed) / len(blamed):.3g} % / '
            f'{100.0 * sum(bool(row.among_three) for row in blamed) / len(blamed):.3g} %')


def _false_alarms(name: str, rows: Sequence[Row]) -> str:
    hours = sum(row.lasted_s for row in rows) / 3600.0
    alarms = sum(row.alarms or 0 for row in rows)
    low, high = confidence.poisson_rate(alarms, hours)
    return (f'- {name}: {alarms} in {60.0 * hours:.1f} min of normal operation (95 %: '
            f'{low:.1f} to {high:.1f} an hour)')


def _watched(row: Row) -> str:
    return f'- {row.system}: ' + ('judges all together' if row.watched is None
                                  else f'{row.watched} of {row.components}')


def _quiet(kind: str, rows: Sequence[Row]) -> List[str]:
    """Return the line of a kind of normal operation."""
    hours = sum(row.lasted_s for row in rows) / 3600.0
    alarms = sum(row.alarms or 0 for row in rows)
    suspicions = sum(row.suspicions or 0 for row in rows)
    standing_s = sum(row.standing_s or 0.0 for row in rows)
    low, high = confidence.poisson_rate(alarms, hours)
    named = sum(row.named or 0 for row in rows)
    return [f'**{kind}**', f'{60.0 * hours:.0f} min',
            f'{suspicions} ({suspicions / hours:.1f} an hour)',
            f'{alarms} (95 %: {low:.1f} to {high:.1f} an hour; expected by calibrate: '
            f'{rows[0].expected or math.nan:.2g}); {named} name a node', _NONE,
            f'an alarm stood for {standing_s:.0f} s ({standing_s / hours / 36.0:.2g} % of the '
            'time)', _text(_counted([said for row in rows for said in row.said.split(SEPARATOR)]))]


def _counted(said: Sequence[str]) -> str:
    """Return how often the same was said of the same topic, whatever the numbers."""
    kinds = Counter(': '.join(text.split(': ')[:2]) for text in said if text)
    return '; '.join(f'{kind} ({number}x)' for kind, number in sorted(kinds.items()))


def _fault(row: Row) -> List[str]:
    if row.void:
        return [_name(row), f'{row.lasted_s:.0f} s', *[_NONE] * 4, f'void: {row.void}']
    guilty = (_NONE if row.first is None else 'yes' if row.first
              else 'among three' if row.among_three else 'no')
    cleared = 'did not clear' if row.cleared_s == math.inf else f'{row.cleared_s:.1f} s'
    return [_name(row), f'{row.lasted_s:.0f} s', _latency(row.suspicion_s),
            _latency(row.latency_s), guilty,
            _NONE if row.latency_s is None and not row.cleared_s else cleared, _text(row.said)]


def _name(row: Row) -> str:
    return f'`{row.node}` {row.fault}' if row.node else row.fault


def _latency(latency_s: Optional[float]) -> str:
    return 'none' if latency_s is None else f'{latency_s:.2f} s'


def _text(said: str) -> str:
    return said.replace('|', '/') or _NONE
