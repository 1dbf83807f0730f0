"""The two sides of a comparison: models, or a model and a recording that is counted like one."""
from __future__ import annotations

import copy
from dataclasses import dataclass
from functools import cached_property
from typing import Dict, List, Optional, Set, Tuple

from self_awareness import (EventType, EvidenceCounts, EvidenceModel, TrainedModel, Training,
                            recordings, recordings_in_event_log)
from self_awareness.recordings import BagPart
from self_awareness.stamps import SECOND_NS

Kind = Tuple[str, str, str]
"""Source, scope and type of an event type."""


@dataclass(frozen=True)
class Side:
    """One side: what was counted, in two halves.

    Args:
        name: of its file.
        model: with all counts of the evidence detector.
        is_recording: it is one, and not a model.
    """

    name: str
    model: TrainedModel
    is_recording: bool

    @cached_property
    def halves(self) -> Tuple[EvidenceCounts, EvidenceCounts]:
        """Return the counts of the two halves."""
        return EvidenceCounts(self.model, 0), EvidenceCounts(self.model, 1)

    @cached_property
    def all(self) -> EvidenceCounts:
        """Return the counts of both halves."""
        return EvidenceCounts(self.model)

    @cached_property
    def ids(self) -> Dict[Kind, int]:
        """Return the event types that came, and their ids."""
        return {key_of(kind): index for index, kind in enumerate(self.model.event_types)
                if self.all.events(index) > 0}

    @property
    def duration(self) -> float:
        """Time between the first and the last event of the recordings [s]."""
        return self.all.duration / SECOND_NS

    @cached_property
    def relations(self) -> Optional[Set[Tuple[Kind, Kind]]]:
        """Return pairs of event types that have to do with each other; None: it is not known.

        Which ones follows from the starts that show them, so only calibrated models say it.
        """
        calibration = self.model.calibration
        if self.is_recording or calibration is None:
            return None
        kinds = [key_of(kind) for kind in self.model.event_types]
        return {(kinds[track.from_id], kinds[track.to_id])
                for track, relation in zip(EvidenceModel(self.model).tracks, calibration.relations)
                if track.from_id != track.to_id and relation.watched}


def key_of(kind: EventType) -> Kind:
    """Return an event type as a key of both sides."""
    return kind.source, kind.scope, kind.type


def read_sides(before: str, after: str) -> Tuple[Side, Side]:
    """Return the two sides; a recording is counted with the encoding of the model.

    Raises:
        BagError, ModelFileError: a file cannot be read.
        ValueError: none is a model, or they do not count the same things.
    """
    models = [_model_of(before), _model_of(after)]
    if models == [None, None]:
        raise ValueError(f'{before} and {after}: one of them must be a model (rosrun '
                         'self_awareness train): it says how messages become events')
    like = next(model for model in models if model is not None)
    sides: List[Side] = []
    for name, model in zip((before, after), models):
        sides.append(_recording_side(name, like) if model is None else Side(name, model, False))
    _check(*sides)
    return sides[0], sides[1]


def _model_of(name: str) -> Optional[TrainedModel]:
    """Return the model of a file; None: it is a recording, or a part of one."""
    part = BagPart.parse(name)
    if (part.start is not None or part.recording is not None
            or recordings_in_event_log(part.path) is not None
            or recordings.is_bag(name)):
        return None
    model = TrainedModel.load(name)
    try:
        model.require('evidence')
    except ValueError as error:
        raise ValueError(f'{name}: {error}') from error
    return model


def _recording_side(name: str, like: TrainedModel) -> Side:
    parts = recordings.expand([BagPart.parse(name)])
    if len(parts) > 1:
        raise ValueError(f'{name}: the event log holds {len(parts)} recordings; name one: '
                         f'{parts[0]}')
    recording = recordings.read(like, parts[0])
    training = Training(copy.copy(like.encoding), like.bin_size, like.window, like.horizon_bins,
                        True, False, like.tuning)
    training.add_events(recording.event_types, recording.stamps, recording.ids,
                        recording.recording, clock_steps=recording.clock_steps)
    return Side(name, training.model(watch=False), True)


def _check(before: Side, after: Side) -> None:
    for name in ('source', 'include_topics', 'exclude_topics', 'include_sources',
                 'exclude_sources', 'type_fields'):
        if getattr(before.model.encoding, name) != getattr(after.model.encoding, name):
            raise ValueError(f'{before.name} and {after.name}: they were trained with another '
                             f'encoding each ({name}, info shows it): their event types are not '
                             'the same things')
