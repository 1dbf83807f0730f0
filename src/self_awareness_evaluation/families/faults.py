"""What can be wrong with a robot of a family."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Tuple

CRASH, HALF_RATE, LATE, MISSES, RESTART = ('crash', 'half rate', 'late 60 ms', 'misses inputs',
                                           'restart')
"""The kinds of faults of one component."""

STALL, LOAD, STOP = 'stall after a crash', 'load after a crash', 'stop after a crash'
"""Crashes that something else follows, which must not hide them."""

AFTER_CRASH = (STALL, LOAD, STOP)

SLOWER = '0.7 of the rate'  # a fault of one component that no gap alone shows

OLD, LOSSES, OTHER, FLOOD, FAILS = ('old stamps', 'loses 30 %', 'new value', 'flood of log lines',
                                    'fails more often')
"""The kinds of faults of one component that what it says shows."""

STARVED, SILENT = 'starved CPU', 'everything silent'  # the kinds of faults of the whole robot
LONGEST_START_S = 90_000.0  # a start of the robot lasts no longer than this [s]


@dataclass(frozen=True)
class Fault:
    """A fault of one component, or of the whole robot."""

    # CRASH: it is silent. STALL: it is, and later the host stands still for 2 s. LOAD: instead,
    # all messages wait for 2 s. STOP: instead, others that do not hear it or each other are
    # silent, too. RESTART: it is silent, too; after the relief its timers have other phases.
    # HALF_RATE: it leaves out every second message. SLOWER: its timers are slower, and it leaves
    # out some answers. LATE: its answers to others come 60 ms later. MISSES: it answers nothing
    # for a second, now and then. What answers to it suffers as it would. OLD: its stamps are 3 s
    # older. LOSSES: 30 % of its messages never arrive. OTHER: its outputs say their other value.
    # FLOOD: it logs 100 warnings a second. FAILS: four in five of its goals fail. STARVED: all
    # messages wait, longer and longer within 20 s. SILENT: nobody sends. Empty: nothing is wrong.
    kind: str
    source: str  # the component; empty: the robot
    onset_s: float  # from the beginning of the recording [s]
    relief_s: float = LONGEST_START_S  # from there on all is well again [s]
    # Of STALL, LOAD and STOP, when what follows the crash begins [s].
    follows_s: float = LONGEST_START_S
    others: Tuple[str, ...] = ()  # of STOP, the components that are silent then


NOTHING = Fault('', '', LONGEST_START_S)
