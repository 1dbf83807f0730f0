"""Writes what the live evaluation found: a CSV file of all samples, a page of tables, a plot."""
from __future__ import annotations

import csv
import os
import time
from dataclasses import astuple, fields
from pathlib import Path
from typing import List, Optional, Sequence

from self_awareness.calibration import confidence
from self_awareness.output_files import replacing
from self_awareness_evaluation.live import offline
from self_awareness_evaluation.live.learning import APART_S
from self_awareness_evaluation.live.listeners import QUIET_S
from self_awareness_evaluation.live.samples import Sample, of_system
from self_awareness_evaluation.live.session import FAULTS_S, SessionPlan
from self_awareness_evaluation.pages import written_by
from self_awareness_evaluation.figures import quantile
from self_awareness_evaluation.records import NORMAL
from self_awareness_evaluation.tables import percent, seconds, table
from self_awareness_evaluation.systems import distinct

LIVE = 'evidence'
"""The detector of the monitor that listened."""

SYSTEMS = (LIVE, *offline.SYSTEMS)

_DPI = 120

_INTRODUCTION = """\
# Evaluation on the running robot

{written}

Faults induced in the 15 processes of `launch/follow_me.launch` under a real master, on a machine
of {cores} cores, while the monitor of `launch/monitor.launch` listened with the evidence
detector. The model: training on {training} s, limits by {calibration:g} s of other normal
operation, each recorded in another start of the robot, {apart:g} s after the one before, with the
graph of the running robot. That is less than in simulated time (2 x 100 s and 600 s), since real
time passes here.

Each of the {rounds} rounds: {normal:g} s of normal operation; the faults of the table in its
order, in the same running robot, each as `induce` does it. Nodes that were killed are started
again; `silence` ends the round, and the robot is started again. The monitor runs on. Before each
fault its ~reset is called, and it has settled and not alarmed for {quiet:g} s; otherwise the alarm
of one fault could stand at the next one's onset. How long it stands is not measured here.

The latency of `{live}` is from the onset to the end of the window whose status was ERROR, by ROS
time; that of WARN (a suspicion) likewise, an ERROR being one. Median (smallest to largest); a
fault without an alarm while it lasted counts as infinite (–). The onset is when the
node was killed, the parameter was set or, for `extra`, its first message came. A sample is void
if an alarm stood at the onset, if the monitor was settling, or if the machine's clock was set
during the fault.

By default (`~unknown`: `warn`) events never seen in training, those of `unknown` and `extra`, are
a suspicion and no alarm.

The other systems were not running: they judge the recording of the same session, having learned
from the same training, with thresholds that a share of 0.001 of the calibration's windows falls
below. They blame and alarm as in [research.md](research.md).

The machine's load average at the beginning of normal operation was {low:.1f} to {high:.1f},
the robot's own included.

All samples: [live.csv](live.csv).

![Latencies](live.png)
"""


def write(folder: Path, plan: SessionPlan, live: Sequence[Sample], afterwards: offline.Found,
          command: str) -> List[Path]:
    """Write all files, each whole or not at all; return their names.

    Args:
        folder: exists.
        plan: of the session.
        live: samples of the monitor.
        afterwards: what the other systems find in the recording.
        command: that the page says it was written by.

    Raises:
        OSError: a file cannot be written.
    """
    samples = [*live, *afterwards.samples]
    paths = [folder / 'live.csv', folder / 'live.md', folder / 'live.png']
    save_csv(paths[0], samples)
    with replacing(str(paths[1])) as temporary:
        Path(temporary).write_text(page(plan, samples, afterwards, command), encoding='utf-8')
    _save_plot(str(paths[2]), samples)
    return paths


def save_csv(path: Path, samples: Sequence[Sample]) -> None:
    """Write a row for every sample.

    Raises:
        OSError: the file cannot be written.
    """
    with replacing(str(path)) as temporary:
        with open(temporary, 'w', encoding='utf-8', newline='') as file:
            writer = csv.writer(file, lineterminator='\n')
            writer.writerow([field.name for field in fields(Sample)])
            writer.writerows(astuple(sample) for sample in samples)


