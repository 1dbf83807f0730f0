"""What a monitor has said so far, in the shape of a table; knows neither ROS nor the terminal."""
from __future__ import annotations

import fnmatch
import re
import time
from collections import deque
from dataclasses import dataclass
from typing import Any, Callable, Deque, Dict, List, Mapping, Optional, Tuple

from self_awareness.status_names import task_of

LEVELS = ('OK', 'WARN', 'ERROR', 'STALE')
"""As of diagnostic_msgs/DiagnosticStatus."""
SORTS = ('level', 'name', 'rate', 'age', 'limit')
"""By what components can be sorted; `level` puts the worst first."""
STALE_S = 5.0
"""A monitor that was not heard for longer is stale, as the aggregator has it."""

_BARS = '▁▂▃▄▅▆▇█'
_LONGEST_CURVE = 400
_WHOLE, _ITSELF = 'communication', 'monitor'
_DEATHS = ('died', 'never came')
# Components take turns of 50 s; the aggregator waits for 60 s.
_STALE_COMPONENT_S, _FORGOTTEN_COMPONENT_S = 60.0, 120.0
_COUNTED = re.compile(r'[0-9]+, listed every 20 s')
_NUMBER = r'([0-9]+(?:\.[0-9]+)?(?:e[+-]?[0-9]+)?)'
_RATES = re.compile(f'{_NUMBER} of {_NUMBER} Hz')
# A sender has no name that is a pattern, whatever it calls itself.
_STRANGER = re.compile(r'(?:([^ ,*]+) on )?([^ ,*]+): [0-9]+')


@dataclass(frozen=True)
class Component:
    """A component as its status says.

    Args:
        name: of a node, or of a topic where nodes are not known.
        level: index in LEVELS.
        message: in words.
        rate: events a second; None: not told.
        expected: events a second in training; None: not told.
        age: when it was last heard [s ago]; None: it was not.
        share: of its limit that its evidence has reached, 1 is the limit; None: not told.
        found_after: how soon its death is found, in words; empty: not known.
        not_watched: why it is not, or is watched less; empty: it is.
    """

    name: str
    level: int
    message: str
    rate: Optional[float]
    expected: Optional[float]
    age: Optional[float]
    share: Optional[float]
    found_after: str
    not_watched: str


