"""Trains one model on many bags, in this process, in several, or on a cluster.

Every bag is counted by itself. Counts are added in the order in which the bags are named: first
those of a batch of neighbouring bags, where they were counted, then the sums of the batches. So
the model does not depend on who counts, and little is handed over.
"""
from __future__ import annotations

import copy
import os
from contextlib import closing
from dataclasses import dataclass, field, replace
from typing import Callable, Iterable, List, Optional, Sequence, Tuple

import numpy as np

from self_awareness import (BagError, BagSummary, Calibration, DetectorParameters, EncodingRules,
                            Recording, TrainedModel, lasting_subscriptions, progress, read_events,
                            recordings)
from self_awareness.calibration import heads_and_tails, limits
from self_awareness.calibration.limits import TrainedOn
from self_awareness.judging import PAPER
from self_awareness.parts import BagPart
from self_awareness.recordings import DistinctRecordings, RecordingEvents, check_windows
from self_awareness.stamps import SECOND_NS
from self_awareness.training import numbered_names, value_classes
from self_awareness.training.counting import Counting
from self_awareness.training.robot_graph import RobotGraph
from self_awareness.workers import InProcess, Workers

_MOST_EVENTS_OF_BATCH = 5_000_000
_MOST_EVENTS = 20_000_000
"""At most so many events, of 12 bytes each, are kept for the limits; other bags are read twice."""


