"""How the bags of a training are counted."""
from __future__ import annotations

import copy
from dataclasses import dataclass, field
from typing import Optional, Tuple

from self_awareness import (DEFAULT_WINDOW, EncodingRules, Learner, TrainedModel, Tuning,
                            summarise_bag)
from self_awareness.judging import EVIDENCE, PAPER
from self_awareness.parts import BagPart


@dataclass(frozen=True)
class Counting:
    """How bags are counted."""

    # How messages become events; None: by the defaults, and without sources where no bag names
    # any.
    encoding: Optional[EncodingRules] = None
    bin_size: int = 10_000_000  # of delays [ns]
    window: int = DEFAULT_WINDOW  # length of a window [ns]
    horizon_bins: int = 0  # delays of so many bins or more share one; 0: unbounded
    # Who is counted for: evidence, paper or both. The paper's counts take three quarters of the
    # time, and most of the file.
    detector: str = EVIDENCE
    tuning: Tuning = field(default_factory=Tuning)  # the numbers of the evidence detector
    rename: Tuple[Tuple[str, str], ...] = ()  # rules, after those of the encoding

    def renamed(self, encoding: EncodingRules) -> EncodingRules:
        """Return a copy of an encoding that renames what is to be renamed, too."""
        renamed = copy.copy(encoding)
        renamed.rename = [*encoding.rename, *self.rename]
        # As the renames leave it: where there are some already, it is renamed.
        if encoding.mode is not None and self.rename and not encoding.rename:
            topic, name = encoding.mode
            renamed.mode = (renamed.scopes_of({topic})[topic], name)
        return renamed

    @classmethod
    def of(cls, model: TrainedModel) -> Counting:
        """Return how the bags of a model were counted."""
        return cls(copy.copy(model.encoding), model.bin_size, model.window, model.horizon_bins,
                   model.detectors, model.tuning)

    def learner(self, encoding: EncodingRules) -> Learner:
        """Return who counts by an encoding, which these rules have become for a recording."""
        return Learner(self.tuning, set(), self.window, encoding, self.bin_size,
                       self.horizon_bins, self.detector != PAPER, self.detector != EVIDENCE)

    def encoding_of(self, part: BagPart) -> EncodingRules:
        """Return the rules for a recording: those of its event log where none are given.

        Raises:
            BagError: it cannot be read.
        """
        encoding = self.encoding or EncodingRules.defaults()
        if self.encoding is None and part.recording is not None:
            encoding = summarise_bag(part.files, part.recording).encoding or encoding
        return self.renamed(encoding)
