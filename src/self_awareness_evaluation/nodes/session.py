"""One session beside the nodes: recordings of several starts, model, monitor, and faults."""
from __future__ import annotations

import contextlib
import random
import subprocess
import threading
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Callable, Iterator, List, Optional

from self_awareness import TrainedModel
from self_awareness.training.robot_graph import graph_file
from self_awareness_evaluation.live.learning import Apart, learn
from self_awareness_evaluation.live.listeners import (STARTED_WITHIN_S, MonitorListener,
                                                      reset_until_quiet)
from self_awareness_evaluation.live.master import own_master
from self_awareness_evaluation.live.passing import say, stretch, wait
from self_awareness_evaluation.live.processes import (LiveError, Processes, await_condition,
                                                      becomes_true)
from self_awareness_evaluation.live.samples import Stretch
from self_awareness_evaluation.nodes import drivers, measures
from self_awareness_evaluation.nodes.measures import BURSTS, UNDISTURBED, Promised, Row
from self_awareness_evaluation.nodes.running import RunningSystem
from self_awareness_evaluation.nodes.system import FAULTS, Fault
from self_awareness_follow_me import induction
from self_awareness_follow_me.effects import Starvation

QUIET_AFTER_S = 10.0
"""A fault is over when there has been no alarm for so long after it was undone [s]."""

RECOVERED_WITHIN_S = 60.0
"""An alarm that stands for longer after the fault was undone does not clear [s]."""

BURST_S = (0.2, 1.5)
"""A burst of foreign load on all cores lasts so long, at least and at most [s]."""

BETWEEN_BURSTS_S = 20.0
"""Between two of them, on the average [s]."""

_BURST = Starvation(ramp=0.0, slowdown=1.0, workers_per_core=4)
_BURSTS_SEED = 1
_WARM_UP_S = 10.0  # after the start, which is no normal operation
_PIECE_S = 600.0  # of normal operation, so that little is lost if the session fails


@dataclass(frozen=True)
class SessionPlan:
    """What a session does.

    Args:
        starts: of the system, each recorded to learn from.
        training_s: length of each of these recordings [s].
        calibrations: further starts, each recorded to find the limits by.
        calibration_s: length of each of these recordings [s].
        minutes: of normal operation that are watched.
        burst_minutes: the same after that, beside short bursts of foreign load.
    """

    starts: int
    training_s: float
    calibrations: int
    calibration_s: float
    minutes: float
    burst_minutes: float


def run(plan: SessionPlan, folder: Path, told: Callable[[Row], None]) -> None:
    """Run a session under a master of its own; nothing of it runs on afterwards.

    Args:
        plan: what to do.
        folder: exists; for recordings, the model and logs.
        told: gets a row after every stretch.

    Raises:
        LiveError: a program failed, or something does not happen in time.
    """
    drivers.write(folder)
    with own_master(folder) as processes:
        _Session(plan, folder, processes, told).run()


