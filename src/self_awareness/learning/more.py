"""Trains and calibrates a model again, with what was heard since."""
from __future__ import annotations

import math
import os
import shutil
from dataclasses import replace
from typing import List, Sequence

from self_awareness import Recording, TrainedModel, accepted_file
from self_awareness.learning.age import LEARNED, Age, Heard
from self_awareness.learning.logs import Division, Log, divide
from self_awareness.output_files import replacing
from self_awareness.parts import BagPart
from self_awareness.recordings import overlap
from self_awareness.stamps import SECOND_NS


def divided(trained: TrainedModel, age: Age, start_up: float) -> Division:
    """Return what of the recordings is trained on, and what the limits are found on.

    Each new recording is cut, as by learn.launch. What the model was calibrated on already is
    calibrated on again, as far as it is named: training drops what it has shown. Of each start of
    the robot, the start-up [s] is left out.
    """
    new = [Log(each.part, (each.recording.end - each.origin) / SECOND_NS,
               each.recording.robot_start or each.origin)
           for each in age.counted]
    division = divide(new, start_up)
    known = [] if trained.calibration is None else trained.calibration.recordings
    again = [part for each in age.heard if each.left_out == LEARNED
             for part in _calibrated_on(each, trained.recordings, known)]
    return Division(division.training, again + division.calibration)


def _calibrated_on(heard: Heard, trained: Sequence[Recording],
                   calibrated: Sequence[Recording]) -> List[BagPart]:
    """Return the parts of a recording that were calibrated on, and not trained on since."""
    parts = []
    for each in calibrated:
        if each.fingerprint != heard.recording.fingerprint or any(
                overlap(each, other) for other in trained):
            continue
        # Whole seconds, as they are printed.
        begin = math.ceil((each.start - heard.origin) / SECOND_NS)
        end = math.floor((each.end - heard.origin) / SECOND_NS)
        parts.append(replace(heard.part, start=float(begin), end=float(end)))
    return parts


def take(new: str, model: str) -> str:
    """Let a new model take the place of another one, which stays under another name.

    What was accepted meanwhile stays accepted, unless the new one has learned it.

    Returns:
        that name.

    Raises:
        ModelFileError: the new one is damaged, or no model.
        ValueError: it has no limits.
        OSError: a file cannot be written; the old model is in its place.
    """
    taken = TrainedModel.load(new)
    if taken.calibration is None:
        raise ValueError(f'{new}: it has no limits, so no monitor would raise an alarm by it; '
                         'find them with rosrun self_awareness calibrate')
    _, left = accepted_file.learned(accepted_file.beside(model), taken)
    before, number = f'{model}.before', 1
    while os.path.exists(before):
        number += 1
        before = f'{model}.before_{number}'
    with replacing(before) as temporary:
        shutil.copyfile(model, temporary)
    accepted_file.keep(accepted_file.beside(model), before)
    with replacing(model) as temporary:
        shutil.copyfile(new, temporary)
    accepted_file.keep(left, model)
    for path in (new, accepted_file.path_of(new)):
        if os.path.exists(path):
            os.remove(path)
    return before
