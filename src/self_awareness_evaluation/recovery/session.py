"""One session: a fast robot whose nodes are respawned, the monitor, the recovery, and faults."""
from __future__ import annotations

import signal
import threading
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Dict, List

import rospy
import yaml

from self_awareness.msg import RecoveryAction, RecoveryActions, SelfAwareness
from self_awareness.recovery import history
from self_awareness.recovery.ladder import SHORTEST_HEALING_S
from self_awareness.recovery.node_process import process_of
from self_awareness_evaluation.live.learning import learn
from self_awareness_evaluation.live.listeners import (STARTED_WITHIN_S, MonitorListener,
                                                      RobotListener)
from self_awareness_evaluation.live.master import own_master
from self_awareness_evaluation.live.passing import say, wait
from self_awareness_evaluation.live.processes import Processes, await_condition, becomes_true
from self_awareness_evaluation.recovery.measures import Blamed, Hang, Restart
from self_awareness_evaluation.soak.measures import Happened
from self_awareness_evaluation.soak.robot import Robot
from self_awareness_evaluation.soak.schedule import CRASH, faults, regular
from self_awareness_follow_me.induction import InduceError, process_id
from self_awareness_follow_me.scenario import load_scenario

DELAY_S = 1.0
"""Of the rules: an alarm stands for so long before a node is restarted [s]."""

_MONITOR, _RECOVERY = '/self_awareness', '/self_awareness_recovery'
_VICTIM, _ITS_TOPIC = '/player', 'scan'
_GRACE_S = 1.0
_MOST_STEPS = history.MOST  # more than faults: what is wrong is to be seen
_QUIET_WITHIN_S = 90.0
_BACK_WITHIN_S = 60.0
_CRASH_LASTS_S = 1.0
# The next fault is a new one, not what the last step did not help against.
_HEALED_S = max(DELAY_S, SHORTEST_HEALING_S) + 1.0


@dataclass(frozen=True)
class RecoveryPlan:
    """What a session does.

    Args:
        times: that the laser driver hangs.
        minutes: of faults at random.
        seed: of the faults, and of what is random in the robot.
        speed: of the robot, in its usual one.
        training_s: length of each of the two recordings to learn from, and of the one that the
            limits are found by [s].
    """

    times: int
    minutes: float
    seed: int
    speed: float
    training_s: float


@dataclass(frozen=True)
class Recovered:
    """What happened in a session.

    Args:
        hangs: of the laser driver.
        happened: the faults at random.
        restarts: that the recovery made meanwhile.
        blamed: the alarms meanwhile.
    """

    hangs: List[Hang]
    happened: List[Happened]
    restarts: List[Restart]
    blamed: List[Blamed]


def run(plan: RecoveryPlan, folder: Path) -> Recovered:
    """Run a session under a master of its own; nothing of it runs on afterwards.

    Args:
        plan: what to do.
        folder: exists; for recordings, the model and logs. Recordings that it holds are used
            again.

    Raises:
        LiveError: a program failed, or something does not happen in time.
        InduceError: a fault cannot be induced.
    """
    with own_master(folder) as processes:
        return _Session(plan, folder, processes).run()


