"""Writes docs/performance/core.json from the output of the core's benchmarks, and from that the
section `core` of docs/performance.md.
"""
from __future__ import annotations

import argparse
import json
import statistics
from pathlib import Path
from typing import Any, Callable, Dict, List, Optional

from page import publish, table

DETECTORS = ('paper', 'evidence')
_PER_MILLISECOND = {'ns': 1e-6, 'us': 1e-3, 'ms': 1.0}

Measured = Dict[str, Any]


def _medians(benchmarks: List[Measured]) -> Dict[str, Measured]:
    """Return the medians of the repetitions, by name and size; times: CPU time [ms]."""
    runs: Dict[str, List[Measured]] = {}
    for run in benchmarks:
        if run['run_type'] == 'iteration':
            runs.setdefault('/'.join(run['name'].split('/')[:2]), []).append(run)
    medians = {}
    for name, repetitions in runs.items():
        time = 'real_time' if 'manual_time' in repetitions[0]['name'] else 'cpu_time'
        medians[name] = {key: value for key, value in repetitions[0].items()
                         if isinstance(value, (int, float))}
        medians[name]['time'] = statistics.median(
            run[time] * _PER_MILLISECOND[run['time_unit']] for run in repetitions)
    return medians


def summary(raw: Measured) -> Measured:
    """Return the results of every detector, by number of event types."""
    medians = _medians(raw['benchmarks'])
    result: Measured = {'date': raw['context']['date'][:10]}
    for detector in DETECTORS:
        rows = {}
        for name, score in medians.items():
            kind, size = name.split('/')
            if kind != f'score{detector.capitalize()}':
                continue
            of = {step: medians.get(f'{step}{detector.capitalize()}/{size}')
                  for step in ('lookUp', 'train', 'load', 'closeWindow', 'choose')}
            rows[size] = {
                'event_ns': score['time'] * 1e6,
                'terms': score.get('terms'),
                'lookup_ns': of['lookUp']['time'] * 1e6 if of['lookUp'] else None,
                'window_ns': of['closeWindow']['time'] * 1e6 if of['closeWindow'] else None,
                'train_events_per_s': of['train']['events'] / of['train']['time'] * 1e3,
                'train_bytes': of['train']['bytes'],
                'train_bytes_of_twice': of['train']['bytes_of_twice'],
                'model_bytes': of['load']['bytes'],
                'load_ms': of['load']['time'],
                'choose_ms': of['choose']['time'] if of['choose'] else None,
            }
        result[detector] = dict(sorted(rows.items(), key=lambda row: int(row[0])))
    return result


def _number(value: Optional[float], digits: int = 3) -> str:
    if value is None:
        return '–'
    return f'{value:,.0f}' if value >= 10 ** (digits - 1) else f'{value:.{digits}g}'


def _ratio(row: Measured, over: str, under: str) -> Optional[float]:
    return row[over] / row[under] if row[under] else None


_SCORING: Dict[str, Callable[[Measured], Optional[float]]] = {
    'terms an event': lambda row: row['terms'],
    'an event [ns]': lambda row: row['event_ns'],
    'a term [ns]': lambda row: _ratio(row, 'event_ns', 'terms'),
    'the look-ups alone [ns]': lambda row: row['lookup_ns'],
    'ratio': lambda row: _ratio(row, 'event_ns', 'lookup_ns'),
    "a window's end [ns]": lambda row: row['window_ns']}
_TRAINING: Dict[str, Callable[[Measured], Optional[float]]] = {
    'training [events/s]': lambda row: row['train_events_per_s'],
    'counts [MB]': lambda row: row['train_bytes'] / 1e6,
    'of twice the time [MB]': lambda row: row['train_bytes_of_twice'] / 1e6,
    'choosing [ms]': lambda row: row['choose_ms'],
    'model [MB]': lambda row: row['model_bytes'] / 1e6,
    'computing it [ms]': lambda row: row['load_ms']}


def _table_of(rows: Dict[str, Measured],
              columns: Dict[str, Callable[[Measured], Optional[float]]]) -> str:
    """Return a table of the columns that this detector has."""
    told = {name: column for name, column in columns.items()
            if any(column(row) is not None for row in rows.values())}
    return table(('event types', *told), [
        [size, *(_number(column(row)) for column in told.values())]
        for size, row in rows.items()])


def markdown(measured: Measured) -> str:
    """Return the section's text."""
    return '\n\n'.join(
        part for detector in DETECTORS for part in (
            f'**`detector: {detector}`**, {measured["date"]}',
            _table_of(measured[detector], _SCORING), _table_of(measured[detector], _TRAINING)))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('raw', type=Path, help='JSON of Google Benchmark')
    parser.add_argument('docs', type=Path, help='folder of performance.md')
    arguments = parser.parse_args()
    measured = summary(json.loads(arguments.raw.read_text()))
    publish('core', measured, markdown(measured), arguments.docs)


if __name__ == '__main__':
    main()
