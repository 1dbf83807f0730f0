"""One live session: recordings of a robot, a model, the monitor, and a plan of faults."""
from __future__ import annotations

import os
import time
from dataclasses import dataclass, replace
from pathlib import Path
from typing import (Any, Callable, ContextManager, Dict, Iterator, List, Optional, Sequence,
                    Tuple)

import yaml

from self_awareness import TrainedModel
from self_awareness.calibration.limits import BUDGET
from self_awareness_evaluation.live.breaking import nothing
from self_awareness_evaluation.live.listeners import MONITOR, MonitorListener
from self_awareness_evaluation.live.processes import (STARTED_WITHIN_S, LiveError, Processes,
                                                      await_condition, becomes_true, say, wait)
from self_awareness_evaluation.live.recordings import System, learn
from self_awareness_evaluation.live.rows import Row, measure
from self_awareness_evaluation.records import Learning
from self_awareness_evaluation.rows import AFTERMATH_S
from self_awareness_follow_me.induction import process_id

_STATUS_WITHIN_S = 5.0  # of the last window of a stretch
_CLOCK_STEP_S = 0.05  # a clock that moved by more than this was set


@dataclass(frozen=True)
class Step:
    """A fault that is to come, or normal operation.

    Args:
        fault: its name; of normal operation: what it is called.
        lasts_s: from the onset to when it is undone, at most [s].
        culprits: sources to blame; empty: none, or the whole machine.
        broken: induces it, hands out its onset [s since 1970], and undoes it.
        is_normal: nothing is wrong.
        round: number, from 1 on.
        reset: the monitor's ~reset is called before.
        returned: waits instead until the node is back by itself; returns when it was heard
            [s since 1970], None: it was not in `lasts_s`.
    """

    fault: str
    lasts_s: float
    culprits: Tuple[str, ...] = ()
    broken: Callable[[], ContextManager[float]] = nothing
    is_normal: bool = False
    round: int = 1
    reset: bool = False
    returned: Optional[Callable[[], Optional[float]]] = None


@dataclass(frozen=True)
class Plan:
    """What a session does.

    Args:
        system: the robot.
        what: is recorded of it, to learn from (recordings).
        learning: how much.
        steps: drawn one after the other, while the session goes on.
        quiet_s: a fault is over when there has been no alarm for so long after it was undone [s],
            AFTERMATH_S or more.
        quiet_within_s: an alarm that stands for longer does not clear [s]; 0: nobody waits.
        budget: false alarms an hour that the limits allow.
        beside: commands that run beside the monitor.
        also: called after every step, returns further rows.
    """

    system: System
    what: str
    learning: Learning
    steps: Iterator[Step]
    quiet_s: float
    quiet_within_s: float
    budget: float = BUDGET
    beside: Sequence[Sequence[str]] = ()
    also: Callable[[], List[Row]] = list


def run(plan: Plan, folder: Path, processes: Processes, told: Callable[[Row], None]) -> None:
    """Run a session.

    The master runs, and this process is a node.

    Args:
        plan: what to do.
        folder: exists; for recordings, the model and logs.
        processes: to start programs among.
        told: gets every row as soon as it is measured.

    Raises:
        LiveError: a program failed, or something does not happen in time.
        InduceError: a fault cannot be induced.
    """
    model = learn(plan.system, plan.what, plan.learning, plan.budget, folder, processes)
    plan.system.start()
    monitor = MonitorListener()
    config = folder / 'monitor.yaml'
    config.write_text(yaml.safe_dump({'recorder': {'directory': str(folder / 'alarms')}}))
    processes.start('monitor', 'roslaunch', '--wait', 'self_awareness', 'monitor.launch',
                    f'model:={model}', f'config:={config}', 'respawn:=false')
    await_condition('the monitor says something', lambda: bool(monitor.statuses),
                    STARTED_WITHIN_S)
    beside = [processes.start(f'beside_{number}', *command)
              for number, command in enumerate(plan.beside, 1)]
    # Where it stays loud, the rows tell it.
    becomes_true(lambda: monitor.quiet_for() >= plan.quiet_s, STARTED_WITHIN_S)
    walk = Walk(plan, monitor, _promised(model))
    for step in plan.steps:
        for row in (walk.take(step), *plan.also()):
            told(row)
    for process in beside:
        processes.end(process)
    plan.system.end()


