"""Other systems on the recording of a session, judged afterwards."""
from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import List, Sequence

from self_awareness import DEFAULT_WINDOW, TrainedModel
from self_awareness import recordings as bags
from self_awareness.parts import BagPart
from self_awareness.stamps import SECOND_NS
from self_awareness_evaluation import catalogue
from self_awareness_evaluation.live.measures import ERROR, Status, measure
from self_awareness_evaluation.live.recordings import (CALIBRATION, MODEL, SESSION, TRAINING,
                                                       recordings)
from self_awareness_evaluation.live.rows import Row
from self_awareness_evaluation.systems import Judged, watched_by
from self_awareness_evaluation.windowed_events import WindowedEvents

SYSTEMS = ('paper', 'frequency_learned')
"""They learn from the session's training, and their thresholds come from its calibration."""


def judge(stretches: Sequence[Row], folder: Path) -> List[Row]:
    """Judge a session by all SYSTEMS; return a row for each of its stretches.

    Args:
        stretches: not yet measured.
        folder: with its recordings and its model.

    Raises:
        BagError: a recording cannot be read.
    """
    model = TrainedModel.load(str(folder / MODEL))
    training, normal, (events,) = ([_read(model, path) for path in recordings(folder, name)]
                                   for name in (TRAINING, CALIBRATION, SESSION))
    components = {each.component for each in model.coverage()}
    rows: List[Row] = []
    for name in SYSTEMS:
        system = catalogue.make(name)
        system.train(training)
        system.calibrate(normal)
        said = statuses(system.judge(events))
        for stretch in stretches:
            row = measure(replace(stretch, system=name, expected=None), said)
            rows.append(replace(row, watched=watched_by(system, components))
                        if row.is_normal else row)
    return rows


def statuses(judged: Judged) -> List[Status]:
    """Return what a system says of a recording as the monitor would say it."""
    raised = {alarm.start: alarm for alarm in judged.alarms}
    found = []
    for start, stands, settles in zip(judged.start, judged.standing, judged.settling):
        end = int(start) + DEFAULT_WINDOW
        suspects = raised[end].suspects if end in raised else ()
        found.append(Status(end / SECOND_NS, ERROR if stands else 0, bool(settles),
                            suspects=None if suspects is None else tuple(suspects)))
    return found


def _read(model: TrainedModel, path: Path) -> WindowedEvents:
    events = bags.read(model, BagPart(str(path)))
    return WindowedEvents(events.event_types, events.stamps, events.ids, events.end + 1,
                          attributes=events.attributes, waiting=events.waiting)
