"""When an output of a component sends its messages: by a timer, as an answer, now and then.

All times are in seconds since the robot's start, float64 and ascending.
"""
from __future__ import annotations

from dataclasses import dataclass
from typing import Callable, Optional, Protocol

import numpy as np

from self_awareness_evaluation.families.conditions import in_order
from self_awareness_evaluation.families.scene import LEAD_S, Asked, Scene

_WANDER_PERIODS_S = (3600.0, 8000.0)
_WANDER_STEP_S = 1.0

Heard = Callable[[int], np.ndarray]
"""Returns when the messages of an output, by its index, reach the component [s]."""


class Emission(Protocol):
    """Decides when an output sends.

    `trigger` is the index of the output that it answers to, if any; `activity` is the name of what
    it sends in only, or empty.
    """

    @property
    def trigger(self) -> Optional[int]:
        """See above."""

    @property
    def activity(self) -> str:
        """See above."""

    def times(self, scene: Scene, index: int, heard: Heard) -> np.ndarray:
        """Return when output number `index` sends, before any fault."""


@dataclass(frozen=True)
class Timer:
    """Sends by a timer, whose phase is another one with every start.

    Args:
        period_s: from tick to tick [s].
        jitter_s: standard deviation of the time by which messages come after the tick [s].
        variation: standard deviation of the gaps over the period; they add up. 0: exact ticks.
        ppm: by how many millionths its clock is slow.
        wander: the largest share by which the rate wanders within hours.
        loop: what a stall of the host takes is added to the time of all later ticks.
        activity: sends during this only; empty: always.
    """

    period_s: float
    jitter_s: float = 0.0003
    variation: float = 0.0
    ppm: float = 0.0
    wander: float = 0.0
    loop: bool = False
    activity: str = ''
    trigger: Optional[int] = None

    def times(self, scene: Scene, index: int, heard: Heard) -> np.ndarray:
        """See Emission."""
        ticks = self._ticks(scene, index)
        if self.loop:
            ticks = _halted(ticks, scene)
        late = np.abs(scene.of_recording(f'jitter {index}').normal(0.0, self.jitter_s, len(ticks)))
        sent = in_order(ticks + late * scene.load(ticks))
        return sent[scene.during(self.activity, ticks)]

    def _ticks(self, scene: Scene, index: int) -> np.ndarray:
        period = self.period_s * (1.0 + self.ppm * 1e-6)
        phase = scene.of_start(f'phase {index}').uniform(0.0, period)
        if self.variation:
            rng = scene.of_recording(f'gaps {index}')
            number = int((scene.end - scene.begin) / period * 1.1) + 20
            gaps = period * (1.0 + self.variation * rng.normal(size=number))
            ticks = scene.begin + phase + np.cumsum(np.maximum(gaps, 0.0))
            return ticks[ticks < scene.end]
        if self.wander:
            return self._wandering_ticks(scene, index, phase)
        first, last = np.ceil((np.array([scene.begin, scene.end]) - phase) / period)
        return phase + np.arange(first, last) * period

    def _wandering_ticks(self, scene: Scene, index: int, phase: float) -> np.ndarray:
        rng = scene.of_start(f'wander {index}')
        grid = np.arange(scene.begin, scene.end + 2.0 * _WANDER_STEP_S, _WANDER_STEP_S)
        passed = grid - phase
        # The integral of the relative rate, 1 + the mean of two slow sines.
        for begin, turn in zip(rng.uniform(0.0, 2.0 * np.pi, 2),
                               2.0 * np.pi / rng.uniform(*_WANDER_PERIODS_S, 2)):
            passed -= self.wander / 2.0 * (np.cos(turn * grid + begin) - np.cos(begin)) / turn
        counts = np.arange(np.ceil(passed[0] / self.period_s), passed[-1] / self.period_s)
        ticks = np.interp(counts * self.period_s, passed, grid)
        return ticks[ticks < scene.end]


