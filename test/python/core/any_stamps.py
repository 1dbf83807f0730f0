"""Recordings drawn at random, with stamps that robots give only once in a long time."""
from __future__ import annotations

from typing import Any, Callable, List, Sequence, Tuple

from hypothesis import HealthCheck
from hypothesis import strategies as st

Event = Tuple[int, str]

MS = 10 ** 6
SECOND = 1000 * MS
HOUR = 3600 * SECOND
DAY = 24 * HOUR
END_OF_TIME = 2 ** 32 * SECOND
"""ROS time has 32 bits for its seconds: until 2106."""
LETTERS = 'ABCD'
LEFT_OUT = [check for check in HealthCheck
            if check.name in ('too_slow', 'data_too_large', 'function_scoped_fixture')]
"""Checks of the tests themselves; not all of them are known to hypothesis 5."""

_BEGINNINGS = (0, 1, 1_600_000_000 * SECOND, 2 ** 31 * SECOND - 2 * SECOND,
               END_OF_TIME - 20 * SECOND, END_OF_TIME - 1)
_STEPS = (0, 0, 0, 1, MS, 7 * MS, 10 * MS, 33 * MS, 99 * MS, 100 * MS, 100 * MS, 250 * MS,
          2 * SECOND, 20 * SECOND)
_LATE = (-1, -MS, -100 * MS)
_CLOCK_SET = (-100 * MS - 1, -SECOND, -HOUR, -9 * DAY, HOUR + 1, DAY, 400 * DAY)


@st.composite
def recordings(draw: Callable[..., Any], longest: int = 40) -> List[Event]:
    """Return one recording: its events in the order in which they came, 1 at least."""
    letters = LETTERS[:draw(st.integers(1, len(LETTERS)))]
    steps = draw(st.sampled_from([_STEPS, _STEPS + _LATE, 4 * _STEPS + 2 * _LATE + _CLOCK_SET]))
    stamp = draw(st.one_of(st.sampled_from(_BEGINNINGS), st.integers(0, END_OF_TIME - 1)))
    events = []
    for step, letter in draw(st.lists(
            st.tuples(st.sampled_from(steps), st.sampled_from(letters)), min_size=1,
            max_size=longest)):
        # Where time ends, a clock can only be set back.
        stamp = min(max(stamp + step, 0), END_OF_TIME - 1)
        events.append((stamp, letter))
    return events


@st.composite
def long_recordings(draw: Callable[..., Any]) -> List[Event]:
    """Return a recording of minutes, so that much is watched: a motif again and again, with
    strange steps here and there.
    """
    motif = draw(st.lists(st.tuples(st.sampled_from(_STEPS), st.sampled_from(LETTERS)),
                          max_size=5))
    motif.append((draw(st.sampled_from([250 * MS, 2 * SECOND])), LETTERS[0]))
    strange = draw(st.dictionaries(st.integers(0, 400),
                                   st.sampled_from(_STEPS + _LATE + _CLOCK_SET), max_size=6))
    stamp = draw(st.sampled_from(_BEGINNINGS))
    events = []
    for number in range(len(motif) * draw(st.integers(60, 120))):
        step, letter = motif[number % len(motif)]
        stamp = min(max(stamp + strange.get(number, step), 0), END_OF_TIME - 1)
        events.append((stamp, letter))
    return events


def pieces(events: Sequence[Event]) -> List[List[Event]]:
    """Cut a recording where the clock was set (docs/method.md, section 1.2), literally."""
    found = [[events[0]]]
    for before, event in zip(events, events[1:]):
        if event[0] < before[0] - 100 * MS or event[0] > before[0] + HOUR:
            found.append([])
        found[-1].append(event)
    return found
