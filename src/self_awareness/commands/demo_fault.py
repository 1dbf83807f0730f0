"""The end of scripts/demo.sh: kills the laser's driver, prints the alarm as operators get it."""
from __future__ import annotations

import argparse
import threading
import time
from typing import Callable, Dict

import rospy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus

from self_awareness.commands import cli
from self_awareness.progress import waiting
from self_awareness_follow_me import induction
from self_awareness_follow_me.scenario import load_scenario

_MONITOR = 'self_awareness'
_STATUS = _MONITOR + ': communication'
_AGGREGATED = '/Self-awareness/communication'
_SETTLED_WITHIN_S = 60
_NORMAL_FOR_S = 10
_ALARM_WITHIN_S = 30
_OTHER_WORK = 'if this machine has other work to do, end that and start again'


class _Operator:
    """Sees what an operator sees: /diagnostics and /diagnostics_agg."""

    def __init__(self) -> None:
        self._changed = threading.Condition()
        self._last: Dict[str, DiagnosticStatus] = {}
        self.error_since: Dict[str, float] = {}  # Unix time of the first ERROR of a status [s]
        for topic in ('/diagnostics', '/diagnostics_agg'):
            rospy.Subscriber(topic, DiagnosticArray, self._on_diagnostics)

    def _on_diagnostics(self, array: DiagnosticArray) -> None:
        with self._changed:
            for status in array.status:
                self._last[status.name] = status
                if status.level >= DiagnosticStatus.ERROR:
                    self.error_since.setdefault(status.name, time.time())
            self._changed.notify_all()

    def status(self) -> DiagnosticStatus:
        """Return what the monitor said last."""
        return self._last.get(_STATUS, DiagnosticStatus())

    def awaits(self, condition: Callable[[], bool], seconds: float) -> bool:
        """Wait until something was said; return whether it was."""
        with self._changed:
            return self._changed.wait_for(condition, seconds)


def _demonstrate(_arguments: argparse.Namespace) -> None:
    """Kill `player` in the running robot; raise ValueError unless the alarm came after that."""
    component = load_scenario().faults.cc1
    rospy.init_node('demo', anonymous=True, disable_signals=True)
    operator = _Operator()
    if not operator.awaits(lambda: 'normal communication' in operator.status().message,
                           _SETTLED_WITHIN_S):
        if not operator.status().message:
            raise ValueError('the monitor says nothing; is it running?')
        raise ValueError(f'the monitor does not settle: {operator.status().message}; '
                         f'{_OTHER_WORK}')
    for _ in waiting(_NORMAL_FOR_S, 'normal operation'):
        if _STATUS in operator.error_since:
            raise ValueError(f'an alarm came before the fault: {operator.status().message}; '
                             f'{_OTHER_WORK}')
    killed_at = time.time()
    pid = induction.crash(component)
    print(f'killed {component.component} (kill -9 {pid})')
    if not operator.awaits(lambda: _STATUS in operator.error_since, _ALARM_WITHIN_S):
        raise ValueError(f'no alarm within {_ALARM_WITHIN_S} s')
    _report(operator.status(), operator.error_since[_STATUS] - killed_at)
    if not operator.awaits(lambda: _AGGREGATED in operator.error_since, _ALARM_WITHIN_S):
        raise ValueError('no alarm on /diagnostics_agg')
    print(f'on /diagnostics_agg as {_AGGREGATED}')


def _report(status: DiagnosticStatus, seconds: float) -> None:
    values = {pair.key: pair.value for pair in status.values}
    print(f'\nALARM on /diagnostics {seconds:.2f} s after the fault')
    print(f'  {status.name}')
    print(f'  {status.message}')
    print(f'  {values["share of limit"]} of the limit')
    for key in sorted(key for key in values if key.startswith('suspect')):
        print(f'  {key}: {values[key]}')
    print()


main = cli.Program('demo_fault', __doc__, '', lambda _: None, _demonstrate)
