"""A soak from the session to the page."""
from __future__ import annotations

from pathlib import Path
from typing import List

from self_awareness_evaluation.soak import report, session
from self_awareness_evaluation.soak.session import SoakPlan


class SoakError(ValueError):
    """The monitor did not stand the soak; the message says why."""


def evaluate(plan: SoakPlan, folder: Path, output: Path, command: str) -> List[Path]:
    """Run a soak and write what it found; return the files.

    Args:
        plan: of the soak.
        folder: for recordings, the model and logs.
        output: folder of reliability.md.
        command: that the page says it was written by.

    Raises:
        LiveError: the session failed.
        SoakError: a fault was missed, an alarm was false, or memory grows; all is written.
        OSError: a file cannot be written.
    """
    soaked = report.result(plan, session.run(plan, folder), command)
    paths = report.write(output, soaked)
    if soaked.failures:
        raise SoakError('; '.join(soaked.failures))
    return paths
