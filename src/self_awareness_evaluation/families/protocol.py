"""What of a robot is recorded to learn from, to watch, and with which faults."""
from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Dict, Iterator, List, Optional, Sequence, Tuple

import numpy as np

from self_awareness.stamps import SECOND_NS, nanoseconds
from self_awareness_evaluation.families.kinds import FAMILIES
from self_awareness_evaluation.families.robot import WARNING
from self_awareness_evaluation.families.scene import (AFTER_CRASH, CRASH, DOUBLE_RATE, FAILS,
                                                      FLOOD, HALF_RATE, LATE, LOAD,
                                                      LONGEST_START_S, LOSSES, MISSES, NOTHING,
                                                      OLD, OTHER, RESTART, SILENT, SLOWER, STALL,
                                                      STARVED, STOP, Fault)
from self_awareness_evaluation.records import FaultRecord, Learning, WindowedEvents
from self_awareness_evaluation.records import Robot as RecordedRobot

DEATH = 'death'  # the crash of a component that is silent until something is asked of it
UNHEARD = 'unheard'  # the same before it has said anything: as if it were not in the recording
SELDOM = 'seldom'  # that of one that speaks when something happens, and is asked by nobody
NEVER = 'absent'  # what is latched at every start does not come

TITLES: Dict[str, str] = {  # what tables call the kinds of faults
    CRASH: 'crashes', HALF_RATE: 'half rate', LATE: 'late answers', DEATH: 'deaths when asked',
    MISSES: 'inputs missed now and then', STARVED: 'starved CPU', SILENT: 'everything silent',
    SELDOM: 'deaths of who speaks seldom', RESTART: 'restarts',
    STALL: 'a stall follows a crash', LOAD: 'load follows a crash',
    STOP: 'others stop after a crash', SLOWER: '0.7 of the rate', OLD: 'stamps are 3 s older',
    LOSSES: '30 % of the messages lost', OTHER: 'no transform, failed goals, an error (WARN)',
    FLOOD: 'log lines without end', NEVER: 'no latched message (WARN)',
    FAILS: 'four in five goals fail, not one in twelve', UNHEARD: 'deaths before the first answer',
    DOUBLE_RATE: 'double rate'}

KINDS = tuple(TITLES)  # as they are told apart in the results
WATCHED_S = 1800.0  # length of a recording of normal operation that is watched [s]
AFTER_ONSET_S = 60.0  # a recording with a fault lasts for so long after the onset [s]
AFTER_DEATH_S = 1800.0  # and for so long after a death
# A component that is started again is silent for so long, and then watched for so long [s].
RESTARTS_IN_S, AFTER_RESTART_S = 10.0, 180.0

_ASKED = (DEATH, UNHEARD)
_ONSET_S = 60.0
_ONSET_SPREAD_S = 2.0  # the onset must have no fixed phase to the windows and the robot's timers
_ONE_IN = 3  # components has old stamps, or loses messages
_LOSES_S = 20.0
_FOLLOWS_S = 1.0  # so long after the first message is missing, something else follows a crash
_STOP_TOGETHER = 3
_PAUSES = 3.0  # a recording goes on for so many of its longest pauses after who speaks seldom died
_PAUSES_FROM_S = 3600.0  # the longest pause is that of so long a time
_MISSING_S = 60.0  # a death is counted if the recording goes on for this long afterwards
MOST_STARTS = 16  # the most starts that systems learn from


@dataclass(frozen=True)
class _Section:
    """Where recordings of a purpose come from: a start each, or parts of one and the same."""

    first: int  # seed of the first start
    from_s: float  # begin of the first part
    every_s: float  # from the begin of a part to that of the next one
    is_learned: bool = False


_TRAINING = _Section(0, 0.0, 600.0, is_learned=True)
_CALIBRATION = _Section(100, 10_000.0, 600.0, is_learned=True)
_FAULTS = _Section(10_000, 15_000.0, 200.0)
_WATCHED = _Section(1000, 36_000.0, WATCHED_S)


def check_hours(families: Sequence[str], hours: float) -> None:
    """Check that so many hours of normal operation can be watched, of some in one start."""
    longest = (LONGEST_START_S - _WATCHED.from_s) / 3600.0
    short = [name for name in families if FAMILIES[name].watched_start]
    if short and hours > longest:
        raise ValueError(f'{hours:g} hours: {", ".join(short)} can be watched for {longest:g} '
                         'hours; watch more robots instead')


