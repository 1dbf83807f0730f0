"""The package's own detectors as systems to evaluate: a class for each."""
from __future__ import annotations

import math
from typing import AbstractSet, Dict, Iterable, List, Optional, Sequence, Set, Tuple

import numpy as np

from self_awareness import (DEFAULT_WINDOW, Alarm, DetectorParameters, EventType, EvidenceModel,
                            Learner, Occurrence, PaperModel, TrainedModel, Tuning, Verdicts,
                            fold_incidents, judge_by_evidence)
from self_awareness.calibration import limits
from self_awareness.calibration.limits import HeldOut
from self_awareness_evaluation.records import (ALARM, FALSE_POSITIVE_RATE, Judged, SystemAlarm,
                                               WindowedEvents, common_threshold)


class Paper:
    """The paper's detector (`detector: paper`); silence scores 0.

    Args:
        rate: share of the normal windows of the calibration that may score below the threshold.
        most_silent: the largest share of them that may be silent; where more than `rate` are,
            twice that share is taken, and so on, and where more than this, no window is abnormal.
    """

    watched = None  # it judges all together
    expected_per_hour = None

    def __init__(self, rate: float = FALSE_POSITIVE_RATE, most_silent: float = 0.0) -> None:
        self._rate, self._most_silent = rate, most_silent
        self._types: List[EventType]
        self._model: PaperModel
        self.threshold: Optional[float] = None

    def train(self, recordings: Sequence[WindowedEvents]) -> None:
        """Count the delays."""
        learner = Learner(evidence=False, paper=True)
        for recording in recordings:
            learner.count(recording.event_types, recording.stamps, recording.ids,
                          recording.fingerprint, attributes=recording.attributes)
        trained = learner.model(watch=False)
        self._types = trained.event_types
        self._model = PaperModel(trained)

    def calibrate(self, recordings: Sequence[WindowedEvents]) -> None:
        """Choose s* by the common rule."""
        verdicts = [self.verdicts(recording) for recording in recordings]
        scores = [np.nan_to_num(verdict.score[~verdict.settling]) for verdict in verdicts]
        rate, self.threshold = self._rate, common_threshold(scores, self._rate)
        while self.threshold <= 0.0 and 2.0 * rate <= self._most_silent:
            rate *= 2.0
            self.threshold = common_threshold(scores, rate)

    def judge(self, recording: WindowedEvents) -> Judged:
        """Judge a recording."""
        return judged_of(self.verdicts(recording), recording.encoded(self._types).event_types)

    def verdicts(self, recording: WindowedEvents) -> Verdicts:
        """Return what the detector says of a recording."""
        encoded = recording.encoded(self._types)
        # - 1, because the window in which the recording ends is the last one.
        return self._model.judge(DEFAULT_WINDOW, self.threshold, DetectorParameters(),
                                 encoded.stamps, encoded.ids, encoded.end - 1)


