"""How old a model is: how far what was heard since has drifted from what was learned."""
from __future__ import annotations

import os
from collections import Counter
from dataclasses import dataclass, field
from typing import Dict, List, Sequence

from self_awareness import (Acceptance, ComponentDrift, DetectorParameters, EvidenceModel,
                            Recording, TrainedModel, accepted_file, drift_of, evidence_lanes,
                            recordings)
from self_awareness.judging import evidence_judge
from self_awareness.parts import BagPart, Named, look
from self_awareness.recordings import DistinctRecordings, overlap
from self_awareness.stamps import SECOND_NS

LEARNED, INCIDENT, SHORT = 'learned from', 'not normal', 'too short'
"""Why a recording says nothing of a drift."""

_SHORTEST_NS = 60 * SECOND_NS


@dataclass(frozen=True)
class Heard:
    """A recording, as a model judges it."""

    part: BagPart  # the whole recording
    recording: Recording  # what a model file says of it
    origin: int  # stamp of its first message [ns]
    left_out: str = ''  # why it says nothing of a drift; empty: it does
    why: str = ''  # the same in more words; may be empty
    # The largest share of its limit, by component; empty: it is left out.
    shares: Dict[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Age:
    """What recordings say of a model's age."""

    budget: float  # false alarms an hour that the model's limits allow
    learned_until: int  # end of the last recording that it was learned from, or calibrated on [ns]
    heard: List[Heard]  # the recordings, in the order of time
    drift: Dict[str, ComponentDrift]  # by component; empty: nothing says anything of it
    samples: int  # starts of the robot, or days of one, that the drift comes from
    needed: float  # evidence from which on a drift is told

    @property
    def counted(self) -> List[Heard]:
        """Return the recordings that are not left out."""
        return [each for each in self.heard if not each.left_out]

    @property
    def left_out(self) -> Dict[str, int]:
        """Return how many recordings are left out, by reason."""
        return dict(Counter(each.left_out for each in self.heard if each.left_out))

    @property
    def drifting(self) -> List[str]:
        """Return the components of which a drift is told, the one with most evidence first."""
        told = [(drift.evidence, name) for name, drift in self.drift.items() if drift.told_by]
        return [name for _, name in sorted(told, reverse=True)]


def logs_of(model: str, named: Sequence[str]) -> Named:
    """Return the recordings that are named; without any, those that are kept beside the model.

    Raises:
        ValueError: there is none, or a part of a recording is named.
    """
    kept = f'{model}.kept'
    if not named and not os.path.isdir(kept):
        raise ValueError(f'there is no folder {kept}: name event logs of normal operation '
                         '(roslaunch self_awareness record.launch)')
    parts = [BagPart.parse(name) for name in named or [kept]]
    for part in parts:
        if part.start is not None:
            raise ValueError(f'{part}: a part of a recording; name the whole one')
    return look(parts)


def age_of(path: str, trained: TrainedModel, named: Named, skip_bad: bool = False) -> Age:
    """Return what recordings say of the age of a model, which has limits.

    Args:
        path: of the model: what is accepted lies beside it.
        trained: the model.
        named: whole recordings, of one robot, that are taken for normal; those that turn out to
            be bad are added to these.
        skip_bad: leave them out.

    Raises:
        BadRecordingsError: a recording cannot be used, and is not to be left out, or none can.
        ValueError: it is of another robot, or there as well twice; or the model has no limits.
    """
    trained.require('evidence')
    if trained.calibration is None:
        raise ValueError(f'{path}: has no limits that anything could drift towards (rosrun '
                         'self_awareness calibrate)')
    accepted = accepted_file.beside(path)
    computed = EvidenceModel(trained)
    heard: List[Heard] = []
    distinct = DistinctRecordings()
    for found in named.each(lambda part: _heard(trained, computed, accepted, part)):
        distinct.add(str(found.part), found.recording)
        heard.append(found)
    named.check(skip_bad and bool(heard))
    heard.sort(key=lambda each: each.origin)
    robots = sorted({each.recording.robot for each in heard})
    if len(robots) > 1:
        raise ValueError(f'the recordings are of several robots ({", ".join(robots)}); name those '
                         'of one')
    counted = [each for each in heard if not each.left_out]
    components = list(counted[0].shares) if counted else []
    drift = drift_of(len(components), [
        (each.origin, each.recording.end, each.recording.robot_start,
         [each.shares[name] for name in components]) for each in counted])
    learned = [*trained.recordings, *trained.calibration.recordings]
    return Age(trained.calibration.budget, max((each.end for each in learned), default=0), heard,
               {name: drift.component(number) for number, name in enumerate(components)},
               drift.samples, drift.needed)


def _heard(trained: TrainedModel, computed: EvidenceModel, accepted: Sequence[Acceptance],
           part: BagPart) -> Heard:
    events = recordings.read(trained, part)
    recording = events.recording

    def left_out(reason: str, why: str = '') -> Heard:
        return Heard(part, recording, events.origin, reason, why)

    assert trained.calibration is not None
    if any(overlap(recording, each)
           for each in (*trained.recordings, *trained.calibration.recordings)):
        return left_out(LEARNED)
    parameters = DetectorParameters()
    first = int(events.stamps[0])
    if events.end - first < parameters.settle_time + _SHORTEST_NS:
        return left_out(SHORT)
    verdicts = evidence_judge(trained, parameters, computed, accepted)(events)
    alarms = [*verdicts.alarms, *verdicts.suspicions]
    if alarms:
        return left_out(INCIDENT, f'{alarms[0].kind} {alarms[0].culprit}'.strip())
    # The largest shares once the detector has settled.
    lanes = evidence_lanes(trained, computed, parameters, events, [first + parameters.settle_time],
                           accepted)
    return Heard(part, recording, events.origin,
                 shares=dict(zip(lanes.components, lanes.shares[:, 0].tolist())))
