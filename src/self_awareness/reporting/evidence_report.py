"""What `calibrate` found for the evidence detector, in words."""
from __future__ import annotations

import math
from statistics import median
from typing import Any, Dict, List, Mapping, Optional, Sequence, Tuple

from self_awareness.calibration import confidence, heads_and_tails
from self_awareness.calibration.runs import RECORDED, FalseAlarms, Injections, JudgedRun
from self_awareness.reporting.text import aligned, duration, first_lines
from self_awareness.stamps import SECOND_NS

_DIFFERENT = 0.8
_MOST_ROWS = 10
_COLUMNS = ('fault', 'node', 'found', 'after', 'named first', 'among three')


def budgets(by_budget: Mapping[float, Sequence[Dict[str, Any]]]) -> List[str]:
    """Return whose death is found how soon with a smaller budget, and with a larger one.

    Args:
        by_budget: what coverage_text.summarise() returned for the limits of each budget.
    """
    found_s: Dict[str, List[float]] = {}  # of each budget; infinite: not found
    for budget in sorted(by_budget):
        for each in by_budget[budget]:
            found_s.setdefault(each['component'], []).append(each['death_found_after'] or math.inf)
    differ = sorted(((component, times) for component, times in found_s.items()
                     if times[-1] < _DIFFERENT * times[0]), key=lambda each: -each[1][0])
    names = ', '.join(f'{budget:g}' for budget in sorted(by_budget))
    if not differ:
        return [f'--budget: with {names} false alarms an hour, all deaths are found equally soon']
    rows = [(component, *(duration(time) if time < math.inf else '-' for time in times))
            for component, times in differ]
    head = ('component', *(f'{budget:g}' for budget in sorted(by_budget)))
    return [f'--budget: deaths found with {names} false alarms an hour allowed; all others, and '
            'late answers, equally soon', *first_lines(aligned([head, *rows]), _MOST_ROWS + 1)]


def on_normal(normal: Sequence[JudgedRun], alarms: FalseAlarms, details: bool) -> List[str]:
    """Return the alarms on the recordings that the limits were found on; they may hold a fault.

    Args:
        normal: the recordings.
        alarms: on them.
        details: whether to say so, too, if there is none.
    """
    text = []
    if alarms.count or alarms.at_end or details:
        at_end = (f', and {alarms.at_end} of what stopped before a recording ended'
                  if alarms.at_end else '')
        text.append(f'alarms on these {duration(3600.0 * alarms.hours)} of normal operation: '
                    f'{alarms.count}{at_end}' + ('; if that was a fault, leave it out'
                                                 if alarms.count else ''))
    for run in normal:
        kinds = run.run.source.event_types
        for alarm in run.verdicts.alarms:
            suspects = [f'{kinds[suspect.id]}: {suspect.reason.words}'
                        for suspect in alarm.suspects]
            more = f' (and {len(suspects) - 1} more)' if suspects[1:] else ''
            before_s = heads_and_tails.stopped_before_end(run.run.source, alarm)
            end = '' if before_s is None else f', {before_s:.1f} s before the recording ended'
            begin_s = (alarm.begin - run.run.source.origin) / SECOND_NS
            text.append(f'  {run.run.source.part}: {begin_s:.1f} s: '
                        f'{suspects[0] if suspects else "no suspect stands out"}{more}{end}')
    return text


def faults(faulty: Sequence[JudgedRun], details: bool) -> List[str]:
    """Return how many faults were found, how soon; and a table of fault and source.

    Args:
        faulty: what was judged.
        details: a row for every fault, not only for those that were not found.
    """
    if not faulty:
        return []
    groups: Dict[Tuple[str, str], List[JudgedRun]] = {}
    for run in faulty:
        groups.setdefault(_names(run), []).append(run)
    rows = []
    for (fault, source), runs in groups.items():
        latencies = [run.latency for run in runs if run.latency is not None]
        ranks = [_rank(run, source) for run in runs if run.latency is not None]
        if details or len(latencies) < len(runs):
            rows.append((fault, source, f'{len(latencies)} of {len(runs)}',
                         duration(median(latencies)) if latencies else '-',
                         _share(ranks, 1) if source else '-', _share(ranks, 3) if source else '-'))
    found_s = [run.latency for run in faulty if run.latency is not None]
    text = f'faults: found {len(found_s)} of {len(faulty)}'
    if details:
        low, high = confidence.wilson(len(found_s), len(faulty))
        text += f' (95 %: {low:.1%} to {high:.1%})'
    if found_s:
        text += f', half of them within {duration(median(found_s))}'
        if len(found_s) > 1:
            text += f', the last after {duration(max(found_s))}'
        ranks = [_rank(run, _names(run)[1]) for run in faulty
                 if run.latency is not None and _names(run)[1]]
        if ranks:
            text += f'; the node is named first in {_share(ranks, 1)}'
    return [text, *(f'  {line}' for line in aligned([_COLUMNS, *rows]) if rows)]


def not_tried(injections: Injections) -> List[str]:
    """Return which faults no recording can show, and which recordings none."""
    text = []
    if injections.silent:
        text.append('not tried, silent after the middle of every recording: '
                    + ', '.join(injections.silent))
    if injections.excused:
        text.append('no fault is injected into these, in which the machine was busy, or all was '
                    'silent, all the time: ' + ', '.join(injections.excused))
    return text


def _names(run: JudgedRun) -> Tuple[str, str]:
    if run.run.fault == RECORDED:
        return str(run.run.source.part), ''
    parts = run.run.fault.split(':')
    return ':'.join(parts[:1] + parts[2:]), parts[1] if len(parts) > 1 else ''


def _rank(run: JudgedRun, source: str) -> Optional[int]:
    """Return the place of a source among those blamed by the first alarm after the onset."""
    for alarm in run.verdicts.alarms:
        if alarm.begin > run.run.onset:
            kinds = run.run.source.event_types
            blamed = list(dict.fromkeys(kinds[suspect.id].source for suspect in alarm.suspects))
            return blamed.index(source) + 1 if source in blamed else None
    return None


def _share(ranks: Sequence[Optional[int]], worst: int) -> str:
    if not ranks:
        return '-'
    return f'{sum(rank is not None and rank <= worst for rank in ranks)} of {len(ranks)}'