class Evidence:
    """The evidence detector (`detector: evidence`).

    Args:
        graph: publisher, topic and subscriber, as the model holds it after a training while the
            robot runs; empty: it was trained on bags alone.
        tuning: the numbers of the method; None: the defaults.
        budget: false alarms an hour that the limits allow.
    """

    def __init__(self, graph: Set[Tuple[str, str, str]], tuning: Optional[Tuning] = None,
                 budget: float = limits.BUDGET) -> None:
        self._graph = graph
        self._tuning = tuning or Tuning()
        self._budget = budget
        self._trained: TrainedModel
        self._model: EvidenceModel

    def train(self, recordings: Sequence[WindowedEvents]) -> None:
        """Count the delays and gaps."""
        learner = Learner(self._tuning, self._graph)
        for recording in recordings:
            learner.add(recording.event_types, recording.stamps, recording.ids,
                        recording.fingerprint, attributes=recording.attributes)
        self._trained = learner.learn()
        for recording in recordings:
            self._trained.add_subscriptions(_lasting(recording))
        self._model = EvidenceModel(self._trained)

    def calibrate(self, recordings: Sequence[WindowedEvents]) -> None:
        """Find the limits."""
        encoded = [recording.encoded(self._trained.event_types) for recording in recordings]
        self._trained.calibration, = limits.find(
            self._trained, DetectorParameters().settle_time, [self._budget],
            [HeldOut(recording.stamps, recording.ids, attributes=recording.attributes,
                     waiting=recording.waiting)
             for recording in encoded])

    def judge(self, recording: WindowedEvents) -> Judged:
        """Judge a recording."""
        return judged_of(self.verdicts(recording),
                         recording.encoded(self._trained.event_types).event_types,
                         self._trained.graph)

    @property
    def expected_per_hour(self) -> Optional[float]:
        """See System."""
        calibration = self._trained.calibration
        if calibration is None or math.isnan(calibration.false_alarms_per_hour):
            return None
        return calibration.false_alarms_per_hour

    @property
    def watched(self) -> Set[str]:
        """See System."""
        return {each.component for each in self._trained.coverage() if each.is_watched}

    def verdicts(self, recording: WindowedEvents) -> Verdicts:
        """Return what the detector says of a recording, suspicions included."""
        encoded = recording.encoded(self._trained.event_types)
        expected = self._trained.subscriptions
        # - 1, because the window in which the recording ends is the last one.
        return judge_by_evidence(self._trained, self._model, DetectorParameters(), encoded.stamps,
                                 encoded.ids, encoded.end - 1, encoded.event_types,
                                 missing=[(stamp, expected - present)
                                          for stamp, present in encoded.subscriptions],
                                 waiting=list(encoded.waiting),
                                 attributes=encoded.attributes)


def _lasting(recording: WindowedEvents) -> Set[Tuple[str, str]]:
    """Return what nodes of a recording subscribe to all the time; empty: it is not known."""
    states = [set(present) for _, present in recording.subscriptions]
    return set.intersection(*states) if states else set()


def judged_of(verdicts: Verdicts, event_types: Sequence[EventType],
              graph: AbstractSet[Tuple[str, str, str]] = frozenset()) -> Judged:
    """Return what one of the package's detectors says of a recording as all systems do."""
    incidents = incidents_of([*verdicts.alarms, *verdicts.suspicions], graph)

    def told(found: Sequence[Alarm]) -> List[SystemAlarm]:
        return [SystemAlarm(alarm.begin, alarm.end, alarm.over,
                            list(dict.fromkeys(event_types[suspect.id].source
                                               for suspect in alarm.suspects)), alarm.evidence,
                            alarm.level, alarm.culprit, alarm.kind, incidents.get(alarm.id))
                for alarm in found]

    return Judged(verdicts.start, verdicts.settling, told(verdicts.alarms), verdicts.suspicion,
                  told(verdicts.suspicions))


def incidents_of(found: Iterable[Alarm], graph: AbstractSet[Tuple[str, str, str]]
                 ) -> Dict[int, Tuple[int, int, bool]]:
    """Return by the id of each alarm and suspicion when its incident begins and ends [ns], and
    whether that is over; graph: see Evidence."""
    by_id = {each.id: each for each in sorted(found, key=lambda each: each.begin)}
    occurrences = [Occurrence(
        each.id, each.level == ALARM, each.begin, each.end, each.kind, each.culprit,
        [(suspect.component, suspect.abnormal, None, suspect.reason.kind, suspect.onset)
         for suspect in (*each.suspects, *each.later)],
        [] if each.silent is None else each.silent.hosts) for each in by_id.values()]
    spans = {}
    for incident in fold_incidents(occurrences, set(graph)):
        of_it = [by_id[id_] for id_ in incident.ids]
        span = (min(each.begin for each in of_it), max(each.end for each in of_it),
                all(each.over for each in of_it))
        spans.update(dict.fromkeys(incident.ids, span))
    return spans