@dataclass(frozen=True)
class TwoRates:
    """Sends by one timer during an activity, and by another one otherwise."""

    during: Timer
    otherwise: Timer
    activity_of_rates: str
    activity: str = ''
    trigger: Optional[int] = None

    def times(self, scene: Scene, index: int, heard: Heard) -> np.ndarray:
        """See Emission."""
        during, otherwise = (timer.times(scene, index, heard)
                             for timer in (self.during, self.otherwise))
        return np.sort(np.concatenate([
            during[scene.during(self.activity_of_rates, during)],
            otherwise[~scene.during(self.activity_of_rates, otherwise)]]))


@dataclass(frozen=True)
class Answer:
    """Sends some time after a message that the component hears.

    Args:
        trigger: index of the output that it answers to, one before its own.
        delay_s: median time that the answer takes [s].
        spread: standard deviation of the logarithm of that time.
        every: only every so many messages are answered.
        share: of the messages that are answered, 0 < share <= 1.
        activity: answers during this only; empty: always.
    """

    trigger: int
    delay_s: float
    spread: float = 0.1
    every: int = 1
    share: float = 1.0
    activity: str = ''

    def times(self, scene: Scene, index: int, heard: Heard) -> np.ndarray:
        """See Emission."""
        inputs = heard(self.trigger)
        chosen = scene.during(self.activity, inputs)
        chosen &= np.arange(len(inputs)) % self.every == 0
        chosen &= scene.of_recording(f'share {index}').uniform(size=len(inputs)) < self.share
        # A delay for every message, so that a fault does not change those of earlier ones.
        noise = scene.of_recording(f'delay {index}').normal(size=len(inputs))[chosen]
        inputs = inputs[chosen]
        delays = self.delay_s * np.exp(self.spread * noise) * scene.load(inputs)
        scene.asked[index] = Asked(inputs, in_order(inputs + delays))
        return scene.asked[index].answered


@dataclass(frozen=True)
class Feedback:
    """Sends while the component works on an answer, as an action server does.

    Args:
        result: index of the output with the answers, one before its own and of the same component.
        period_s: from message to message [s].
    """

    result: int
    period_s: float
    activity: str = ''
    trigger: Optional[int] = None

    def times(self, scene: Scene, index: int, heard: Heard) -> np.ndarray:
        """See Emission."""
        asked, answered = scene.asked[self.result]
        number = np.floor((answered - asked) / self.period_s).astype(np.int64)
        of_task = np.repeat(np.arange(len(asked)), number)
        nth = np.arange(len(of_task)) - np.repeat(np.cumsum(number) - number, number) + 1
        times = asked[of_task] + nth * self.period_s
        return np.sort(times)


@dataclass(frozen=True)
class Sporadic:
    """Sends when something happens: gaps are exponentially distributed.

    Args:
        gap_s: their mean [s].
        activity: sends during this only; empty: always.
    """

    gap_s: float
    activity: str = ''
    trigger: Optional[int] = None

    def times(self, scene: Scene, index: int, heard: Heard) -> np.ndarray:
        """See Emission."""
        rng = scene.of_recording(f'gaps {index}')
        number = rng.poisson((scene.end - scene.begin) / self.gap_s)
        times = np.sort(rng.uniform(scene.begin, scene.end, number))
        return times[scene.during(self.activity, times)]


@dataclass(frozen=True)
class Once:
    """Sends once, some seconds after the recording begins: what is latched."""

    activity: str = ''
    trigger: Optional[int] = None

    def times(self, scene: Scene, index: int, heard: Heard) -> np.ndarray:
        """See Emission."""
        return scene.begin + LEAD_S + scene.of_recording(f'once {index}').uniform(0.5, 3.0, 1)


def stalled(times: np.ndarray, scene: Scene) -> np.ndarray:
    """Return times at which what was to happen in a stall comes right after it."""
    moved = times.copy()
    for begin, length in zip(*scene.stalls()):
        hit = (moved >= begin) & (moved < begin + length)
        moved[hit] = begin + length + (moved[hit] - begin) * 1e-3
    return in_order(moved)


def _halted(ticks: np.ndarray, scene: Scene) -> np.ndarray:
    """Return the ticks of a loop, whose time stands still in a stall."""
    begins, lengths = scene.stalls()
    before = np.concatenate([[0.0], np.cumsum(lengths)])
    return ticks + before[np.searchsorted(begins - before[:-1], ticks, side='right')]
