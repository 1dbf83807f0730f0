"""Channels and scorer against a literal, slow implementation, on random recordings.

What is watched, and the limits, are the package's: test_method_version.py and the measured pages
hold those.
"""
from __future__ import annotations

import math
import random
from typing import Dict, List, Tuple

import numpy as np
import pytest
from reference_evidence import LABELS, LEAST_EFFECT, Counts, Event, ReferenceModel, is_mode
from reference_scorer import ReferenceScorer

from self_awareness import EventType, EvidenceModel, Learner, TrainedModel, Tuning
from self_awareness.recordings import RecordingEvents
from self_awareness.stamps import SECOND_NS

MS = 1_000_000
WINDOW = 100 * MS
LETTERS = 'ABCDEFGHIJKLxy'
SEED = 1
OUTAGE_S = 0.8


def robot(chance: random.Random, seconds: float, fault_s: float = math.inf,
          until_s: float = math.inf, outage_s: float = OUTAGE_S) -> List[Event]:
    """A trigger, two that answer it, a timer, an irregular one, requests, one that is rare, two
    that pause together, and one that pauses while a mode lasts, which is told when it begins.

    While the fault lasts, the answers come later and often not at all, requests get none, the
    timer comes often, the irregular one is gone for a while, one of those that pause together and
    the one of the mode are gone, and something unknown comes. Once, the whole robot is silent.
    Some stamps are equal, some late.
    """
    start = chance.randrange(10 ** 15)
    stall_s = chance.uniform(0.4, 0.6) * seconds
    found: List[Tuple[float, int, str]] = []

    def put(at: float, kind: str, late: float = 0.0) -> None:
        if stall_s <= at < stall_s + outage_s:
            at, late = stall_s + outage_s, 0.0
        stamp = start + round((at - late) * 1000) * MS
        found.append((at, stamp, kind))

    at = chance.uniform(0.0, 0.2)
    while at < seconds:
        faulty = fault_s <= at < until_s
        put(at, 'A', chance.choice([0.0, 0.0, 0.0, 0.003]))
        if not faulty or chance.random() < 0.4:
            answer = at + chance.choice([0.02, 0.025, 0.03]) + 0.045 * faulty
            put(answer, 'B')
            if chance.random() < 0.7:
                put(answer + chance.choice([0.0, 0.006]), 'C')
        at += 0.001 if chance.random() < 0.05 else chance.uniform(0.05, 0.6)
    for kind, gap in (('D', 0.7), ('E', 0.25), ('F', 4.0), ('G', 2.0), ('H', 20.0)):
        at = chance.uniform(0.0, gap)
        while at < seconds:
            faulty = fault_s <= at < until_s
            gone = kind == 'E' and fault_s <= at < fault_s + 10.0
            if not gone and (kind != 'G' or faulty):
                put(at, kind)
                if kind == 'F' and not faulty:
                    put(at + chance.uniform(0.4, 0.5), 'I')
            often = 4.0 if kind == 'D' and faulty else 1.0
            spread = 0.1 if kind == 'D' else 0.8
            at += gap / often * chance.uniform(1.0 - spread, 1.0 + spread)
    for kind, gap in (('J', 0.4), ('K', 0.3)):
        for step in range(round(seconds / gap)):
            at = gap * (step + chance.random())
            if at % 14.0 < 8.0 and not (kind == 'J' and fault_s <= at < until_s):
                put(at, kind)
    for step in range(round(seconds / 0.25)):
        at = 0.25 * (step + 0.1 * (step * 7 % 5))
        if at % 24.0 < 8.0 and not fault_s <= at < until_s:
            put(at, 'L')
    for step in range(round(seconds / 24.0) + 1):
        for at, kind in ((24.0 * step, 'x'), (24.0 * step + 8.0, 'y'), (24.0 * step + 9.5, 'y')):
            if at < seconds:
                put(at, kind)
    return [(stamp, kind) for _, stamp, kind in sorted(found)]


def held_back(events: List[Event], chance: random.Random, after_s: float) -> List[Event]:
    """Let the whole robot stand still for a moment; what waited comes when that is over."""
    start = next(t for t, _ in events if t >= events[0][0] + after_s * SECOND_NS)
    end = start + chance.randrange(550, 650) * MS
    return sorted(((end if start < t < end else t, kind) for t, kind in events),
                  key=lambda event: event[0])


