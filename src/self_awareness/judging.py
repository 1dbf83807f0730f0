"""Judges whole recordings with either detector: both are called in the same way."""
from __future__ import annotations

from typing import Callable, Dict, Iterable, Optional, Sequence, Set, Tuple

import numpy as np

from self_awareness import (Acceptance, DetectorParameters, EventType, EvidenceModel, PaperModel,
                            ReplayedMonitor, TrainedModel, Verdicts, Waiting, judge_by_evidence)

EVIDENCE = 'evidence'
PAPER = 'paper'
BOTH = 'both'
"""The detectors that a model may be trained for."""

Judge = Callable[..., Verdicts]
"""Judges stamps and ids of a recording, and the silence up to its end [ns]. Further arguments: the
event types by id, those of the model first (without, those of unknown events are not known), a
ReplayedMonitor that is told of all of it, where the clock was set (clock_steps), how the machine
was (waiting), on which computers sources ran (hosts), which subscriptions were missing, the
attributes of the messages (attributes), and who sent besides (senders)."""


def paper_judge(trained: TrainedModel, model: PaperModel, threshold: Optional[float],
                parameters: DetectorParameters) -> Judge:
    """Return what judges by the paper's score; threshold None: scores only, no alarms."""
    return lambda stamps, ids, end, event_types=(), monitor=None, clock_steps=(), **_: (
        model.judge(trained.window, threshold, parameters, stamps, ids, end, list(event_types),
                    monitor, clock_steps))


def evidence_judge(trained: TrainedModel, parameters: DetectorParameters,
                   computed: Optional[EvidenceModel] = None,
                   accepted: Sequence[Acceptance] = ()) -> Judge:
    """Return what judges by evidence and the model's limits.

    Args:
        trained: the model.
        parameters: of the detector.
        computed: from the model, if the caller has it already.
        accepted: what is normal besides (accepted_file).

    Raises:
        ValueError: the limits are not those of the model.
    """
    model = computed or EvidenceModel(trained)

    def judge(stamps: np.ndarray, ids: np.ndarray, end: Optional[int] = None,
              event_types: Iterable[EventType] = (), monitor: Optional[ReplayedMonitor] = None,
              clock_steps: Sequence[int] = (), waiting: Iterable[Waiting] = (),
              hosts: Optional[Dict[str, str]] = None,
              missing: Iterable[Tuple[int, Set[Tuple[str, str]]]] = (),
              attributes: Optional[np.ndarray] = None,
              senders: Iterable[Tuple[int, Set[Tuple[str, str]], Set[EventType]]] = ()
              ) -> Verdicts:
        return judge_by_evidence(trained, model, parameters, stamps, ids, end, list(event_types),
                                 monitor, clock_steps, list(waiting), hosts or {}, list(accepted),
                                 list(missing), attributes, list(senders))
    return judge
