"""Whatever stamps a recording has, the core counts and judges what the literal ones do.

Recordings are drawn at random, with stamps that robots give only once in a long time.
"""
from __future__ import annotations

import itertools
import math
from dataclasses import replace
from typing import Any, Callable, Dict, List, Optional, Sequence, Tuple

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, reject, settings
from hypothesis import strategies as st
from reference import Event, Reference
from reference_evidence import BINS, MS, SECOND, Counts, is_mode, lower_edge, stalls_of

from self_awareness import (Calibrator, DetectorParameters, EventType, EvidenceModel, Learner,
                            PaperModel, TrainedModel)
from self_awareness.recordings import RecordingEvents

HOUR = 3600 * SECOND
DAY = 24 * HOUR
END_OF_TIME = 2 ** 32 * SECOND  # ROS time has 32 bits for its seconds: until 2106
LETTERS = 'ABCD'

_BEGINNINGS = (0, 1, 1_600_000_000 * SECOND, 2 ** 31 * SECOND - 2 * SECOND,
               END_OF_TIME - 20 * SECOND, END_OF_TIME - 1)
_STEPS = (0, 0, 0, 1, MS, 7 * MS, 10 * MS, 33 * MS, 99 * MS, 100 * MS, 100 * MS, 250 * MS,
          2 * SECOND, 20 * SECOND)
_LATE = (-1, -MS, -100 * MS)
_CLOCK_SET = (-100 * MS - 1, -SECOND, -HOUR, -9 * DAY, HOUR + 1, DAY, 400 * DAY)

WINDOW = 100 * MS
BIN = 10 * MS
SETTLE = 5 * SECOND
THRESHOLD = 0.4
MODES = {'C': 'x', 'D': 'y'}  # what tells a mode in place of an event type
KINDS = [*LETTERS, *MODES.values()]
TYPES = [EventType('', f'/{kind}', f'[mode: {kind}]' if is_mode(kind) else '') for kind in KINDS]


@st.composite
def recordings(draw: Callable[..., Any], longest: int = 40) -> List[Event]:
    """Return one recording: its events in the order in which they came, 1 at least."""
    letters = LETTERS[:draw(st.integers(1, len(LETTERS)))]
    steps = draw(st.sampled_from([_STEPS, _STEPS + _LATE, 4 * _STEPS + 2 * _LATE + _CLOCK_SET]))
    stamp = draw(st.one_of(st.sampled_from(_BEGINNINGS), st.integers(0, END_OF_TIME - 1)))
    events = []
    for step, letter in draw(st.lists(
            st.tuples(st.sampled_from(steps), st.sampled_from(letters)), min_size=1,
            max_size=longest)):
        # Where time ends, a clock can only be set back.
        stamp = min(max(stamp + step, 0), END_OF_TIME - 1)
        events.append((stamp, letter))
    return events


@st.composite
def long_recordings(draw: Callable[..., Any]) -> List[Event]:
    """Return a recording of minutes, so that much is watched: a motif again and again, with
    strange steps here and there.
    """
    motif = draw(st.lists(st.tuples(st.sampled_from(_STEPS), st.sampled_from(LETTERS)),
                          max_size=5))
    motif.append((draw(st.sampled_from([250 * MS, 2 * SECOND])), LETTERS[0]))
    strange = draw(st.dictionaries(st.integers(0, 400),
                                   st.sampled_from(_STEPS + _LATE + _CLOCK_SET), max_size=6))
    stamp = draw(st.sampled_from(_BEGINNINGS))
    events = []
    for number in range(len(motif) * draw(st.integers(60, 120))):
        step, letter = motif[number % len(motif)]
        stamp = min(max(stamp + strange.get(number, step), 0), END_OF_TIME - 1)
        events.append((stamp, letter))
    return events


SEVERAL = st.lists(recordings(), min_size=1, max_size=3)
MUCH = st.lists(long_recordings(), min_size=1, max_size=2)  # enough for something to be watched

# The same examples in every run: a test that fails does so for everybody.
examples = settings(max_examples=30, deadline=None, derandomize=True, database=None,
                    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])


def pieces(events: Sequence[Event]) -> List[List[Event]]:
    """Cut a recording where the clock was set (docs/method.md, section 1.2), literally."""
    found = [[events[0]]]
    for before, event in zip(events, events[1:]):
        if event[0] < before[0] - 100 * MS or event[0] > before[0] + HOUR:
            found.append([])
        found[-1].append(event)
    return found


