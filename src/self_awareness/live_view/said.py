"""What a monitor has said so far, in the shape of a table; knows neither ROS nor the terminal."""
from __future__ import annotations

import fnmatch
from collections import deque
from dataclasses import dataclass
from typing import Any, Deque, Dict, List, Mapping, Optional, Tuple

LEVELS = ('OK', 'WARN', 'ERROR', 'STALE')
"""As of diagnostic_msgs/DiagnosticStatus."""
SORTS = ('level', 'name', 'rate', 'age')
"""By what components can be sorted; `level` puts the worst first."""

_BARS = '▁▂▃▄▅▆▇█'
_LONGEST_CURVE = 400
_WHOLE, _ITSELF = 'communication', 'monitor'
_DEATHS = ('died', 'never came')


@dataclass(frozen=True)
class Component:
    """A component as its status says.

    Args:
        name: of a node, or of a topic where nodes are not known.
        level: index in LEVELS.
        message: in words.
        rate: events a second; None: not told.
        age: when it was last heard [s ago]; None: it was not.
        found_after: how soon its death is found, in words; empty: not known.
    """

    name: str
    level: int
    message: str
    rate: Optional[float]
    age: Optional[float]
    found_after: str


class Said:
    """All that is shown of a monitor."""

    def __init__(self, monitor: str) -> None:
        """Nothing was said yet.

        Args:
            monitor: its full name.
        """
        self._prefix = f'{monitor.lstrip("/")}: '
        self._statuses: Dict[str, Any] = {}
        self._scores: Deque[float] = deque(maxlen=_LONGEST_CURVE)
        self.verdict: Any = None
        """The last SelfAwareness; None: there was none."""
        self.incidents: List[Any] = []
        """The last ones (Incident), the oldest first."""

    def on_status(self, verdict: Any) -> None:
        """Take in the verdict on a window (SelfAwareness)."""
        self.verdict = verdict
        share = verdict.score / verdict.threshold if verdict.threshold else 0.0
        self._scores.append(share if share > 0 else 0.0)  # also where it is NaN

    def on_diagnostics(self, array: Any) -> None:
        """Take in a DiagnosticArray: what others say is left out."""
        for status in array.status:
            if status.name.startswith(self._prefix):
                self._statuses[status.name[len(self._prefix):]] = status

    def on_incidents(self, incidents: Any) -> None:
        """Take in the Incidents."""
        self.incidents = list(incidents.incidents)

    @property
    def heard(self) -> bool:
        """Whether the monitor has said anything."""
        return self.verdict is not None or bool(self._statuses)

    @property
    def level(self) -> int:
        """Of the whole, as /diagnostics has it: what is muted is OK."""
        return int(self._statuses[_WHOLE].level) if _WHOLE in self._statuses else 0

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

    @property
    def not_watched(self) -> str:
        """Who is not watched; empty: everybody is, or it is not known."""
        return self._value(_WHOLE, 'not watched')

    @property
    def strangers(self) -> List[Tuple[str, str]]:
        """Who is heard, and where, whom training never saw and nobody has accepted."""
        told = self._value(_WHOLE, 'not accepted, events so far')
        pairs = [each.rpartition(': ')[0].rpartition(' on ') for each in told.split(', ') if each]
        return [(source, topic) for source, _, topic in pairs]

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
    def mutes(self) -> List[str]:
        """All mutes in words."""
        return [value for key, value in self._values(_ITSELF).items() if key.startswith('mute ')]

    @property
    def itself(self) -> str:
        """What the monitor says of itself."""
        status = self._statuses.get(_ITSELF)
        return '' if status is None else (
            f'{status.message}; {self._value(_ITSELF, "events a second")} events/s, '
            f'{self._value(_ITSELF, "share of a core spent")} cores')

    def components(self, sort: str, pattern: str) -> List[Component]:
        """Return the components whose names hold a pattern, sorted.

        Args:
            sort: one of SORTS.
            pattern: a part of the name, or one with `*`; empty: all.
        """
        asked = pattern if '*' in pattern else f'*{pattern}*'
        found = [self._component(name) for name in self._statuses
                 if name not in (_WHOLE, _ITSELF) and fnmatch.fnmatch(name, asked)]
        keys = {'level': lambda each: (-each.level, each.name),
                'name': lambda each: each.name,
                'rate': lambda each: (-(each.rate or 0.0), each.name),
                'age': lambda each: (each.age is not None, -(each.age or 0.0), each.name)}
        return sorted(found, key=keys[sort])

    def _component(self, name: str) -> Component:
        status = self._statuses[name]
        return Component(name, int(status.level), status.message,
                         _number(self._value(name, 'events a second')),
                         _number(self._value(name, 'last heard [s ago]')),
                         self._value(name, 'death found after [s]'))

    def _value(self, name: str, key: str) -> str:
        return self._values(name).get(key, '')

    def _values(self, name: str) -> Mapping[str, str]:
        status = self._statuses.get(name)
        return {} if status is None else {pair.key: pair.value for pair in status.values}


def _number(text: str) -> Optional[float]:
    try:
        return float(text)
    except ValueError:
        return None
