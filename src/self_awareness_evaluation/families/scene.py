"""What the messages of one recording have in common: conditions, faults, time, chance."""
from __future__ import annotations

import zlib
from dataclasses import dataclass
from typing import Dict, List, Tuple

import numpy as np

# The kinds of faults of one component. What answers to it suffers as it would.
CRASH = 'crash'  # it is silent
RESTART = 'restart'  # it is, too; after the relief its timers have other phases
HALF_RATE = 'half rate'  # it leaves out every second message
DOUBLE_RATE = 'double rate'  # it sends a second message between each two
SLOWER = '0.7 of the rate'  # its timers are slower, and it leaves out some answers
LATE = 'late 60 ms'  # its answers to others come so much later
MISSES = 'misses inputs'  # it answers nothing for a second, now and then
OLD = 'old stamps'  # its stamps are 3 s older
LOSSES = 'loses 30 %'  # so many of its messages never arrive
OTHER = 'new value'  # its outputs say their other value
FLOOD = 'flood of log lines'  # it logs 100 warnings a second
FAILS = 'fails more often'  # four in five of its goals fail

# Crashes that something else follows, which must not hide them.
STALL = 'stall after a crash'  # the host stands still for 2 s
LOAD = 'load after a crash'  # all messages wait for 2 s
STOP = 'stop after a crash'  # others that do not hear it or each other are silent, too
AFTER_CRASH = (STALL, LOAD, STOP)

# The kinds of faults of the whole robot.
STARVED = 'starved CPU'  # all messages wait, longer and longer within 20 s
SILENT = 'everything silent'  # nobody sends

LONGEST_START_S = 90_000.0  # a start of the robot lasts no longer than this [s]
# A recording begins on a robot that has run for this long [s]; the longest answers fit into it.
LEAD_S = 10.0
LASTS_S = 2.0  # what follows a crash lasts for so long [s]
_TRANSPORT_S = 0.0002
_LINK_S = 0.004
_SHORTEST_LINK, _LONGEST_LINK = 0.7, 1.5
_LINK_HEAVY = 10.0
_HICCUP_S = 0.02
_SOON_S = 0.15


@dataclass(frozen=True)
class Activity:
    """Something that the robot does now and then; both times are exponentially distributed."""

    on_s: float  # mean time that it lasts
    off_s: float  # mean time between

    def edges(self, begin: float, end: float, rng: np.random.Generator) -> np.ndarray:
        """Return when it begins and ends in turn [s], from `begin` to after `end`."""
        pairs = int((end - begin) / (self.on_s + self.off_s) * 1.5) + 20
        lengths = np.empty(2 * pairs)
        lengths[0::2] = rng.exponential(self.off_s, pairs)
        lengths[1::2] = rng.exponential(self.on_s, pairs)
        if rng.uniform() < self.on_s / (self.on_s + self.off_s):
            lengths[0] = 0.0
        return begin + np.cumsum(lengths)


@dataclass(frozen=True)
class Conditions:
    """What is the same for all messages of a robot."""

    # Share of messages that come some 20 ms later still, as what follows them does.
    hiccups: float = 1e-5
    # Share of messages that a listener does not get, of those that come soon after the one before:
    # queues lose what comes too fast for the listener.
    lost: float = 0.0
    lost_however_slow: float = 0.0  # the same of all other messages
    heavy: float = 0.0  # share of delays over the wireless link that are ten times as long
    load_period_s: float = 0.0  # time in which the load rises and falls once [s]; 0: it does not
    most_load: float = 1.0  # by how much longer work takes at the most, 1 or more
    # How often the host stalls; everything waits then, also the recorder, and comes at once.
    stalls_an_hour: float = 0.0
    stall_s: Tuple[float, float] = (0.1, 0.6)  # for how long, at least and at most [s]

    def transport(self, sent: np.ndarray, over_link: bool, rng: np.random.Generator) -> np.ndarray:
        """Return when messages arrive that were sent at some times [s], in their order."""
        # A row for each message: what comes later does not change it.
        drawn = rng.uniform(size=(len(sent), 3))
        delay = -np.log1p(-drawn[:, 0]) * _TRANSPORT_S
        if over_link:
            link = _LINK_S * (_SHORTEST_LINK + (_LONGEST_LINK - _SHORTEST_LINK) * drawn[:, 1])
            delay += np.where(drawn[:, 2] < self.heavy, _LINK_HEAVY * link, link)
        return in_order(sent + delay)

    def received(self, arrived: np.ndarray, rng: np.random.Generator) -> np.ndarray:
        """Return which messages a listener gets, bool, of those that arrive at some times [s]."""
        if not self.lost and not self.lost_however_slow:
            return np.ones(len(arrived), dtype=bool)
        soon = np.diff(arrived, prepend=-np.inf) < _SOON_S
        return rng.uniform(size=len(arrived)) >= np.where(soon, self.lost, self.lost_however_slow)

    def hiccup(self, times: np.ndarray, rng: np.random.Generator) -> np.ndarray:
        """Return when messages are sent that were to be at some times [s]."""
        drawn = rng.uniform(size=(len(times), 2))
        hit = drawn[:, 0] < self.hiccups
        return in_order(times - np.log1p(-drawn[:, 1]) * _HICCUP_S * hit)


