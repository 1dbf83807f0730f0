"""Detectors on recordings of real robots, in which somebody found the outages by eye.

The recordings are short. So the package's own detector finds its limits on what it learned from,
by cross-fit, and the others choose their thresholds on the part that they did not learn from.
"""
from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Callable, Dict, Iterator, List, Optional, Sequence, Tuple

import numpy as np

from self_awareness import (EVIDENCE_THRESHOLD, DetectorParameters, EncodingRules, EvidenceModel,
                            PaperModel, Roc, TrainedModel, Tuning, recordings)
from self_awareness.calibration.limits import TooLittleError
from self_awareness.judging import BOTH, Judge, evidence_judge, paper_judge
from self_awareness.parts import BagPart
from self_awareness.recordings import RecordingEvents
from self_awareness.stamps import SECOND_NS, nanoseconds
from self_awareness.training import many_bags
from self_awareness.training.many_bags import Counting, Trained
from self_awareness_evaluation import tunings
from self_awareness_evaluation.detectors import judged_of
from self_awareness_evaluation.experiment import Unit
from self_awareness_evaluation.peers.frequency import LearnedFrequencyMonitor
from self_awareness_evaluation.records import NORMAL
from self_awareness_evaluation.rows import HOUR_S, Row, Subject, at_end
from self_awareness_evaluation.systems import Judged, ScoringSystem, SystemAlarm, settling
from self_awareness_evaluation.windowed_events import WindowedEvents

OUTAGE = 'outage'
"""Kind of fault: what is wrong in a recording of a real robot."""

RATE = 0.01
"""The share of normal windows that may score below the threshold of systems that have one.

More than in simulated time: in a recording of 30 s, a share of 0.001 is less than one window.
"""

MOST_SILENT = 0.1
"""The paper's detector cannot judge a robot of which more normal windows are silent than this."""

Span = Tuple[float, float]
"""Start and end, in seconds from the recording's first message."""

END = 1e9
"""Stands for the end of a recording [s]."""


@dataclass(frozen=True)
class Case:
    """A recording to judge, and normal operation of the same robot; paths are below the data's.

    Args:
        name: in the table.
        training: normal operation, the first part.
        calibration: and the second.
        judged: the recording to judge.
        outage: what is to be found; None: nothing.
        normal: where no alarm may be raised, nor stand; the rest is neither.
    """

    name: str
    training: BagPart
    calibration: BagPart
    judged: str
    outage: Optional[Span]
    normal: Tuple[Span, ...]


def _social(judged: int, first: int, second: int) -> Case:
    bags = [f'social_robot/subject2_session{session}.bag' for session in (first, second, judged)]
    return Case(f'social_robot, session {judged}', BagPart(bags[0]), BagPart(bags[1]), bags[2],
                None, ((0.0, END),))


_WHEELED = 'wheeled_robot/'

CASES = (
    # What is abnormal is told in the README of the data. After an outage comes a burst.
    Case('wheeled_robot, 13 February', BagPart(f'{_WHEELED}feb13_normal.bag', 24.0, 65.0),
         BagPart(f'{_WHEELED}feb13_normal.bag', 65.0), f'{_WHEELED}feb13_outage.bag',
         (27.9, 36.1), ((24.0, 27.9), (40.0, END))),
    Case('wheeled_robot, 17 January', BagPart(f'{_WHEELED}jan17_normal.bag', 15.0, 51.0),
         BagPart(f'{_WHEELED}jan17_normal.bag', 55.0), f'{_WHEELED}jan17_outage.bag',
         # From 42 s on all nodes stall for up to 1.8 s at a time: it is not normal, nor an outage.
         (66.0, END), ((0.0, 42.0),)),
    _social(101, 102, 103),
    _social(102, 101, 103),
    _social(103, 101, 102),
)
"""All cases."""


def check_data(data: Path) -> None:
    """Check that a folder has the recordings of all cases.

    Raises:
        ValueError: one is not in it.
    """
    for case in CASES:
        for path in (case.training.path, case.calibration.path, case.judged):
            if not (data / path).is_file():
                raise ValueError(f'{data / path}: no such recording; --data names the folder that '
                                 'has it')


def rows(unit: Unit, case: Case, data: Path) -> Iterator[Row]:
    """Yield what variants say of a case: of normal operation, and of the outage if there is one.

    Args:
        unit: of the case.
        case: one of CASES.
        data: folder of the recordings, see check_data().

    Raises:
        BagError: a recording cannot be read.
    """
    for variant in unit.variants:
        subject = unit.subject(variant)
        try:
            judged = SYSTEMS[variant.system](case, data, tunings.tuning_of(variant.change))
        except TooLittleError as error:
            yield Row(subject, NORMAL, refused=str(error))
            if case.outage is not None:
                yield Row(subject, OUTAGE, refused=str(error))
            continue
        yield from case_rows(subject, case, judged)


@dataclass(frozen=True)
class JudgedCase:
    """What a system says of a recording.

    Args:
        alarms, suspicions: as SystemAlarm, with times from the first message on [ns].
        length: of the recording [s].
        watched: event types, or topics, that it watches at all.
    """

    alarms: Sequence[SystemAlarm]
    suspicions: Sequence[SystemAlarm]
    length: float
    watched: int


