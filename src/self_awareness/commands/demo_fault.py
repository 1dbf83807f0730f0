"""The end of scripts/demo.sh: kills a component and reports the alarm as operators get it."""
from __future__ import annotations

import argparse
import threading
import time
from typing import Dict, Optional, Sequence

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
        self._first_error: Dict[str, float] = {}
        rospy.Subscriber('/diagnostics', DiagnosticArray, self._on_diagnostics)
        rospy.Subscriber('/diagnostics_agg', DiagnosticArray, self._on_diagnostics)

    def _on_diagnostics(self, array: DiagnosticArray) -> None:
        now = time.time()
        with self._changed:
            for status in array.status:
                self._last[status.name] = status
                if status.level >= DiagnosticStatus.ERROR:
                    self._first_error.setdefault(status.name, now)
            self._changed.notify_all()

    def error_since(self, name: str) -> Optional[float]:
        """Unix time of the first ERROR of a status [s]; None if there was none."""
        with self._changed:
            return self._first_error.get(name)

    def status(self, name: str) -> DiagnosticStatus:
        with self._changed:
            return self._last[name]

    def message(self) -> str:
        """Return what the monitor said last; empty: nothing."""
        with self._changed:
            return self._last[_STATUS].message if _STATUS in self._last else ''

    def await_message(self, text: str, seconds: float) -> bool:
        """Wait until the monitor's status says `text`."""
        with self._changed:
            return self._changed.wait_for(
                lambda: _STATUS in self._last and text in self._last[_STATUS].message, seconds)

    def await_error(self, name: str, seconds: float) -> bool:
        with self._changed:
            return self._changed.wait_for(lambda: name in self._first_error, seconds)


def main(argv: Optional[Sequence[str]] = None) -> int:
    """Kill `player` in the running robot; return 0 if the alarm came after that, and only then."""
    parser = argparse.ArgumentParser(
        prog='demo_fault', description='Kills the laser driver of the simulated robot, and prints '
        'the alarm of the monitor that runs; it is the end of scripts/demo.sh.')
    return cli.run(parser, _demonstrate, argv)


def _demonstrate(_arguments: argparse.Namespace) -> None:
    component = load_scenario().faults.cc1
    rospy.init_node('demo', anonymous=True, disable_signals=True)
    operator = _Operator()
    if not operator.await_message('normal communication', _SETTLED_WITHIN_S):
        if not operator.message():
            raise ValueError('the monitor says nothing; is it running?')
        raise ValueError('the monitor does not settle: ' + operator.message() + '; ' + _OTHER_WORK)
    for _ in waiting(_NORMAL_FOR_S, 'normal operation'):
        if operator.error_since(_STATUS) is not None:
            raise ValueError('an alarm came before the fault: ' + operator.message() + '; '
                             + _OTHER_WORK)
    killed_at = time.time()
    pid = induction.crash(component)
    print(f'killed {component.component} (kill -9 {pid})')
    if not operator.await_error(_STATUS, _ALARM_WITHIN_S):
        raise ValueError(f'no alarm within {_ALARM_WITHIN_S} s')
    _report(operator, killed_at)
    if not operator.await_error(_AGGREGATED, _ALARM_WITHIN_S):
        raise ValueError('no alarm on /diagnostics_agg')
    print(f'on /diagnostics_agg as {_AGGREGATED}')


def _report(operator: _Operator, killed_at: float) -> None:
    status = operator.status(_STATUS)
    values = {pair.key: pair.value for pair in status.values}
    seconds = (operator.error_since(_STATUS) or killed_at) - killed_at
    print(f'\nALARM on /diagnostics {seconds:.2f} s after the fault')
    print(f'  {status.name}')
    print(f'  {status.message}')
    print(f'  {values["share of limit"]} of the limit')
    for key in sorted(key for key in values if key.startswith('suspect')):
        print(f'  {key}: {values[key]}')
    print()
