"""One live session: recordings of a robot, a model, the monitor, and a plan of faults; what breaks
any node, and what is listened to."""
from __future__ import annotations

import contextlib
import os
import random
import signal
import threading
import time
from dataclasses import dataclass, replace
from pathlib import Path
from typing import (Any, Callable, ContextManager, Dict, Iterator, List, Optional, Protocol,
                    Sequence, Tuple)

import rospy
import yaml
from std_srvs.srv import Trigger

from self_awareness import TrainedModel
from self_awareness.calibration.limits import BUDGET
from self_awareness.msg import SelfAwareness
from self_awareness.training.robot_graph import graph_file
from self_awareness_evaluation.live.processes import (STARTED_WITHIN_S, LiveError, Processes,
                                                      await_condition, becomes_true, say, wait)
from self_awareness_evaluation.live.rows import ERROR, Row, Status, measure
from self_awareness_evaluation.records import Learning
from self_awareness_evaluation.rows import AFTERMATH_S
from self_awareness_follow_me import induction
from self_awareness_follow_me.effects import Starvation
from self_awareness_follow_me.induction import process_id

# From the end of one bag to the beginning of the next one [s]: bags that follow each other within
# a minute count as one start.
_APART_S = 70.0

BAGS, EVENTS = 'bags', 'events'  # what is recorded: whole messages, or event logs
_TRAINING, _CALIBRATION, _MODEL = 'training', 'calibration', 'learned.model'  # names of files
_WITHIN_S = 900.0
_STATUS_WITHIN_S = 5.0  # of the last window of a stretch
_CLOCK_STEP_S = 0.05  # a clock that moved by more than this was set
_BURST_S = (0.2, 1.5)  # at least and at most
_BETWEEN_BURSTS_S = 20.0  # on the average

BUSY = Starvation(ramp=0.0, slowdown=1.0, workers_per_core=4)  # they take the machine
MONITOR = '/self_awareness'  # the monitor's node
_QUIET_S = 3.0  # the monitor has settled, and there is no alarm, for so long before the next fault
_NO_STATUS_S = 15.0  # a starved CPU takes its time
_SERVICE_WITHIN_S = 10.0
_QUIET_WITHIN_S = 15.0
_MOST_RESETS = 3


@contextlib.contextmanager
def stopped(pid: int) -> Iterator[None]:
    """Stop a process; it goes on at the end, if it still is there."""
    os.kill(pid, signal.SIGSTOP)
    try:
        yield
    finally:
        with contextlib.suppress(ProcessLookupError):  # it was killed, as it hung
            os.kill(pid, signal.SIGCONT)


@contextlib.contextmanager
def bursts(chance: random.Random) -> Iterator[None]:
    """Let busy processes on all cores take the machine for a moment now and then."""
    over = threading.Event()

    def take() -> None:
        while not over.wait(chance.expovariate(1.0 / _BETWEEN_BURSTS_S)):
            with induction.starved(BUSY):
                over.wait(chance.uniform(*_BURST_S))

    thread = threading.Thread(target=take)
    thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join()


class System(Protocol):
    """A robot: start() waits until it is in normal operation, or raises LiveError."""

    def start(self) -> None: ...
    def end(self) -> None: ...


# Induces a fault, hands out its onset [s since 1970], or None: it is now, and undoes it.
Broken = ContextManager[Optional[float]]


@dataclass(frozen=True)
class Step:
    """A fault that is to come, or normal operation."""

    fault: str  # its name; of normal operation: what it is called
    lasts_s: float  # from the onset to when it is undone, at most [s]
    culprits: Tuple[str, ...] = ()  # sources to blame; empty: none, or the whole machine
    broken: Callable[[], Broken] = contextlib.nullcontext
    is_normal: bool = False  # nothing is wrong
    round: int = 1  # number, from 1 on
    reset: bool = False  # the monitor's ~reset is called before
    # Waits instead until the node is back by itself; returns when it was heard [s since 1970],
    # None: it was not in `lasts_s`.
    returned: Optional[Callable[[], Optional[float]]] = None


@dataclass(frozen=True)
class Plan:
    """What a session does."""

    system: System  # the robot
    what: str  # is recorded of it, to learn from (recordings)
    learning: Learning  # how much
    steps: Iterator[Step]  # drawn one after the other, while the session goes on
    # After so long without an alarm a fault that was undone is over [s]; AFTERMATH_S or more.
    quiet_s: float
    quiet_within_s: float  # an alarm that stands for longer does not clear [s]; 0: nobody waits
    budget: float = BUDGET  # false alarms an hour that the limits allow
    beside: Sequence[Sequence[str]] = ()  # commands that run beside the monitor
    also: Callable[[], List[Row]] = list  # called after every step, returns further rows


