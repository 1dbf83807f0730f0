"""The plans: which robot, what is learned of it, what is done to it, and what runs beside it."""
from __future__ import annotations

import argparse
import random
import time
from functools import partial
from pathlib import Path
from typing import Callable, Dict, Iterator, List, Optional, Sequence, Tuple

import rospy
import yaml

from self_awareness.msg import RecoveryAction, RecoveryActions
from self_awareness.recovery import history
from self_awareness.recovery.ladder import SHORTEST_HEALING_S
from self_awareness.recovery.node_process import process_of
from self_awareness_evaluation.live.follow_me import FollowMe
from self_awareness_evaluation.live.packaged import FAULTS, PackagedSystem
from self_awareness_evaluation.live.processes import Processes, becomes_true
from self_awareness_evaluation.live.rows import (AT_RANDOM, CRASH, DELAY_S, HANG, HANGS, RESTARTED,
                                                 Row)
from self_awareness_evaluation.live.session import BAGS, EVENTS, Plan, Step, bursts, listening
from self_awareness_evaluation.records import NORMAL, Learning
from self_awareness_evaluation.rows import AFTERMATH_S
from self_awareness_follow_me.induction import process_id

NORMAL_S = 20.0  # of `live`: normal operation at the beginning of each round [s]

# Of `live`: how long each fault lasts in a round [s], in their order; the last one ends the robot.
FAULTS_S: Dict[str, float] = {
    'lat': 8.0, 'half:player': 8.0, 'double:gaze_control': 8.0, 'order': 8.0, 'unknown': 5.0,
    'extra': 8.0, 'rs': 20.0, 'ac': 35.0, 'cc1': 6.0, 'cc2': 6.0, 'silence': 6.0}

# Of `nodes`: the names of normal operation.
_UNDISTURBED, _BURSTS = 'undisturbed', 'undisturbed, but for short bursts of foreign load'

SPEED = 10.0  # of `soak` and `recovery`: of the robot, in its usual one

# At random: shortest and longest of short hangs, which need not be found, and of all others [s].
SHORT_S, LONG_S = (0.2, 1.5), (4.0, 12.0)
PAUSE_S = (5.0, 20.0)  # at random: least and most of normal operation between two faults [s]
_BUDGET = 0.1  # of the soak: false alarms an hour that the limits allow
_PIECE_S = 600.0  # of normal operation, so that little is lost if the session fails
_QUIET_S, _QUIET_WITHIN_S = 10.0, 60.0  # after a fault of the packaged nodes
_AT_RANDOM_QUIET_WITHIN_S = 90.0
_SHARE_OF_SHORT = 0.15
_VICTIM = 'player'
_BACK_WITHIN_S = 60.0
_CRASH_RESPAWNED_S = 1.0  # who was killed is back at once

# After so long without an alarm, the next fault is a new one, and not what the last step did not
# help against [s].
_HEALED_S = max(DELAY_S, SHORTEST_HEALING_S) + 1.0
_RECOVERY = '/self_awareness_recovery'
_MOST_STEPS = history.MOST  # more than faults: what is wrong is to be seen


def live(given: argparse.Namespace, learning: Learning, _: Path, processes: Processes) -> Plan:
    """Return the plan of `evaluate live`: each kind of fault in each round; of all plans, given:
    the arguments of the command, folder: for what the robot needs."""
    robot = FollowMe(processes, seed=0)

    def steps() -> Iterator[Step]:
        for number in range(1, given.rounds + 1):
            yield Step(NORMAL, NORMAL_S, is_normal=True, round=number, reset=True)
            for name, lasts_s in FAULTS_S.items():
                yield Step(name, lasts_s, robot.culprits(name), partial(robot.broken, name),
                           round=number, reset=True)

    return Plan(robot, BAGS, learning, steps(), AFTERMATH_S, 0.0)


def nodes(given: argparse.Namespace, learning: Learning, folder: Path,
          processes: Processes) -> Plan:
    """Return the plan of `evaluate nodes`: undisturbed, with bursts, and fault after fault."""
    system = PackagedSystem(folder, processes)

    def steps() -> Iterator[Step]:
        for length_s in _pieces(60.0 * given.minutes):
            yield Step(_UNDISTURBED, length_s, is_normal=True)
        chance = random.Random(1)
        for length_s in _pieces(60.0 * given.burst_minutes):
            yield Step(_BURSTS, length_s, broken=partial(bursts, chance), is_normal=True)
        for kind, node, lasts_s in FAULTS:
            yield Step(kind, lasts_s, (f'/{node}',) if node else (),
                       partial(system.broken, kind, node), reset=True)

    # An operator looks on, with tools that training did not see.
    return Plan(system, BAGS, learning, steps(), _QUIET_S, _QUIET_WITHIN_S, beside=[
        ['rosbag', 'record', '--all', '--output-name', str(folder / 'operator')],
        ['rostopic', 'echo', '/diagnostics']])


