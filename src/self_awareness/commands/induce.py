"""`rosrun self_awareness induce`: induces a fault in the running follow-me robot."""
from __future__ import annotations

import argparse
import contextlib
import signal
import time
from pathlib import Path
from typing import Optional

from self_awareness import progress
from self_awareness.commands import cli
from self_awareness_follow_me import induction
from self_awareness_follow_me.effects import Crash, Silence
from self_awareness_follow_me.faults import described, effect_of, in_short
from self_awareness_follow_me.scenario import load_scenario


def _induce(arguments: argparse.Namespace) -> None:
    # A termination must clean up like Ctrl-C.
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    scenario = load_scenario(arguments.scenario)
    effect = effect_of(scenario, arguments.kind)
    if not isinstance(effect, (Crash, Silence)):
        with induction.lasting(effect, arguments.kind, arguments.namespace, arguments.scenario):
            _last(f'fault {arguments.kind}', arguments.duration)
        return
    if arguments.duration is not None:
        arguments.refuse('--duration: not for this fault, which kills nodes: they stay dead')
    if isinstance(effect, Crash):
        pids = {effect.component: induction.crash(effect, arguments.namespace)}
    else:
        pids = induction.silence(scenario, arguments.namespace)
    for name, pid in pids.items():
        progress.say(f'{time.time():.3f} {name} killed (pid {pid})')


def _last(what: str, duration_s: Optional[float]) -> None:
    """Wait for the duration (s), without one until Ctrl-C."""
    progress.say(f'{time.time():.3f} {what} begins')
    with contextlib.suppress(KeyboardInterrupt):
        if duration_s is None:
            signal.pause()
        else:
            for _ in progress.waiting(duration_s, what):
                pass
    progress.say(f'{time.time():.3f} {what} ends')


def _arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('kind', type=in_short, metavar='KIND', help='one of the faults below')
    parser.add_argument('--duration', type=cli.above_zero('a time in s'), metavar='S',
                        help='how long it lasts in s; not for faults that kill nodes (default: '
                             'until Ctrl-C)')
    parser.add_argument('--namespace', default='', metavar='NS',
                        help='namespace of the robot (default: none)')
    parser.add_argument('--scenario', type=Path, metavar='FILE',
                        help='the robot (default: config/follow_me.yaml of the package)')
    parser.set_defaults(refuse=parser.error)


main = cli.Program('induce', __doc__, f'faults:\n{described()}', _arguments, _induce)