def page(plan: SessionPlan, samples: Sequence[Sample], afterwards: offline.Found,
         command: str) -> str:
    """Return the page of tables."""
    systems = [name for name in SYSTEMS if any(sample.system == name for sample in samples)]
    kinds = [kind for kind in FAULTS_S if any(sample.fault == kind for sample in samples)]
    loads = [sample.load for sample in samples if sample.fault == NORMAL]
    lines = [_INTRODUCTION.format(
        written=written_by(command, time.strftime('%Y-%m-%d', time.gmtime())), live=LIVE,
        cores=len(os.sched_getaffinity(0)), rounds=plan.rounds, normal=plan.normal_s,
        training=' + '.join(f'{length:g}' for length in plan.training),
        calibration=plan.calibration_s, apart=APART_S, quiet=QUIET_S, low=min(loads),
        high=max(loads))]
    lines += ['## Alarms', '', 'Raised, of those that count; median latency (smallest to '
              'largest).', '']
    lines += table(['fault', 'lasts', f'{LIVE}: WARN', *systems],
                   [[kind, f'{FAULTS_S[kind]:g} s',
                     _latencies([sample.suspicion_s
                                 for sample in of_system(samples, LIVE, kind)]),
                     *(_latencies([sample.latency_s for sample in of_system(samples, name, kind)])
                       for name in systems)] for kind in kinds])
    lines += ['', '## Blame', '', 'Alarms that blame a guilty source first / among the first '
              'three; – where no source is guilty, or no alarm was raised.', '']
    lines += table(['fault', *systems, f'first evidence of {LIVE}'],
                   [[kind, *(_blame(of_system(samples, name, kind)) for name in systems),
                     '; '.join(distinct([sample.evidence
                                         for sample in of_system(samples, LIVE, kind)
                                         if sample.evidence]))] for kind in kinds])
    lines += ['', '## False alarms', '', *_false_alarms(samples, systems), '',
              '## Components watched', '',
              *(f'- {name}: {_number_watched(afterwards, name)}' for name in systems), '']
    return '\n'.join(lines + _remarks(samples))


def _number_watched(found: offline.Found, name: str) -> str:
    number = found.watched[name]
    return ('judges all together' if number is None
            else f'{number} of {found.components}')


def _latencies(values: Sequence[Optional[float]]) -> str:
    raised = [value for value in values if value is not None]
    text = f'{len(raised)} of {len(values)}'
    if not raised:
        return text
    return (f'{text}, {seconds(quantile(values, 0.5))} ({min(raised):.2f} to '
            f'{max(raised):.2f})')


def _blame(samples: Sequence[Sample]) -> str:
    blamed = [sample for sample in samples if sample.top1 is not None]
    if not blamed:
        return '–'
    return (f'{percent(sum(bool(sample.top1) for sample in blamed) / len(blamed))} / '
            f'{percent(sum(bool(sample.top3) for sample in blamed) / len(blamed))}')


def _false_alarms(samples: Sequence[Sample], systems: Sequence[str]) -> List[str]:
    lines = []
    hours = 0.0
    for name in systems:
        of_normal = of_system(samples, name, NORMAL)
        hours = sum(sample.lasted_s for sample in of_normal) / 3600.0
        if hours == 0.0:
            continue
        count = sum(sample.false_alarms or 0 for sample in of_normal)
        low, high = confidence.poisson_rate(count, hours)
        lines.append(f'- {name}: {count} in {60.0 * hours:.1f} min of normal operation (95 %: '
                     f'{low:.1f} to {high:.1f} an hour)')
    needed = confidence.poisson_rate(0, 1.0)[1]
    return [*lines, '', 'That is little: to say that there is less than one an hour takes '
            f'{needed:.1f} h without one. Simulated time tells more.']


def _remarks(samples: Sequence[Sample]) -> List[str]:
    remarks = [f'- {sample.system}, round {sample.round}, {sample.fault}: '
               + '; '.join(filter(None, (sample.void and f'void: {sample.void}', sample.note)))
               for sample in samples
               if sample.void or (sample.note and sample.system == LIVE)]
    return ['## Void samples, and what did not go as planned', '',
            *(remarks or ['Nothing.']), '']


def _save_plot(path: str, samples: Sequence[Sample]) -> None:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(11, 5), dpi=_DPI, constrained_layout=True)
    axes = figure.subplots()
    kinds = list(FAULTS_S)
    for index, name in enumerate(SYSTEMS):
        found, missed = [], []
        for place, kind in enumerate(kinds):
            x = place + 0.22 * (index - 1)
            for sample in of_system(samples, name, kind):
                if sample.latency_s is None:
                    missed.append((x, FAULTS_S[kind]))
                else:
                    found.append((x, sample.latency_s))
        axes.plot(*_columns(found), 'o', color=f'C{index}', markersize=5, alpha=0.6, label=name)
        axes.plot(*_columns(missed), 'x', color=f'C{index}', markersize=7)
    axes.set(yscale='log', ylabel='latency of the alarm [s]; x: none while the fault lasted',
             ylim=(0.05, 1.5 * max(FAULTS_S.values())), xticks=range(len(kinds)))
    axes.set_xticklabels(kinds, rotation=20, ha='right')
    axes.grid(alpha=0.3)
    axes.legend()
    with replacing(path) as temporary:
        figure.savefig(temporary, format='png')


def _columns(points: Sequence[tuple]) -> List[List[float]]:
    return [list(column) for column in zip(*points)] or [[], []]
