"""Where an excuse held, or the machine stood still, no fault is injected and no limit is found."""
from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any, List, Sequence, Tuple

import pytest
from conftest import Message, jittery_robot, write_bag

from self_awareness import DetectorParameters, TrainedModel, recordings
from self_awareness.calibration import limits
from self_awareness.calibration.fault_injection import InjectedFault
from self_awareness.calibration.runs import JudgedRun, Run, injections, judge_runs
from self_awareness.judging import evidence_judge
from self_awareness.parts import BagPart
from self_awareness.recordings import RecordingEvents
from self_awareness.stamps import SECOND_NS

CRASHES = [InjectedFault.parse('crash:*')]


@pytest.fixture(scope='module', name='model')
def _model(evidence_model: str) -> TrainedModel:
    return TrainedModel.load(evidence_model)


@pytest.fixture(scope='module', name='recording')
def _recording(model: TrainedModel, tmp_path_factory: pytest.TempPathFactory) -> RecordingEvents:
    bag = write_bag(tmp_path_factory.mktemp('b') / 'b.bag', jittery_robot(5000.0, 120.0, 7))
    return recordings.read(model, BagPart(bag))


def starved(recording: RecordingEvents, begin_s: int, end_s: int) -> RecordingEvents:
    """Return it with what the recorder measured: processes waited for most of some seconds."""
    tenth = SECOND_NS // 10
    return replace(recording, waiting=[
        (recording.origin + number * tenth, recording.origin + (number + 1) * tenth,
         int(0.98 * tenth) if 10 * begin_s <= number < 10 * end_s else 0)
        for number in range(1200)])


def judged(model: TrainedModel, recording: RecordingEvents) -> Tuple[Any, JudgedRun]:
    judge = evidence_judge(model, DetectorParameters())
    return judge, judge_runs(judge, model.window, [Run(recording)])[0]


@pytest.mark.parametrize('begin_s, end_s, part', [(50, 80, (0, 50)), (20, 50, (50, 120))])
def test_faults_are_injected_before_or_after_the_excuse(
        model: TrainedModel, recording: RecordingEvents, begin_s: int, end_s: int,
        part: Tuple[int, int]) -> None:
    judge, run = judged(model, starved(recording, begin_s, end_s))
    injected = injections(CRASHES, model, [run])
    assert len(injected.runs) == 3 and not injected.excused
    for each in judge_runs(judge, model.window, injected.runs):
        assert part[0] <= (each.run.onset - recording.origin) / SECOND_NS <= part[1]
        assert each.latency is not None


def test_a_recording_that_was_starved_all_the_time_shows_no_fault(
        model: TrainedModel, recording: RecordingEvents) -> None:
    _, run = judged(model, starved(recording, 15, 110))
    injected = injections(CRASHES, model, [run])
    assert injected.runs == [] and injected.silent == []
    assert injected.excused == [str(recording.part)]


def test_without_an_excuse_the_whole_recording_is_used(model: TrainedModel,
                                                       recording: RecordingEvents) -> None:
    _, run = judged(model, recording)
    assert injections(CRASHES, model, [run]).runs[0].source is recording


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


def measured(recording: Any) -> List[Tuple[int, int, int]]:
    """What the recorder measured. It looked last a little before, and then only after some
    messages had come."""
    begin = recording.origin + int((FROM_S - 0.01) * SECOND_NS)
    end = recording.origin + int((UNTIL_S + 0.01) * SECOND_NS)
    return [(recording.origin, begin, 0), (begin, end, end - begin - 1)]


def test_it_is_no_silence_that_a_limit_must_allow(evidence_model: str, tmp_path: Path) -> None:
    """Of two starts, none is outvoted (docs/method.md, section 5.2)."""
    trained = TrainedModel.load(evidence_model)

    def found_after(recording: Any, waiting: Sequence[Tuple[int, int, int]]) -> List[float]:
        trained.calibration, = limits.find(
            trained, DetectorParameters().settle_time, [limits.BUDGET],
            [replace(recording, waiting=waiting)])
        return [each.death_found_after for each in trained.coverage()]

    usual, stood = (recordings.read(trained, BagPart(write_bag(tmp_path / name, messages)))
                    for name, messages in (('usual.bag', normal(5000.0)),
                                           ('stood.bag', stood_still(5000.0))))
    assert min(found_after(stood, [])) > UNTIL_S - FROM_S
    assert found_after(stood, measured(stood)) == pytest.approx(found_after(usual, []), rel=0.25)
