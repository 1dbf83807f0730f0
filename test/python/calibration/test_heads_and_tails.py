"""What a recording holds before a component's first message, and after its last one."""
from __future__ import annotations

from typing import Dict, Optional, Tuple

import numpy as np
import pytest

from self_awareness import EventType
from self_awareness.calibration import heads_and_tails
from self_awareness.recordings import BagPart, RecordingEvents
from self_awareness.stamps import SECOND_NS

ORIGIN = 1_600_000_000 * SECOND_NS
LENGTH_S = 100.0


def recorded(name: str, start: Optional[float] = None,
             **heard: Tuple[float, float]) -> RecordingEvents:
    """Return a recording of timers at 5 Hz, each heard from one time to another."""
    spans: Dict[str, Tuple[float, float]] = {'always': (0.0, LENGTH_S), **heard}
    stamps = [np.arange(0.0, LENGTH_S, 0.2) + 0.001 * number for number in range(len(spans))]
    kept = [each[(each >= begin) & (each < end)]
            for each, (begin, end) in zip(stamps, spans.values())]
    ids = np.repeat(np.arange(len(kept), dtype=np.uint32), [len(each) for each in kept])
    times = np.concatenate(kept)
    order = np.argsort(times, kind='stable')
    return RecordingEvents(
        [EventType(f'/{node}', f'/{node}/t', 'T') for node in spans],
        ORIGIN + (times[order] * SECOND_NS).astype(np.int64), ids[order],
        ORIGIN + int(LENGTH_S * SECOND_NS), 1, part=BagPart(name, start), origin=ORIGIN)


@pytest.mark.parametrize('heard, begin', [
    ({'laser': (14.5, 100.0), 'gps': (7.0, 100.0)}, 14.6),
    ({'laser': (3.0, 100.0)}, None),
    # These do not come with the others.
    ({'laser': (14.5, 100.0), 'camera': (40.0, 100.0), 'joystick': (20.0, 22.0)}, 14.6)])
def test_the_start_lasts_until_all_have_come_that_come_all_the_time(
        heard: Dict[str, Tuple[float, float]], begin: Optional[float]) -> None:
    left = heads_and_tails.without_start_up(recorded('a', None, **heard))
    assert left.part.start == begin and len(left.ids) == len(left.stamps)
    assert (left.stamps[0] - ORIGIN) / SECOND_NS == pytest.approx(begin or 0.0, abs=0.002)


def test_a_begin_that_is_named_stays() -> None:
    for start in (0.0, 3.0):
        whole = recorded('a', start, laser=(14.5, 100.0))
        assert heads_and_tails.without_start_up(whole) is whole


def test_who_starts_after_recordings_or_ends_before_them_is_told() -> None:
    parts = [recorded('a', 0.0, move=(0.0, 94.0)), recorded('b', 0.0, move=(20.0, 100.0)),
             recorded('c', 0.0, move=(0.0, 91.0)), recorded('d', 0.0)]
    lines = heads_and_tails.lines([(each.part, heads_and_tails.silences(each)) for each in parts],
                                  '--start', '--end')
    assert lines == [
        '/move starts after the recording does in 1 of 3: b@0 by 20.0 s. That counts as no pause '
        '(--start leaves it out)',
        '/move ends before the recording does in 2 of 3: a@0 by 6.0 s, c@0 by 9.0 s. That counts '
        'as no pause (--end leaves it out)']
