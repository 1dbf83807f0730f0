"""Detectors on recordings of real robots, in which somebody found the outages by eye.

The recordings are short. So the package's own detector finds its limits on what it learned from,
by cross-fit, and the others choose their thresholds on the part that they did not learn from.
"""
from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Callable, Dict, Iterator, NamedTuple, Optional, Sequence, Tuple, Union

from self_awareness import DetectorParameters, EncodingRules, EvidenceModel, Tuning, recordings
from self_awareness.calibration.limits import TooLittleError
from self_awareness.judging import BOTH, evidence_judge
from self_awareness.parts import BagPart
from self_awareness.recordings import RecordingEvents
from self_awareness.stamps import SECOND_NS, nanoseconds
from self_awareness.training import many_bags
from self_awareness.training.many_bags import Counting, Trained
from self_awareness_evaluation.experiment import Unit
from self_awareness_evaluation.records import NORMAL, SystemAlarm, WindowedEvents
from self_awareness_evaluation.rows import HOUR_S, Row, Subject, at_end
from self_awareness_evaluation.systems import FrequencyMonitor, Paper, judged_of
from self_awareness_evaluation.variants import tuning_of

OUTAGE = 'outage'  # kind of fault: what is wrong in a recording of a real robot

# The share of normal windows that may score below the threshold of systems that have one: more
# than in simulated time, since in a recording of 30 s, 0.001 is less than one window.
_RATE = 0.01
# The paper's detector cannot judge a robot of which more normal windows are silent than this.
_MOST_SILENT = 0.1

Span = Tuple[float, float]  # start and end, in seconds from the recording's first message
END = 1e9  # stands for the end of a recording [s]


@dataclass(frozen=True)
class Case:
    """A recording to judge, and normal operation of the same robot; paths are below the data's."""

    name: str  # in the table
    training: BagPart  # normal operation, the first part
    calibration: BagPart  # and the second
    judged: str  # the recording to judge
    outage: Optional[Span]  # what is to be found; None: nothing
    normal: Tuple[Span, ...]  # where no alarm may be raised, nor stand; the rest is neither


def _social(judged: int, first: int, second: int) -> Case:
    bags = [f'social_robot/subject2_session{session}.bag' for session in (first, second, judged)]
    return Case(f'social_robot, session {judged}', BagPart(bags[0]), BagPart(bags[1]), bags[2],
                None, ((0.0, END),))


CASES = (
    # What is abnormal is told in the README of the data. After an outage comes a burst.
    Case('wheeled_robot, 13 February', BagPart('wheeled_robot/feb13_normal.bag', 24.0, 65.0),
         BagPart('wheeled_robot/feb13_normal.bag', 65.0), 'wheeled_robot/feb13_outage.bag',
         (27.9, 36.1), ((24.0, 27.9), (40.0, END))),
    Case('wheeled_robot, 17 January', BagPart('wheeled_robot/jan17_normal.bag', 15.0, 51.0),
         BagPart('wheeled_robot/jan17_normal.bag', 55.0), 'wheeled_robot/jan17_outage.bag',
         # From 42 s on all nodes stall for up to 1.8 s at a time: it is not normal, nor an outage.
         (66.0, END), ((0.0, 42.0),)),
    _social(101, 102, 103), _social(102, 101, 103), _social(103, 101, 102))


def check_data(data: Path) -> None:
    """Check that a folder has the recordings of all cases."""
    for case in CASES:
        for path in (case.training.path, case.calibration.path, case.judged):
            if not (data / path).is_file():
                raise ValueError(f'{data / path}: no such recording; --data names the folder that '
                                 'has it')


class JudgedCase(NamedTuple):
    """What a system says of a recording."""

    alarms: Sequence[SystemAlarm]
    suspicions: Sequence[SystemAlarm]
    begin: int  # stamp of the first message [ns]
    end: int  # and of the last one
    watched: int  # event types, or topics, that it watches at all