def run(plan: Plan, folder: Path, processes: Processes, told: Callable[[Row], None]) -> None:
    """Run a session; told: gets every row as soon as it is measured. The master runs, and this
    process is a node. Raise LiveError if a program failed, or something does not happen in time,
    InduceError if a fault cannot be induced."""
    model = _learn(plan, folder, processes)
    plan.system.start()
    monitor = MonitorListener()
    config = folder / 'monitor.yaml'
    config.write_text(yaml.safe_dump({'recorder': {'directory': str(folder / 'alarms')}}))
    processes.start('monitor', 'roslaunch', '--wait', 'self_awareness', 'monitor.launch',
                    f'model:={model}', f'config:={config}', 'respawn:=false')
    await_condition('the monitor says something', lambda: bool(monitor.statuses), STARTED_WITHIN_S)
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


def _learn(plan: Plan, folder: Path, processes: Processes) -> Path:
    """Record starts of the robot by record.launch, but for recordings that the folder holds
    already; train and calibrate; return the model."""
    ended = -_APART_S  # the last one, by time.monotonic()
    for prefix, number, length_s in (
            (_TRAINING, plan.learning.starts, plan.learning.training_s),
            (_CALIBRATION, plan.learning.calibrations, plan.learning.calibration_s)):
        for name in (f'{prefix}_{turn}' for turn in range(1, number + 1)):
            if not _recorded(folder, name):
                not_before = ended + _APART_S if plan.what == BAGS else ended
                ended = _record(plan, folder, name, length_s, not_before, processes)
    model = str(folder / _MODEL)
    for arguments in (['train', *_recorded(folder, _TRAINING)],
                      ['calibrate', '--model', model, '--normal',
                       *_recorded(folder, _CALIBRATION), '--budget', str(plan.budget)]):
        say(arguments[0])
        processes.run(arguments[0], _WITHIN_S, 'rosrun', 'self_awareness', *arguments, '-o', model)
    return folder / _MODEL


def _record(plan: Plan, folder: Path, name: str, length_s: float, not_before: float,
            processes: Processes) -> float:
    """Record a start of the robot; return when that ended, by time.monotonic()."""
    plan.system.start()
    if not_before > time.monotonic():
        wait(not_before - time.monotonic(), 'so that this start counts as another one')
    recorder = processes.start(
        f'record_{name}', 'roslaunch', '--wait', 'self_awareness', 'record.launch',
        f'what:={plan.what}', f'output:={folder / name}')
    await_condition(f'{name} is written', lambda: any(folder.glob(f'{name}_*.bag.active')),
                    STARTED_WITHIN_S)
    wait(length_s, f'recording {name}')
    processes.end(recorder)
    ended = time.monotonic()
    plan.system.end()
    found = _recorded(folder, name)
    if not found or (plan.what == BAGS and not Path(graph_file(found[0])).exists()):
        raise LiveError(f'{name}: record.launch has written no recording with its graph, see '
                        f'{folder}/record_{name}.log')
    return ended


def _recorded(folder: Path, prefix: str) -> List[str]:
    return sorted(str(path) for path in folder.glob(f'{prefix}_*.bag'))


class Walk:
    """Takes step after step beside a monitor; promised: what the model says of itself, by the
    columns of rows of normal operation."""

    def __init__(self, plan: Plan, monitor: MonitorListener, promised: Dict[str, Any]) -> None:
        self._plan = plan
        self._monitor = monitor
        self._promised = promised
        self._pid = process_id(MONITOR)
        self._normal_since: Optional[float] = None  # the fault before is over since then

    def take(self, step: Step) -> Row:
        """Induce a fault and undo it, or let normal operation pass; return what was measured."""
        note = self._monitor.reset_until_quiet() if step.reset else ''
        what = ' '.join((step.fault, *step.culprits))
        with step.broken() as told:
            since = self._normal_since if step.is_normal else told
            onset = time.time() if since is None else since
            ahead_s, load = time.time() - time.monotonic(), os.getloadavg()[0]
            back = None
            if step.returned is None:
                wait(step.lasts_s, what)
            else:
                say(what)
                back = step.returned()
            end = time.time()
            set_s = end - time.monotonic() - ahead_s
        row = Row(step.fault, ' '.join(source[1:] for source in step.culprits), round=step.round,
                  onset=onset, lasted_s=end - onset, note=note, load=load)
        if abs(set_s) > _CLOCK_STEP_S:
            row = replace(row, void=f"the machine's clock was set by {set_s:.2f} s")
        if step.is_normal:
            row = replace(row, alarms=0, **self._promised)
        self._normal_since = None
        if not step.is_normal and self._plan.quiet_within_s:
            row = self._over(row)
        becomes_true(lambda: self._monitor.statuses[-1].stamp > end, _STATUS_WITHIN_S)
        row = replace(measure(row, self._monitor.statuses), **used(self._pid))
        if back is not None and row.blamed_s is not None:
            row = replace(row, back_s=back - onset - row.blamed_s)
        return row

    def _over(self, row: Row) -> Row:
        """Wait until a fault that was undone is over; note when it was."""
        recovered = time.time()
        # Where it does not clear in time, the row tells it.
        becomes_true(lambda: min(self._monitor.quiet_for(), time.time() - recovered)
                     >= self._plan.quiet_s, self._plan.quiet_within_s)
        self._normal_since = recovered + AFTERMATH_S
        return replace(row, recovered_s=recovered - row.onset)


