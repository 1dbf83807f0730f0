"""What a monitor has said so far, in the shape of a table; knows neither ROS nor the terminal."""
from __future__ import annotations

import fnmatch
import time
from collections import deque
from typing import Any, Callable, Deque, Dict, List, Optional

from self_awareness.status_names import task_of

LEVELS = ('OK', 'WARN', 'ERROR', 'STALE')  # as of diagnostic_msgs/DiagnosticStatus
SORTS = ('level', 'name', 'rate', 'age', 'limit')
"""By what components can be sorted; `level` puts the worst first."""
STALE_S = 5.0  # a monitor that was not heard for longer is stale, as the aggregator has it

_BARS = '▁▂▃▄▅▆▇█'
_LONGEST_CURVE = 400
_WHOLE, _ITSELF = 'communication', 'monitor'
_DEATHS = ('silent', 'topic silent', 'unanswered', 'never came')
_IN_GRAPH = 'in the graph'  # the state of a node that the model does not know


class Said:
    """All that is shown of a monitor, by its full name; the clock is steady [s]."""

    def __init__(self, monitor: str, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self.heard_at: Optional[float] = None
        """When the monitor said something last; None: it has not."""
        self._monitor = monitor
        self._statuses: Dict[str, Any] = {}
        self._components: Any = None  # Components; None: they were not told
        self._scores: Deque[float] = deque(maxlen=_LONGEST_CURVE)
        self.verdict: Any = None  # the last SelfAwareness; None: there was none
        self.incidents: List[Any] = []  # the last ones (Incident), the oldest first

    def on_status(self, verdict: Any) -> None:
        """Take in the verdict on a window (SelfAwareness)."""
        self.verdict = verdict
        self.heard_at = self._clock()
        share = verdict.score / verdict.threshold if verdict.threshold else 0.0
        self._scores.append(share if share > 0 else 0.0)  # also where it is NaN

    def on_diagnostics(self, array: Any) -> None:
        """Take in a DiagnosticArray: what others say is left out."""
        told = {task: status for status in array.status
                if (task := task_of(self._monitor, status.name)) in (_WHOLE, _ITSELF)}
        if told:
            self.heard_at = self._clock()
            self._statuses.update(told)

    def on_components(self, components: Any) -> None:
        """Take in how all components are (Components)."""
        self._components = components
        self.heard_at = self._clock()

    def on_incidents(self, incidents: Any) -> None:
        """Take in the Incidents."""
        self.incidents = list(incidents.incidents)

    @property
    def silent_for(self) -> float:
        """How long the monitor has said nothing [s]; 0: it never did."""
        return 0.0 if self.heard_at is None else self._clock() - self.heard_at

    @property
    def level(self) -> Optional[int]:
        """Of the whole, as /diagnostics has it: what is muted is OK; None: it was not told yet."""
        return level_of(self._statuses[_WHOLE]) if _WHOLE in self._statuses else None

    @property
    def message(self) -> str:
        """Of the whole, in words; empty: there is none yet."""
        return str(self._statuses[_WHOLE].message) if _WHOLE in self._statuses else ''

    @property
    def score(self) -> float:
        """The last score in units of its limit: 1 is the limit."""
        return self._scores[-1] if self._scores else 0.0

    def curve(self, width: int) -> str:
        """Return the last scores as bars; the highest one is the limit, or beyond."""
        return ''.join(_BARS[min(int(share * (len(_BARS) - 1)), len(_BARS) - 1)]
                       for share in list(self._scores)[-width:])

    def listed(self, field: str) -> List[Any]:
        """Return what a field of the last Components lists; nothing, if there was none."""
        return list(getattr(self._components, field, ()))

    @property
    def strangers(self) -> List[Any]:
        """Who is heard whom training never saw and nobody has accepted, as ~accept takes it."""
        # No name is a pattern, whatever its owner calls himself: it would accept others.
        return [each for each in self.listed('strangers')
                if '*' not in each.component + each.topic]

    @property
    def told_mode(self) -> str:
        """The mode that the robot tells, and for how long; empty: nobody tells it."""
        return self._value(_ITSELF, 'mode')

    @property
    def standing(self) -> int:
        """Id of the alarm or suspicion that stands, muted or not; 0: nothing does."""
        stands = self.verdict is not None and self.verdict.level != 0
        return int(self.verdict.alarm) if stands else 0

    @property
    def deaths(self) -> List[str]:
        """Who has died, or never came, of those that what stands names."""
        if not self.standing:
            return []
        named = [(self.verdict.component, self.verdict.kind),
                 *((each.component, each.kind) for each in self.verdict.suspects)]
        return list(dict.fromkeys(component for component, kind in named
                                  if component and kind in _DEATHS))

    @property
    def level_of_itself(self) -> int:
        """How the monitor says that it is itself."""
        return level_of(self._statuses[_ITSELF]) if _ITSELF in self._statuses else 0

    @property
    def itself(self) -> str:
        """What the monitor says of itself."""
        status = self._statuses.get(_ITSELF)
        return '' if status is None else (
            f'{status.message}; {self._value(_ITSELF, "events a second")} events/s, '
            f'{self._value(_ITSELF, "share of a core spent")} cores')

    def components(self, sort: str, pattern: str) -> List[Any]:
        """Return the components (ComponentState) whose names hold a pattern, by one of SORTS.

        Those that the model does not know come last. A pattern is a part of the name, or one with
        `*`; empty: all.
        """
        asked = pattern if '*' in pattern else f'*{pattern}*'
        keys: Dict[str, Callable[[Any], Any]] = {
            'level': lambda each: (-each.level, each.share < 1.0),
            'name': lambda each: each.name,
            'rate': lambda each: -each.rate,
            'age': lambda each: (each.age >= 0.0, -each.age),
            'limit': lambda each: -each.share}
        return sorted((each for each in self.listed('components')
                       if fnmatch.fnmatch(each.name, asked)),
                      key=lambda each: (is_unknown(each), keys[sort](each), each.name))

    def _value(self, name: str, key: str) -> str:
        status = self._statuses.get(name)
        return '' if status is None else next(
            (str(pair.value) for pair in status.values if pair.key == key), '')


def is_unknown(component: Any) -> bool:
    """Whether it is a node of the graph that the model does not know."""
    return bool(component.state == _IN_GRAPH)


def level_of(status: Any) -> int:
    """Return an index in LEVELS, whatever somebody has published: bytes have a sign in rospy."""
    level = int(status.level)
    return level if 0 <= level < len(LEVELS) else LEVELS.index('STALE')