@dataclass
class Trained:
    """What came out of a training."""

    model: TrainedModel  # of all good bags
    trained_on: List[TrainedOn]  # the good bags
    bad: List[str]  # what is wrong with the others
    # Names that differ by a number alone, in words.
    numbered: List[str] = field(default_factory=list)


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
    renames, numbered = numbered_names.of_training(counting, parts, workers, base)
    counting = replace(counting, rename=(*counting.rename, *renames))
    if counting.encoding is not None:
        encoding = copy.copy(counting.encoding)
        encoding.classes = value_classes.learned(counting.renamed(encoding), parts, workers,
                                                 skip_bad).classes
        counting = replace(counting, encoding=encoding)
    how = _How(counting, skip_bad, _MOST_EVENTS_OF_BATCH if workers.near else 0)
    number = workers.batches(len(parts))
    cuts = [len(parts) * batch // number for batch in range(number + 1)]
    batches = [_Batch(parts[begin:end]) for begin, end in zip(cuts, cuts[1:])]
    distinct = DistinctRecordings()
    for recording in [] if base is None else base.recordings:
        distinct.add(f'{recording.bag}, which the model was trained on', recording)
    total = _Sum(_MOST_EVENTS, base)
    unit = 'bags' if number == len(parts) else 'batches of bags'
    with closing(workers.map(_count_batch, how, batches, unit)) as counts:
        for counted in counts:
            for line in counted.lines:
                tell(line)
            for trained_on, recording in counted.recordings():
                distinct.add(str(trained_on.part), recording)
            total.add(counted)
            if counted.error is not None:
                raise ValueError(counted.error)
    if total.model is None or not total.trained_on:
        raise ValueError(f'no bag can be trained on: {total.bad[-1]}')
    if counting.detector != PAPER:
        total.model.watch()
    return Trained(total.model, total.trained_on, total.bad, numbered)


def preliminary_limits(trained: Trained, workers: Optional[Workers] = None) -> Calibration:
    """Give a model limits by what one half of the training says of the other; return them.

    Raises:
        BagError: a recording cannot be read any more.
        TooLittleError: the recordings are too short.
    """
    found, = limits.find(trained.model, DetectorParameters().settle_time, [limits.BUDGET],
                         trained.trained_on, workers, keep_findings=True)
    found.recordings = trained.model.recordings[-len(trained.trained_on):]
    trained.model.calibration = found
    return found


@dataclass(frozen=True)
class _How:
    """How batches are counted; at most so many events are kept of each."""

    counting: Counting
    skip_bad: bool  # leave out bags that cannot be used, and go on
    most_events: int


@dataclass(frozen=True)
class _Batch:
    """Neighbouring bags."""

    parts: Sequence[BagPart]

    def __str__(self) -> str:
        first, last = self.parts[0].path, self.parts[-1].path
        return first if len(self.parts) == 1 else f'one of {first} to {last}'


@dataclass
class _Sum:
    """What was counted in neighbouring bags."""

    most_events: int  # that are kept
    # The sum, after what was there before; None: no bag was good.
    model: Optional[TrainedModel] = None
    trained_on: List[TrainedOn] = field(default_factory=list)  # the good bags
    lines: List[str] = field(default_factory=list)  # about each bag that is done
    bad: List[str] = field(default_factory=list)  # what is wrong with those that were skipped
    error: Optional[str] = None  # what is wrong with the bag that ended it; None: nothing
    _kept: int = field(default=0, init=False)

    def recordings(self) -> Iterable[Tuple[TrainedOn, Recording]]:
        """Return the good bags, and what the model says of them; of a sum without a base."""
        return zip(self.trained_on, [] if self.model is None else self.model.recordings)

    def add(self, other: _Sum) -> None:
        """Add the bags that come after these; the other sum is used up.

        Raises:
            ValueError: they do not fit; nothing was added.
        """
        if other.model is not None:
            self._add_counts(other, other.model)
        self.lines += other.lines
        self.bad += other.bad

    def _add_counts(self, other: _Sum, model: TrainedModel) -> None:
        if self.model is None:
            self.model = model
        else:
            self._check_sources(other, self.model, model)
            try:
                self.model.merge(model)
            except ValueError as error:
                raise ValueError(f'{_Batch([each.part for each in other.trained_on])}: {error}'
                                 ) from error
        for each in other.trained_on:
            events = 0 if each.events is None else len(each.events.stamps)
            keep = self._kept + events <= self.most_events
            self._kept += events if keep else 0
            self.trained_on.append(each if keep else replace(each, events=None))

    def _check_sources(self, other: _Sum, mine: TrainedModel, model: TrainedModel) -> None:
        if mine.encoding.source == model.encoding.source:
            return
        # The two bags where one names senders and the other does not: the same in any batches.
        before, after = self.trained_on[-1], other.trained_on[0]
        nameless = after if model.encoding.source == 'none' else before
        raise ValueError(f'{nameless.part}: {_NAMELESS}')


_NAMELESS = ('no connection of this bag names its sender, and sources are to be told apart; leave '
             'the bag out, or use "source: none" for all (--encoding)')
_COPIED = ('a copy that rosbag filter, compress or decompress made: if several nodes publish on a '
           'topic, all their messages are under the name of one. Use the bag as it was recorded, '
           'and leave topics out by the encoding (exclude_topics)')


class _BadBag(ValueError):
    """Something is wrong with a bag by itself."""


def _count_batch(how: _How, batch: _Batch) -> _Sum:
    total = _Sum(how.most_events)
    for part in batch.parts:
        try:
            total.add(_count(how, part))
        except ValueError as error:
            if not (how.skip_bad and isinstance(error, _BadBag)):
                total.error = str(error)
                break
            total.bad.append(str(error))
            total.lines.append(f'skipped: {error}')
    return total


def _count(how: _How, part: BagPart) -> _Sum:
    counting = how.counting
    try:
        whole, encoding, summary = _read(counting, part)
        events = heads_and_tails.without_start_up(whole)
        part = events.part
        learner = counting.learner(encoding)
        learner.count(replace(events, before=_before(encoding, whole, events)))
        model = learner.model(watch=False)
        graph = (RobotGraph.beside(part.files) if summary.encoding is None  # no event log
                 else RobotGraph(*summary.graph))
        graph.add_to(model, encoding)
        model.add_subscriptions(lasting_subscriptions(summary, encoding))
    except BagError as error:
        raise _BadBag(str(error)) from error
    except ValueError as error:
        raise _BadBag(f'{part}: {error}') from error
    seconds = (events.stamps[-1] - events.stamps[0]) / SECOND_NS
    warnings = [recordings.clock_steps(events)]
    if summary.dropped:
        warnings.append(f'{summary.dropped} messages came too fast to be written, and are missing')
    warnings += [f'{reason}; it is left out' for reason in summary.left_out]
    if events.copied and encoding.source != 'none':
        warnings.append(_COPIED)
    lines = [f'{part}: {seconds:.1f} s, {len(events.stamps)} events',
             *(f'{part}: warning: {warning}' for warning in filter(None, warnings))]
    trained_on = TrainedOn(part, events, heads_and_tails.silences(events))
    return _Sum(len(events.stamps), model, [trained_on], lines)


def _before(encoding: EncodingRules, whole: RecordingEvents,
            events: RecordingEvents) -> Optional[Tuple[np.ndarray, np.ndarray]]:
    """Return stamps and ids of what a bag holds before the events that are left of it without the
    start of the robot; None: nothing. How long a component takes to start is learned from it.
    """
    if not events.part.start:
        return None
    if not whole.part.start:
        first = len(whole.stamps) - len(events.stamps)
        return whole.stamps[:first], whole.ids[:first]
    part = events.part
    read = read_events(part.files, encoding, events.event_types, None, part.start,
                       recording=part.recording)
    return read.stamps, read.ids


def _read(counting: Counting, part: BagPart) -> Tuple[RecordingEvents, EncodingRules, BagSummary]:
    encoding = counting.encoding_of(part)
    with progress.messages(os.path.basename(part.path)) as update:
        read = read_events(part.files, encoding, [], part.start, part.end, update, part.recording)
    if not read.summary.has_sources or len(read.stamps) == 0:
        recordings.check_kind(part.path)
    if encoding.source == 'callerid' and not read.summary.has_sources:
        if counting.encoding is not None:
            raise ValueError(_NAMELESS)
        encoding.source = 'none'  # what was read stays the same
    events = RecordingEvents.of(part, read, encoding)
    if len(events.stamps) == 0:
        raise ValueError('no message is an event by the encoding; a recording of "rosbag play" '
                         'needs "source: none" (--encoding), and a part that is too short another '
                         '--start or --end')
    if len(events.stamps) == 1:
        raise ValueError('one event only, there is no delay to learn; leave it out or record for '
                         'longer')
    check_windows(events.stamps, counting.window)
    return events, encoding, read.summary
