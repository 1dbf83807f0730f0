"""The recorder and its machine stood still: that says nothing of the robot."""
from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any, List, Sequence

import pytest
from conftest import Message, jittery_robot, write_bag

from self_awareness import DetectorParameters, TrainedModel, Waiting, recordings
from self_awareness.calibration import limits
from self_awareness.judging import evidence_judge
from self_awareness.parts import BagPart
from self_awareness.stamps import SECOND_NS

LENGTH_S = 120.0
FROM_S, UNTIL_S = 60.0, 61.5


def normal(begin: float) -> List[Message]:
    return list(jittery_robot(begin, LENGTH_S, int(begin)))


def stood_still(begin: float) -> List[Message]:
    """All that was to happen meanwhile happens at once, right afterwards."""
    def moved(stamp: float) -> float:
        after = stamp - begin - FROM_S
        return begin + UNTIL_S + after * 1e-3 if 0 <= after < UNTIL_S - FROM_S else stamp

    return sorted((moved(stamp), topic, text) for stamp, topic, text in normal(begin))


@pytest.fixture(name='recording')
def _recording(evidence_model: str, tmp_path: Path) -> Any:
    return recordings.read(TrainedModel.load(evidence_model), BagPart(
        write_bag(tmp_path / 'stood.bag', stood_still(5000.0))))


def measured(recording: Any) -> List[Waiting]:
    """What the recorder measured. It looked last a little before, and then only after some
    messages had come."""
    begin = recording.origin + int((FROM_S - 0.01) * SECOND_NS)
    end = recording.origin + int((UNTIL_S + 0.01) * SECOND_NS)
    return [Waiting(recording.origin, begin, 0), Waiting(begin, end, end - begin - 1)]


def alarms(model: str, recording: Any, waiting: Sequence[Waiting]) -> List[Any]:
    judge = evidence_judge(TrainedModel.load(model), DetectorParameters())
    found = judge(replace(recording, waiting=waiting))
    return list(found.alarms) + list(found.suspicions)


def test_nobody_is_to_blame(evidence_model: str, recording: Any) -> None:
    assert alarms(evidence_model, recording, []), 'nobody knows who stood still'
    assert not alarms(evidence_model, recording, measured(recording))


def test_a_death_afterwards_is_found(evidence_model: str, recording: Any) -> None:
    dead = recording.origin + int((UNTIL_S + 10.0) * SECOND_NS)
    lives = [not (stamp > dead and recording.event_types[id_].source == '/laser')
             for stamp, id_ in zip(recording.stamps, recording.ids)]
    left = replace(recording, stamps=recording.stamps[lives], ids=recording.ids[lives],
                   attributes=None)
    found = alarms(evidence_model, left, measured(left))[0]
    assert recording.event_types[found.suspects[0].id].source == '/laser'


def test_it_is_no_silence_that_a_limit_must_allow(evidence_model: str, tmp_path: Path) -> None:
    """Of two starts, none is outvoted (docs/method.md, section 5.2)."""
    trained = TrainedModel.load(evidence_model)

    def found_after(recording: Any, waiting: Sequence[Waiting]) -> List[float]:
        trained.calibration, = limits.find(
            trained, DetectorParameters().settle_time, [limits.BUDGET],
            [replace(recording, waiting=waiting)])
        return [each.death_found_after for each in trained.coverage()]

    usual, stood = (recordings.read(trained, BagPart(write_bag(tmp_path / name, messages)))
                    for name, messages in (('usual.bag', normal(5000.0)),
                                           ('stood.bag', stood_still(5000.0))))
    assert min(found_after(stood, [])) > UNTIL_S - FROM_S
    assert found_after(stood, measured(stood)) == pytest.approx(found_after(usual, []), rel=0.25)
