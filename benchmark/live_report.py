"""Results of the live benchmark, as a section of docs/performance.md."""
from __future__ import annotations

import statistics
from typing import Any, Dict, Iterator, List, Tuple


def markdown(result: Dict[str, Any]) -> str:
    """Return the tables."""
    return '\n'.join([*_costs(result), '', *_latency(result['latency'])])


def _costs(result: Dict[str, Any]) -> Iterator[str]:
    yield (f'CPU in % of a core, median of {result["rounds"]} times {result["seconds"]:g} s, all '
           'in turn; peak of the resident memory; messages that were published and did not '
           'arrive, of all rounds. The listener is bound to one core, the publishers to the '
           'other.')
    yield ''
    yield ('| messages/s | topics | images | bare | `rosbag record` | monitor | monitor / bare '
           '| MB: bare | record | monitor | dropped: bare | record | monitor |')
    yield '|--:' * 2 + '|:-:' + '|--:' * 10 + '|'
    for (rate, topics, image), rows in _by_configuration(result['costs']).items():
        bare, record, monitor = (rows[name] for name in ('bare', 'record', 'monitor'))
        subjects = (bare, record, monitor)
        ratio = monitor['cpu_share'] / bare['cpu_share']
        yield ' | '.join([
            f'| {rate:,} | {topics} | {"30 Hz" if image else ""}',
            *(f'{100 * row["cpu_share"]:.1f}' for row in subjects), f'**{ratio:.2f}**',
            *(f'{row["peak_bytes"] / 1e6:.0f}' for row in subjects),
            *(f'{row["dropped"]:.0f}' for row in subjects)]) + ' |'


def _by_configuration(costs: List[Dict[str, Any]]
                      ) -> Dict[Tuple[int, int, bool], Dict[str, Dict[str, Any]]]:
    configurations: Dict[Tuple[int, int, bool], Dict[str, Dict[str, Any]]] = {}
    for row in costs:
        key = (row['rate'], row['topics'], row['image'])
        configurations.setdefault(key, {})[row['subject']] = row
    return configurations


def _latency(latency: Dict[str, Any]) -> Iterator[str]:
    yield f'At {latency["rate"]:,} messages a second on {latency["topics"]} topics:'
    yield ''
    yield '| | median | most | of |'
    yield '|---|--:|--:|--:|'
    for what, key, unit in (('a message to the verdict on its window of 100 ms', 'message_s',
                             'messages'),
                            ('end of a window to its verdict on `~status`', 'verdict_s',
                             'windows')):
        times = latency[key]
        yield (f'| {what} | {_ms(times["median"])} | {_ms(times["most"])} '
               f'| {times["number"]:,} {unit} |')
    yield _row('`kill -9` of a node to the alarm on `/diagnostics`', latency['alarm_s'], 'times')
    yield _row('start of the process until it is connected to all topics', latency['connected_s'],
               'starts')
    for types, seconds in latency['loaded_s'].items():
        yield _row(f'start of the process until the model is loaded, {types} event types', seconds,
                   'starts')


def _row(what: str, seconds: List[float], unit: str) -> str:
    return (f'| {what} | {_ms(statistics.median(seconds))} | {_ms(max(seconds))} '
            f'| {len(seconds)} {unit} |')


def _ms(seconds: float) -> str:
    return f'{1000 * seconds:.3g} ms' if seconds < 1 else f'{seconds:.2f} s'