def soak(given: argparse.Namespace, learning: Learning, _: Path, processes: Processes) -> Plan:
    """Return the plan of `evaluate soak`: faults at random."""
    robot = FollowMe(processes, given.seed, SPEED)
    return Plan(robot, EVENTS, learning, _at_random(robot, given), AFTERMATH_S,
                _AT_RANDOM_QUIET_WITHIN_S, _BUDGET)


def with_recovery(given: argparse.Namespace, learning: Learning, folder: Path,
                  processes: Processes) -> Plan:
    """Return the plan of `evaluate recovery`: a node hangs again and again; faults at random."""
    robot = FollowMe(processes, given.seed, SPEED, respawn=True)

    def steps() -> Iterator[Step]:
        name, source = f'{HANG}:{_VICTIM}', f'/{_VICTIM}'
        for _ in range(given.times):
            yield Step(name, _BACK_WITHIN_S, (source,), partial(robot.broken, name), round=HANGS,
                       returned=_returns(source, robot.topics[_VICTIM]))
        yield from _at_random(robot, given, AT_RANDOM, _CRASH_RESPAWNED_S)

    restarts = RestartListener()
    command = _recovery_command(folder / 'rules.yaml', list(robot.topics))
    return Plan(robot, EVENTS, learning, steps(), _HEALED_S, _AT_RANDOM_QUIET_WITHIN_S,
                beside=[command], also=restarts.rows)


def drawn(possible: Sequence[str], seed: int) -> Iterator[Tuple[str, float, float]]:
    """Yield faults without an end, the same for the same seed: their names, the time of normal
    operation before them, and how long they last [s]."""
    chance = random.Random(f'{seed}/faults')
    hangs = [name for name in possible if name.startswith(f'{HANG}:')]
    while True:
        after_s = round(chance.uniform(*PAUSE_S), 1)
        if chance.random() < _SHARE_OF_SHORT:
            yield chance.choice(hangs), after_s, round(chance.uniform(*SHORT_S), 1)
        else:
            yield chance.choice(possible), after_s, round(chance.uniform(*LONG_S), 1)


def _at_random(robot: FollowMe, given: argparse.Namespace, number: int = 1,
               crash_s: float = LONG_S[1]) -> Iterator[Step]:
    """Yield faults at random, with normal operation between them, for some time; crash_s: a node
    that was killed is dead for so long at most [s]."""
    until = time.monotonic() + 60.0 * given.minutes
    for name, after_s, lasts_s in drawn(robot.possible(), given.seed):
        left_s = until - time.monotonic()
        if after_s + lasts_s > left_s:
            yield Step(NORMAL, max(1.0, left_s), is_normal=True, round=number)
            return
        yield Step(NORMAL, after_s, is_normal=True, round=number)
        yield Step(name, min(lasts_s, crash_s) if name.startswith(CRASH) else lasts_s,
                   robot.culprits(name), partial(robot.broken, name), round=number)


def _pieces(length_s: float) -> Iterator[float]:
    while length_s > 0.0:
        yield min(length_s, _PIECE_S)
        length_s -= _PIECE_S


def _recovery_command(rules: Path, components: Sequence[str]) -> List[str]:
    """Write rules that restart every one of these components that has died; return the command."""
    rules.write_text(yaml.safe_dump({
        'delay': DELAY_S, 'grace': 1.0, 'limit': _MOST_STEPS, 'limit_of_all': _MOST_STEPS,
        'rules': [{'component': f'/{name}', 'kinds': ['silent', 'never came'],
                   'steps': [{'stop': [f'/{name}']}]} for name in components]}))
    return ['rosrun', 'self_awareness', 'recovery.py', str(rules), f'__name:={_RECOVERY[1:]}']


class RestartListener:
    """Makes a row of each node that the recovery stops; `rospy.init_node` has been called."""

    def __init__(self) -> None:
        self._seen: Dict[int, RecoveryAction] = {}  # by their begin; only a thread of rospy adds
        self._told = 0
        rospy.Subscriber(f'{_RECOVERY}/actions', RecoveryActions, self._on_actions)

    def rows(self) -> List[Row]:
        """Return those since the last call."""
        new = list(self._seen.values())[self._told:]
        self._told += len(new)
        return [Row(RESTARTED, each.component[1:], onset=each.begin.to_sec()) for each in new]

    def _on_actions(self, message: RecoveryActions) -> None:
        self._seen.update((each.begin.to_nsec(), each) for each in message.actions)


def _returns(node: str, topic: str) -> Callable[[], Optional[float]]:
    """Return what waits until a node that runs, and is to be stopped, is another process, and is
    heard on a topic of it; returns when that was, None if it takes longer than _BACK_WITHIN_S."""
    process = process_of(node, process_id(node))

    def wait() -> Optional[float]:
        until = time.monotonic() + _BACK_WITHIN_S
        with listening([topic]) as last:
            if not becomes_true(lambda: not process.runs(), _BACK_WITHIN_S):
                return None
            ended = time.time()
            is_back = becomes_true(lambda: last(node, topic) > ended, until - time.monotonic())
            return last(node, topic) if is_back else None

    return wait
