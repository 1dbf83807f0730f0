"""What the peers share that see a window as its counts of events by type, and nothing else."""
from __future__ import annotations

from typing import List, Optional, Sequence

import numpy as np

from self_awareness import EventType
from self_awareness_evaluation.windowed_events import WindowedEvents, counts, vocabulary


class CountScorer:
    """A scorer of the counts of a window's events by type; the last count: types not trained on.

    It cannot tell whom to blame.
    """

    def __init__(self) -> None:
        self._types: List[EventType] = []

    def train(self, recordings: Sequence[WindowedEvents]) -> None:
        """Learn the counts of normal operation."""
        self._types = vocabulary(recordings)
        self._fit([counts(recording, self._types) for recording in recordings])

    def scores(self, recording: WindowedEvents) -> np.ndarray:
        """Return the scores of the windows."""
        return self._score(counts(recording, self._types))

    def suspects(self, recording: WindowedEvents, window: int) -> Optional[List[str]]:
        """Return None: counts cannot tell whom to blame."""
        return None

    def _fit(self, tables: Sequence[np.ndarray]) -> None:
        """Learn the counts of recordings, each [window, type]."""
        raise NotImplementedError

    def _score(self, table: np.ndarray) -> np.ndarray:
        """Return the scores of the windows of a recording, [window, type]."""
        raise NotImplementedError