class Walk:
    """Takes step after step beside a monitor.

    Args:
        plan: of the session.
        monitor: that is listened to.
        promised: what the model says of itself, by the columns of rows of normal operation.
    """

    def __init__(self, plan: Plan, monitor: MonitorListener,
                 promised: Dict[str, Any]) -> None:
        self._plan = plan
        self._monitor = monitor
        self._promised = promised
        self._pid = process_id(MONITOR)
        self._normal_since: Optional[float] = None  # the fault before is over since then

    def take(self, step: Step) -> Row:
        """Induce a fault and undo it, or let normal operation pass; return what was measured."""
        note = self._monitor.reset_until_quiet() if step.reset else ''
        with step.broken() as onset:
            if step.is_normal and self._normal_since is not None:
                onset = self._normal_since
            ahead_s, load = time.time() - time.monotonic(), os.getloadavg()[0]
            back = _passed(step)
            end = time.time()
            set_s = end - time.monotonic() - ahead_s
        row = Row(step.fault, ' '.join(source[1:] for source in step.culprits), round=step.round,
                  onset=onset, lasted_s=end - onset, note=note, load=load, void=_clock(set_s))
        if step.is_normal:
            row = replace(row, alarms=0, **self._promised)
            self._normal_since = None
        else:
            row = self._over(row)
        becomes_true(lambda: self._monitor.statuses[-1].stamp > end, _STATUS_WITHIN_S)
        row = replace(measure(row, self._monitor.statuses, self._monitor.incidents),
                      **used(self._pid))
        if back is not None and row.blamed_s is not None:
            row = replace(row, back_s=back - onset - row.blamed_s)
        return row

    def _over(self, row: Row) -> Row:
        """Wait until a fault that was undone is over; note when it was."""
        self._normal_since = None
        if not self._plan.quiet_within_s:
            return row
        recovered = time.time()
        # Where it does not clear in time, the row tells it.
        becomes_true(lambda: min(self._monitor.quiet_for(), time.time() - recovered)
                     >= self._plan.quiet_s, self._plan.quiet_within_s)
        self._normal_since = recovered + AFTERMATH_S
        return replace(row, recovered_s=recovered - row.onset)


def _passed(step: Step) -> Optional[float]:
    """Let the time of a step pass; return when the node was back, if it came by itself."""
    what = ' '.join((step.fault, *step.culprits))
    if step.returned is None:
        wait(step.lasts_s, what)
        return None
    say(what)
    return step.returned()


def _clock(set_s: float) -> str:
    """Return why a stretch does not count in which the machine's clock was set."""
    return f"the machine's clock was set by {set_s:.2f} s" if abs(set_s) > _CLOCK_STEP_S else ''


def _promised(path: Path) -> Dict[str, Any]:
    """Return what the model says of itself, by the columns of a row."""
    model = TrainedModel.load(str(path))
    if model.calibration is None:
        raise LiveError(f'{path}: calibrate has written no limits')
    coverage = model.coverage()
    return {'components': len(coverage), 'watched': sum(each.is_watched for each in coverage)}


def used(pid: int) -> Dict[str, Any]:
    """Return what a process uses now, by the columns of a row.

    Raises:
        LiveError: it has ended.
    """
    process = Path('/proc') / str(pid)
    try:
        fields = dict(line.split(':', 1) for line in (process / 'status').read_text().splitlines())
        # "kB" of /proc are 1024 bytes.
        return {'memory_mb': int(fields['VmRSS'].split()[0]) * 1024 / 1e6,
                'threads': int(fields['Threads']), 'files': len(list((process / 'fd').iterdir()))}
    except (FileNotFoundError, ProcessLookupError) as error:
        raise LiveError(f'process {pid} has ended') from error
