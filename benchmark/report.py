#!/usr/bin/python3
"""Benchmark of the report: an hour with 500 event types, of which one node is silent for a minute.

Measures `score` with and without --report, the size of the page, and how long Chromium takes to
load it; these come from python3-selenium and chromium-driver.
"""
from __future__ import annotations

import json
import os
import re
import statistics
import subprocess
import sys
import tempfile
from functools import reduce
from operator import getitem
from pathlib import Path
from typing import Any, Dict, List

import numpy as np

import page
import timers

_TYPES = 500
_SECONDS = 3600.0
_TRAINED_S = 300
_SILENT_S = (1800.0, 1860.0)
_SILENT_TYPE = 0
_RUNS = 3
_PROGRAM = 'import sys\nfrom self_awareness.commands.{0} import main\nsys.exit(main(sys.argv[1:]))'


def _write(path: str) -> int:
    """Write the recording, and return the number of its messages."""
    stamps, ids = timers.events_of(_TYPES, _SECONDS)
    node = ids // 3 == _SILENT_TYPE // 3
    silent = node & (stamps >= 1e9 * _SILENT_S[0]) & (stamps < 1e9 * _SILENT_S[1])
    timers.write_bag(path, stamps[~silent], ids[~silent])
    return int(np.count_nonzero(~silent))


def _run(program: str, *arguments: str) -> Dict[str, float]:
    """Run a program; return what it used."""
    return page.run_program((sys.executable, '-B', '-c', _PROGRAM.format(program), *arguments)
                            )._asdict()


def _loaded_s(path: str) -> float:
    """Return how long a browser takes to load and draw a page [s]."""
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service
    options = webdriver.ChromeOptions()
    for argument in ('--headless=new', '--disable-gpu', '--window-size=1200,900', '--no-sandbox'):
        options.add_argument(argument)
    driver = webdriver.Chrome(service=Service('/usr/bin/chromedriver'), options=options)
    try:
        driver.get(Path(path).as_uri())  # returns after what its scripts draw
        return driver.execute_script(
            'return performance.timing.loadEventEnd - performance.timing.navigationStart') / 1000
    finally:
        driver.quit()


def measure() -> Dict[str, Any]:
    """Return the results."""
    result: Dict[str, Any] = dict(page.machine(), types=_TYPES, seconds=_SECONDS, runs=_RUNS)
    with tempfile.TemporaryDirectory() as folder:
        bag, model, report = (os.path.join(folder, name) for name in ('b.bag', 'm', 'r.html'))
        # In a process of its own: the memory of this one is a part of what its children have.
        result['messages'] = int(subprocess.run(
            (sys.executable, '-B', __file__, '--write', bag), check=True, text=True,
            stdout=subprocess.PIPE).stdout)
        _run('train', bag, '--end', str(_TRAINED_S), '-o', model)
        runs: List[Dict[str, Any]] = []
        for _ in range(_RUNS):
            runs.append({'score': _run('score', bag, '--model', model),
                         'report': _run('score', bag, '--model', model, '--report', report),
                         'load_s': _loaded_s(report)})
        result['measured'] = runs
        result['report_bytes'] = os.path.getsize(report)
        text = Path(report).read_text(encoding='utf-8')
        data, = re.findall(r'<script type="application/json" id="data">(.*?)</script>', text)
        result['data_bytes'] = len(data)
        result['incidents'] = len(json.loads(data)['sections'][0]['incidents'])
    return result


def markdown(result: Dict[str, Any]) -> str:
    """Return the medians of all runs."""
    def median(*keys: str) -> float:
        return statistics.median(reduce(getitem, keys, each) for each in result['measured'])

    return (f'{result["messages"]:,} messages of {result["types"]} event types in '
            f'{result["seconds"] / 60:.0f} minutes: `score` {median("score", "wall_s"):.1f} s, '
            f'with `--report` {median("report", "wall_s"):.1f} s and '
            f'{median("report", "peak_bytes") / 1e6:.0f} MB of memory; the page '
            f'{result["report_bytes"] / 1e6:.1f} MB ({result["data_bytes"] / 1e6:.2f} of data), '
            f'drawn in {median("load_s"):.1f} s.')


if __name__ == '__main__':
    if sys.argv[1:2] == ['--write']:
        print(_write(sys.argv[2]))
    else:
        page.run('report', __doc__, measure, markdown)
