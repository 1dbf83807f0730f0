"""What an output of a component sends: when, by a timer, as an answer or now and then, and what.

All times are in seconds since the robot's start, float64 and ascending."""
from __future__ import annotations

import zlib
from dataclasses import dataclass, field
from typing import Callable, Optional

import numpy as np

from self_awareness import pack_attributes
from self_awareness_evaluation.families.scene import LEAD_S, Scene, in_order

_WANDER_PERIODS_S = (3600.0, 8000.0)
_WANDER_STEP_S = 1.0

# Of the messages.
_HEADERS = 0.7  # share of the outputs whose messages have a header
_VARYING = 0.4  # of those whose sizes vary
_REPEATING = 0.3  # of those that repeat themselves
_PROCESSED_S = (0.001, 0.08)  # how old stamps are
_BYTES = (20.0, 1e6)
_JITTER = 0.2  # standard deviation of the logarithm of an age
_MOST_SPREAD = 0.5  # the same of sizes that vary
_HELD_S = (0.2, 60.0)  # mean time with the same content, of those that repeat themselves

# Returns when the messages of an output, by its index, reach the component [s].
Heard = Callable[[int], np.ndarray]


class Emission:
    """Decides when an output sends."""

    trigger: Optional[int] = None  # index of the output that it answers to
    activity: str = ''  # name of what it sends in only; empty: it always sends

    def times(self, scene: Scene, index: int, heard: Heard) -> np.ndarray:
        """Return when output number `index` sends, before any fault."""
        raise NotImplementedError


@dataclass(frozen=True)
class Timer(Emission):
    """Sends by a timer, whose phase is another one with every start."""

    period_s: float = 1.0  # from tick to tick [s]
    jitter_s: float = 0.0003  # standard deviation of the time from the tick to the message
    variation: float = 0.0  # that of the gaps over the period; they add up. 0: exact ticks
    ppm: float = 0.0  # by how many millionths its clock is slow
    wander: float = 0.0  # the largest share by which the rate wanders within hours
    loop: bool = False  # what a stall of the host takes is added to the time of all later ticks
    activity: str = ''

    def times(self, scene: Scene, index: int, heard: Heard) -> np.ndarray:
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
class TwoRates(Emission):
    """Sends by one timer during an activity, and by another one otherwise."""

    during: Timer
    otherwise: Timer
    activity_of_rates: str

    def times(self, scene: Scene, index: int, heard: Heard) -> np.ndarray:
        during, otherwise = (timer.times(scene, index, heard)
                             for timer in (self.during, self.otherwise))
        return np.sort(np.concatenate([
            during[scene.during(self.activity_of_rates, during)],
            otherwise[~scene.during(self.activity_of_rates, otherwise)]]))


@dataclass(frozen=True)
class Answer(Emission):
    """Sends some time after a message that the component hears."""

    trigger: int = field()  # without the default of Emission; one before its own
    delay_s: float  # median time that the answer takes [s]
    spread: float = 0.1  # standard deviation of the logarithm of that time
    every: int = 1  # only every so many messages are answered
    share: float = 1.0  # of the messages that are answered, 0 < share <= 1
    activity: str = ''

    def times(self, scene: Scene, index: int, heard: Heard) -> np.ndarray:
        inputs = heard(self.trigger)
        chosen = scene.during(self.activity, inputs)
        chosen &= np.arange(len(inputs)) % self.every == 0
        chosen &= scene.of_recording(f'share {index}').uniform(size=len(inputs)) < self.share
        # A delay for every message, so that a fault does not change those of earlier ones.
        noise = scene.of_recording(f'delay {index}').normal(size=len(inputs))[chosen]
        inputs = inputs[chosen]
        delays = self.delay_s * np.exp(self.spread * noise) * scene.load(inputs)
        answered = in_order(inputs + delays)
        scene.answers[index] = inputs, answered
        return answered


