"""No fault is injected where an excuse held; and recordings are judged as `score` judges them."""
from __future__ import annotations

from dataclasses import replace
from typing import Any, Tuple

import pytest
from conftest import jittery_robot, write_bag

from self_awareness import DetectorParameters, TrainedModel, Waiting, recordings
from self_awareness.calibration.fault_injection import InjectedFault
from self_awareness.calibration.runs import JudgedRun, Run, injections, judge_runs
from self_awareness.judging import evidence_judge
from self_awareness.recordings import BagPart, RecordingEvents
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
        Waiting(recording.origin + number * tenth, recording.origin + (number + 1) * tenth,
                int(0.98 * tenth) if 10 * begin_s <= number < 10 * end_s else 0)
        for number in range(1200)])


def judged(model: TrainedModel, recording: RecordingEvents) -> Tuple[Any, JudgedRun]:
    judge = evidence_judge(model, DetectorParameters())
    return judge, judge_runs(judge, model.window, [Run(recording)])[0]


def test_a_recording_is_judged_with_what_its_machine_measured(model: TrainedModel,
                                                              recording: RecordingEvents) -> None:
    _, run = judged(model, starved(recording, 50, 80))
    assert [alarm.busy is not None for alarm in run.verdicts.suspicions] == [True]


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
