"""Other systems on the recording of a live session, judged afterwards."""
from __future__ import annotations

from pathlib import Path
from typing import List

from self_awareness import TrainedModel, recordings
from self_awareness.recordings import BagPart
from self_awareness_evaluation import catalogue
from self_awareness_evaluation.live.samples import Sample, measure_alarms
from self_awareness_evaluation.live.session import Session
from self_awareness_evaluation.windowed_events import WindowedEvents

SYSTEMS = ('paper', 'frequency_learned')
"""They learn from the session's training, and their thresholds come from its calibration."""


def judge(session: Session) -> List[Sample]:
    """Return the samples of all SYSTEMS on a session.

    Raises:
        BagError: a recording cannot be read.
    """
    model = TrainedModel.load(str(session.model))
    training = [_read(model, path) for path in session.training]
    calibration = [_read(model, session.calibration)]
    recording = _read(model, session.recording)
    samples: List[Sample] = []
    for name in SYSTEMS:
        system = catalogue.make(name)
        system.train(training)
        system.calibrate(calibration)
        alarms = system.judge(recording).alarms
        samples += [measure_alarms(name, stretch, alarms) for stretch in session.stretches]
    return samples


def _read(model: TrainedModel, path: Path) -> WindowedEvents:
    events = recordings.read(model, BagPart(str(path)))
    return WindowedEvents(events.event_types, events.stamps, events.ids, events.end + 1,
                          attributes=events.attributes, waiting=events.waiting)
