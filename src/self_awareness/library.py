"""The package as a library: learn a model from bags, and judge others by it (docs/library.md)."""
from __future__ import annotations

import json
import os
from contextlib import closing
from typing import Any, Dict, Iterable, List, Optional, Tuple, Union

from self_awareness import (Alarm, Coverage, DetectorParameters, EncodingRules, EvidenceModel,
                            TrainedModel, Verdicts, alarms, recordings)
from self_awareness.calibration import limits
from self_awareness.calibration.runs import check_unseen
from self_awareness.judging import evidence_judge
from self_awareness.parts import BagPart, expand
from self_awareness.recordings import RecordingEvents
from self_awareness.training import many_bags
from self_awareness.training.many_bags import Counting
from self_awareness.workers import on_this_machine

Bag = Union[str, 'os.PathLike[str]']
"""The name of a bag or an event log, or `BAG@START-END`: a part, in s from its first message."""


class Alarms(List[Alarm]):
    """Alarms and suspicions of a recording, in the order of their begin.

    >>> alarms = load('robot.model').judge('crash.bag')
    >>> [(alarm.level, alarm.kind, alarm.culprit) for alarm in alarms if alarm.level == 'ERROR']
    [('ERROR', 'silent', '/laser')]
    >>> alarms[-1].suspects[0].reason.words[:10]
    'silent for'

    Args:
        recording: the events.
        verdicts: on its windows, as arrays.
    """

    def __init__(self, recording: RecordingEvents, verdicts: Verdicts) -> None:
        super().__init__(alarms.in_order(verdicts))
        self.recording = recording
        self.verdicts = verdicts

    def table(self) -> List[Dict[str, Any]]:
        """Return a dictionary for each, of strings and numbers; what is not known is None.

        >>> row = load('robot.model').judge('crash.bag').table()[-1]
        >>> row['level'], row['kind'], row['culprit'], 12.0 < row['begin_s'] < 13.0
        ('ERROR', 'silent', '/laser', True)
        """
        return [alarms.as_values(alarm, self.recording.event_types, self.recording.origin)
                for alarm in self]

    def to_json(self) -> str:
        """Return the table as JSON, as `score --json` writes it."""
        return json.dumps(self.table(), indent=2, allow_nan=False)


class Model:
    """What was learned of a robot; made by learn() or load().

    Args:
        trained: all that its file holds.
    """

    def __init__(self, trained: TrainedModel) -> None:
        trained.require('evidence')
        self.trained = trained
        self._computed: Optional[EvidenceModel] = None

    def save(self, path: Bag) -> None:
        """Write a file for the monitor and the programs; whole or not at all.

        Raises:
            ModelFileError: it cannot be written, or the model was loaded to judge only.
        """
        self.trained.save(os.fspath(path))

    def calibrate(self, bags: Iterable[Bag], budget: float = limits.BUDGET) -> None:
        """Find the limits by recordings of normal operation that it was not trained on.

        Args:
            bags: hours of several starts of the robot, if possible.
            budget: false alarms an hour that the limits allow.

        Raises:
            BagError: a recording cannot be read.
            ValueError: the recordings are too short, or were trained on.
        """
        read = [recordings.read(self.trained, part) for part in _parts(bags)]
        check_unseen(self.trained, read)
        self.trained.calibration, = limits.held_out(self.trained, read,
                                                    DetectorParameters().settle_time, [budget])

    def judge(self, bag: Bag, parameters: Optional[DetectorParameters] = None) -> Alarms:
        """Find out when a recording was abnormal, and who is to blame.

        Args:
            bag: one recording.
            parameters: of the detector; None: as the monitor has them by default.

        Raises:
            BagError: it cannot be read.
            ValueError: the model has no limits; or the file holds several recordings.
        """
        if self.trained.calibration is None:
            raise ValueError('the model has no limits: calibrate it')
        parts = _parts([bag])
        if len(parts) > 1:
            raise ValueError(f'{bag}: holds {len(parts)} recordings; name one of them: '
                             f'{parts[0]}')
        if self._computed is None:
            self._computed = EvidenceModel(self.trained)
        recording = recordings.read(self.trained, parts[0])
        judge = evidence_judge(self.trained, parameters or DetectorParameters(), self._computed)
        return Alarms(recording, judge(recording))

    def coverage(self) -> List[Coverage]:
        """Return how soon the death of each component is found, and whether late answers are.

        >>> [each.component for each in load('robot.model').coverage() if each.is_watched]
        ['/laser', '/battery', '/slam']
        """
        return self.trained.coverage()


def learn(bags: Iterable[Bag], encoding: Optional[EncodingRules] = None,
          graph: Iterable[Tuple[str, str, str]] = (), jobs: int = 1) -> Model:
    """Learn a model from recordings of normal operation.

    It has limits by what one half of the recordings says of the other, if these are long enough;
    calibrate() finds better ones, on recordings that it was not trained on.

    >>> model = learn(['monday.bag', 'tuesday.bag'])
    >>> model.save('robot.model')

    Args:
        bags: of several starts of the robot, if possible.
        encoding: how messages become events; None: by the defaults.
        graph: who listens to whom, as (publisher, topic, subscriber), if the bags do not say.
        jobs: processes that read bags at a time.

    Raises:
        BagError: a bag cannot be read.
        ValueError: a bag cannot be used, or is named twice.
    """
    parts = _parts(bags)
    if not parts:
        raise ValueError('no bag is named')
    with closing(on_this_machine(min(jobs, len(parts)))) as workers:
        trained = many_bags.train(parts, Counting(encoding), workers)
        trained.model.graph = trained.model.graph | set(graph)
        try:
            many_bags.preliminary_limits(trained, workers)
        except limits.TooLittleError:
            pass  # calibrate() may find them, and judge() says that there are none
    return Model(trained.model)


def load(path: Bag) -> Model:
    """Read a model file.

    Raises:
        ModelFileError: it is missing, no model, too new, or damaged.
        ValueError: it was not trained for the evidence detector.
    """
    return Model(TrainedModel.load(os.fspath(path)))


def _parts(bags: Iterable[Bag]) -> List[BagPart]:
    return expand(BagPart.parse(os.fspath(bag)) for bag in bags)
