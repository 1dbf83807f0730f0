"""`rosrun self_awareness top`: shows in a terminal what a monitor says, as it says it."""
from __future__ import annotations

import argparse
import copy
import sys
import threading
from functools import partial
from typing import Any, Callable, Dict, List

import rosgraph
import rospy
from diagnostic_msgs.msg import DiagnosticArray
from std_srvs.srv import Trigger

from self_awareness.commands import cli
from self_awareness.live_view.said import Said
from self_awareness.msg import Acceptance, Components, Incidents, SelfAwareness
from self_awareness.srv import Accept, Mute

_EPILOG = """\
Keys: q quit, s sort by another column, f filter by a part of the name, p pause, m mute the
selected component for 10 minutes (after y), u take the last mute back, a accept what stands, or,
if nothing does, who is new (after y), c clear the alarm, d write the flight recorder's file. 80
columns are enough. A monitor that was not heard for 5 s is STALE. It ends when the master is
gone.
"""

_MASTER_EVERY_S = 1.0
_GOODBYE_S = 2.0


def _top(arguments: argparse.Namespace) -> None:
    try:
        from self_awareness.live_view.screen import Screen
    except ImportError as error:
        raise ValueError('needs urwid, which is not installed: apt install python3-urwid'
                         ) from error
    if not sys.stdout.isatty() or not sys.stdin.isatty():
        raise ValueError('needs a terminal; for programs there are ~status and ~incidents')
    if not rosgraph.is_master_online():
        raise ValueError(f'no master answers at {rosgraph.get_master_uri()}')
    # rospy writes into the terminal otherwise, and takes Ctrl-C for itself.
    rospy.init_node('self_awareness_top', anonymous=True, disable_rosout=True,
                    disable_signals=True)
    monitor = rospy.resolve_name(arguments.monitor)
    listener = _Listener(monitor)
    screen = Screen(listener.said, listener.is_over, _calls(monitor))
    try:
        screen.run()
    finally:
        # A master whose machine is gone would not answer for a minute.
        goodbye = threading.Thread(target=rospy.signal_shutdown, args=('',), daemon=True)
        goodbye.start()
        goodbye.join(_GOODBYE_S)
    if screen.why:
        raise ValueError(screen.why)


class _Listener:
    """Keeps what a monitor says, and looks whether the master is there."""

    def __init__(self, monitor: str) -> None:
        self._lock = threading.Lock()
        self._said = Said(monitor)
        self._why = ''
        for topic, kind, take in (
                (f'{monitor}/status', SelfAwareness, self._said.on_status),
                (f'{monitor}/incidents', Incidents, self._said.on_incidents),
                (f'{monitor}/components', Components, self._said.on_components),
                ('/diagnostics', DiagnosticArray, self._said.on_diagnostics)):
            rospy.Subscriber(topic, kind, self._locked(take))
        threading.Thread(target=self._watch, daemon=True).start()

    def said(self) -> Said:
        """Return a copy of what was said so far."""
        with self._lock:
            return copy.deepcopy(self._said)

    def is_over(self) -> str:
        """Return why nothing more will come; empty: it goes on."""
        return self._why

    def _locked(self, take: Callable[[Any], None]) -> Callable[[Any], None]:
        def on_message(message: Any) -> None:
            with self._lock:
                take(message)
        return on_message

    def _watch(self) -> None:
        wait = threading.Event()
        while not wait.wait(_MASTER_EVERY_S):
            if not rosgraph.is_master_online():
                self._why = 'the master is gone'
                return


def _calls(monitor: str) -> Dict[str, Callable[..., str]]:
    def call(service: str, kind: Any, **fields: Any) -> str:
        try:
            return str(rospy.ServiceProxy(f'{monitor}/{service}', kind)(**fields).message)
        except (rospy.ServiceException, rospy.ROSException, OSError) as error:
            return f'not done: {error}'

    def mute(component: str, duration: float) -> str:
        return call('mute', Mute, component=component, duration=duration)

    def accept(alarm: int, strangers: List[Acceptance]) -> str:
        return call('accept', Accept, alarm=alarm, more=[] if alarm else strangers)

    return {'c': partial(call, 'clear', Trigger), 'd': partial(call, 'dump', Trigger),
            'm': mute, 'a': accept}


def _arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('monitor', nargs='?', default='/self_awareness', metavar='MONITOR',
                        help='name of the monitor (default: /self_awareness)')


main = cli.Program('top', __doc__, _EPILOG, _arguments, _top, is_node=True)
