"""What the peers share that watch every topic or event type against bounds of its own."""
from __future__ import annotations

from typing import List, Optional, Tuple

import numpy as np

from self_awareness_evaluation.windowed_events import WindowedEvents


class DeviationScorer:
    """A scorer of the largest deviation from bounds, negated; blames whose is the largest."""

    def __init__(self) -> None:
        self._last: Optional[Tuple[WindowedEvents, np.ndarray]] = None

    def scores(self, recording: WindowedEvents) -> np.ndarray:
        """Return the scores of the windows."""
        deviations = self._known_deviations(recording)
        return -deviations.max(axis=0) if len(deviations) else np.zeros(len(recording.starts()))

    def suspects(self, recording: WindowedEvents, window: int) -> List[str]:
        """Return the sources of what is beyond its bounds, the furthest first."""
        deviations = self._known_deviations(recording)[:, window]
        return list(dict.fromkeys(source for row in np.argsort(-deviations, kind='stable')
                                  if deviations[row] > 0 for source in self._blamed(int(row))))

    def _known_deviations(self, recording: WindowedEvents) -> np.ndarray:
        # Every alarm of a recording asks for them again.
        if self._last is None or self._last[0] is not recording:
            self._last = recording, self._deviations(recording)
        return self._last[1]

    def _deviations(self, recording: WindowedEvents) -> np.ndarray:
        """Return the deviations, [row, window]; 0 within the bounds."""
        raise NotImplementedError

    def _blamed(self, row: int) -> List[str]:
        """Return the sources to blame for a row."""
        raise NotImplementedError