def in_order(times: np.ndarray) -> np.ndarray:
    """Return times at which nothing overtakes what was before it."""
    return np.maximum.accumulate(times) if len(times) else times


@dataclass(frozen=True)
class Fault:
    """A fault of one component, or of the whole robot."""

    kind: str  # one of those above; empty: nothing is wrong
    source: str  # the component; empty: the robot
    onset_s: float  # from the beginning of the recording [s]
    relief_s: float = LONGEST_START_S  # from there on all is well again [s]
    # Of STALL, LOAD and STOP, when what follows the crash begins [s].
    follows_s: float = LONGEST_START_S
    others: Tuple[str, ...] = ()  # of STOP, the components that are silent then


NOTHING = Fault('', '', LONGEST_START_S)


class Scene:
    """A stretch of one start of a robot, while it is simulated.

    Times are seconds since the robot's start, float64. What holds for a whole start (phases of
    timers, the time of day) is drawn by `of_start`, all else by `of_recording`. Every purpose has
    a stream of its own: what one output draws does not change another one.
    """

    def __init__(self, robot_seed: int, start_seed: int, recorded_from: float, end: float,
                 conditions: Conditions, activities: Dict[str, Activity], fault: Fault) -> None:
        self.recorded_from = recorded_from
        self.begin = recorded_from - LEAD_S
        self.end = end
        self.conditions = conditions
        self.fault = fault
        self.published: List[np.ndarray] = []
        # When an output was asked, and when it answered.
        self.answers: Dict[int, Tuple[np.ndarray, np.ndarray]] = {}
        self._seed = (robot_seed, start_seed)
        self._recording = round(recorded_from * 1e3)
        self._edges = {name: activity.edges(self.begin, self.end, self.of_recording(name))
                       for name, activity in activities.items()}
        rng = self.of_recording('stalls')
        number = rng.poisson((end - self.begin) / 3600.0 * conditions.stalls_an_hour)
        # When the host stalls, and for how long.
        self.stalls = (np.sort(rng.uniform(self.begin, end, number)),
                       rng.uniform(*conditions.stall_s, number))
        if fault.kind == STALL:
            begin, (begins, lengths) = recorded_from + fault.follows_s, self.stalls
            place = np.searchsorted(begins, begin)
            self.stalls = np.insert(begins, place, begin), np.insert(lengths, place, LASTS_S)
        self._day_phase = self.of_start('time of day').uniform(0.0, 1.0)

    def of_start(self, purpose: str) -> np.random.Generator:
        """Return what draws the same in all recordings of a start."""
        return np.random.default_rng((*self._seed, zlib.crc32(purpose.encode())))

    def of_recording(self, purpose: str) -> np.random.Generator:
        """Return what draws for this recording only."""
        return np.random.default_rng((*self._seed, zlib.crc32(purpose.encode()), self._recording))

    def load(self, times: np.ndarray) -> np.ndarray:
        """Return by how much longer work takes at some times, 1 or more."""
        period_s, most = self.conditions.load_period_s, self.conditions.most_load
        if not period_s:
            return np.ones(len(times))
        turn = 2.0 * np.pi * (times / period_s + self._day_phase)
        return 1.0 + (most - 1.0) * (1.0 - np.cos(turn)) / 2.0

    def during(self, activity: str, times: np.ndarray) -> np.ndarray:
        """Return which times [s] lie in an activity; an empty name: all do."""
        if not activity:
            return np.ones(len(times), dtype=bool)
        # Before the first edge the activity is off, after it on, and so on.
        return np.searchsorted(self._edges[activity], times, side='right') % 2 == 1

    def in_fault(self, times: np.ndarray) -> np.ndarray:
        """Return which times [s] lie in the fault."""
        return ((times >= self.recorded_from + self.fault.onset_s)
                & (times < self.recorded_from + self.fault.relief_s))

    def has(self, kind: str, source: str, times: np.ndarray) -> np.ndarray:
        """Return at which times [s] a component has a fault of a kind."""
        is_one = (self.fault.kind, self.fault.source) == (kind, source)
        return self.in_fault(times) & is_one
