"""Silences that one recording alone shows: found, named, and left out if that is asked."""
from __future__ import annotations

from types import SimpleNamespace
from typing import List, Tuple, cast

import numpy as np
import pytest

from self_awareness import Coverage, EventType
from self_awareness.calibration import heads_and_tails, holes
from self_awareness.calibration.heads_and_tails import Silence
from self_awareness.parts import BagPart
from self_awareness.recordings import RecordingEvents
from self_awareness.stamps import SECOND_NS

GPS, SCAN = EventType('/gps', '/fix', 'T'), EventType('/laser', '/scan', 'T')
ORIGIN = 1_600_000_000 * SECOND_NS


def recorded(name: str, *silent: Tuple[float, float], seconds: float = 100.0) -> RecordingEvents:
    """Return a recording of two timers at 5 Hz, of which /gps is silent now and then."""
    ticks = np.arange(0.0, seconds, 0.2)
    gps = ticks[~np.any([(ticks >= begin) & (ticks < end) for begin, end in silent], axis=0)] \
        if silent else ticks
    stamps = np.concatenate([gps, ticks + 0.01])
    order = np.argsort(stamps, kind='stable')
    ids = np.repeat(np.array([0, 1], dtype=np.uint32), [len(gps), len(ticks)])[order]
    return RecordingEvents([GPS, SCAN], ORIGIN + (stamps[order] * SECOND_NS).astype(np.int64), ids,
                           ORIGIN + int(seconds * SECOND_NS), 1, part=BagPart(name), origin=ORIGIN)


def found(*recordings: RecordingEvents) -> List[holes.Hole]:
    """Return the holes of some recordings."""
    return holes.find([(each.part, heads_and_tails.silences(each)) for each in recordings])


def known(component: str, found_s: float) -> Coverage:
    """Return what is known of who is watched."""
    return cast(Coverage, SimpleNamespace(component=component, death_found_after=found_s))


def test_the_longest_silence_of_every_type_is_known() -> None:
    silences = heads_and_tails.silences(recorded('a.bag', (40.0, 46.0), (60.0, 62.0)))
    assert silences[GPS].begin_s == pytest.approx(39.8, abs=1e-3)
    assert silences[GPS].length_s == pytest.approx(6.2, abs=1e-3)
    assert silences[SCAN].length_s == pytest.approx(0.2, abs=1e-3)


def test_what_a_recording_cuts_off_is_no_hole() -> None:
    silences = heads_and_tails.silences(recorded('a.bag', (0.0, 20.0), (60.0, 200.0)))
    assert silences[GPS].length_s == pytest.approx(0.2, abs=1e-3)


def test_what_came_seldom_says_nothing() -> None:
    assert GPS not in heads_and_tails.silences(recorded('a.bag', (5.0, 200.0)))


def test_a_hole_is_what_one_recording_alone_shows() -> None:
    normal = [recorded(name) for name in ('a.bag', 'b.bag')]
    hole, = found(*normal, recorded('c.bag', (40.0, 46.0)))
    assert (hole.part.path, hole.component) == ('c.bag', '/gps')
    assert hole.others_s == pytest.approx(0.2, abs=1e-3)
    assert not found(*normal, recorded('c.bag', (40.0, 40.7))), 'a second more is little'
    assert not found(*normal, *(recorded(name, (40.0, 46.0)) for name in ('c.bag', 'd.bag')))
    assert not found(normal[0], recorded('c.bag', (40.0, 46.0))), 'one of two: who is right?'


def test_what_the_training_showed_is_as_good_as_other_recordings() -> None:
    part = recorded('c.bag', (40.0, 46.0))
    silences = [(part.part, heads_and_tails.silences(part))]
    assert [hole.component for hole in holes.find(silences, {GPS: 0.3, SCAN: 0.3})] == ['/gps']
    assert not holes.find(silences, {GPS: 3.0})
    assert not holes.find(silences, {})


def test_what_is_left_are_the_parts_before_and_after() -> None:
    normal = [recorded(name) for name in ('a.bag', 'b.bag')]
    recordings = [*normal, recorded('c.bag', (40.0, 46.0))]
    left = holes.without([each.part for each in recordings], found(*recordings))
    assert [str(part) for part in left] == ['a.bag', 'b.bag', 'c.bag@0-39.8', 'c.bag@46']


def test_several_holes_of_one_recording_leave_parts_that_do_not_meet() -> None:
    part = BagPart('a.bag')
    holes_of = [holes.Hole(part, key, Silence(begin_s, length_s), 0.2) for key, begin_s, length_s
                in ((GPS, 60.0, 6.0), (SCAN, 20.0, 8.0), (SCAN, 22.0, 3.0))]
    assert [str(piece) for piece in holes.without([part], holes_of)] \
        == ['a.bag@0-20', 'a.bag@28-60', 'a.bag@66']


def test_a_line_names_who_when_where_and_the_effect() -> None:
    hole = holes.Hole(BagPart('tuesday.bag'), GPS, Silence(212.0, 6.0), 0.3)
    assert holes.lines([hole], [], True, 'mend it') == [
        'tuesday.bag: /gps (/fix) is silent for 6.0 s from 212.0 s on, 0.3 s at most in the other '
        'recordings']

    decides, agreed = known('/gps', 10.0), known('/gps', 0.6)
    line, mend = holes.lines([hole], [decides], False, 'mend it')
    assert line.endswith('; because of that its death is found after 10 s instead of about 0.5 s')
    assert mend == 'if that was a fault, mend it'
    line, = holes.lines([hole], [agreed], True, 'mend it')
    assert line.endswith('; its death is found after 0.6 s all the same, as most starts agree')
    assert holes.lines([hole], [agreed], False, 'mend it') == []