class _Session:
    def __init__(self, plan: SessionPlan, folder: Path, processes: Processes,
                 told: Callable[[Row], None]) -> None:
        self._plan = plan
        self._folder = folder
        self._processes = processes
        self._told = told
        self._system = RunningSystem(folder, processes)
        self._monitor = MonitorListener()
        self._apart = Apart()

    def run(self) -> None:
        training = [self._recorded(f'training_{number}', self._plan.training_s)
                    for number in range(1, self._plan.starts + 1)]
        normal = [self._recorded(f'calibration_{number}', self._plan.calibration_s)
                  for number in range(1, self._plan.calibrations + 1)]
        model = self._folder / 'nodes.model'
        learn(self._processes, model, training, normal)
        self._start_system()
        recorder = self._start_recorder('session')  # for score, should there be an alarm
        self._processes.start('monitor', 'roslaunch', '--wait', 'self_awareness', 'monitor.launch',
                              f'model:={model}')
        await_condition('the monitor says something', lambda: bool(self._monitor.statuses),
                        STARTED_WITHIN_S)
        # An operator looks on, with tools that training did not see.
        tools = [self._processes.start('operator', 'rosbag', 'record', '--all', '--output-name',
                                       str(self._folder / 'operator')),
                 self._processes.start('reader', 'rostopic', 'echo', '/diagnostics')]
        promised = _promised(model)
        self._watch(UNDISTURBED, self._plan.minutes, promised)
        with _bursts():
            self._watch(BURSTS, self._plan.burst_minutes, promised)
        for fault in FAULTS:
            self._induce(fault)
        for process in [*tools, recorder]:
            self._processes.end(process)
        self._system.end()

    def _watch(self, kind: str, minutes: float, promised: Promised) -> None:
        def over(quiet: Stretch) -> None:
            self._told(measures.of_quiet(quiet, promised, self._monitor.statuses))

        left = 60.0 * minutes
        while left > 0.0:
            piece = min(left, _PIECE_S)
            with stretch(1, kind, (), '', time.time(), over):
                wait(piece, kind)
            left -= piece

    def _induce(self, fault: Fault) -> None:
        note = reset_until_quiet(self._monitor)
        over: List[Stretch] = []
        with self._system.broken(fault) as onset:
            with stretch(1, fault.kind, fault.culprits, note, onset, over.append):
                wait(fault.lasts_s, f'{fault.node or "the machine"} {fault.kind}')
        recovered = time.time()
        # Where it does not clear in time, the row tells it.
        becomes_true(lambda: self._is_over(recovered), RECOVERED_WITHIN_S)
        self._told(measures.of_fault(fault, over[0], recovered, self._monitor.statuses))

    def _is_over(self, recovered: float) -> bool:
        quiet = min(self._monitor.quiet_for(), time.time() - recovered)
        return quiet >= QUIET_AFTER_S

    def _start_system(self) -> None:
        say('starting the nodes')
        self._system.start()
        wait(_WARM_UP_S, 'warming up')

    def _recorded(self, name: str, length_s: float) -> Path:
        """Return a recording of a start, by record.launch; one that is there is used again."""
        found = self._bag(name)
        if found is not None:
            return found
        self._start_system()
        self._apart.wait()
        recorder = self._start_recorder(name)
        wait(length_s, f'recording {name}')
        self._processes.end(recorder)
        self._apart.ended()
        self._system.end()
        found = self._bag(name)
        if found is None or not Path(graph_file(str(found))).exists():
            raise LiveError(f'{name}: record.launch has written no bag with its graph, see '
                            f'{self._folder / name}.log')
        return found

    def _start_recorder(self, name: str) -> subprocess.Popen:
        recorder = self._processes.start(
            name, 'roslaunch', '--wait', 'self_awareness', 'record.launch', 'what:=bags',
            f'output:={self._folder / name}')
        await_condition(f'rosbag writes {name}',
                        lambda: any(self._folder.glob(f'{name}_*.bag.active')), STARTED_WITHIN_S)
        return recorder

    def _bag(self, name: str) -> Optional[Path]:
        return next(iter(sorted(self._folder.glob(f'{name}_*.bag'))), None)


@contextlib.contextmanager
def _bursts() -> Iterator[None]:
    """Take all cores for a moment now and then, while the with statement lasts."""
    over = threading.Event()
    rng = random.Random(_BURSTS_SEED)

    def run() -> None:
        while not over.wait(rng.expovariate(1.0 / BETWEEN_BURSTS_S)):
            with induction.starved(_BURST):
                over.wait(rng.uniform(*BURST_S))

    thread = threading.Thread(target=run)
    thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join()


def _promised(path: Path) -> Promised:
    model = TrainedModel.load(str(path))
    if model.calibration is None:
        raise LiveError(f'{path}: calibrate has written no limits')
    coverage = model.coverage()
    return Promised(model.calibration.false_alarms_per_hour,
                    sum(each.is_watched for each in coverage), len(coverage))
