"""What a recording holds before a component's first message, after its last, and its holes."""
from __future__ import annotations

from types import SimpleNamespace
from typing import Dict, List, Optional, Tuple, cast

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
TICKS = np.arange(0.0, 100.0, 0.2)


def of_times(part: BagPart, times: Dict[EventType, np.ndarray]) -> RecordingEvents:
    """Return a recording of 100 s in which each type comes at these times [s]."""
    stamps = np.concatenate(list(times.values()))
    order = np.argsort(stamps, kind='stable')
    ids = np.repeat(np.arange(len(times), dtype=np.uint32), list(map(len, times.values())))[order]
    return RecordingEvents(list(times), ORIGIN + (stamps[order] * SECOND_NS).astype(np.int64), ids,
                           ORIGIN + 100 * SECOND_NS, 1, part=part, origin=ORIGIN)


def recorded(name: str, *silent: Tuple[float, float]) -> RecordingEvents:
    """Return a recording of two timers at 5 Hz, of which /gps is silent now and then."""
    gps = TICKS
    for begin, end in silent:
        gps = gps[(gps < begin) | (gps >= end)]
    return of_times(BagPart(name), {GPS: gps, SCAN: TICKS + 0.01})


def heard(name: str, start: Optional[float] = None,
          **nodes: Tuple[float, float]) -> RecordingEvents:
    """Return a recording of timers at 5 Hz, each heard from one time to another."""
    times = {EventType('/always', '/always/t', 'T'): TICKS}
    for number, (node, (begin, end)) in enumerate(nodes.items(), 1):
        of_node = TICKS + 0.001 * number
        times[EventType(f'/{node}', f'/{node}/t', 'T')] = of_node[(of_node >= begin)
                                                                  & (of_node < end)]
    return of_times(BagPart(name, start), times)


def found(*recordings: RecordingEvents) -> List[holes.Hole]:
    """Return the holes of some recordings."""
    return holes.find([(each.part, heads_and_tails.silences(each)) for each in recordings])


def known(component: str, found_s: float) -> Coverage:
    """Return what is known of who is watched."""
    return cast(Coverage, SimpleNamespace(component=component, death_found_after=found_s))


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


@pytest.mark.parametrize('nodes, begin', [
    ({'laser': (14.5, 100.0), 'gps': (7.0, 100.0)}, 14.6),
    ({'laser': (3.0, 100.0)}, None),
    # These do not come with the others.
    ({'laser': (14.5, 100.0), 'camera': (40.0, 100.0), 'joystick': (20.0, 22.0)}, 14.6)])
def test_the_start_lasts_until_all_have_come_that_come_all_the_time(
        nodes: Dict[str, Tuple[float, float]], begin: Optional[float]) -> None:
    left = heads_and_tails.without_start_up(heard('a', None, **nodes))
    assert left.part.start == begin and len(left.ids) == len(left.stamps)
    assert (left.stamps[0] - ORIGIN) / SECOND_NS == pytest.approx(begin or 0.0, abs=0.002)


def test_a_begin_that_is_named_stays() -> None:
    for start in (0.0, 3.0):
        whole = heard('a', start, laser=(14.5, 100.0))
        assert heads_and_tails.without_start_up(whole) is whole


def test_who_starts_after_recordings_or_ends_before_them_is_told() -> None:
    parts = [heard('a', 0.0, move=(0.0, 94.0)), heard('b', 0.0, move=(20.0, 100.0)),
             heard('c', 0.0, move=(0.0, 91.0)), heard('d', 0.0)]
    lines = heads_and_tails.lines([(each.part, heads_and_tails.silences(each)) for each in parts],
                                  '--start', '--end')
    assert lines == [
        '/move starts after the recording does in 1 of 3: b@0 by 20.0 s. That counts as no pause '
        '(--start leaves it out)',
        '/move ends before the recording does in 2 of 3: a@0 by 6.0 s, c@0 by 9.0 s. That counts '
        'as no pause (--end leaves it out)']
