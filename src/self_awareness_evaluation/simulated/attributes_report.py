"""The page on faults that neither silence nor timing tells, and its rows as a CSV file."""
from __future__ import annotations

import math
from pathlib import Path
from typing import List, Sequence

from self_awareness.calibration import limits
from self_awareness.output_files import replacing
from self_awareness_evaluation import row_files
from self_awareness_evaluation.pages import written_by
from self_awareness_evaluation.simulated import summary
from self_awareness_evaluation.simulated.experiment import Plan
from self_awareness_evaluation.simulated.measures import Row
from self_awareness_evaluation.simulated.records import (NORMAL_TEST_S, RECORD_S, TRAINING_NAMES,
                                                         WITHIN_S)
from self_awareness_evaluation.simulated.tables import table
from self_awareness_evaluation.tally import NONE, Tally

NAME = 'attributes'

SYSTEM = 'evidence'
"""Whom the first table is about."""

_INTRODUCTION = """\
# Faults that neither silence nor timing tells

{written}

The [simulated robot](../simulated_robot.md) sends what it always sends, when it always does, and
is broken all the same: its stamps stand still, one message in a hundred is lost, scans are empty,
an image stays the same, a node does not subscribe to a topic. Seeds {seeds}: for each, {training}
records of {record_s:g} s to learn from, one of {calibration_s:g} s to calibrate on, one of
{normal_s:g} s of normal operation, and one for each fault, which begins between 50 and 52 s. A
record holds what an event log does: times, [attributes of the messages](../attributes.md) and [who
subscribes to what](../connections.md). All systems learn from and judge the same records, made
like those of [simulated.md](simulated.md).

## Found

`{system}`, with limits for {budget:g} false alarms an hour: alarms after the onset. Of
`unsubscribed`, it is a suspicion (WARN), and never an alarm; it is one finding after a minute. *In
time*: no later than what is aimed at. One message in a hundred is another thing for `motors`, with
86 messages a second, than for `camera`, with 7.5: in 30 s, two are lost of the latter on average,
and the [sum of losses](../attributes.md) must say more than chance does. Its record goes on for
150 s after the onset.

{found}

## Beside others

`timestamps` is diagnostic_updater's TimeStampStatus with its defaults: a stamp more than 1 s
ahead, or older than 5 s. `sizes` knows the smallest and the largest message of each topic in
training, and allows a quarter more. Both look at messages, and at nothing else. `gaps` and
`frequency_learned` look at times, and at nothing else: a message that is lost is a longer gap, and
one less in 5 s; of a timer as exact as this robot's, that is more than ever. Each cell: found, and
the median latency; what a system with false alarms finds, it may find by chance.

{others}

All rows: [{name}.csv]({name}.csv).
"""


def write(folder: Path, plan: Plan, rows: Sequence[Row], command: str) -> List[Path]:
    """Write the page and the rows, each whole or not at all; return their names.

    Args:
        folder: exists.
        plan: what was evaluated; SYSTEM is one of the systems.
        rows: what was found.
        command: that the page says it was written by.

    Raises:
        OSError: a file cannot be written.
    """
    paths = [folder / f'{NAME}.csv', folder / f'{NAME}.md']
    row_files.save(paths[0], rows, Row)
    with replacing(str(paths[1])) as temporary:
        Path(temporary).write_text(_page(plan, rows, command), encoding='utf-8')
    return paths


def _page(plan: Plan, rows: Sequence[Row], command: str) -> str:
    return _INTRODUCTION.format(
        written=written_by(command), name=NAME, system=SYSTEM,
        seeds=', '.join(str(seed) for seed in plan.seeds), training=len(TRAINING_NAMES),
        record_s=RECORD_S, calibration_s=plan.calibration_s, normal_s=NORMAL_TEST_S,
        budget=limits.BUDGET, found='\n'.join(_found(plan, rows)),
        others='\n'.join(_others(plan, rows)))


def _found(plan: Plan, rows: Sequence[Row]) -> List[str]:
    body = []
    for kind in plan.faults:
        tally = _tally(rows, SYSTEM, kind)
        found = [latency for latency in tally.latencies_s if latency < math.inf]
        body.append([f'`{kind}`', f'{WITHIN_S[kind]:g} s',
                     f'{tally.within(WITHIN_S[kind])} of {len(tally.latencies_s)}', tally.found(),
                     f'{max(found):.2f} s' if found else NONE, tally.named_first])
    return table(['fault', 'aim', 'in time', 'found, median', 'longest', 'blamed first'], body)


def _others(plan: Plan, rows: Sequence[Row]) -> List[str]:
    body = [[f'`{kind}`', *(_tally(rows, system, kind).found() for system in plan.systems)]
            for kind in plan.faults]
    of_systems = [[row for row in rows if row.system == system] for system in plan.systems]
    for what, rate_of in (('false alarms an hour', summary.false_alarms),
                          ('suspicions or alarms an hour', summary.false_suspicions)):
        rates = [rate_of(of_system) for of_system in of_systems]
        body.append([f'{what} (95 %), in {rates[0].hours:.2g} h',
                     *(f'{rate.per_hour:.2g} ({rate.interval[0]:.2g} to {rate.interval[1]:.2g})'
                       for rate in rates)])
    return table(['fault', *(f'`{system}`' for system in plan.systems)], body)


def _tally(rows: Sequence[Row], system: str, kind: str) -> Tally:
    """Return how a system found a fault: by an alarm, or by a suspicion where it never is one."""
    chosen = [row for row in rows if (row.system, row.record) == (system, kind)]
    if kind.startswith('unsubscribed:'):
        return Tally.of((row.noticed_s, row.noticed_first) for row in chosen)
    return Tally.of((row.latency_s, row.top1) for row in chosen)
