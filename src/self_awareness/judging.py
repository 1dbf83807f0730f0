"""Judges whole recordings with either detector: both are called in the same way."""
from __future__ import annotations

from functools import partial
from typing import Callable, Optional, Sequence

from self_awareness import (Acceptance, DetectorParameters, EvidenceModel, PaperModel,
                            TrainedModel, Verdicts, judge_by_evidence)

EVIDENCE, PAPER, BOTH = 'evidence', 'paper', 'both'  # detectors that a model is trained for

Judge = Callable[..., Verdicts]
"""Takes a RecordingEvents, and a ReplayedMonitor if one is to be told of each window."""


def paper_judge(trained: TrainedModel, model: PaperModel, threshold: Optional[float],
                parameters: DetectorParameters) -> Judge:
    """Return what judges by the paper's score; threshold None: scores only, no alarms."""
    return partial(model.judge, trained.window, threshold, parameters)


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
    return partial(judge_by_evidence, trained, computed or EvidenceModel(trained), parameters,
                   accepted=list(accepted))


def load_model(path: str, detector: str, watched_only: bool = False) -> TrainedModel:
    """Return the model of a file, which a detector is to judge by.

    Raises:
        ModelFileError: it cannot be read.
        ValueError: it was not trained for this detector.
    """
    model = TrainedModel.load(path, watched_only)
    try:
        model.require(detector)
    except ValueError as error:
        raise ValueError(f'{path}: {error}') from error
    return model
