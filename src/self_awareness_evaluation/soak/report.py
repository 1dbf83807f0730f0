"""Writes what a soak found: a JSON file, and its section of docs/reliability.md."""
from __future__ import annotations

import json
import time
from dataclasses import asdict, dataclass
from pathlib import Path
from statistics import median
from typing import Any, Dict, List, Optional, Sequence

from self_awareness.output_files import replacing
from self_awareness_evaluation.page_section import machine, write_section
from self_awareness_evaluation.pages import written_by
from self_awareness_evaluation.tables import table
from self_awareness_evaluation.soak import measures
from self_awareness_evaluation.soak.measures import MUST_BE_FOUND_S, FalseAlarm, Found
from self_awareness_evaluation.soak.memory import KB_PER_MB, WARM_UP_S, Usage, slope_mb_per_hour
from self_awareness_evaluation.soak.session import Soak, SoakPlan

MOST_SLOPE = 1.0
"""Of resident memory that counts as flat [MB an hour]."""

SECTION = 'soak'
"""Of the page reliability.md."""

_EVERY_S = 10  # of the samples of memory, in the file


@dataclass(frozen=True)
class Result:
    """A soak, judged.

    Args:
        command: that it was started by.
        date: of its end, UTC.
        plan: what was asked for.
        machine: where it ran.
        lasted_s: [s].
        messages_per_s: that the monitor judged, on average.
        loads: least and largest load average at the faults.
        slope_mb_per_hour: of the monitor's resident memory after WARM_UP_S; None: it ran too
            short for one.
        memory: of the monitor, every 10 s.
        found: every fault.
        false_alarms: alarms without a fault.
    """

    command: str
    date: str
    plan: SoakPlan
    machine: Dict[str, Any]
    lasted_s: float
    messages_per_s: float
    loads: List[float]
    slope_mb_per_hour: Optional[float]
    memory: List[Usage]
    found: List[Found]
    false_alarms: List[FalseAlarm]

    @property
    def missed(self) -> List[Found]:
        """The faults that lasted long enough and were not found."""
        return [fault for fault in self.found if fault.missed]

    @property
    def failures(self) -> List[str]:
        """What was not as it should be, in words; empty: the soak passed."""
        wrong = [f'{fault.fault} at {fault.onset_s:.0f} s was missed' for fault in self.missed]
        wrong += [f'false alarm at {alarm.at_s:.0f} s: {alarm.message}'
                  for alarm in self.false_alarms]
        if self.slope_mb_per_hour is not None and self.slope_mb_per_hour >= MOST_SLOPE:
            wrong.append(f'memory grows by {self.slope_mb_per_hour:.2f} MB an hour')
        return wrong


def result(plan: SoakPlan, soak: Soak, command: str) -> Result:
    """Judge a soak."""
    found, false_alarms = measures.judge(soak.happened, soak.statuses, soak.begin)
    lasted_s = soak.end - soak.begin
    return Result(command, time.strftime('%Y-%m-%d', time.gmtime(soak.end)), plan, machine(),
                  lasted_s, soak.events / lasted_s,
                  [min(soak.loads), max(soak.loads)] if soak.loads else [],
                  slope_mb_per_hour(soak.memory), soak.memory[::_EVERY_S], found, false_alarms)


def write(docs: Path, soaked: Result) -> List[Path]:
    """Write reliability/soak.json and the section of reliability.md; return the files.

    Args:
        docs: the folder, with the page.
        soaked: what to write.

    Raises:
        ValueError: the page has no such section.
        OSError: a file cannot be written.
    """
    numbers, page = docs / 'reliability' / 'soak.json', docs / 'reliability.md'
    numbers.parent.mkdir(parents=True, exist_ok=True)
    with replacing(str(numbers)) as temporary:
        Path(temporary).write_text(json.dumps(asdict(soaked), indent=1) + '\n', encoding='utf-8')
    write_section(page, SECTION, section(soaked))
    return [numbers, page]