def _promised(path: Path) -> Dict[str, Any]:
    """Return what the model says of itself, by the columns of a row."""
    model = TrainedModel.load(str(path))
    if model.calibration is None:
        raise LiveError(f'{path}: calibrate has written no limits')
    coverage = model.coverage()
    return {'components': len(coverage), 'watched': sum(each.is_watched for each in coverage)}


def used(pid: int) -> Dict[str, Any]:
    """Return what a process uses now, by the columns of a row; raise LiveError if it has ended."""
    process = Path('/proc') / str(pid)
    try:
        fields = dict(line.split(':', 1) for line in (process / 'status').read_text().splitlines())
        # "kB" of /proc are 1024 bytes.
        return {'memory_mb': int(fields['VmRSS'].split()[0]) * 1024 / 1e6,
                'threads': int(fields['Threads']), 'files': len(list((process / 'fd').iterdir()))}
    except (FileNotFoundError, ProcessLookupError) as error:
        raise LiveError(f'process {pid} has ended') from error


class MonitorListener:
    """Keeps all that the monitor says; `rospy.init_node` has been called."""

    # Without a lock: only threads of rospy append to the statuses.
    def __init__(self) -> None:
        self.statuses: List[Status] = []  # all so far
        self._heard_at = self._quiet_since = time.monotonic()
        rospy.Subscriber(f'{MONITOR}/status', SelfAwareness, self._on_status, queue_size=1000)

    def quiet_for(self) -> float:
        """Return for how long [s] there has been no alarm, and no settling, until now; raise
        LiveError if the monitor has gone silent."""
        if not self.statuses:
            return 0.0
        if time.monotonic() - self._heard_at > _NO_STATUS_S:
            raise LiveError(f'the monitor has said nothing for {_NO_STATUS_S:g} s')
        return time.monotonic() - self._quiet_since

    def reset_until_quiet(self) -> str:
        """Reset the monitor until it is quiet; return a note if that took long or failed, raise
        LiveError if it does not answer. The alarm of one fault must not stand at the onset of the
        next one."""
        for resets in range(1, _MOST_RESETS + 1):
            try:
                rospy.wait_for_service(f'{MONITOR}/reset', _SERVICE_WITHIN_S)
                rospy.ServiceProxy(f'{MONITOR}/reset', Trigger)()
            except (rospy.ROSException, rospy.ServiceException) as error:
                raise LiveError(f'{MONITOR}/reset: {error}') from error
            self._quiet_since = time.monotonic()  # what it said before does not count as quiet
            if becomes_true(lambda: self.quiet_for() >= _QUIET_S, _QUIET_WITHIN_S):
                return '' if resets == 1 else f'no alarm only after {resets} times ~reset'
        return f'the alarm stood after {_MOST_RESETS} times ~reset'

    def _on_status(self, message: SelfAwareness) -> None:
        suspects = dict.fromkeys(suspect.source for suspect in message.suspects)  # each once
        status = Status(message.header.stamp.to_sec(), message.level, message.settling,
                        tuple(suspects), message.message, message.component, message.kind,
                        message.events)
        self._heard_at = time.monotonic()
        if status.level >= ERROR or status.settling:
            self._quiet_since = self._heard_at
        self.statuses.append(status)


@contextlib.contextmanager
def listening(topics: Sequence[str]) -> Iterator[Callable[[str, str], float]]:
    """Hand out what returns when a node was last heard on a topic [s since 1970]; 0: never."""
    last: Dict[Tuple[str, str], float] = {}

    def on_message(message: rospy.AnyMsg, topic: str) -> None:
        last[message._connection_header['callerid'], topic] = time.time()

    subscribers = [rospy.Subscriber(topic, rospy.AnyMsg, on_message, topic, queue_size=100)
                   for topic in dict.fromkeys(topics)]
    try:
        yield lambda source, topic: last.get((source, topic), 0.0)
    finally:
        for subscriber in subscribers:
            subscriber.unregister()


@contextlib.contextmanager
def heard(expected: Sequence[Tuple[str, str]]) -> Iterator[None]:
    """Wait at the end of a with statement until sources were heard on topics since its begin, or
    raise LiveError."""
    begin = time.time()
    with listening([topic for _, topic in expected]) as last:
        yield
        for source, topic in expected:
            await_condition(f'{source} publishes {topic}', lambda: last(source, topic) > begin,
                            STARTED_WITHIN_S)
