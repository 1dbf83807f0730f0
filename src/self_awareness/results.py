"""Result bags: what the monitor would have published while recordings were made."""
from __future__ import annotations

from contextlib import contextmanager
from typing import Callable, Iterator, Optional, Sequence

from self_awareness import (BagError, Coverage, ReplayedMonitor, ResultBag, TrainedModel,
                            summarise_bag)
from self_awareness.output_files import replacing
from self_awareness.parts import BagPart
from self_awareness.recordings import RecordingEvents

Replay = Callable[[RecordingEvents], Optional[ReplayedMonitor]]
"""Returns what the judge of a recording must tell; None: nobody wants to know."""


def check_apart(path: Optional[str], parts: Sequence[BagPart]) -> None:
    """Check before long work that a result bag can hold the results of all recordings.

    Args:
        path: of the result bag; None: there will be none.
        parts: whose results it will hold.

    Raises:
        ValueError: two parts overlap in time.
    """
    if path is None or len(parts) == 1:
        return
    spans = []
    for part in parts:
        try:
            summary = summarise_bag(part.files, part.recording)
        except BagError:
            continue  # who reads it says what is wrong
        spans.append((part.span(summary.start, summary.end), str(part)))
    spans.sort()
    for (before, first), (after, second) in zip(spans, spans[1:]):
        if after[0] < before[1]:
            raise ValueError(f'{path}: {first} and {second} overlap in time, so that their '
                             'results would be mixed up; write a result bag for each')


@contextmanager
def result_bag(path: Optional[str], model_path: str, trained: TrainedModel,
               calibrated: bool, coverage: Sequence[Coverage] = ()) -> Iterator[Replay]:
    """Write a result bag, which replaces `path` at the end of the block, or nothing.

    Args:
        path: of the result bag; None: write none.
        model_path: what the diagnostics call the model.
        calibrated: there are limits, or a threshold, for the detector that judges.
        coverage: how soon it finds faults of the components; none: not known.

    Raises:
        BagError: it cannot be written.
    """
    if path is None:
        yield lambda recording: None
        return
    with replacing(path) as temporary:
        bag = ResultBag(temporary, path)

        def replay(recording: RecordingEvents) -> ReplayedMonitor:
            return ReplayedMonitor(bag, model_path, trained, calibrated, recording.event_types,
                                   recording.recording.start, list(coverage))

        yield replay
        bag.close()