@dataclass(frozen=True)
class Feedback(Emission):
    """Sends while the component works on an answer, as an action server does."""

    result: int  # index of the output with the answers, one before its own, of the same component
    period_s: float  # from message to message [s]

    def times(self, scene: Scene, index: int, heard: Heard) -> np.ndarray:
        asked, answered = scene.answers[self.result]
        number = np.floor((answered - asked) / self.period_s).astype(np.int64)
        of_task = np.repeat(np.arange(len(asked)), number)
        nth = np.arange(len(of_task)) - np.repeat(np.cumsum(number) - number, number) + 1
        return np.sort(asked[of_task] + nth * self.period_s)


@dataclass(frozen=True)
class Sporadic(Emission):
    """Sends when something happens: gaps are exponentially distributed."""

    gap_s: float  # the mean
    activity: str = ''

    def times(self, scene: Scene, index: int, heard: Heard) -> np.ndarray:
        rng = scene.of_recording(f'gaps {index}')
        number = rng.poisson((scene.end - scene.begin) / self.gap_s)
        times = np.sort(rng.uniform(scene.begin, scene.end, number))
        return times[scene.during(self.activity, times)]


@dataclass(frozen=True)
class Once(Emission):
    """Sends once, some seconds after the recording begins: what is latched."""

    def times(self, scene: Scene, index: int, heard: Heard) -> np.ndarray:
        return scene.begin + LEAD_S + scene.of_recording(f'once {index}').uniform(0.5, 3.0, 1)


def stalled(times: np.ndarray, scene: Scene) -> np.ndarray:
    """Return times at which what was to happen in a stall comes right after it."""
    moved = times.copy()
    for begin, length in zip(*scene.stalls):
        hit = (moved >= begin) & (moved < begin + length)
        moved[hit] = begin + length + (moved[hit] - begin) * 1e-3
    return in_order(moved)


def _halted(ticks: np.ndarray, scene: Scene) -> np.ndarray:
    """Return the ticks of a loop, whose time stands still in a stall."""
    begins, lengths = scene.stalls
    before = np.concatenate([[0.0], np.cumsum(lengths)])
    return ticks + before[np.searchsorted(begins - before[:-1], ticks, side='right')]


def has_header(datatype: str, index: int) -> bool:
    """Return whether the messages of an output have a header, and so stamps and numbers."""
    return bool(_of_robot(datatype, index).uniform() < _HEADERS)


def attributes_of(datatype: str, scene: Scene, index: int, times: np.ndarray,
                  numbers: np.ndarray, on_the_way_s: np.ndarray) -> np.ndarray:
    """Return the attributes of messages as they are heard (pack_attributes): honest ones
    (docs/method.md, 3.10).

    Stamps are a little older than the messages, numbers count them, and sizes and contents are
    those of their types: some have one size, some vary, and some say the same again and again.
    The messages of the output come at `times` [s], `numbers` were sent before.
    """
    of_robot = _of_robot(datatype, index)
    rng = scene.of_recording(f'attributes {index}')
    with_header, varies, repeats = of_robot.uniform(size=3) < (_HEADERS, _VARYING, _REPEATING)
    age_s = np.exp(of_robot.uniform(*np.log(_PROCESSED_S)))
    size = np.exp(of_robot.uniform(*np.log(_BYTES)))
    held_s = np.exp(of_robot.uniform(*np.log(_HELD_S)))
    count = len(times)
    ages = age_s * np.exp(_JITTER * rng.normal(size=count)) * scene.load(times) + on_the_way_s
    spread = of_robot.uniform(0.05, _MOST_SPREAD) if varies else 0.0
    sizes = np.maximum(size * np.exp(spread * rng.normal(size=count)), 1.0)
    steps = np.diff(numbers, prepend=numbers[:1] - 1)
    steps[:1] = -1
    gaps = np.diff(times, prepend=times[:1])
    same = (rng.uniform(size=count) < np.exp(-gaps / held_s)) & (repeats & ~varies)
    same[:1] = False
    if not with_header:
        ages = np.full(count, np.nan)
        steps = np.full(count, -1)
    return pack_attributes(ages, sizes.astype(np.uint64), steps, same)


def _of_robot(datatype: str, index: int) -> np.random.Generator:
    return np.random.default_rng((zlib.crc32(datatype.encode()), index))