def _evidence(case: Case, data: Path, tuning: Tuning) -> JudgedCase:
    """Let the evidence detector judge a case.

    Args:
        case: one of CASES.
        data: folder of the recordings, see check_data().
        tuning: of the method.

    Raises:
        BagError: a recording cannot be read.
        TooLittleError: the recordings are too short for limits.
    """
    parts = [_below(data, case.training), _below(data, case.calibration)]
    trained_on = _trained(parts, tuning)
    limits = many_bags.preliminary_limits(trained_on).limits
    trained, parameters = trained_on.model, DetectorParameters()
    watched = {track.to_id for track, limit in zip(EvidenceModel(trained).tracks, limits)
               if not math.isnan(limit)}
    return _judge(trained, evidence_judge(trained, parameters), data / case.judged,
                  len(watched))


def _paper(case: Case, data: Path, _: Tuning) -> JudgedCase:
    trained = _trained([_below(data, case.training)]).model
    model, parameters = PaperModel(trained), DetectorParameters()
    normal = recordings.read(trained, _below(data, case.calibration))
    scores = paper_judge(trained, model, None, parameters)(normal.stamps, normal.ids,
                                                           normal.end)
    threshold = _paper_threshold(np.nan_to_num(scores.score[~scores.settling]))
    return _judge(trained, paper_judge(trained, model, threshold, parameters),
                  data / case.judged, len(trained.event_types) if threshold > 0.0 else 0)


def _frequency_learned(case: Case, data: Path, _: Tuning) -> JudgedCase:
    trained = _trained([_below(data, case.training)]).model  # for the encoding only
    scorer = LearnedFrequencyMonitor()
    scorer.train([_events(recordings.read(trained, _below(data, case.training)))])
    normal = _events(recordings.read(trained, _below(data, case.calibration)))
    threshold = Roc(scorer.scores(normal)[~settling(normal)], []).level(RATE).cutoff
    recording = recordings.read(trained, BagPart(str(data / case.judged)))
    judged = ScoringSystem('frequency_learned', scorer, threshold).judge(_events(recording))
    return _from_first_message(recording, judged, len(scorer.bounds))


SYSTEMS: Dict[str, Callable[[Case, Path, Tuning], JudgedCase]] = {
    'evidence': _evidence,
    'paper': _paper,
    'frequency_learned': _frequency_learned,
}
"""The systems by name."""


def _below(data: Path, part: BagPart) -> BagPart:
    return BagPart(str(data / part.path), part.start, part.end)


def _trained(parts: Sequence[BagPart], tuning: Optional[Tuning] = None) -> Trained:
    return many_bags.train(parts, Counting(EncodingRules.defaults(), detector=BOTH,
                                           tuning=tuning or Tuning()))


def _paper_threshold(scores: np.ndarray) -> float:
    """Return the threshold at RATE, or at twice that and so on where more windows are silent.

    It is 0, which no score is below, where more are silent than MOST_SILENT.
    """
    rate, threshold = RATE, 0.0
    while threshold <= 0.0 and rate <= MOST_SILENT:
        threshold = Roc(scores, []).level(rate).cutoff
        rate *= 2.0
    return threshold


def _judge(trained: TrainedModel, judge: Judge, path: Path, watched: int) -> JudgedCase:
    recording = recordings.read(trained, BagPart(str(path)))
    verdicts = judge(recording.stamps, recording.ids, recording.end, recording.event_types,
                     attributes=recording.attributes)
    judged = judged_of(verdicts, recording.event_types, EVIDENCE_THRESHOLD, trained.graph)
    return _from_first_message(recording, judged, watched)


def _from_first_message(recording: RecordingEvents, judged: Judged, watched: int) -> JudgedCase:
    def shifted(found: Sequence[SystemAlarm]) -> List[SystemAlarm]:
        return [each.shifted(-recording.origin) for each in found]
    return JudgedCase(shifted(judged.alarms), shifted(judged.suspicions),
                      (recording.end - recording.origin) / SECOND_NS, watched)


def _events(recording: RecordingEvents) -> WindowedEvents:
    return WindowedEvents(recording.event_types, recording.stamps, recording.ids,
                          recording.end + 1, attributes=recording.attributes)


def case_rows(subject: Subject, case: Case, judged: JudgedCase) -> Iterator[Row]:
    """Yield the rows of a case."""
    normal = [(start, min(end, judged.length)) for start, end in case.normal]
    false = [alarm for alarm in judged.alarms
             if any(start <= alarm.start / SECOND_NS < end for start, end in normal)]
    yield Row(subject, NORMAL, hours=sum(end - start for start, end in normal) / HOUR_S,
              alarms=len(false), standing_hours=sum(
                  _overlap(alarm, span) for alarm in judged.alarms for span in normal) / HOUR_S,
              evidence=tuple(alarm.evidence for alarm in false), watched=judged.watched)
    if case.outage is None:
        return
    onset, relief = (nanoseconds(min(each, judged.length)) for each in case.outage)
    found = next((alarm for alarm in judged.alarms if onset < alarm.start < relief), None)
    row = Row(subject, OUTAGE, watched=judged.watched,
              stood_before=any(alarm.stands_at(onset) for alarm in judged.alarms),
              latency_s=None if found is None else (found.start - onset) / SECOND_NS)
    yield at_end(row, [*judged.alarms, *judged.suspicions], onset, relief)


def _overlap(alarm: SystemAlarm, span: Span) -> float:
    return max(min(alarm.end / SECOND_NS, span[1]) - max(alarm.start / SECOND_NS, span[0]), 0.0)
