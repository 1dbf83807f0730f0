"""What the injected faults do to stamps and ids."""
from __future__ import annotations

from typing import Tuple

import numpy as np
import pytest

from self_awareness import EventType
from self_awareness.calibration.fault_injection import InjectedFault, inject, of_known_source

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


def test_the_recording_given_is_left_alone() -> None:
    stamps, ids = STAMPS.copy(), IDS.copy()
    for text in ('crash:/laser', 'slow:/slam:2', 'starve', 'late:/slam:1'):
        faulty(text)
    assert (stamps == STAMPS).all() and (ids == IDS).all()


@pytest.mark.parametrize('text', [
    'crash', 'crash:', 'crash:/a:1', 'starve:/a', 'slow:/a', 'slow:/a:1', 'slow:/a:nan',
    'slow:/a:-2', 'slow:/a:inf', 'late:/a:0', 'late:/a:nan', 'late:/a:soon', 'melt:/a', ''])
def test_what_is_no_fault_is_refused(text: str) -> None:
    with pytest.raises(ValueError):
        InjectedFault.parse(text)


@pytest.mark.parametrize('text', ['crash:/a', 'slow:/a:2.5', 'starve', 'late:/a:-0.5'])
def test_a_fault_is_written_as_it_is_read(text: str) -> None:
    assert str(InjectedFault.parse(text)) == text


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