def section(soaked: Result) -> str:
    """Return the section, without its heading."""
    plan = soaked.plan
    lines = [
        f'{written_by(soaked.command, soaked.date)} Seed {plan.seed}, '
        f'{soaked.machine["cores"]} cores ({soaked.machine["machine"]}), load average at the '
        f'faults {" to ".join(f"{load:.1f}" for load in soaked.loads) or "unknown"}, the robot\'s '
        'own included.', '',
        f'{soaked.lasted_s / 60.0:.0f} minutes of the simulated robot at {plan.speed:g} times its '
        f'speed: the monitor judged {soaked.messages_per_s:.0f} messages a second. It had learned '
        f'from {plan.starts} x {plan.training_s:g} s; its limits are those of '
        f'{plan.calibrations} x {plan.calibration_s:g} s, with a budget of {plan.budget:g} false '
        'alarms an hour. Each of these recordings is of another start of the robot.', '']
    lines += table(['what', 'demanded', 'measured'], [
        [f'faults of more than {MUST_BE_FOUND_S:g} s that were missed', 'none', _missed(soaked)],
        ['alarms without a fault', 'none', str(len(soaked.false_alarms))],
        [f'slope of resident memory after {WARM_UP_S / 60.0:g} minutes',
         f'less than {MOST_SLOPE:g} MB an hour', _slope(soaked)],
        ['resident memory at the beginning and the end', '', _memory(soaked.memory)],
        ['threads, open files', '', _handles(soaked.memory)]])
    lines += ['', *table(['fault', 'number', 'found', 'median time to the alarm', 'longest',
                          'named first', 'alarm over after the end, median', 'longest'],
                         _rows(soaked.found))]
    lines += [''] + [f'- {failure}' for failure in soaked.failures]
    return '\n'.join(lines).rstrip()


def _missed(soaked: Result) -> str:
    number = sum(fault.lasted_s > MUST_BE_FOUND_S for fault in soaked.found)
    return f'{len(soaked.missed)} of {number}'


def _slope(soaked: Result) -> str:
    if soaked.slope_mb_per_hour is None:
        return 'not measured: it takes 10 minutes'
    return f'{soaked.slope_mb_per_hour:.2f} MB an hour'


def _memory(memory: Sequence[Usage]) -> str:
    if not memory:
        return 'unknown'
    first, last = (memory[at].resident_kb / KB_PER_MB for at in (0, -1))
    return f'{first:.1f} MB, {last:.1f} MB'


def _handles(memory: Sequence[Usage]) -> str:
    if not memory:
        return 'unknown'
    return (f'{memory[0].threads} and {memory[0].files}, then {memory[-1].threads} and '
            f'{memory[-1].files}')


def _rows(found: Sequence[Found]) -> List[List[str]]:
    rows = []
    for kind in sorted({_kind(fault) for fault in found}):
        of_kind = [fault for fault in found if _kind(fault) == kind]
        latencies = [fault.latency_s for fault in of_kind if fault.latency_s is not None]
        cleared = [fault.cleared_s for fault in of_kind if fault.cleared_s is not None]
        rows.append([kind, str(len(of_kind)), str(len(latencies)), *_times(latencies),
                     str(sum(fault.rank == 1 for fault in of_kind)), *_times(cleared)])
    return rows


def _times(times_s: Sequence[float]) -> List[str]:
    """Return median and longest."""
    if not times_s:
        return ['', '']
    return [f'{median(times_s):.2f} s', f'{max(times_s):.2f} s']


def _kind(fault: Found) -> str:
    """Return the kind of a fault; those that need not be found are one of their own."""
    kind = fault.fault.partition(':')[0]
    short = fault.lasted_s <= MUST_BE_FOUND_S
    return f'{kind} of less than {MUST_BE_FOUND_S:g} s' if short else kind
