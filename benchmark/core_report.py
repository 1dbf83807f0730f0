"""Writes docs/performance/core.json from the output of the core's benchmarks, and from that the
section `core` of docs/performance.md."""
from __future__ import annotations

import json
import statistics
from pathlib import Path
from typing import Any, Dict, List, Optional

import page

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
        of = detector.capitalize()
        sizes = [name.split('/')[1] for name in medians if name.startswith(f'score{of}/')]
        result[detector] = {
            size: {'event_ns': score['time'] * 1e6, 'terms': score.get('terms'),
                   'lookup_ns': _nanoseconds(medians.get(f'lookUp{of}/{size}')),
                   'window_ns': _nanoseconds(medians.get(f'closeWindow{of}/{size}')),
                   'train_events_per_s': train['events'] / train['time'] * 1e3,
                   'model_bytes': score['bytes']}
            for size in sorted(sizes, key=int)
            for score, train in [(medians[f'score{of}/{size}'], medians[f'train{of}/{size}'])]}
    return result


def _nanoseconds(step: Optional[Measured]) -> Optional[float]:
    return None if step is None else step['time'] * 1e6


def markdown(measured: Measured) -> str:
    """Return the section's text; every second size is enough for it."""
    lines = ["| event types | an event [ns] | a window's end [µs] | training [million events/s] "
             '| model [MB] | `paper`: an event [ns] | a term [ns] | of look-ups alone |',
             f'| --- {"| ---: " * 7}|']
    for size, paper in list(measured['paper'].items())[::2]:
        row = measured['evidence'][size]
        lines.append(
            f'| {size} | {row["event_ns"]:.0f} | {row["window_ns"] / 1e3:.1f} | '
            f'{row["train_events_per_s"] / 1e6:.2f} | {row["model_bytes"] / 1e6:.2g} | '
            f'{paper["event_ns"]:.0f} | {paper["event_ns"] / paper["terms"]:.1f} | '
            f'{paper["event_ns"] / paper["lookup_ns"]:.1f} |')
    return '\n'.join([*lines, '', f'{measured["date"]}.'])


def main() -> None:
    parser = page.parser('core', __doc__)
    parser.add_argument('raw', type=Path, help='JSON of Google Benchmark')
    arguments = parser.parse_args()
    measured = summary(json.loads(arguments.raw.read_text()))
    page.publish('core', measured, markdown(measured), arguments.output)


if __name__ == '__main__':
    main()
