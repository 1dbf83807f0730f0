"""What is judged: recordings of robots, without a fault and with one, whoever made them."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Callable, FrozenSet, Iterable, Optional, Sequence, Set, Tuple

from self_awareness_evaluation.windowed_events import WindowedEvents

NORMAL = 'normal'
"""What a record without a fault is called, in place of the kind of the fault."""

FAMILIES, OWN, REAL = 'families', 'own robot', 'recordings'
"""Where records come from: robots drawn by seed, the simulated follow-me robot, real robots."""


@dataclass(frozen=True)
class FaultRecord:
    """A recording with a fault.

    Args:
        kind: of the fault.
        culprits: the sources to blame; empty if no single one is.
        recording: the events.
        onset: of the fault [ns].
        back: when it is over [ns]; None: it lasts to the end of the recording.
        involved: the culprits, and who may suffer from them; None: nobody is guilty, or it is not
            known.
    """

    kind: str
    culprits: Tuple[str, ...]
    recording: WindowedEvents
    onset: int
    back: Optional[int] = None
    involved: Optional[FrozenSet[str]] = None

    @property
    def ends(self) -> int:
        """When the fault ends, at the latest with the recording [ns]."""
        return self.recording.end if self.back is None else self.back

    @property
    def source(self) -> str:
        """The culprits in one text; empty if no single one is."""
        return '; '.join(self.culprits)


@dataclass(frozen=True)
class Learning:
    """What a system learns from.

    Args:
        starts: of the robot to train on, a recording of each.
        training_s: length of each [s].
        calibrations: further starts to calibrate on, a recording of each.
        calibration_s: length of each [s].
    """

    starts: int
    training_s: float
    calibrations: int
    calibration_s: float

    @classmethod
    def of(cls, starts: int, training_s: float, calibration_s: float) -> Learning:
        """Return what is recorded by default: half as many starts to calibrate, at least one."""
        return cls(starts, training_s, max(1, starts // 2), calibration_s)

    def __str__(self) -> str:
        return (f'{self.starts} x {self.training_s:g} s + '
                f'{self.calibrations} x {self.calibration_s:g} s')


@dataclass(frozen=True)
class Robot:
    """A robot of which there are records. They are simulated when they are asked for.

    Args:
        part: FAMILIES or OWN.
        name: with its seed.
        components: of the robot.
        graph: publisher, topic and subscriber, as a training while the robot runs finds it.
        training, calibration: return the recordings that are learned from.
        normal: returns normal operation, recording by recording.
        faults: returns the recordings with a fault.
    """

    part: str
    name: str
    components: Set[str]
    graph: Set[Tuple[str, str, str]]
    training: Callable[[Learning], Sequence[WindowedEvents]]
    calibration: Callable[[Learning], Sequence[WindowedEvents]]
    normal: Callable[[], Iterable[WindowedEvents]]
    faults: Callable[[], Iterable[FaultRecord]]
