"""What a robot's messages meet with: transport, hosts, load, and what the robot does just now."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Tuple

import numpy as np

_TRANSPORT_S = 0.0002
_LINK_S = 0.004
_SHORTEST_LINK, _LONGEST_LINK = 0.7, 1.5
_LINK_HEAVY = 10.0
_HICCUP_S = 0.02
_SOON_S = 0.15
_HOUR_S = 3600.0


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

    def load(self, times: np.ndarray, phase: float) -> np.ndarray:
        """Return by how much longer work takes at some times [s]; phase: 0 to 1."""
        if not self.load_period_s:
            return np.ones(len(times))
        turn = 2.0 * np.pi * (times / self.load_period_s + phase)
        return 1.0 + (self.most_load - 1.0) * (1.0 - np.cos(turn)) / 2.0

    def transport(self, sent: np.ndarray, over_link: bool,
                  rng: np.random.Generator) -> np.ndarray:
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

    def stalls(self, begin: float, end: float,
               rng: np.random.Generator) -> Tuple[np.ndarray, np.ndarray]:
        """Return when the host stalls, and for how long [s]."""
        number = rng.poisson((end - begin) / _HOUR_S * self.stalls_an_hour)
        return (np.sort(rng.uniform(begin, end, number)),
                rng.uniform(*self.stall_s, number))


def in_order(times: np.ndarray) -> np.ndarray:
    """Return times at which nothing overtakes what was before it."""
    return np.maximum.accumulate(times) if len(times) else times