class _Actions:
    """What the recovery does, as it says."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._seen: Dict[int, RecoveryAction] = {}  # by their begin. Guarded by _lock.
        rospy.Subscriber(f'{_RECOVERY}/actions', RecoveryActions, self._on_actions)

    @property
    def restarts(self) -> List[Restart]:
        """All so far."""
        with self._lock:
            return [Restart(each.component, each.begin.to_sec()) for each in self._seen.values()]

    def _on_actions(self, message: RecoveryActions) -> None:
        with self._lock:
            self._seen.update((each.begin.to_nsec(), each) for each in message.actions)


class _Session:
    def __init__(self, plan: RecoveryPlan, folder: Path, processes: Processes) -> None:
        self._plan = plan
        self._folder = folder
        self._processes = processes
        self._scenario = load_scenario()
        self._robot = Robot(self._scenario, plan.speed, folder, processes, respawn=True)
        self._monitor = MonitorListener()
        self._actions = _Actions()

    def run(self) -> Recovered:
        model = self._model()
        self._robot.start(self._seed(0))
        say('starting the monitor and the recovery')
        self._processes.start('monitor', 'rosrun', 'self_awareness', 'self_awareness_node',
                              f'__name:={_MONITOR[1:]}', f'_model:={model}',
                              f'_recorder/directory:={self._folder / "alarms"}')
        self._processes.start('recovery', 'rosrun', 'self_awareness', 'recovery.py',
                              str(self._rules()), f'__name:={_RECOVERY[1:]}')
        await_condition('the monitor has settled', self._is_quiet, STARTED_WITHIN_S)
        hangs = [self._hang(number) for number in range(1, self._plan.times + 1)]
        begin = time.time()
        happened = self._break_for(60.0 * self._plan.minutes)
        return Recovered(hangs, happened,
                         [each for each in self._actions.restarts if each.at > begin],
                         [Blamed(status.component, status.received)
                          for status in self._monitor.statuses
                          if status.level >= SelfAwareness.ERROR and status.received > begin])

    def _model(self) -> Path:
        model = self._folder / 'recovery.model'
        logs = [self._robot.recorded(f'training_{number}', self._seed(number),
                                     self._plan.training_s) for number in (1, 2, 3)]
        learn(self._processes, model, logs[:2], logs[2:])
        return model

    def _rules(self) -> Path:
        """Write rules that restart every regular component that has died."""
        path = self._folder / 'rules.yaml'
        path.write_text(yaml.safe_dump({
            'delay': DELAY_S, 'grace': _GRACE_S, 'limit': _MOST_STEPS, 'limit_of_all': _MOST_STEPS,
            'rules': [{'component': f'/{name}', 'kinds': ['died', 'never came'],
                       'steps': [{'stop': [f'/{name}']}]} for name in regular(self._scenario)]}))
        return path

    def _seed(self, number: int) -> int:
        """Return a seed for a start of the robot."""
        return 1000 * self._plan.seed + number

    def _is_quiet(self) -> bool:
        return self._monitor.quiet_for() > _HEALED_S

    def _hang(self, number: int) -> Hang:
        """Stop the laser driver, and see how it comes back."""
        if becomes_true(self._is_quiet, _QUIET_WITHIN_S):
            hang = self._stop_until_back()
        else:
            hang = Hang(None, None, f'the monitor was not quiet within {_QUIET_WITHIN_S:g} s')
        say(f'hang {number} of {self._plan.times}: {hang}')
        return hang

    def _stop_until_back(self) -> Hang:
        pid = process_id(_VICTIM)
        process = process_of(_VICTIM, pid)
        listener = RobotListener([_ITS_TOPIC])
        onset = time.time()
        process.signal(signal.SIGSTOP)
        try:
            seen = len(self._monitor.statuses)
            ended: List[float] = []  # when its process was seen to have ended
            back: List[float] = []  # when another one was heard

            def is_back() -> bool:
                if not ended and not process.runs():
                    ended.append(time.time())
                heard = listener.last(_VICTIM, _ITS_TOPIC)
                if ended and heard > ended[0] and _is_another(pid):
                    back.append(heard)
                return bool(back)

            becomes_true(is_back, _BACK_WITHIN_S)
            alarm = next((status.received for status in self._monitor.statuses[seen:]
                          if status.level >= SelfAwareness.ERROR
                          and status.component == _VICTIM), None)
        finally:
            process.signal(signal.SIGCONT)  # of who was not mended: the next hang is another one
            listener.close()
        return Hang(None if alarm is None else alarm - onset,
                    back[0] - alarm if back and alarm is not None else None)

    def _break_for(self, seconds: float) -> List[Happened]:
        happened: List[Happened] = []
        until = time.monotonic() + seconds
        for number, fault in enumerate(faults(self._scenario, self._plan.seed)):
            if fault.after_s + fault.lasts_s > until - time.monotonic():
                break
            wait(fault.after_s, 'normal operation')
            with self._robot.broken(fault, self._seed(200 + number)) as onset:
                # Who was killed is back at once.
                wait(_CRASH_LASTS_S if fault.kind == CRASH else fault.lasts_s, fault.name)
            happened.append(Happened(fault.name, f'/{fault.component}', onset, time.time()))
            becomes_true(self._is_quiet, _QUIET_WITHIN_S)
        return happened


def _is_another(pid: int) -> bool:
    """Return whether the laser driver is another process now."""
    try:
        return process_id(_VICTIM) != pid
    except InduceError:  # the new one is not known to the master yet
        return False
