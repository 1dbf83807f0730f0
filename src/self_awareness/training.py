"""Trains one model on many bags, in whatever processes.

Every bag is counted for itself, and the counts are added in the order in which the bags are named:
so the model is the same whoever counted.
"""
from __future__ import annotations

import copy
import os
from contextlib import closing
from dataclasses import dataclass
from typing import Callable, Dict, List, Optional, Sequence, Tuple, Union

from self_awareness import (PREDECESSORS, BagError, DetectorParameters, EncodingRules, Recording,
                            TrainedModel, Training, evidence_limits, progress, read_events)
from self_awareness.evidence_limits import TrainedOn
from self_awareness.recordings import BagPart, RecordingEvents, overlap
from self_awareness.stamps import SECOND_NS
from self_awareness.workers import InProcess, Workers

_MOST_EVENTS_OF_BAG = 5_000_000
_MOST_EVENTS = 20_000_000
"""So many events, of 12 bytes each, are kept for the limits; other bags are read once more."""


@dataclass(frozen=True)
class Counting:
    """How bags are counted.

    Args:
        encoding: how messages become events; None: by the defaults, and without sources where no
            bag names any.
        bin_size: of delays [ns].
        window: length of a window [ns].
        horizon_bins: delays of so many bins or more share one; 0: unbounded.
        predecessors: of an event type that are watched at most.
    """

    encoding: Optional[EncodingRules] = None
    bin_size: int = 10_000_000
    window: int = 100_000_000
    horizon_bins: int = 0
    predecessors: int = PREDECESSORS

    @classmethod
    def of(cls, model: TrainedModel) -> Counting:
        """Return how the bags of a model were counted."""
        return cls(copy.copy(model.encoding), model.bin_size, model.window, model.horizon_bins,
                   model.predecessors)


@dataclass
class Trained:
    """What came out of a training.

    Args:
        model: of all good bags.
        trained_on: those.
        bad: what is wrong with the others.
    """

    model: TrainedModel
    trained_on: List[TrainedOn]
    bad: List[str]


def train(parts: Sequence[BagPart], counting: Counting, workers: Optional[Workers] = None,
          base: Optional[TrainedModel] = None, skip_bad: bool = False,
          tell: Callable[[str], None] = lambda _: None) -> Trained:
    """Train on recordings.

    Args:
        parts: bags, or parts of them.
        counting: how they are counted.
        workers: who counts; None: this process.
        base: a model that what is counted is added to, and that is changed; counted the same way.
        skip_bad: go on without bags that cannot be used.
        tell: called with a line about each bag that is done.

    Raises:
        ValueError: a bag cannot be used, and is not to be skipped, or none can; a recording is
            named twice, or is in the base already; some bags name senders, and some do not.
    """
    workers = workers or InProcess()
    alone = base is None and len(parts) == 1
    total = _Total(base)
    tasks = [_Task(part, alone, workers.near) for part in parts]
    with closing(workers.map(_count, counting, tasks, 'bags')) as results:
        for part, counted in zip(parts, results):
            if isinstance(counted, _Counted):
                tell(total.add(part, counted, alone))
            elif skip_bad:
                total.bad.append(counted.error)
                tell(f'skipped: {counted.error}')
            else:
                raise ValueError(counted.error)
    if total.model is None or not total.trained_on:
        raise ValueError(f'no bag can be trained on: {total.bad[-1]}')
    if base is None and len(total.trained_on) == 1 and not alone:
        # Without the bad ones it is alone, and both halves come from it.
        again = train([total.trained_on[0].part], counting, workers)
        return Trained(again.model, again.trained_on, total.bad)
    total.model.watch()
    return Trained(total.model, total.trained_on, total.bad)


def preliminary_limits(trained: Trained, workers: Optional[Workers] = None) -> None:
    """Give a model limits by what one half of the training says of the other.

    Raises:
        BagError: a recording cannot be read any more.
        TooLittleError: the recordings are too short.
    """
    trained.model.evidence_calibration = evidence_limits.cross_fit(
        trained.model, trained.trained_on, DetectorParameters().settle_time,
        evidence_limits.BUDGET, workers)


class DistinctRecordings:
    """Recordings that are not the same, even in part."""

    def __init__(self) -> None:
        self._known: Dict[int, List[Tuple[str, Recording]]] = {}

    def add(self, name: str, recording: Recording) -> Optional[str]:
        """Add a recording, or return the name of one that is the same, at least in part."""
        same = self._known.setdefault(recording.fingerprint, [])
        for other_name, other in same:
            if overlap(other, recording):
                return other_name
        same.append((name, recording))
        return None


