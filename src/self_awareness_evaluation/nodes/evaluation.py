"""The evaluation beside the packaged nodes, from the session to the page."""
from __future__ import annotations

from pathlib import Path
from typing import List

from self_awareness import progress
from self_awareness_evaluation.nodes import report, session
from self_awareness_evaluation.nodes.measures import BURSTS, UNDISTURBED, Row
from self_awareness_evaluation.nodes.session import SessionPlan


def evaluate(plan: SessionPlan, folder: Path, output: Path, command: str) -> List[Path]:
    """Run a session and return the files that are written: the CSV file after every stretch.

    Args:
        plan: what to do.
        folder: for recordings and logs; exists.
        output: for the results; exists.
        command: that the page names.

    Raises:
        LiveError: the session failed.
        OSError: a file cannot be written.
    """
    rows: List[Row] = []

    def told(row: Row) -> None:
        rows.append(row)
        report.save_csv(report.csv_path(output), rows)
        progress.say(f'  {_brief(row)}')

    session.run(plan, folder, told)
    return report.write(output, plan, rows, command)


def _brief(row: Row) -> str:
    if row.fault in (UNDISTURBED, BURSTS):
        return (f'{row.lasted_s:.0f} s: alarms: {row.alarms:g} ({row.named:g} name a node), '
                f'suspicions: {row.suspicions:g}, '
                f'an alarm stood for {row.standing_s:.1f} s; {row.said}')
    return (f'{row.node} {row.fault}: {row.void or row.latency_s}, suspicion {row.suspicion_s}, '
            f'cleared after {row.cleared_s:.1f} s, {row.suspects}; {row.said} {row.note}')
