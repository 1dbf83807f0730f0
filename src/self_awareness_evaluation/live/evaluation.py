"""The live evaluation from the session to the page."""
from __future__ import annotations

from pathlib import Path
from typing import List, Sequence

from self_awareness import progress
from self_awareness_evaluation.live import offline, report, session
from self_awareness_evaluation.live.samples import Sample, Status, Stretch, measure
from self_awareness_evaluation.live.session import SessionPlan


def evaluate(plan: SessionPlan, folder: Path, output: Path, command: str) -> List[Path]:
    """Run a session, judge it and write the results; return the files.

    What the monitor said is saved after every fault, so that little is lost if the session fails.

    Args:
        plan: of the session.
        folder: for recordings and logs.
        output: for the results.
        command: that the page says it was written by.

    Raises:
        LiveError: the session failed.
        OSError: a file cannot be written.
    """
    samples: List[Sample] = []

    def told(stretch: Stretch, statuses: Sequence[Status]) -> None:
        samples.append(measure(report.LIVE, stretch, statuses))
        report.save_csv(output / 'live.csv', samples)
        progress.say(f'  {_brief(samples[-1])}')

    afterwards = offline.judge(session.run(plan, folder, told), report.LIVE)
    return report.write(output, plan, samples, afterwards, command)


def _brief(sample: Sample) -> str:
    if sample.false_alarms is not None:
        return f'{sample.fault}: false alarms: {sample.false_alarms}'
    return (f'{sample.fault}: {sample.void or sample.latency_s}, suspicion {sample.suspicion_s}, '
            f'{sample.evidence}, {sample.suspects} {sample.note}')