def arrays(events: Sequence[Event], trained: Optional[TrainedModel] = None) -> RecordingEvents:
    """Return a recording by ids of TYPES, or of a model."""
    ids = {kind: index for index, kind in enumerate(KINDS)} if trained is None else ids_of(trained)
    return RecordingEvents([] if trained else TYPES, np.array([stamp for stamp, _ in events]),
                           np.array([ids.get(kind, len(ids)) for _, kind in events]))


def trained_on(all_events: Sequence[Sequence[Event]], window: int = WINDOW, bin_size: int = BIN,
               horizon_bins: int = 0) -> TrainedModel:
    """Train both detectors on recordings."""
    learner = Learner(window=window, bin_size=bin_size, horizon_bins=horizon_bins, paper=True)
    for events in all_events:
        learner.count(arrays(events))
    return learner.model()


def ids_of(trained: TrainedModel) -> Dict[str, int]:
    """Return the model's ids by letter."""
    return {kind.scope[1:]: index for index, kind in enumerate(trained.event_types)}


def evidence_of(trained: TrainedModel, events: Sequence[Event]) -> np.ndarray:
    """Return the evidence of a recording."""
    of_model = arrays(events, trained)
    return EvidenceModel(trained).evidence(WINDOW, of_model.stamps, of_model.ids)


@examples
@given(SEVERAL, st.booleans())
def test_the_counts_of_evidence_are_the_literal_ones(all_events: List[List[Event]],
                                                     with_modes: bool) -> None:
    """Modes count by their ticks."""
    if with_modes:
        assume(all(len(pieces(events)) == 1 for events in all_events))  # else it lasts on
        all_events = [[(stamp, MODES.get(kind, kind)) for stamp, kind in events]
                      for events in all_events]
    trained = trained_on(all_events)
    ids = ids_of(trained)
    parts = [piece for events in all_events for piece in pieces(events)]
    reference = Counts(parts, list(ids), WINDOW, [stalls for events in all_events
                                                  for stalls in stalls_of(pieces(events))])
    found = EvidenceModel.of_all_pairs(trained)
    assert found.duration == sum(max(t for t, _ in part) - part[0][0] for part in parts)
    for i in ids:
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


@settings(examples, max_examples=60)
@given(SEVERAL, recordings(), st.sampled_from([1 * MS, 5 * MS, BIN, 30 * MS]),
       st.sampled_from([0, 0, 1, 8]), st.sampled_from([20 * MS, WINDOW]))
def test_the_papers_scores_are_the_literal_ones(
        all_events: List[List[Event]], events: List[Event], bin_size: int, horizon_bins: int,
        window_ns: int) -> None:
    trained = trained_on(all_events, window_ns, bin_size, horizon_bins)
    reference = Reference([piece for part in all_events for piece in pieces(part)], bin_size,
                          horizon_bins)
    model, ids = PaperModel(trained), ids_of(trained)
    assert sorted(ids) == reference.types
    for i, j in itertools.product(ids, ids):
        assert trained.histogram(ids[i], ids[j]) == dict(reference.counts[i, j])
        assert model.weight(ids[i], ids[j]) == pytest.approx(
            reference.weight(i, j, reference.types), abs=1e-12)
    expected: List[Tuple[int, int, int, float]] = []
    parts = pieces(events)
    for piece in parts:
        scores, newest = reference.event_scores(piece), -1
        windows: Dict[int, List[int]] = {}
        for n, (stamp, _) in enumerate(piece):
            newest = max(newest, stamp // window_ns)  # what comes late counts in the open window
            windows.setdefault(newest, []).append(n)
        for window in range(piece[0][0] // window_ns, newest + (piece is parts[-1])):
            inside = windows.get(window, [])
            expected.append((
                window * window_ns, len(inside),
                sum(piece[n][1] not in reference.types for n in inside),
                math.fsum(scores[n] for n in inside) / len(inside) if inside else math.nan))
    found = model.judge(window_ns, THRESHOLD, DetectorParameters(), arrays(events, trained))
    assert list(zip(found.start.tolist(), found.events.tolist(), found.unknown.tolist())) == [
        row[:3] for row in expected]
    assert found.score == pytest.approx([row[3] for row in expected], abs=1e-12, nan_ok=True)
    assert found.abnormal.tolist() == [
        (0.0 if math.isnan(row[3]) else row[3]) < THRESHOLD for row in expected]


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
    for events in normal:
        calibrator.add(arrays(events, trained))
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


def test_a_part_of_a_wrong_type_is_named() -> None:
    with pytest.raises(TypeError, match='fingerprint'):
        Learner().count(replace(arrays([(0, 'A')]), fingerprint='a'))