def rows(case: Case, data: Path, unit: Unit) -> Iterator[Row]:
    """Yield what variants say of a case: of normal operation, and of an outage if there is one."""
    for variant in unit.variants:
        subject = unit.subject(variant)
        try:
            judged = SYSTEMS[variant.system](case, data, tuning_of(variant.change))
        except TooLittleError as error:
            for kind in (NORMAL,) if case.outage is None else (NORMAL, OUTAGE):
                yield Row(subject, kind, refused=str(error))
        else:
            yield from case_rows(subject, case, judged)


def _evidence(case: Case, data: Path, tuning: Tuning) -> JudgedCase:
    """Let the evidence detector judge, with limits of what it learned from, by cross-fit."""
    trained_on = _trained(data, tuning, case.training, case.calibration)
    limits = many_bags.preliminary_limits(trained_on).limits
    trained = trained_on.model
    watched = {track.to_id for track, limit in zip(EvidenceModel(trained).tracks, limits)
               if not math.isnan(limit)}
    found = recordings.read(trained, _below(data, BagPart(case.judged)))
    verdicts = evidence_judge(trained, DetectorParameters())(RecordingEvents(
        found.event_types, found.stamps, found.ids, found.end, attributes=found.attributes))
    judged = judged_of(verdicts, found.event_types)
    return JudgedCase(judged.alarms, judged.suspicions, found.origin, found.end, len(watched))


def _learned(make: Callable[[], Union[Paper, FrequencyMonitor]], case: Case, data: Path,
             _: Tuning) -> JudgedCase:
    """Let another system judge; it learns from the first part, and its threshold is that of the
    second one."""
    system = make()
    trained = _trained(data, Tuning(), case.training).model  # for the encoding only
    found = [recordings.read(trained, _below(data, part))
             for part in (case.training, case.calibration, BagPart(case.judged))]
    training, calibration, judged = (
        WindowedEvents(each.event_types, each.stamps, each.ids, each.end + 1,
                       attributes=each.attributes) for each in found)
    system.train([training])
    system.calibrate([calibration])
    if isinstance(system, FrequencyMonitor):
        watched = len(system.bounds)
    else:
        watched = (sum(kind.is_message for kind in trained.event_types)
                   if (system.threshold or 0.0) > 0.0 else 0)
    return JudgedCase(system.judge(judged).alarms, (), found[-1].origin, found[-1].end, watched)


SYSTEMS: Dict[str, Callable[[Case, Path, Tuning], JudgedCase]] = {  # by name
    'evidence': _evidence,
    'paper': partial(_learned, lambda: Paper(_RATE, _MOST_SILENT)),
    'frequency_learned': partial(_learned, lambda: FrequencyMonitor(_RATE))}


def _trained(data: Path, tuning: Tuning, *parts: BagPart) -> Trained:
    return many_bags.train([_below(data, part) for part in parts],
                           Counting(EncodingRules.defaults(), detector=BOTH, tuning=tuning))


def _below(data: Path, part: BagPart) -> BagPart:
    return BagPart(str(data / part.path), part.start, part.end)


def case_rows(subject: Subject, case: Case, judged: JudgedCase) -> Iterator[Row]:
    def at(second: float) -> int:
        return min(judged.begin + nanoseconds(second), judged.end)

    normal = [(at(start), at(end)) for start, end in case.normal]
    false = [alarm for alarm in judged.alarms
             if any(start <= alarm.start < end for start, end in normal)]
    standing = sum(max(min(alarm.end, end) - max(alarm.start, start), 0)
                   for alarm in judged.alarms for start, end in normal)
    length = sum(end - start for start, end in normal)
    yield Row(subject, NORMAL, hours=length / SECOND_NS / HOUR_S, alarms=len(false),
              standing_hours=standing / SECOND_NS / HOUR_S, watched=judged.watched,
              evidence=tuple(alarm.evidence for alarm in false))
    if case.outage is None:
        return
    onset, relief = map(at, case.outage)
    found = next((alarm for alarm in judged.alarms if onset < alarm.start < relief), None)
    row = Row(subject, OUTAGE, watched=judged.watched,
              stood_before=any(alarm.stands_at(onset) for alarm in judged.alarms),
              latency_s=None if found is None else (found.start - onset) / SECOND_NS)
    yield at_end(row, [*judged.alarms, *judged.suspicions], relief)
