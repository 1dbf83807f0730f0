"""What a soak and a recovery must do, by their rows: nothing missed, made up or restarted."""
from __future__ import annotations

import math
from statistics import median
from typing import List, Optional, Sequence, Tuple

from self_awareness_evaluation.live.follow_me import CRASH, HANG
from self_awareness_evaluation.live.recovery import DELAY_S
from self_awareness_evaluation.live.rows import RESTARTED, Row
from self_awareness_evaluation.live.usage import WARM_UP_S, slope_mb_per_hour
from self_awareness_evaluation.rows import AFTERMATH_S
from self_awareness_evaluation.tables import table

HANGS, AT_RANDOM = 1, 2
"""Rounds of a recovery: a node hangs again and again; faults at random."""

MUST_BE_FOUND_S = 2.0
"""A fault that lasts for longer is missed if there is no alarm [s]."""

MOST_SLOPE = 1.0
"""Of resident memory that counts as flat [MB an hour]."""

BACK_WITHIN_S = 5.0
"""From the alarm to when a node that hangs is heard again, besides the delay of the rules [s]."""


def of_soak(rows: Sequence[Row]) -> Tuple[List[str], List[str]]:
    """Return the tables of a soak, and what was not as it should be."""
    long = [row for row in _faults(rows) if row.lasted_s > MUST_BE_FOUND_S]
    missed = [row for row in long if row.latency_s is None]
    loud = [row for row in rows if row.alarms]
    stuck = [row for row in rows if row.cleared_s == math.inf]
    slope, first, last = slope_mb_per_hour(rows), rows[0], rows[-1]
    wrong = [*(f'{row.fault} at {_at(row, rows)} was missed: {row.void}' for row in missed),
             *(f'false alarm after {_at(row, rows)}: {row.said}' for row in loud),
             *(f'{row.fault} at {_at(row, rows)}: the alarm did not clear' for row in stuck)]
    if slope is not None and slope >= MOST_SLOPE:
        wrong.append(f'memory grows by {slope:.2f} MB an hour')
    lasted_s = last.onset + last.lasted_s - first.onset
    lines = [f'{lasted_s / 60.0:.0f} minutes, '
             f'{sum(row.events or 0 for row in rows) / sum(row.lasted_s for row in rows):.0f} '
             'messages a second.', '', *table(['what', 'demanded', 'measured'], [
                 [f'faults of more than {MUST_BE_FOUND_S:g} s that were missed', 'none',
                  f'{len(missed)} of {len(long)}'],
                 ['alarms without a fault', 'none', str(sum(row.alarms or 0 for row in loud))],
                 [f'slope of resident memory after {WARM_UP_S / 60.0:g} minutes',
                  f'less than {MOST_SLOPE:g} MB an hour',
                  'not measured: it takes 10 minutes' if slope is None
                  else f'{slope:.2f} MB an hour'],
                 ['resident memory at the beginning and the end', '',
                  f'{first.memory_mb or math.nan:.1f} MB, {last.memory_mb or math.nan:.1f} MB'],
                 ['threads, open files', '', f'{first.threads} and {first.files}, then '
                  f'{last.threads} and {last.files}']])]
    kinds = sorted({_kind(row) for row in _faults(rows)})
    lines += ['', *table(['fault', 'number', 'found', 'median time to the alarm', 'longest',
                          'named first', 'alarm over after the end, median', 'longest'],
                         [_of_kind(kind, [row for row in _faults(rows) if _kind(row) == kind])
                          for kind in kinds])]
    return lines, wrong


