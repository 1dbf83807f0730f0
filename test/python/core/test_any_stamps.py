"""Whatever stamps a recording has, the core counts and judges what the literal ones do."""
from __future__ import annotations

import math
import pickle
from pathlib import Path
from typing import Dict, List, Sequence, Tuple

import numpy as np
import pytest
from any_stamps import LEFT_OUT, LETTERS, MS, SECOND, Event, long_recordings, pieces, recordings
from hypothesis import assume, given, reject, settings
from hypothesis import strategies as st
from reference import Reference
from reference_evidence import BINS, Counts, is_mode, lower_edge, stalls_of

from self_awareness import (Calibrator, DetectorParameters, EventType, EvidenceModel, Learner,
                            PaperModel, TrainedModel, Verdicts)

WINDOW = 100 * MS
BIN = 10 * MS
SETTLE = 5 * SECOND
THRESHOLD = 0.4
MODES = {'C': 'x', 'D': 'y'}
"""What tells a mode in place of an event type."""
KINDS = [*LETTERS, *MODES.values()]
TYPES = [EventType('', f'/{kind}', f'[mode: {kind}]' if is_mode(kind) else '') for kind in KINDS]
SEVERAL = st.lists(recordings(), min_size=1, max_size=3)
MUCH = st.lists(long_recordings(), min_size=1, max_size=2)
"""Enough for something to be watched."""

# The same examples in every run: a test that fails does so for everybody.
examples = settings(max_examples=30, deadline=None, derandomize=True, database=None,
                    suppress_health_check=LEFT_OUT)


def arrays(events: Sequence[Event]) -> Tuple[np.ndarray, np.ndarray]:
    """Return stamps, and ids of TYPES."""
    return (np.array([stamp for stamp, _ in events]),
            np.array([KINDS.index(kind) for _, kind in events]))


def trained_on(all_events: Sequence[Sequence[Event]]) -> TrainedModel:
    """Train both detectors on recordings."""
    learner = Learner(window=WINDOW, bin_size=BIN, paper=True)
    for events in all_events:
        learner.count(TYPES, *arrays(events), 0)
    return learner.model()


def ids_of(trained: TrainedModel) -> Dict[str, int]:
    """Return the model's ids by letter."""
    return {kind.scope[1:]: index for index, kind in enumerate(trained.event_types)}


def judged(trained: TrainedModel, events: Sequence[Event]) -> Verdicts:
    """Judge a recording by the paper's detector."""
    ids = ids_of(trained)
    return PaperModel(trained).judge(WINDOW, THRESHOLD, DetectorParameters(), arrays(events)[0],
                                     np.array([ids.get(kind, len(ids)) for _, kind in events]))


def evidence_of(trained: TrainedModel, events: Sequence[Event]) -> np.ndarray:
    """Return the evidence of a recording."""
    ids = ids_of(trained)
    return EvidenceModel(trained).evidence(
        WINDOW, arrays(events)[0], np.array([ids.get(kind, len(ids)) for _, kind in events]))


@examples
@given(SEVERAL)
def test_the_counts_of_evidence_are_the_literal_ones(all_events: List[List[Event]]) -> None:
    check_counts(all_events)


@examples
@given(SEVERAL)
def test_modes_count_by_their_literal_ticks(all_events: List[List[Event]]) -> None:
    assume(all(len(pieces(events)) == 1 for events in all_events))  # else it lasts on
    check_counts([[(stamp, MODES.get(kind, kind)) for stamp, kind in events]
                  for events in all_events])


def check_counts(all_events: List[List[Event]]) -> None:
    """Compare the counts of recordings with the literal ones."""
    trained = trained_on(all_events)
    ids = ids_of(trained)
    parts = [piece for events in all_events for piece in pieces(events)]
    reference = Counts(parts, list(ids), WINDOW,
                       [stalls for events in all_events for stalls in stalls_of(pieces(events))])
    found = EvidenceModel.of_all_pairs(trained)
    assert found.duration == sum(seen.end - seen.start for seen in reference.recordings)
    for i in ids:
        assert found.events(ids[i]) == sum(seen.events[i] for seen in reference.recordings)
        counts = [0] if is_mode(i) else reference.rates[i] or [0]
        mean = sum(counts) / len(counts)
        assert found.rate_variance(ids[i]) == pytest.approx(
            sum(n * n for n in counts) / len(counts) - mean * mean, abs=1e-9)
        for j in ids:
            delays = reference.delays[i, j]
            assert found.delay_count(ids[i], ids[j]) == len(delays)
            assert [count for _, count in found.delays(ids[i], ids[j])] == [
                delays.count(index) for index in range(BINS)]
            for share in (0.5, 0.9, 1.0):
                assert found.usual_delay(ids[i], ids[j], share) == pytest.approx(
                    reference.usual_delay(i, j, share), abs=1e-9)
    assert [edge for edge, _ in found.delays(0, 0)] == [lower_edge(k) for k in range(BINS)]


