"""Other systems on the recording of a live session, judged afterwards."""
from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Dict, List, Optional

from self_awareness import TrainedModel, recordings
from self_awareness.parts import BagPart
from self_awareness_evaluation import catalogue
from self_awareness_evaluation.live.samples import Sample, measure_alarms
from self_awareness_evaluation.live.session import Session
from self_awareness_evaluation.systems import watched_by
from self_awareness_evaluation.windowed_events import WindowedEvents

SYSTEMS = ('paper', 'frequency_learned')
"""They learn from the session's training, and their thresholds come from its calibration."""


@dataclass(frozen=True)
class Found:
    """What is found out afterwards.

    Args:
        samples: of all SYSTEMS.
        watched: how many components the monitor's model and each of the SYSTEMS watches; None: it
            judges all together.
        components: whom the calibration's recording holds.
    """

    samples: List[Sample]
    watched: Dict[str, Optional[int]]
    components: int


def judge(session: Session, live: str) -> Found:
    """Judge a session by all SYSTEMS.

    Args:
        session: with its recordings.
        live: what the monitor's detector is called.

    Raises:
        BagError: a recording cannot be read.
    """
    model = TrainedModel.load(str(session.model))
    training = [_read(model, path) for path in session.training]
    calibration = [_read(model, session.calibration)]
    recording = _read(model, session.recording)
    components = {event_type.source for event_type in calibration[0].event_types}
    samples: List[Sample] = []
    watched: Dict[str, Optional[int]] = {live: sum(
        each.is_watched and each.component in components for each in model.coverage())}
    for name in SYSTEMS:
        system = catalogue.make(name)
        system.train(training)
        system.calibrate(calibration)
        watched[name] = watched_by(system, components)
        alarms = system.judge(recording).alarms
        samples += [measure_alarms(name, stretch, alarms) for stretch in session.stretches]
    return Found(samples, watched, len(components))


def _read(model: TrainedModel, path: Path) -> WindowedEvents:
    events = recordings.read(model, BagPart(str(path)))
    return WindowedEvents(events.event_types, events.stamps, events.ids, events.end + 1,
                          attributes=events.attributes, waiting=events.waiting)
