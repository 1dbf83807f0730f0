"""The package's own detectors as systems to evaluate: a class for each."""
from __future__ import annotations

import math
from typing import AbstractSet, Dict, Iterable, List, Optional, Sequence, Set, Tuple

import numpy as np

from self_awareness import (DEFAULT_WINDOW, EVIDENCE_THRESHOLD, Alarm, DetectorParameters,
                            EventType, EvidenceModel, Learner, Occurrence, PaperModel,
                            TrainedModel, Tuning, Verdicts, fold_incidents, judge_by_evidence)
from self_awareness.calibration import limits
from self_awareness.calibration.limits import HeldOut
from self_awareness_evaluation.systems import (ALARM, FALSE_POSITIVE_RATE, Judged, SystemAlarm,
                                               common_threshold, required)
from self_awareness_evaluation.windowed_events import WindowedEvents
from self_awareness_follow_me.scenario import load_scenario


class Paper:
    """The paper's detector (`detector: paper`); silence scores 0.

    Args:
        rate: share of the normal windows of the calibration that may score below the threshold.
        most_silent: the largest share of them that may be silent; where more than `rate` are,
            twice that share is taken, and so on, and where more than this, no window is abnormal.
    """

    name = 'paper'
    watched = None  # it judges all together

    def __init__(self, rate: float = FALSE_POSITIVE_RATE, most_silent: float = 0.0) -> None:
        self._rate, self._most_silent = rate, most_silent
        self._types: List[EventType] = []
        self._model: Optional[PaperModel] = None
        self._threshold: Optional[float] = None

    def train(self, recordings: Sequence[WindowedEvents]) -> None:
        """Count the delays."""
        learner = Learner(evidence=False, paper=True)
        for recording in recordings:
            learner.count(recording.event_types, recording.stamps, recording.ids,
                          recording.fingerprint, robot=recording.robot,
                          attributes=recording.attributes)
        trained = learner.model(watch=False)
        self._types = trained.event_types
        self._model = PaperModel(trained)

    def calibrate(self, recordings: Sequence[WindowedEvents]) -> None:
        """Choose s* by the common rule."""
        verdicts = [self._verdicts(recording.encoded(self._types)) for recording in recordings]
        scores = [np.nan_to_num(verdict.score[~verdict.settling]) for verdict in verdicts]
        rate, self._threshold = self._rate, common_threshold(scores, self._rate)
        while self._threshold <= 0.0 and 2.0 * rate <= self._most_silent:
            rate *= 2.0
            self._threshold = common_threshold(scores, rate)

    def judge(self, recording: WindowedEvents) -> Judged:
        """Judge a recording."""
        encoded = recording.encoded(self._types)
        verdicts = self._verdicts(encoded)
        return judged_of(verdicts, encoded.event_types,
                         required(self._threshold, self.name, 'calibrate'))

    def _verdicts(self, encoded: WindowedEvents) -> Verdicts:
        # - 1, because the window in which the recording ends is the last one.
        model: PaperModel = required(self._model, self.name, 'train')
        return model.judge(DEFAULT_WINDOW, self._threshold, DetectorParameters(),
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
        self.name = 'evidence' if graph else 'evidence_no_graph'
        self._graph = graph
        self._tuning = tuning or Tuning()
        self._budget = budget
        self._trained: Optional[TrainedModel] = None
        self._model: Optional[EvidenceModel] = None

    def train(self, recordings: Sequence[WindowedEvents]) -> None:
        """Count the delays and gaps."""
        learner = Learner(self._tuning, self._graph)
        for recording in recordings:
            learner.add(recording.event_types, recording.stamps, recording.ids,
                        recording.fingerprint, robot=recording.robot,
                        attributes=recording.attributes)
        trained = learner.learn()
        for recording in recordings:
            trained.add_subscriptions(_lasting(recording))
        self._trained = trained
        self._model = EvidenceModel(trained)

    def calibrate(self, recordings: Sequence[WindowedEvents]) -> None:
        """Find the limits."""
        trained: TrainedModel = required(self._trained, self.name, 'train')
        encoded = [recording.encoded(trained.event_types) for recording in recordings]
        trained.calibration, = limits.find(
            trained, DetectorParameters().settle_time, [self._budget],
            [HeldOut(recording.stamps, recording.ids, robot=recording.robot,
                     attributes=recording.attributes, waiting=recording.waiting)
             for recording in encoded])

    def judge(self, recording: WindowedEvents) -> Judged:
        """Judge a recording."""
        trained: TrainedModel = required(self._trained, self.name, 'train')
        return judged_of(self.verdicts(recording, DetectorParameters()),
                         recording.encoded(trained.event_types).event_types, EVIDENCE_THRESHOLD,
                         trained.graph)

    @property
    def expected_per_hour(self) -> Optional[float]:
        """The false alarms an hour that the calibration expects; None: it does not say."""
        trained: TrainedModel = required(self._trained, self.name, 'train')
        expected = math.nan if trained.calibration is None \
            else trained.calibration.false_alarms_per_hour
        return None if math.isnan(expected) else expected

    @property
    def watched(self) -> Set[str]:
        """The components whose death it would find."""
        trained: TrainedModel = required(self._trained, self.name, 'train')
        return {each.component for each in trained.coverage() if each.is_watched}

    def verdicts(self, recording: WindowedEvents, parameters: DetectorParameters) -> Verdicts:
        """Return what the detector says of a recording, suspicions included."""
        trained: TrainedModel = required(self._trained, self.name, 'train')
        encoded = recording.encoded(trained.event_types)
        # - 1, because the window in which the recording ends is the last one.
        model: EvidenceModel = required(self._model, self.name, 'train')
        expected = trained.subscriptions
        return judge_by_evidence(trained, model, parameters, encoded.stamps,
                                 encoded.ids, encoded.end - 1, encoded.event_types,
                                 missing=[(stamp, expected - present)
                                          for stamp, present in encoded.subscriptions],
                                 waiting=list(encoded.waiting),
                                 attributes=encoded.attributes)


def _lasting(recording: WindowedEvents) -> Set[Tuple[str, str]]:
    """Return what nodes of a recording subscribe to all the time; empty: it is not known."""
    states = [set(present) for _, present in recording.subscriptions]
    return set.intersection(*states) if states else set()


def judged_of(verdicts: Verdicts, event_types: Sequence[EventType], threshold: float,
              graph: AbstractSet[Tuple[str, str, str]] = frozenset()) -> Judged:
    """Return what one of the package's detectors says of a recording as all systems do.

    Args:
        verdicts: on all windows.
        event_types: by id.
        threshold: a score below it is abnormal.
        graph: see Evidence.
    """
    incidents = incidents_of([*verdicts.alarms, *verdicts.suspicions], graph)

    def told(found: Sequence[Alarm]) -> List[SystemAlarm]:
        return [SystemAlarm(alarm.begin, alarm.end, alarm.over,
                            list(dict.fromkeys(event_types[suspect.id].source
                                               for suspect in alarm.suspects)), alarm.evidence,
                            alarm.level, alarm.culprit, alarm.kind, incidents.get(alarm.id))
                for alarm in found]

    return Judged(verdicts.start, verdicts.abnormal, np.nan_to_num(verdicts.score),
                  verdicts.settling, told(verdicts.alarms), threshold, verdicts.suspicion,
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


def scenario_graph() -> Set[Tuple[str, str, str]]:
    """Return who listens to whom in the robot that comes with the package."""
    components = load_scenario().components
    return {(f'/{publisher.name}', f'/{topic}', f'/{listener.name}')
            for publisher in components for listener in components
            for topic in set(publisher.outputs()) & set(listener.inputs())}