def of_recovery(rows: Sequence[Row]) -> Tuple[List[str], List[str]]:
    """Return the table of a recovery, and what was not as it should be."""
    hangs = [row for row in _faults(rows) if row.round == HANGS]
    at_random = [row for row in _faults(rows) if row.round == AT_RANDOM]
    late = [row for row in hangs if row.back_s is None or row.back_s > DELAY_S + BACK_WITHIN_S]
    begin = min((row.onset for row in rows if row.round == AT_RANDOM), default=math.inf)
    end = max(row.onset + row.lasted_s for row in rows)
    restarts = [row for row in _restarts(rows) if row.onset >= begin]
    healthy, lasting = of_healthy(rows), not_mended(rows)
    wrong = [*(f'hang at {_at(row, rows)} was not back in time: {row.back_s} {row.void}'
               for row in late),
             *(f'{row.node} was healthy and restarted at {_at(row, rows)}' for row in healthy),
             *(f'{row.node} hung at {_at(row, rows)}, and was not restarted' for row in lasting)]
    return table(['what', 'demanded', 'measured'], [
        [f'back within {BACK_WITHIN_S:g} s and the delay of {DELAY_S:g} s after the alarm', 'all',
         f'{len(hangs) - len(late)} of {len(hangs)}'],
        ['from the hang to the alarm', '', _times([row.blamed_s for row in hangs])],
        ['from the alarm to the first message of the new process', '',
         _times([row.back_s for row in hangs])],
        [f'faults at random, in {max(0.0, end - begin) / 60.0:.0f} minutes', '',
         str(len(at_random))],
        ['nodes restarted meanwhile', '', str(len(restarts))],
        ['of them healthy', 'none', str(len(healthy))],
        ['hangs that lasted on', 'none', str(len(lasting))]]), wrong


def of_healthy(rows: Sequence[Row]) -> List[Row]:
    """Return the restarts of nodes that did not hang or crash then, nor just had.

    Each fault excuses one restart. Those that only change a rate excuse none: the rules are about
    who has died.
    """
    left = [row for row in _faults(rows) if _kind(row, of_all=True) in (HANG, CRASH)]
    wrong = []
    for restart in _restarts(rows):
        excuse = next((row for row in left if row.node == restart.node
                       and row.onset < restart.onset <= _end(row) + AFTERMATH_S), None)
        if excuse is None:
            wrong.append(restart)
        else:
            left.remove(excuse)
    return wrong


def not_mended(rows: Sequence[Row]) -> List[Row]:
    """Return the hangs that lasted on, although the node should have been restarted.

    A hang that no alarm names should have been found in time all the same.
    """
    return [row for row in _faults(rows) if _kind(row, of_all=True) == HANG
            and _end(row) - row.onset > (MUST_BE_FOUND_S if row.blamed_s is None else row.blamed_s)
            + DELAY_S + BACK_WITHIN_S
            and not any(each.node == row.node and row.onset < each.onset <= _end(row)
                        for each in _restarts(rows))]


def _faults(rows: Sequence[Row]) -> List[Row]:
    return [row for row in rows if row.is_fault]


def _restarts(rows: Sequence[Row]) -> List[Row]:
    return [row for row in rows if row.fault == RESTARTED]


def _end(row: Row) -> float:
    """Return when all was as before [s since 1970]."""
    return row.onset + (row.lasted_s if row.recovered_s is None else row.recovered_s)


def _at(row: Row, rows: Sequence[Row]) -> str:
    return f'{row.onset - rows[0].onset:.0f} s'


def _kind(row: Row, of_all: bool = False) -> str:
    """Return the kind of a fault; those that need not be found are one of their own."""
    kind = row.fault.partition(':')[0]
    short = row.lasted_s <= MUST_BE_FOUND_S and not of_all
    return f'{kind} of less than {MUST_BE_FOUND_S:g} s' if short else kind


def _of_kind(kind: str, rows: Sequence[Row]) -> List[str]:
    found = [row for row in rows if row.latency_s is not None]
    cleared = [row.cleared_s for row in rows if row.cleared_s or row.latency_s is not None]
    return [kind, str(len(rows)), str(len(found)), *_columns([row.latency_s for row in found]),
            str(sum(bool(row.first) for row in rows)), *_columns(cleared)]


def _columns(seconds: Sequence[Optional[float]]) -> List[str]:
    """Return median and longest."""
    known = [value for value in seconds if value is not None]
    return [f'{median(known):.2f} s', f'{max(known):.2f} s'] if known else ['', '']


def _times(seconds: Sequence[Optional[float]]) -> str:
    times = _columns(seconds)
    return f'median {times[0]}, longest {times[1]}' if times[0] else ''