@examples
@given(SEVERAL, recordings())
def test_the_papers_scores_are_the_literal_ones(all_events: List[List[Event]],
                                                events: List[Event]) -> None:
    trained = trained_on(all_events)
    reference = Reference([piece for part in all_events for piece in pieces(part)], BIN)
    expected: List[Tuple[int, int, int, float]] = []
    parts = pieces(events)
    for piece in parts:
        scores, newest = reference.event_scores(piece), -1
        windows: Dict[int, List[int]] = {}
        for n, (stamp, _) in enumerate(piece):
            newest = max(newest, stamp // WINDOW)  # what comes late counts in the open window
            windows.setdefault(newest, []).append(n)
        for window in range(piece[0][0] // WINDOW, newest + (piece is parts[-1])):
            inside = windows.get(window, [])
            expected.append((
                window * WINDOW, len(inside),
                sum(piece[n][1] not in reference.types for n in inside),
                math.fsum(scores[n] for n in inside) / len(inside) if inside else math.nan))
    found = judged(trained, events)
    assert list(zip(found.start.tolist(), found.events.tolist(), found.unknown.tolist())) == [
        row[:3] for row in expected]
    assert found.score == pytest.approx([row[3] for row in expected], abs=1e-12, nan_ok=True)
    assert found.abnormal.tolist() == [
        (0.0 if math.isnan(row[3]) else row[3]) < THRESHOLD for row in expected]


@examples
@given(MUCH, long_recordings())
def test_saving_and_loading_changes_no_bit(tmp_path: Path, all_events: List[List[Event]],
                                           events: List[Event]) -> None:
    trained = trained_on(all_events)
    trained.save(str(tmp_path / 'model'))
    for again in (TrainedModel.load(str(tmp_path / 'model')),
                  pickle.loads(pickle.dumps(trained))):
        assert pickle.dumps(again) == pickle.dumps(trained)
        assert judged(again, events).score.tobytes() == judged(trained, events).score.tobytes()
        assert evidence_of(again, events).tobytes() == evidence_of(trained, events).tobytes()
    watched = TrainedModel.load(str(tmp_path / 'model'), watched_only=True)
    assert evidence_of(watched, events).tobytes() == evidence_of(trained, events).tobytes()


@examples
@given(MUCH, long_recordings())
def test_evidence_is_a_number_that_does_not_depend_on_what_was_before_the_clock_was_set(
        all_events: List[List[Event]], events: List[Event]) -> None:
    trained = trained_on(all_events)
    found = evidence_of(trained, events)
    assert np.isfinite(found).all()
    last = pieces(events)[-1]
    alone = evidence_of(trained, last)
    assert found[len(found) - len(alone):].tobytes() == alone.tobytes()


@examples
@given(MUCH, MUCH)
def test_limits_are_numbers(all_events: List[List[Event]], normal: List[List[Event]]) -> None:
    trained = trained_on(all_events)
    assume(len(EvidenceModel(trained).tracks))
    calibrator = Calibrator(trained, SETTLE)
    ids = ids_of(trained)
    for events in normal:
        calibrator.add(arrays(events)[0],
                       np.array([ids.get(kind, len(ids)) for _, kind in events]))
    try:
        found = calibrator.find(0.5)
    except ValueError as refused:
        assert 'too little normal operation' in str(refused)
        reject()
    # Not a number: the track is not judged.
    assert all(math.isnan(limit) or limit > 0.0 for limit in found.limits)
    assert 0.0 <= found.false_alarms_per_hour < math.inf
    assert 0 <= found.windows <= sum(
        (piece[-1][0] - piece[0][0]) // WINDOW + 2 for events in normal
        for piece in pieces(events))
