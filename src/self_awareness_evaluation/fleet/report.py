"""The page about robots of one make, and its tables as CSV files."""
from __future__ import annotations

from pathlib import Path
from statistics import median
from typing import List, Sequence, Tuple

import numpy as np

from self_awareness.calibration import confidence
from self_awareness.output_files import replacing
from self_awareness_evaluation.fleet.experiment import (FLEET, OWN, DeathRow, NormalRow, Plan,
                                                        Results)
from self_awareness_evaluation.pages import written_by
from self_awareness_evaluation.row_files import save

ALLOWED_S = 0.2
"""By how much later a death may be found than by the robot's own model [s]."""

_TEXT = """\
# Evaluation on robots of one make

{written}

Robots of a make have the same timers and chains of answers, each in a namespace of its own
(`--rename`), with clocks that are off by up to 50 ppm, and with a sensor that no other one has;
every second one has an arm, and what answers to it. Makes are drawn by their seeds: {makes}.

- `{fleet}`: learned on {robots} robots of the make, {starts} starts of each to train on and
  {calibrations} to calibrate on, {recorded:g} s each; budget: {budget:g} false alarms an hour.
- `{own}`: learned on as many recordings of the robot that is watched.

One more robot is watched for {hours:g} h in recordings of 30 minutes, each of another start; and
every component of it that sends regularly dies, each in a recording of its own.

{rows}

Of the {both} deaths that both models watch, `{fleet}` found {compared}. By how much later than
`{own}`: median {middle:+.2f} s, 95 % of them by {most95:+.2f} s at most, the latest by
{most:+.2f} s; {within} of {both} by {allowed:g} s at most.

Not watched by `{fleet}`: {alone}. What only the watched robot has was never learned; it is told
once as new.

## Who works

Robots are counted, limits found and recordings judged by {jobs}, as `train --scheduler` does it on
several machines ([fleets](../fleet.md)). Processes, a cluster and a single process find the same
(`test/python/evaluation/test_evaluate_fleet.py`).

## Real robots

Of the recordings of real robots that the tests use, all of a kind are of one and the same robot,
without a namespace, but for one: a voice assistant in two builds, one with a microphone, one with
an array, whose nodes have other names with every start. Learned on three normal runs of the array,
the six normal runs of the other build (0.9 h) are quiet, and its run in loud noise is found, with
the guilty node. Learned on those six, the run of the array in loud noise is found likewise, and
one of its three normal runs (1.1 h) has a false alarm: a late answer
(`test/python/test_real_recordings.py`, which skips where there are no recordings).

All figures: [fleet_normal.csv](fleet_normal.csv), [fleet_deaths.csv](fleet_deaths.csv).
"""

_HEAD = ('model', 'false alarms in {hours:g} h', 'an hour (95 %)', 'promised, an hour',
         'deaths found, of those watched', 'median', 'named first', 'not watched')


def write(folder: Path, plan: Plan, results: Results, command: str) -> List[Path]:
    """Write the page and its tables; return their paths.

    Raises:
        OSError: one cannot be written.
    """
    page = folder / 'fleet.md'
    tables = folder / 'fleet_normal.csv', folder / 'fleet_deaths.csv'
    save(tables[0], results.normal, NormalRow)
    save(tables[1], results.deaths, DeathRow)
    with replacing(str(page)) as temporary:
        Path(temporary).write_text(_page(plan, results, command), encoding='utf-8')
    return [page, *tables]


def _page(plan: Plan, results: Results, command: str) -> str:
    later = _later(results.deaths)
    found = sum(np.isfinite(later))
    alone = sorted({row.source for row in results.deaths if row.model == FLEET
                    and not row.watched})
    return _TEXT.format(
        written=written_by(command), makes=', '.join(map(str, plan.makes)), fleet=FLEET, own=OWN,
        robots=plan.robots, starts=plan.starts, calibrations=plan.calibrations,
        recorded=plan.recorded_s, budget=plan.budget, hours=plan.hours,
        rows='\n'.join([f'| {" | ".join(_HEAD)} |'.format(hours=plan.hours * len(plan.makes)),
                        '| ' + ' | '.join('---' for _ in _HEAD) + ' |',
                        *(_row(name, results) for name in (FLEET, OWN))]), both=len(later),
        compared='all' if found == len(later) else f'{found}', middle=median(later),
        most95=sorted(later)[max(0, round(0.95 * len(later)) - 1)], most=max(later),
        within=sum(each <= ALLOWED_S + 1e-9 for each in later), allowed=ALLOWED_S,
        alone=', '.join(alone) or 'none', jobs=_told(plan))


def _told(plan: Plan) -> str:
    number = '1 process' if plan.jobs == 1 else f'{plan.jobs} processes'
    return f'{number} of a dask cluster on one machine' if plan.dask else number


def _row(model: str, results: Results) -> str:
    normal = [row for row in results.normal if row.model == model]
    deaths = [row for row in results.deaths if row.model == model and row.watched]
    hours = sum(row.hours for row in normal)
    alarms = sum(row.alarms for row in normal)
    low, high = confidence.poisson_rate(alarms, hours)
    promised = float(np.mean([row.expected for row in normal]))
    latencies = [row.latency_s for row in deaths if row.latency_s is not None]
    others = sum(row.model == model and not row.watched for row in results.deaths)
    first = sum(bool(row.first) for row in deaths)
    return (f'| {model} | {alarms} | {alarms / hours:.3g} ({low:.2g} to {high:.2g}) '
            f'| {promised:.2g} | {len(latencies)} of {len(deaths)} | {median(latencies):.2f} s '
            f'| {first / max(len(latencies), 1):.0%} | {others} |')


def _later(deaths: Sequence[DeathRow]) -> List[float]:
    """Return by how much later FLEET found each death that both watch [s]; infinity: not."""
    found: List[float] = []
    by_model: Tuple[dict, dict] = ({}, {})
    for row in deaths:
        if row.watched:
            by_model[row.model == OWN][row.make, row.source] = (
                np.inf if row.latency_s is None else row.latency_s)
    for key, latency in by_model[0].items():
        own = by_model[1].get(key)
        if own is not None and np.isfinite(own):
            found.append(float(latency - own))
    return found