class Robot:
    """A robot that both the core and the reference have learned from."""

    def __init__(self, seed: int, least_effect: float = LEAST_EFFECT,
                 outage_s: float = OUTAGE_S) -> None:
        self.chance = random.Random(seed)
        self.halves = [[robot(self.chance, seconds, outage_s=outage_s)]
                       for seconds in (90.0, 80.0)]
        everything = self.halves[0] + self.halves[1]
        types = list(dict.fromkeys(kind for events in everything for _, kind in events))
        first, second, both = (Counts(recordings, types, WINDOW)
                               for recordings in (*self.halves, everything))
        trained = self._trained(everything, least_effect)
        self.model = EvidenceModel(trained)
        self.ids: Dict[str, int] = {
            kind.scope: index for index, kind in enumerate(trained.event_types)}
        assert list(self.ids) == types
        tracks = [(track.name, types[track.to_id], types[track.from_id])
                  for track in self.model.tracks]
        self.reference = ReferenceModel(tracks, first, second, both, least_effect)

    @staticmethod
    def _trained(recordings: List[List[Event]], least_effect: float) -> TrainedModel:
        tuning = Tuning()
        tuning.set('least_effect', least_effect / SECOND_NS)
        learner = Learner(tuning, window=WINDOW, paper=True)
        every_type = [EventType('', letter, f'[mode: {letter}]' if is_mode(letter) else '')
                      for letter in LETTERS]
        for half, events in enumerate(recordings):
            learner.count(RecordingEvents(
                every_type, np.array([t for t, _ in events]),
                np.array([LETTERS.index(kind) for _, kind in events]), fingerprint=half))
        return learner.model()

    def arrays(self, events: List[Event]) -> Tuple[np.ndarray, np.ndarray]:
        """Return stamps and ids."""
        return (np.array([t for t, _ in events]),
                np.array([self.ids.get(kind, len(self.ids)) for _, kind in events]))


@pytest.fixture(name='learned', scope='module')
def _learned() -> Robot:
    learned = Robot(SEED)
    assert learned.reference.both.longest_stall >= OUTAGE_S * SECOND_NS
    return learned


def test_every_channel_watches_something(learned: Robot) -> None:
    tracks = learned.reference.tracks
    assert {channel for channel, _, _ in tracks} == set(LABELS)
    assert [track.channel for track in learned.model.tracks] == [
        LABELS[channel] for channel, _, _ in tracks]
    assert ('company', 'L', 'x') in tracks
    assert {channel for channel, _, other in tracks if is_mode(other)} == {'company'}


@pytest.mark.parametrize('fault_s', [math.inf, 25.0])
def test_the_evidence_of_all_channels(learned: Robot, fault_s: float) -> None:
    events = robot(random.Random(str(fault_s)), 100.0, fault_s)
    expected = ReferenceScorer(learned.reference, events, WINDOW).rows
    found = learned.model.evidence(WINDOW, *learned.arrays(events))
    assert found.shape == (len(expected), len(learned.reference.tracks))
    np.testing.assert_allclose(found, np.array(expected), rtol=0.0, atol=1e-9)
    if fault_s < math.inf:
        largest = found.max(axis=0)
        for channel in LABELS:
            assert max(value for value, track in zip(largest, learned.reference.tracks)
                       if track[0] == channel) > 3.0, channel
        assert largest[learned.reference.tracks.index(('company', 'L', 'x'))] > 6.0


def test_the_evidence_with_other_least_effects() -> None:
    events = robot(random.Random(5), 60.0, 25.0)
    pairs = []
    for least_effect in (1e6, 100e6):
        learned = Robot(SEED, least_effect)
        expected = np.array(ReferenceScorer(learned.reference, events, WINDOW).rows)
        found = learned.model.evidence(WINDOW, *learned.arrays(events))
        np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-9)
        pairs.append(found[:, [LABELS[track[0]] == 'pairs'
                               for track in learned.reference.tracks]])
    little, much = pairs
    assert (little >= much).mean() > 0.9 and little.sum() > 1.5 * much.sum()


def test_the_evidence_with_limits(learned: Robot) -> None:
    events = robot(random.Random(7), 240.0, 40.0, 130.0)
    model = learned.reference
    limits = [1.2 * model.least_limit(track) for track in model.tracks]
    pairs = [index for index, track in enumerate(model.tracks) if LABELS[track[0]] == 'pairs']
    limits[pairs[-1]] = math.nan
    expected = ReferenceScorer(model, events, WINDOW, limits)
    found = learned.model.evidence(WINDOW, *learned.arrays(events), limits)
    np.testing.assert_allclose(found, np.array(expected.rows), rtol=0.0, atol=1e-9)
    assert expected.failed > 0
    sums = [(largest, limit) for largest, limit, track in zip(found.max(axis=0), limits,
                                                              model.tracks)
            if LABELS[track[0]] == 'pairs' and not math.isnan(limit)]
    assert any(largest == pytest.approx(1.5 * limit) for largest, limit in sums)
    assert all(largest <= 1.5 * limit + 1e-9 for largest, limit in sums)


def test_limits_of_other_tracks_are_refused(learned: Robot) -> None:
    stamps, ids = learned.arrays(learned.halves[0][0])
    with pytest.raises(ValueError, match='one of each track'):
        learned.model.evidence(WINDOW, stamps, ids, [1.0])


@pytest.mark.parametrize('fault_s', [math.inf, 30.0])
def test_the_evidence_around_stalls(fault_s: float) -> None:
    learned = Robot(3, outage_s=0.0)
    chance = random.Random(str(fault_s))
    events = robot(chance, 90.0, fault_s, outage_s=0.0)
    for after_s in (12.0, 20.0, 46.0, 80.0):  # the second one comes too soon after the first
        events = held_back(events, chance, after_s)
    expected = ReferenceScorer(learned.reference, events, WINDOW)
    assert expected.stalls == 3
    found = learned.model.evidence(WINDOW, *learned.arrays(events))
    np.testing.assert_allclose(found, np.array(expected.rows), rtol=0.0, atol=1e-9)