@dataclass(frozen=True)
class _Task:
    part: BagPart
    alone: bool
    keep_events: bool

    def __str__(self) -> str:
        return self.part.path


@dataclass(frozen=True)
class _Counted:
    """The model of one bag; all counts in its first half, but for a bag that is alone."""

    model: TrainedModel
    events: Optional[RecordingEvents]


@dataclass(frozen=True)
class _Bad:
    error: str


class _Total:
    """The sum of what was counted."""

    def __init__(self, base: Optional[TrainedModel]) -> None:
        self.model = base
        self.trained_on: List[TrainedOn] = []
        self.bad: List[str] = []
        self._events = 0
        self._known = DistinctRecordings()
        for recording in [] if base is None else base.recordings:
            self._known.add(f'{recording.bag}, which the model was trained on', recording)

    def add(self, part: BagPart, counted: _Counted, alone: bool) -> str:
        """Add what was counted in the next bag, or the only one; return a line about it."""
        recording, = counted.model.recordings
        same = self._known.add(part.path, recording)
        if same is not None:
            raise ValueError(f'{part.path}: the same recording as {same}; name it once')
        number = 0 if self.model is None else len(self.model.recordings)
        half = number % 2  # in turn; what holds in one of them only is not taken for information
        if half == 1:
            counted.model.swap_halves()
        if self.model is None:
            self.model = counted.model
        else:
            self._check_sources(part, counted.model)
            try:
                self.model.merge(counted.model)
            except ValueError as error:
                raise ValueError(f'{part.path}: {error}') from error
        self._events += recording.events
        kept = counted.events if self._events <= _MOST_EVENTS else None
        self.trained_on.append(TrainedOn(part, None if alone else half, kept))
        seconds = (recording.end - recording.start) / SECOND_NS
        return f'{part.path}: {seconds:.1f} s, {recording.events} events'

    def _check_sources(self, part: BagPart, added: TrainedModel) -> None:
        if self.model.encoding.source == added.encoding.source:
            return
        nameless = part if added.encoding.source == 'none' else self.trained_on[0].part
        raise ValueError(f'{nameless.path}: {_NAMELESS}')


_NAMELESS = ('no connection of this bag names its sender, and sources are to be told apart; leave '
             'the bag out, or use "source: none" for all (--encoding)')


def _count(counting: Counting, task: _Task) -> Union[_Counted, _Bad]:
    part = task.part
    try:
        events, encoding = _read(counting, part)
        recording = Recording()
        recording.bag = os.path.basename(part.path)
        recording.start = int(events.stamps[0])
        recording.end = int(events.stamps[-1])
        recording.events = len(events.stamps)
        recording.fingerprint = events.fingerprint
        training = Training(encoding, counting.bin_size, counting.window, counting.horizon_bins,
                            counting.predecessors)
        training.add_events(events.event_types, events.stamps, events.ids,
                            events.middle if task.alone else None, recording)
    except BagError as error:
        return _Bad(str(error))
    except ValueError as error:
        return _Bad(f'{part.path}: {error}')
    keep = task.keep_events and recording.events <= _MOST_EVENTS_OF_BAG
    return _Counted(training.model(watch=False), events if keep else None)


def _read(counting: Counting, part: BagPart) -> Tuple[RecordingEvents, EncodingRules]:
    encoding = counting.encoding or EncodingRules.defaults()
    with progress.messages(os.path.basename(part.path)) as update:
        read = read_events(part.path, encoding, [], part.start, part.end, update)
    if encoding.source == 'callerid' and not read.summary.has_sources:
        if counting.encoding is not None:
            raise ValueError(_NAMELESS)
        encoding.source = 'none'  # what was read is the same
    _, end = part.limits(read.summary.start, read.summary.end)
    events = RecordingEvents(part, read.event_types, read.stamps, read.ids, read.summary.start,
                             end, read.summary.fingerprint)
    if len(events.stamps) == 0:
        raise ValueError('no message is an event by the encoding; a recording of "rosbag play" '
                         'needs "source: none" (--encoding), and a part that is too short another '
                         '--start or --end')
    if len(events.stamps) == 1:
        raise ValueError('one event only, there is no delay to learn; leave it out or record for '
                         'longer')
    return events, encoding
