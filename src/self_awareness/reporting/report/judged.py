"""What a report is made of: a recording, what judged it, and the verdicts."""
from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Dict, Optional, Tuple

import numpy as np

from self_awareness import (DetectorParameters, EvidenceLanes, EvidenceModel, TrainedModel,
                            Verdicts, evidence_lanes)
from self_awareness.recordings import RecordingEvents
from self_awareness.stamps import SECOND_NS


@dataclass(frozen=True)
class JudgedBy:
    """What judged the recordings."""

    trained: TrainedModel  # the model
    model_name: str  # of its file
    parameters: DetectorParameters  # of the detector
    threshold: Optional[float]  # of the score; None: not calibrated
    evidence: Optional[EvidenceModel]  # of the evidence detector; None: the paper's judged
    not_watched: str = ''  # who is not watched, in words; empty: everybody is, or it is not known


@dataclass(frozen=True)
class Judged:
    """A recording with its verdicts."""

    by: JudgedBy
    recording: RecordingEvents
    verdicts: Verdicts

    def seconds(self, stamp: int) -> float:
        """Return a stamp [ns] in seconds from the recording's first message."""
        return (stamp - self.recording.origin) / SECOND_NS

    def edges_of(self, *kinds: int) -> np.ndarray:
        """Return the recording's first stamp, those of events of some types, and its end [ns]."""
        if kinds not in self._edges:
            recording = self.recording
            stamps = recording.stamps[np.isin(recording.ids, kinds)]
            self._edges[kinds] = np.concatenate(([recording.origin], stamps, [recording.end]))
        return self._edges[kinds]

    @cached_property
    def _edges(self) -> Dict[Tuple[int, ...], np.ndarray]:
        return {}

    def lanes(self, starts: np.ndarray) -> Optional[EvidenceLanes]:
        """Return the evidence of each component in stretches that start at these stamps [ns].

        None: the detector has no evidence of single components, or no limits.
        """
        if self.by.evidence is None or self.by.threshold is None:
            return None
        return evidence_lanes(self.by.trained, self.by.evidence, self.by.parameters,
                              self.recording, starts.tolist())
