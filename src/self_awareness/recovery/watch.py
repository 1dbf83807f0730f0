"""What a monitor says, as faults to mend; takes its messages, and knows neither ROS nor the clock.
"""
from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Dict, List, Mapping, Optional, Sequence, Set, Tuple

from self_awareness.recovery.ladder import Fault
from self_awareness.recovery.rules import BLAME_NOBODY
from self_awareness.stamps import nanoseconds

FRESH_S = 2.0  # a monitor that says nothing for so long is not believed any more [s]
BESIDE_S = 5.0
"""Who is not to blame for the alarm is named for so long before it is a fault of its own [s]: who
is well is named now and then."""
_ABNORMAL_S = 0.5  # who was abnormal so recently is so now [s]: not every window of a slow node is

_ERROR = 2  # of SelfAwareness
_DIED = ('silent', 'topic silent', 'unanswered')


@dataclass
class _Named:
    """A component that abnormal windows name."""

    # When they named it first and last, without a pause of _ABNORMAL_S [s].
    since: float
    at: float
    kinds: List[str]  # what is wrong with it, the most likely first; of the last such window
    dead_since: float  # what has died, if something has, is known not to have come since then [s]
    # The alarm named it after it was raised, which it only does with those that are abnormal by
    # themselves.
    later: bool


class Watch:
    """What a monitor has said last; times are steady [s].

    The alarm that stands decides what is a fault: an incident may be of several alarms, and keeps
    the kind of one of them, so that it only gives its id.
    """

    def __init__(self) -> None:
        self._incidents: Optional[Sequence[Any]] = None
        self._heard_at = float('-inf')
        self._status: Any = None
        self._named: Dict[str, _Named] = {}
        # By component, of an event type that has died, and did not come again: the stamp of the
        # first window that names it [ns], and when that was [s].
        self._silences: Dict[str, Tuple[int, float]] = {}

    @property
    def heard(self) -> bool:
        """Whether the monitor has ever said something."""
        return self._status is not None

    def on_incidents(self, incidents: Sequence[Any]) -> None:
        """Take in the last incidents (Incident)."""
        self._incidents = incidents

    def on_status(self, now: float, status: Any) -> None:
        """Take in the verdict on a window (SelfAwareness)."""
        self._heard_at = now
        if self._status is not None and self._status.alarm != status.alarm:
            self._named.clear()
            self._silences.clear()
        self._status = status
        if status.level != _ERROR or not status.abnormal:
            return
        self._named = {name: each for name, each in self._named.items()
                       if now - each.at <= _ABNORMAL_S}
        suspects: Dict[str, List[Any]] = {}
        for suspect in status.suspects:
            suspects.setdefault(suspect.component, []).append(suspect)
        for name, its in suspects.items():
            since = self._named[name].since if name in self._named else now
            # The id of an alarm is the time when it was raised. Who is not abnormal by itself is
            # named since the end of each window anew.
            later = any(status.alarm < each.since.to_nsec() < status.header.stamp.to_nsec()
                        for each in its)
            self._named[name] = _Named(since, now, [each.kind for each in its],
                                       self._dead_since(now, name, its, since), later)

    def why_blind(self, now: float) -> str:
        """Return why nothing is known of what there is to mend; empty: it is known."""
        if now - self._heard_at > FRESH_S or self._incidents is None:
            return 'the monitor is not heard'
        if self._status.settling:
            return 'the monitor has not settled'
        window_s = self._status.window.to_sec()
        if window_s > _ABNORMAL_S:
            return (f'the monitor judges by windows of {window_s:g} s; a recovery takes '
                    f'{_ABNORMAL_S:g} s at most')
        if self._status.level == _ERROR and self._status.kind in BLAME_NOBODY:
            return f'no component is to blame: {self._status.kind}'
        return ''

    def beside(self, now: float) -> List[str]:
        """Return who is abnormal by itself besides the one to blame; also victims."""
        if self.why_blind(now) or self._status.level != _ERROR or not self._status.component:
            return []
        return [name for name, each in self._named.items()
                if name and name != self._status.component and each.later
                and now - each.at <= _ABNORMAL_S and each.at - each.since >= BESIDE_S]

    def faults(self, now: float, listeners: Optional[Mapping[str, Set[str]]] = None
               ) -> Optional[List[Fault]]:
        """Return what there is to mend; None: it is not known.

        Args:
            now: [s].
            listeners: by each node, who hears it; None: not known, so that only the one that is
                to blame is a fault.
        """
        if self.why_blind(now):
            return None
        status = self._status
        if status.level != _ERROR or not status.component:
            return []
        incident = self._incident()
        number = status.alarm if incident is None else incident.id
        named = self._named.get(status.component)
        faults = [self._fault(number, status.component, status.kind,
                              named is not None and now - named.at <= _ABNORMAL_S)]
        if incident is None or listeners is None:
            return faults
        return faults + [self._fault(number, name, '', True)
                         for name in self.beside(now)
                         if name not in incident.victims
                         and not self._hears_one(name, listeners)]

    def _dead_since(self, now: float, name: str, suspects: Sequence[Any], named: float) -> float:
        """Return since when what has died of a component is known not to have come [s].

        Who works at half its rate has died at the end of every gap, and comes again. Where the
        window does not tell for how long it has been silent, that is since windows name it.
        """
        died = [each for each in suspects if each.kind in _DIED]
        silent = [each.silence for each in died if not math.isnan(each.silence)]
        stamp = self._status.header.stamp.to_nsec()
        before = self._silences.get(name)
        if silent and (before is None or stamp - nanoseconds(max(silent)) > before[0]):
            self._silences[name] = stamp, now
        if not silent:
            return named
        since = self._silences[name][1]
        return since if len(silent) == len(died) else min(since, named)

    def _incident(self) -> Any:
        """Return the incident of the alarm that stands; None: it is not known yet."""
        return next((each for each in reversed(self._incidents or ())
                     if not each.over and self._status.alarm in (each.id, each.last)), None)

    def _fault(self, incident: int, component: str, of_alarm: str, stands: bool) -> Fault:
        """Return what is wrong with a component now, which may be another thing than at first."""
        named = self._named.get(component)
        kind = of_alarm if named is None or of_alarm in named.kinds else named.kinds[0]
        if named is None or kind not in _DIED:
            return Fault(incident, component, kind, stands)
        return Fault(incident, component, kind, stands, named.dead_since)

    def _hears_one(self, name: str, listeners: Mapping[str, Set[str]]) -> bool:
        """Return whether somebody else that is named may be why a component is abnormal."""
        causes = {self._status.component, *self._named} - {name, ''}
        if not causes <= set(listeners):  # one is gone: who hears it is not known
            return True
        reached: Set[str] = set()
        left = list(causes)
        while left:
            hearing = listeners.get(left.pop(), set()) - reached
            reached |= hearing
            left += hearing
        return name in reached
