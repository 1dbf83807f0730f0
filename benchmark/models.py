#!/usr/bin/python3
"""Benchmark of model files: training, size, and time to load, by the number of event types.

Every number of event types is trained on in a process of its own, whose memory is measured. The
events are those of timers.py: timers of 50 ms to 2 s with chains of two answers each.
"""
from __future__ import annotations

import itertools
import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any, Dict

import page
from self_awareness import EventType, Learner, TrainedModel, half_of
from self_awareness.recordings import RecordingEvents
from timers import SIZES, events_of

_SECONDS = 60.0
_LOADS = 5


def _train(types: int, path: str) -> Dict[str, Any]:
    """Train and save a model; the start of the process and making the events do not count."""
    stamps, ids = events_of(types, _SECONDS)
    kinds = [EventType(f'/node_{kind // 3}', f'/topic_{kind}', 'T') for kind in range(types)]
    learner = Learner()
    before = time.process_time()
    middle = len(stamps) // 2
    for half, part in enumerate((slice(middle), slice(middle, None))):
        fingerprint = next(number for number in itertools.count() if half_of(number) == half)
        learner.count(RecordingEvents(kinds, stamps[part], ids[part], fingerprint=fingerprint))
    model = learner.model()
    trained = time.process_time()
    model.save(path)
    return {'events': len(stamps), 'train_s': trained - before,
            'save_s': time.process_time() - trained,
            'train_peak_bytes': 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss}


def _load(path: str, watched_only: bool) -> Dict[str, Any]:
    before_bytes = _resident()
    before = time.process_time()
    model = TrainedModel.load(path, watched_only)
    return {'load_s': time.process_time() - before, 'load_bytes': _resident() - before_bytes,
            'types': len(model.event_types)}


def _resident() -> int:
    pages = int(Path('/proc/self/statm').read_text().split()[1])
    return pages * os.sysconf('SC_PAGE_SIZE')


def _in_process(*arguments: str) -> Dict[str, Any]:
    done = subprocess.run((sys.executable, '-B', __file__, *arguments), check=True,
                          stdout=subprocess.PIPE, text=True)
    return json.loads(done.stdout)


def measure() -> Dict[str, Any]:
    """Return the results, by number of event types."""
    result: Dict[str, Any] = dict(page.machine(), seconds=_SECONDS, loads=_LOADS, models={})
    with tempfile.TemporaryDirectory() as folder:
        for types in SIZES:
            path = os.path.join(folder, str(types))
            row = _in_process('--train', str(types), path)
            row['file_bytes'] = os.path.getsize(path)
            for name, option in (('all', '--load'), ('watched', '--load-watched')):
                loads = [_in_process(option, path) for _ in range(_LOADS)]
                row[name] = min(loads, key=lambda load: load['load_s'])
            result['models'][str(types)] = row
    return result


def markdown(result: Dict[str, Any]) -> str:
    """Return the line about the largest model."""
    types, row = list(result['models'].items())[-1]
    watched = row['watched']
    return (f'{types} event types, {row["events"]:,} events: trained in {row["train_s"]:.2g} s '
            f'with {row["train_peak_bytes"] / 1e6:.0f} MB, saved in {row["save_s"]:.2g} s to '
            f'{row["file_bytes"] / 1e6:.3g} MB. What is watched is loaded in '
            f'{watched["load_s"]:.2g} s to {watched["load_bytes"] / 1e6:.3g} MB; all, in '
            f'{row["all"]["load_s"]:.2g} s to {row["all"]["load_bytes"] / 1e6:.3g} MB.')


if __name__ == '__main__':  # or one of its parts, in a process of its own
    if sys.argv[1:2] == ['--train']:
        print(json.dumps(_train(int(sys.argv[2]), sys.argv[3])))
    elif sys.argv[1:2] and sys.argv[1].startswith('--load'):
        print(json.dumps(_load(sys.argv[2], sys.argv[1] == '--load-watched')))
    else:
        page.run('models', __doc__, measure, markdown)
