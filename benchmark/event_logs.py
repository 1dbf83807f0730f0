#!/usr/bin/python3
"""Benchmark of event logs: an hour of the simulated robot as a bag and as a log of its events."""
from __future__ import annotations

import os
import tempfile
import time
import timeit
from typing import Any, Callable, Dict

import page
from self_awareness import EncodingRules, EventLogWriter, read_events
from self_awareness.commands import simulate

_SECONDS = 3600
_SEED = 5
_RUNS = 5
_DAY_S = 86400


def _cpu_s(work: Callable[[], object]) -> float:
    """Return the processor time of work, the least of several runs [s]."""
    return min(timeit.repeat(work, timer=time.process_time, repeat=_RUNS, number=1))


def measure() -> Dict[str, Any]:
    """Return the results."""
    rules = EncodingRules.defaults()
    with tempfile.TemporaryDirectory() as folder:
        bag, log = os.path.join(folder, 'robot.bag'), os.path.join(folder, 'log.bag')
        if simulate.main(['--output', bag, '--duration', str(_SECONDS), '--seed', str(_SEED)]):
            raise RuntimeError('simulate failed')

        def convert() -> None:
            writer = EventLogWriter(log)
            writer.add_bag(bag, rules)
            writer.close()

        events = len(read_events(bag, rules).stamps)
        read_bag = _cpu_s(lambda: read_events(bag, rules))
        written = _cpu_s(convert)
        read_log = _cpu_s(lambda: read_events(log, rules, recording=0))
        return dict(page.machine(), seconds=_SECONDS, seed=_SEED, runs=_RUNS, events=events,
                    bytes=os.path.getsize(log), bag_bytes=os.path.getsize(bag),
                    read_bag_s=read_bag, convert_s=written, read_log_s=read_log)


def markdown(result: Dict[str, Any]) -> str:
    """Return the results in a sentence."""
    events, seconds = result['events'], result['seconds']
    writing = result['convert_s'] - result['read_bag_s']
    return (f'{events / seconds:.0f} events a second: {result["bytes"] / events:.2f} bytes an '
            f'event ({result["bag_bytes"] / events:.0f} in a bag), '
            f'{result["bytes"] * _DAY_S / seconds / 1e6:.0f} MB a day; written in '
            f'{1e9 * writing / events:.0f} ns ({100 * writing / seconds:.4f} % of a core), read '
            f'in {1e9 * result["read_log_s"] / events:.0f} ns '
            f'({1e9 * result["read_bag_s"] / events:.0f} from a bag).')


if __name__ == '__main__':
    page.run('event_logs', __doc__, measure, markdown)
