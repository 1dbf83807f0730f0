"""Writes what a recovery did: its section of docs/reliability.md."""
from __future__ import annotations

import time
from pathlib import Path
from statistics import median
from typing import List

from self_awareness_evaluation.page_section import machine, write_section
from self_awareness_evaluation.pages import written_by
from self_awareness_evaluation.recovery.measures import BACK_WITHIN_S, not_mended, of_healthy
from self_awareness_evaluation.recovery.session import DELAY_S, Recovered, RecoveryPlan
from self_awareness_evaluation.tables import table
from self_awareness_evaluation.soak.measures import Happened

SECTION = 'recovery'
"""Of the page reliability.md."""


def failures(recovered: Recovered) -> List[str]:
    """Return what was not as it should be, in words; empty: the recovery passed."""
    wrong = [f'hang {number} was not back in time: {hang}'
             for number, hang in enumerate(recovered.hangs, 1) if not hang.in_time(DELAY_S)]
    wrong += [f'{each.node} was healthy and restarted at {each.at:.1f}'
              for each in of_healthy(recovered.restarts, recovered.happened)]
    return wrong + [f'{each.culprit} hung from {each.onset:.1f} to {each.end:.1f}, and was not '
                    'restarted' for each in _not_mended(recovered)]


def write(docs: Path, plan: RecoveryPlan, recovered: Recovered, command: str) -> Path:
    """Write the section; return the page.

    Raises:
        ValueError: the page has no such section.
        OSError: it cannot be written.
    """
    page = docs / 'reliability.md'
    write_section(page, SECTION, section(plan, recovered, command))
    return page


def section(plan: RecoveryPlan, recovered: Recovered, command: str) -> str:
    """Return the section, without its heading."""
    hangs = recovered.hangs
    back = [hang.back_s for hang in hangs if hang.back_s is not None]
    alarms = [hang.alarm_s for hang in hangs if hang.alarm_s is not None]
    in_time = sum(hang.in_time(DELAY_S) for hang in hangs)
    healthy = of_healthy(recovered.restarts, recovered.happened)
    lines = [
        f'{written_by(command, time.strftime("%Y-%m-%d", time.gmtime()))} Seed {plan.seed}, '
        f'{machine()["cores"]} cores, the robot at {plan.speed:g} times its speed, learned from 2 '
        f'x {plan.training_s:g} s.', '']
    lines += table(['what', 'demanded', 'measured'], [
        [f'back within {BACK_WITHIN_S:g} s and the delay of {DELAY_S:g} s after the alarm', 'all',
         f'{in_time} of {len(hangs)}'],
        ['from the hang to the alarm', '', _times(alarms)],
        ['from the alarm to the first message of the new process', '', _times(back)],
        [f'faults at random, in {plan.minutes:g} minutes', '', str(len(recovered.happened))],
        ['nodes restarted meanwhile', '', str(len(recovered.restarts))],
        ['of them healthy', 'none', str(len(healthy))],
        ['hangs that lasted on', 'none', str(len(_not_mended(recovered)))]])
    return '\n'.join([*lines, '', *(f'- {each}' for each in failures(recovered))]).rstrip()


def _not_mended(recovered: Recovered) -> List[Happened]:
    return not_mended(recovered.happened, recovered.blamed, recovered.restarts, DELAY_S)


def _times(seconds: List[float]) -> str:
    if not seconds:
        return ''
    return f'median {median(seconds):.2f} s, longest {max(seconds):.2f} s'