class Said:
    """All that is shown of a monitor."""

    def __init__(self, monitor: str, clock: Callable[[], float] = time.monotonic) -> None:
        """Nothing was said yet.

        Args:
            monitor: its full name.
            clock: steady time [s].
        """
        self._clock = clock
        self._said_at: Dict[str, float] = {}  # when, by status
        self._lists: Dict[Tuple[str, str], str] = {}  # as they were told last, by status and key
        self._mutes: Tuple[str, ...] = ()
        self._all_mutes = 0
        self.heard_at: Optional[float] = None
        """When the monitor said something last; None: it has not."""
        self._monitor = monitor
        self._statuses: Dict[str, Any] = {}
        self._scores: Deque[float] = deque(maxlen=_LONGEST_CURVE)
        self.verdict: Any = None
        """The last SelfAwareness; None: there was none."""
        self.incidents: List[Any] = []
        """The last ones (Incident), the oldest first."""

    def on_status(self, verdict: Any) -> None:
        """Take in the verdict on a window (SelfAwareness)."""
        self.verdict = verdict
        self.heard_at = self._clock()
        share = verdict.score / verdict.threshold if verdict.threshold else 0.0
        self._scores.append(share if share > 0 else 0.0)  # also where it is NaN

    def on_diagnostics(self, array: Any) -> None:
        """Take in a DiagnosticArray: what others say is left out."""
        of_all = ((task_of(self._monitor, status.name), status) for status in array.status)
        told = {task: status for task, status in of_all if task is not None}
        if not told:
            return
        now = self.heard_at = self._clock()
        model = self._value(_WHOLE, 'model')
        self._statuses.update(told)
        self._said_at.update(dict.fromkeys(told, now))
        reloaded = model not in ('', self._value(_WHOLE, 'model'))
        for name in set(self._statuses).difference(told):
            if reloaded or now - self._said_at[name] > _FORGOTTEN_COMPONENT_S:
                del self._statuses[name], self._said_at[name]
        self._keep_lists()

    def on_incidents(self, incidents: Any) -> None:
        """Take in the Incidents."""
        self.incidents = list(incidents.incidents)

    @property
    def heard(self) -> bool:
        """Whether the monitor has said anything."""
        return self.heard_at is not None

    @property
    def silent_for(self) -> float:
        """How long the monitor has said nothing [s]; 0: it never did."""
        return 0.0 if self.heard_at is None else self._clock() - self.heard_at

    @property
    def told(self) -> bool:
        """Whether the monitor has said on /diagnostics how the whole is."""
        return _WHOLE in self._statuses

    @property
    def level(self) -> int:
        """Of the whole, as /diagnostics has it: what is muted is OK."""
        return _level(self._statuses[_WHOLE]) if self.told else 0

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
        """Who is not watched, and why; empty: everybody is, or it is not known."""
        why = {name: reason for name in self._components() if (reason := self._not_watched(name))}
        told = self._list(_WHOLE, 'not watched') or self._value(_WHOLE, 'not watched')
        for name in re.findall(r'(?:^|, )(/[^, ]+)', told):
            why.setdefault(name, '')
        return (', '.join(f'{name} ({reason})' if reason else name for name, reason in why.items())
                or told)

    @property
    def disarmed(self) -> str:
        """Whose delays must be as in training before they are watched; empty: all are."""
        return self._list(_WHOLE, 'delays not watched now')

    @property
    def strangers(self) -> List[Tuple[str, str]]:
        """Who is heard, and where, whom training never saw and nobody has accepted."""
        told = self._list(_WHOLE, 'not accepted, events so far')
        found = (_STRANGER.fullmatch(each) for each in told.split(', '))
        return [(each[1] or '', each[2]) for each in found if each]

    @property
    def mode(self) -> str:
        """Who is off together, as somebody has accepted; empty: nobody is."""
        return self._list(_WHOLE, 'off together, as is accepted')

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
    def mutes(self) -> List[str]:
        """Mutes in words; where there are many, the first."""
        return list(self._mutes)

    @property
    def number_of_mutes(self) -> int:
        """How many mutes there are."""
        return self._all_mutes

    @property
    def level_of_itself(self) -> int:
        """How the monitor says that it is itself."""
        return _level(self._statuses[_ITSELF]) if _ITSELF in self._statuses else 0

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
        found = [self._component(name) for name in self._components()
                 if fnmatch.fnmatch(name, asked)]
        keys = {'level': lambda each: (-each.level, each.name),
                'name': lambda each: each.name,
                'rate': lambda each: (-(each.rate or 0.0), each.name),
                'age': lambda each: (each.age is not None, -(each.age or 0.0), each.name),
                'limit': lambda each: (-(each.share or 0.0), each.name)}
        return sorted(found, key=keys[sort])

    def _components(self) -> List[str]:
        return [name for name in self._statuses if name not in (_WHOLE, _ITSELF)]

    def _component(self, name: str) -> Component:
        status = self._statuses[name]
        level, message = _level(status), status.message
        untold = max(self._said_at.values()) - self._said_at[name]
        if untold > _STALE_COMPONENT_S:
            level, message = LEVELS.index('STALE'), f'not told for {untold:.0f} s'
        # By topic, as in training; the mean of some seconds.
        rates = [match for value in self._values(name).values()
                 if (match := _RATES.fullmatch(value))]
        return Component(
            name, level, message,
            sum(float(match[1]) for match in rates) if rates
            else _number(self._value(name, 'events a second')),
            sum(float(match[2]) for match in rates) if rates else None,
            _number(self._value(name, 'last heard [s ago]')),
            _share(self._value(name, 'share of limit')),
            self._value(name, 'death found after [s]'), self._not_watched(name))

    def _not_watched(self, name: str) -> str:
        accepted = self._value(name, 'not watched: accepted')
        return (self._value(name, 'why not watched')
                or (f'accepted: {accepted}' if accepted else ''))

    def _keep_lists(self) -> None:
        """Keep what was told: for some seconds, long lists are only counted."""
        for key, value in self._values(_WHOLE).items():
            if not _COUNTED.fullmatch(value):
                self._lists[_WHOLE, key] = value
        values = self._values(_ITSELF)
        told = tuple(value for key, value in values.items() if re.fullmatch('mute [0-9]+', key))
        further = values.get('further mute', '')
        number = len(told) + (int(further) if re.fullmatch('[0-9]{1,9}', further) else 0)
        if len(told) >= len(self._mutes) or number != self._all_mutes:
            self._mutes = told
        self._all_mutes = number

    def _list(self, name: str, key: str) -> str:
        value = self._value(name, key)
        return self._lists.get((name, key), '') if _COUNTED.fullmatch(value) else value

    def _value(self, name: str, key: str) -> str:
        return self._values(name).get(key, '')

    def _values(self, name: str) -> Mapping[str, str]:
        status = self._statuses.get(name)
        return {} if status is None else {pair.key: pair.value for pair in status.values}


def _level(status: Any) -> int:
    """Return an index in LEVELS, whatever somebody has published: bytes have a sign in rospy."""
    level = int(status.level)
    return level if 0 <= level < len(LEVELS) else LEVELS.index('STALE')


def _share(text: str) -> Optional[float]:
    percent = _number(text[:-2]) if text.endswith(' %') else None
    return None if percent is None else percent / 100.0


def _number(text: str) -> Optional[float]:
    try:
        return float(text)
    except ValueError:
        return None