class Records:
    """The recordings of one robot of a family, simulated when they are needed."""

    def __init__(self, family: str, seed: int) -> None:
        self._family = FAMILIES[family]
        self.robot = self._family.robot(seed)

    def training(self, learning: Learning) -> List[WindowedEvents]:
        length_s = learning.training_s
        return [self._recorded(_TRAINING, number, length_s,
                               self._family.flaw(self.robot, number, length_s))
                for number in range(learning.starts)]

    def calibration(self, learning: Learning) -> List[WindowedEvents]:
        """Return the recordings to calibrate on, other ones."""
        return [self._recorded(_CALIBRATION, number, learning.calibration_s)
                for number in range(learning.calibrations)]

    def watched(self, hours: float) -> Iterator[WindowedEvents]:
        """Yield recordings of normal operation of WATCHED_S, and a shorter last one."""
        left = hours * 3600.0
        for number in range(int(np.ceil(left / WATCHED_S))):
            yield self._recorded(_WATCHED, number, min(WATCHED_S, left))
            left -= WATCHED_S

    def faults(self, kinds: Tuple[str, ...], most: Optional[int] = None,
               after_death_s: float = AFTER_DEATH_S) -> Iterator[FaultRecord]:
        """Yield a recording of every fault of some KINDS, of each component in turn; most: only of
        so many for each kind, spread evenly; after_death_s: it lasts for so long after a death.
        The onset of a DEATH, or UNHEARD, is when the first message would have come that is
        missing."""
        robot = self.robot
        regular, answering = robot.regular, robot.answering
        late = [source for source in regular if source in answering]
        asked = [source for source in answering if source not in regular]
        who = {CRASH: regular, HALF_RATE: regular, LATE: late, MISSES: late,
               DEATH: asked, UNHEARD: asked,
               STARVED: [''], SILENT: [''], SELDOM: robot.seldom, RESTART: regular,
               SLOWER: regular, DOUBLE_RATE: regular, OLD: robot.numbered[::_ONE_IN],
               LOSSES: robot.numbered[1::_ONE_IN],
               OTHER: robot.sending(lambda output: bool(output.other) and not output.fails),
               FLOOD: robot.sending(lambda output: output.datatype == WARNING),
               FAILS: robot.sending(lambda output: output.fails > 0),
               NEVER: robot.latching,
               **{kind: regular[first::len(AFTER_CRASH)]
                  for first, kind in enumerate(AFTER_CRASH)}}
        number = 0
        for kind in KINDS:
            count = len(who[kind])
            wanted = 0 if kind not in kinds else count if most is None else min(most, count)
            chosen = {index * count // wanted for index in range(wanted)}
            for index, source in enumerate(who[kind]):
                if index in chosen:
                    yield from self._fault(kind, source, number,
                                           self._lasts(kind, source, number, after_death_s))
                number += 1

    def _fault(self, kind: str, source: str, number: int, after_s: float) -> Iterator[FaultRecord]:
        """Yield the recording with a fault; none if nothing is missing after a crash for which
        that decides."""
        spread = np.random.default_rng((self.robot.seed, number)).uniform(0.0, _ONSET_SPREAD_S)
        onset_s = _ONSET_S + float(spread)
        seconds = onset_s + after_s
        onset_s = 0.0 if kind == NEVER else onset_s
        lasts_s = {RESTART: RESTARTS_IN_S, LOSSES: _LOSES_S}.get(kind, LONGEST_START_S)
        fault = Fault(CRASH if kind in (*_ASKED, SELDOM, NEVER) else kind, source, onset_s,
                      onset_s + lasts_s)
        if kind in (*_ASKED, *AFTER_CRASH):
            healthy = self._recorded(_FAULTS, number, seconds)
            begin = healthy.end - nanoseconds(seconds)
            sent = healthy.stamps_of(source)
            missing = sent[sent >= begin + nanoseconds(onset_s)]
            if not len(missing) or (kind in _ASKED and (
                    (len(missing) == len(sent)) != (kind == UNHEARD)
                    or missing[0] + nanoseconds(_MISSING_S) > healthy.end)):
                return
            others = self.robot.strangers_of(source, _STOP_TOGETHER) if kind == STOP else ()
            fault = replace(fault, others=others,
                            follows_s=(int(missing[0]) - begin) / SECOND_NS + _FOLLOWS_S)
        recording = self._recorded(_FAULTS, number, seconds, fault)
        onset = (int(missing[0]) if kind in _ASKED
                 else recording.end - nanoseconds(seconds) + nanoseconds(onset_s))
        yield FaultRecord(kind, (source,) if source else (), recording, onset,
                          None if lasts_s == LONGEST_START_S else onset + nanoseconds(lasts_s),
                          None if not source or kind in AFTER_CRASH
                          else frozenset(self.robot.reached_by(source)))

    def _lasts(self, kind: str, source: str, number: int, after_death_s: float) -> float:
        """Return for how long a recording with a fault goes on after the onset [s]."""
        if kind == SELDOM:
            stamps = self._recorded(_FAULTS, number, _PAUSES_FROM_S).stamps_of(source)
            return _PAUSES * float(np.max(np.diff(stamps), initial=0)) / SECOND_NS
        if kind == RESTART:
            return RESTARTS_IN_S + AFTER_RESTART_S
        if kind in (LOSSES, NEVER, FAILS):
            return 2.0 * AFTER_ONSET_S
        return after_death_s if kind in _ASKED else AFTER_ONSET_S

    def _recorded(self, section: _Section, number: int, seconds: float,
                  fault: Fault = NOTHING) -> WindowedEvents:
        family, robot, turn = self._family, self.robot, section.first + number
        if family.of_make is not None:  # who is watched is none that is learned from
            robot = family.robot(robot.seed, turn if section.is_learned else _WATCHED.first)
        if family.one_start if section.is_learned else family.watched_start:
            return robot.start(0, seconds, fault, section.from_s + number * section.every_s)
        return robot.start(turn, seconds, fault)


def recorded(family: str, seed: int, hours: float, kinds: Tuple[str, ...] = KINDS,
             most: Optional[int] = None, after_death_s: float = AFTER_DEATH_S) -> RecordedRobot:
    """Return the records of a robot; hours: of normal operation; all else: see Records."""
    records = Records(family, seed)
    return RecordedRobot(
        records.robot.sources, records.robot.graph, records.training, records.calibration,
        lambda: records.watched(hours), lambda: records.faults(kinds, most, after_death_s))
