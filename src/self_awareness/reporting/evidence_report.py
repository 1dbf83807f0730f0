"""Prints what `calibrate` found for the evidence detector."""
from __future__ import annotations

import math
from statistics import median
from typing import Any, Dict, List, Mapping, Optional, Sequence, Tuple

from self_awareness import HOURS_OF_ROBOTS, EvidenceModel, TrainedModel
from self_awareness.calibration import confidence, heads_and_tails
from self_awareness.calibration.results import FalseAlarms
from self_awareness.calibration.runs import RECORDED, Injections, JudgedRun
from self_awareness.reporting import coverage_text, relations_text
from self_awareness.reporting.text import aligned, first_lines, rounded
from self_awareness.stamps import SECOND_NS

_DIFFERENT = 0.8
_MOST_ROWS = 10
_COLUMNS = ('fault', 'source', 'found', 'median [s]', 'guilty first', 'among three')


def counts(tracks: Dict[str, int]) -> str:
    """Return numbers of tracks by channel, as text."""
    return ', '.join(f'{channel} {count}' for channel, count in tracks.items() if count) or 'none'


def print_verdict(trained: TrainedModel, coverage: Sequence[Dict[str, Any]]) -> None:
    """Print what the model is worth, and then what to record next, and why."""
    more = []
    if trained.calibration is not None:
        rate = rounded(trained.calibration.false_alarms_per_hour, 2)
        print(f'expect at most {rate} false alarms an hour (95 of 100 robots have fewer)')
        more_h = (trained.calibration.windows * trained.window / SECOND_NS / 3600.0
                  + HOURS_OF_ROBOTS)
        more = [f'{rounded(more_h, 2)} h more of normal operation, of other starts: if they stay '
                'below the limits, they halve the false alarms to expect']
    found_s = [each['death_found_after'] for each in coverage if each['death_found_after']]
    if found_s:
        print(f'deaths found: those of {len(found_s)} of {len(coverage)} components, after '
              f'{rounded(min(found_s), 2)} s to {rounded(max(found_s), 2)} s')
    print('what to record next:')
    more += relations_text.to_record(relations_text.relations(trained, EvidenceModel(trained)))
    for line in more:
        print(f'  {line}')


def print_coverage(trained: TrainedModel, coverage: Sequence[Dict[str, Any]]) -> None:
    """Print a table of all components."""
    for line in (coverage_text.lines(coverage, trained.fewest_gaps)
                 + coverage_text.unheard_lines(coverage_text.unheard(trained.unheard))):
        print(line)


def print_budgets(by_budget: Mapping[float, Sequence[Dict[str, Any]]]) -> None:
    """Print whose death is found how soon with a smaller budget, and with a larger one.

    Args:
        by_budget: what coverage_text.summarise() returned for the limits of each budget.
    """
    budgets = sorted(by_budget)
    found_s: Dict[str, List[float]] = {}  # of each budget; infinite: not found
    for budget in budgets:
        for each in by_budget[budget]:
            found_s.setdefault(each['component'], []).append(each['death_found_after'] or math.inf)
    differ = sorted(((component, times) for component, times in found_s.items()
                     if times[-1] < _DIFFERENT * times[0]), key=lambda each: -each[1][0])
    names = ', '.join(f'{budget:g}' for budget in budgets)
    if not differ:
        print(f'--budget: with {names} false alarms an hour, all deaths are found equally soon')
        return
    print(f'--budget: deaths found with {names} false alarms an hour allowed; all others, and '
          'late answers, equally soon')
    rows = [(component, *(f'{rounded(time, 3)} s' for time in times))
            for component, times in differ]
    head = ('component', *(f'{budget:g}' for budget in budgets))
    for line in first_lines(aligned([head, *rows]), _MOST_ROWS + 1):
        print(line)


def print_measured(normal: Sequence[JudgedRun], alarms: FalseAlarms) -> None:
    """Print what the limits do on the recordings that they were found on."""
    at_end = (f', and {alarms.at_end} of who stopped before a recording ended'
              if alarms.at_end else '')
    print(f'normal operation: {alarms.hours:.3f} h (recordings: {len(normal)}), alarms: '
          f'{alarms.count}{at_end}; the limits were found on the same recordings')
    for run in normal:
        kinds = run.run.source.event_types
        for alarm in run.verdicts.alarms:
            suspects = [f'{kinds[suspect.id]}: {suspect.reason.words}'
                        for suspect in alarm.suspects]
            more = f' (and {len(suspects) - 1} more)' if suspects[1:] else ''
            before_s = heads_and_tails.stopped_before_end(run.run.source, alarm)
            end = '' if before_s is None else f', {before_s:.1f} s before the recording ended'
            print(f'  {run.run.source.part}: {_seconds(run, alarm.begin)} s: '
                  f'{suspects[0] if suspects else "no suspect stands out"}{more}{end}')


def print_faults(faulty: Sequence[JudgedRun]) -> None:
    """Print a table of fault and source: found, how soon, and the rank of the guilty one."""
    if not faulty:
        return
    rows = [_COLUMNS]
    groups: Dict[Tuple[str, str], List[JudgedRun]] = {}
    for run in faulty:
        groups.setdefault(_names(run), []).append(run)
    for (fault, source), runs in groups.items():
        latencies = [run.latency for run in runs if run.latency is not None]
        ranks = [_rank(run, source) for run in runs if run.latency is not None]
        rows.append((fault, source, f'{len(latencies)} of {len(runs)}',
                     f'{median(latencies):.2f}' if latencies else '-',
                     _share(ranks, 1) if source else '-', _share(ranks, 3) if source else '-'))
    for line in aligned(rows):
        print(line)
    found = sum(run.latency is not None for run in faulty)
    low, high = confidence.wilson(found, len(faulty))
    print(f'found {found} of {len(faulty)} (95 %: {low:.1%} to {high:.1%})')


def print_not_tried(injections: Injections) -> None:
    """Print which faults no recording can show, and which recordings none."""
    if injections.silent:
        print('not tried, silent after the middle of every recording: '
              + ', '.join(injections.silent))
    if injections.excused:
        print('no fault is injected into these, in which the machine was busy, or all was silent, '
              'all the time: ' + ', '.join(injections.excused))


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


def _seconds(run: JudgedRun, stamp: int) -> str:
    return f'{(stamp - run.run.source.origin) / SECOND_NS:.1f}'
