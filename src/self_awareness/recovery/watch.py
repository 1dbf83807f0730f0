"""What a monitor says, as faults to mend; takes its messages, and knows neither ROS nor the clock.
"""
from __future__ import annotations

from typing import Any, List, Optional, Sequence, Set

from self_awareness.recovery.ladder import Fault

FRESH_S = 2.0
"""A monitor that says nothing for so long is not believed any more [s]."""
_ABNORMAL_S = 0.5
"""Who was abnormal so recently is so now [s]: not every window of a slow node is."""

_ERROR = 2  # of SelfAwareness
_NOBODY_IS_TO_BLAME = ('busy machine', 'all silent')


class Watch:
    """What a monitor has said last; times are steady [s]."""

    def __init__(self) -> None:
        self._incidents: Optional[Sequence[Any]] = None
        self._heard_at = float('-inf')
        self._settling = True
        self._abnormal_at = float('-inf')
        self._abnormal: Set[str] = set()

    def on_incidents(self, incidents: Sequence[Any]) -> None:
        """Take in the last incidents (Incident)."""
        self._incidents = incidents

    def on_status(self, now: float, status: Any) -> None:
        """Take in the verdict on a window (SelfAwareness)."""
        self._heard_at = now
        self._settling = status.settling
        if status.level == _ERROR and status.abnormal:
            self._abnormal_at = now
            self._abnormal = {suspect.component for suspect in status.suspects}

    def why_blind(self, now: float) -> str:
        """Return why nothing is known of what there is to mend; empty: it is known."""
        if now - self._heard_at > FRESH_S or self._incidents is None:
            return 'the monitor is not heard'
        if self._settling:
            return 'the monitor has not settled'
        if any(each.kind in _NOBODY_IS_TO_BLAME for each in self._open()):
            return 'the machine is busy, or all are silent: no component is to blame'
        return ''

    def faults(self, now: float) -> Optional[List[Fault]]:
        """Return what there is to mend; None: it is not known."""
        if self.why_blind(now):
            return None
        recent = now - self._abnormal_at <= _ABNORMAL_S
        return [Fault(each.id, each.component, each.kind,
                      recent and each.component in self._abnormal)
                for each in self._open() if each.component]

    def _open(self) -> List[Any]:
        return [each for each in self._incidents or ()
                if each.level == _ERROR and not each.over]
