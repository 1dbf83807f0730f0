"""The two sides of a comparison: models, or a model and a recording that is counted like one."""
from __future__ import annotations

import os
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Dict, Iterator, List, Optional, Set, Tuple

import numpy as np

from self_awareness import (EventType, EvidenceModel, TrainedModel, recordings,
                            recordings_in_event_log)
from self_awareness.judging import EVIDENCE, load_model
from self_awareness.parts import BagPart, Named, look
from self_awareness.recordings import RecordingEvents
from self_awareness.stamps import SECOND_NS
from self_awareness.training.counting import Counting

Kind = Tuple[str, str, str]  # source, scope and type of an event type


@dataclass(frozen=True)
class End:
    """How an event type ended in a recording."""

    last: float  # its last event [s] from the recording's first message
    silent: float  # time from then to the recording's end [s]


@dataclass(frozen=True)
class Side:
    """One side: what was counted, in two halves."""

    name: str  # of its file
    model: TrainedModel  # with all counts of the evidence detector
    is_recording: bool  # it is one or several, and not a model
    # Of each event type of recordings, its last event and how long it was silent then.
    ends: Dict[Kind, End] = field(default_factory=dict)

    @cached_property
    def halves(self) -> Tuple[EvidenceModel, EvidenceModel]:
        """Return the counts of the two halves."""
        return EvidenceModel.of_all_pairs(self.model, 0), EvidenceModel.of_all_pairs(self.model, 1)

    @cached_property
    def all(self) -> EvidenceModel:
        """Return the counts of both halves."""
        return EvidenceModel.of_all_pairs(self.model)

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


def read_sides(before: str, after: str, skip_bad: bool) -> Tuple[Side, Side, List[str]]:
    """Return the two sides; recordings are counted with the encoding of the model.

    Args:
        before, after: names of models, or of recordings.
        skip_bad: leave out recordings that cannot be used.

    Returns:
        also a line for each that was left out.

    Raises:
        BadRecordingsError: a recording cannot be used, and is not to be left out, or none can.
        ModelFileError: a model cannot be read.
        ValueError: none is a model, or they do not count the same things.
    """
    models = [_model_of(before), _model_of(after)]
    if models == [None, None]:
        raise ValueError(f'{before} and {after}: one of them must be a model (rosrun '
                         'self_awareness train): it says how messages become events')
    like = next(model for model in models if model is not None)
    sides: List[Side] = []
    bad: List[str] = []
    for name, model in zip((before, after), models):
        if model is None:
            named = look([BagPart.parse(name)])
            sides.append(_recording_side(name, named, like, skip_bad))
            bad += named.bad
        else:
            sides.append(Side(name, model, False))
    _check(*sides)
    return sides[0], sides[1], bad


def with_recordings(path: str, name: str, parts: List[BagPart]) -> Tuple[Side, Side]:
    """Return a model, and recordings that are called by one name, as the two sides.

    Raises:
        BadRecordingsError: a recording cannot be used.
        ModelFileError: the model cannot be read.
        ValueError: the model was not trained for the evidence detector.
    """
    model = load_model(path, EVIDENCE)
    return Side(path, model, False), _recording_side(name, Named(parts), model)


def _model_of(name: str) -> Optional[TrainedModel]:
    """Return the model of a file; None: it is a recording, or a part of one."""
    part = BagPart.parse(name)
    if (part != BagPart(name) or os.path.isdir(name)
            or recordings_in_event_log(name) is not None or recordings.is_bag(name)):
        return None
    return load_model(name, EVIDENCE)


def _recording_side(name: str, named: Named, like: TrainedModel, skip_bad: bool = False) -> Side:
    """Count recordings; those that turn out to be bad are added to these.

    Raises:
        BadRecordingsError: one cannot be used, and is not to be left out, or none can.
    """
    named.check(skip_bad)
    learner = replace(Counting.of(like), detector=EVIDENCE).learner(like.encoding)
    ends: Dict[Kind, End] = {}
    counted = 0
    for recording in named.each(lambda part: recordings.read(like, part)):
        counted += 1
        learner.count(recording)
        for kind, end in _ends(recording):
            if kind not in ends or end.silent > ends[kind].silent:
                ends[kind] = end
    named.check(skip_bad and counted > 0)
    return Side(name, learner.model(watch=False), True, ends)


def _ends(recording: RecordingEvents) -> Iterator[Tuple[Kind, End]]:
    backwards = recording.ids[::-1]
    for index, place in zip(*np.unique(backwards, return_index=True)):
        last = int(recording.stamps[len(backwards) - 1 - place])
        yield (key_of(recording.event_types[index]),
               End((last - recording.origin) / SECOND_NS, (recording.end - last) / SECOND_NS))


def _check(before: Side, after: Side) -> None:
    for name in ('source', 'include_topics', 'exclude_topics', 'include_sources',
                 'exclude_sources', 'type_fields', 'classes', 'mode'):
        if getattr(before.model.encoding, name) != getattr(after.model.encoding, name):
            raise ValueError(f'{before.name} and {after.name}: they were trained with another '
                             f'encoding each ({name}, info shows it): their event types are not '
                             'the same things')
