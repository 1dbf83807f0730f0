"""Injected faults: what they do to stamps and ids, and where there are none."""
from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any, List, Sequence, Tuple

import numpy as np
import pytest
from conftest import Message, jittery_robot, write_bag

from self_awareness import DetectorParameters, EventType, TrainedModel, recordings
from self_awareness.calibration import limits
from self_awareness.calibration.fault_injection import InjectedFault, inject, of_known_source
from self_awareness.calibration.runs import JudgedRun, Run, injections, judge_runs
from self_awareness.judging import evidence_judge
from self_awareness.parts import BagPart
from self_awareness.recordings import RecordingEvents
from self_awareness.stamps import SECOND_NS

S = 1_000_000_000
TYPES = [EventType('/laser', '/scan', 'T'), EventType('/slam', '/map', 'T'),
         EventType('/laser', '/status', 'T')]
# The laser's two topics every second, slam's one half a second later; 0 to 39.5 s.
STAMPS = np.repeat(np.arange(40), 3) * S + np.tile([0, S // 2, 0], 40)
IDS = np.tile(np.array([0, 1, 2], dtype=np.uint32), 40)
ORDER = np.argsort(STAMPS, kind='stable')
STAMPS, IDS = STAMPS[ORDER], IDS[ORDER]
ONSET, END = 20 * S, 39 * S + S // 2


def faulty(text: str) -> Tuple[np.ndarray, np.ndarray]:
    stamps, ids = inject(InjectedFault.parse(text), TYPES, STAMPS, IDS, ONSET, END)
    assert stamps.dtype == np.int64 and len(stamps) == len(ids)
    assert (np.diff(stamps) >= 0).all() and stamps[-1] <= END
    before = STAMPS < ONSET
    assert (stamps[:before.sum()] == STAMPS[before]).all()
    assert (ids[:before.sum()] == IDS[before]).all()
    return stamps, ids


def of(ids: np.ndarray, stamps: np.ndarray, index: int) -> np.ndarray:
    return stamps[(ids == index) & (stamps >= ONSET)] / S


def test_a_crash_silences_all_of_the_source_and_nothing_else() -> None:
    stamps, ids = faulty('crash:/laser')
    assert len(of(ids, stamps, 0)) == len(of(ids, stamps, 2)) == 0
    assert of(ids, stamps, 1) == pytest.approx(np.arange(20) + 20.5)


def test_slow_stretches_the_delays_of_the_source_by_the_factor() -> None:
    stamps, ids = faulty('slow:/slam:3')
    assert of(ids, stamps, 1) == pytest.approx(np.arange(21.5, 40.0, 3.0))
    assert of(ids, stamps, 0) == pytest.approx(np.arange(20, 40))


def test_starvation_stretches_all_delays_and_grows() -> None:
    stamps, ids = faulty('starve')
    delays = np.diff(of(ids, stamps, 0))
    assert (np.diff(delays) > 0).all()
    assert delays[0] == pytest.approx(1.0 + 0.5 / 20)
    # 14 s after the onset by the undisturbed clock, 14 + 14 * 14 / 40 by ours.
    assert of(ids, stamps, 0)[14] == pytest.approx(20 + 14 + 4.9)
    assert len(of(ids, stamps, 1)) < 20


@pytest.mark.parametrize('seconds', [0.2, -0.2])
def test_a_clock_that_is_off_moves_the_source_against_the_others_and_changes_no_rate(
        seconds: float) -> None:
    stamps, ids = faulty(f'late:/slam:{seconds}')
    assert len(stamps) == len(STAMPS)
    phase = of(ids, stamps, 1) % 1.0
    assert np.median(phase) == pytest.approx(0.5 + seconds)
    assert np.diff(of(ids, stamps, 1)).max() == pytest.approx(1.0)
    assert of(ids, stamps, 0) == pytest.approx(np.arange(20, 40))


@pytest.mark.parametrize('text', [
    'crash', 'crash:', 'crash:/a:1', 'starve:/a', 'slow:/a', 'slow:/a:1', 'slow:/a:nan',
    'slow:/a:-2', 'slow:/a:inf', 'late:/a:0', 'late:/a:nan', 'late:/a:soon', 'melt:/a', ''])
def test_what_is_no_fault_is_refused(text: str) -> None:
    with pytest.raises(ValueError):
        InjectedFault.parse(text)


def test_an_unknown_source_lists_those_there_are() -> None:
    fault = InjectedFault.parse('crash:/slam')
    assert of_known_source(fault, TYPES) == fault
    as_simulate_says_it = InjectedFault.parse('crash:slam')
    assert of_known_source(as_simulate_says_it, TYPES) == fault
    with pytest.raises(ValueError, match='/laser, /slam$'):
        of_known_source(InjectedFault.parse('crash:/motor'), TYPES)
    with pytest.raises(ValueError, match='does not tell sources apart'):
        of_known_source(InjectedFault.parse('crash:/motor'), [EventType('', '/scan', 'T')])


def test_a_fault_that_would_change_nothing_is_refused() -> None:
    with pytest.raises(ValueError, match='nothing would change'):
        inject(InjectedFault.parse('crash:/slam'), TYPES, STAMPS, IDS * 0, ONSET, END)
    with pytest.raises(ValueError, match='shift by less'):
        inject(InjectedFault.parse('late:/slam:19.5'), TYPES, STAMPS, IDS, ONSET, END)


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
