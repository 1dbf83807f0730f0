"""What a program reads of a bag."""
from __future__ import annotations

from pathlib import Path
from typing import Set, Tuple

import pytest
import rosbag
from conftest import put, robot
from diagnostic_msgs.msg import DiagnosticArray
from rosgraph_msgs.msg import Log
from sensor_msgs.msg import Image
from std_msgs.msg import String

from self_awareness import EncodingRules, EventLogWriter, read_events, summarise_bag
from self_awareness.msg import SelfAwareness

_IMAGE_BYTES = 1_000_000


@pytest.fixture(scope='module')
def image_bag(tmp_path_factory: pytest.TempPathFactory) -> str:
    """A camera's minute: an image and ten lines of its log every second."""
    path = str(tmp_path_factory.mktemp('images') / 'images.bag')
    image = Image(data=bytes(_IMAGE_BYTES))
    with rosbag.Bag(path, 'w') as bag:
        for i in range(600):
            for topic, message in [('/image', image)] * (i % 10 == 0) + [('/rosout', Log())]:
                put(bag, '/camera', topic, message, 1000 + 0.1 * i)
    return path


def _bytes_read() -> int:
    counts = dict(line.split(': ') for line in Path('/proc/self/io').read_text().splitlines())
    return int(counts['rchar'])


def test_events_outlive_what_they_were_read_with(image_bag: str) -> None:
    stamps = read_events(image_bag, EncodingRules.defaults()).stamps
    ids = read_events(image_bag, EncodingRules.defaults()).ids
    assert len(stamps) == len(ids) == summarise_bag(image_bag).messages
    assert stamps[0] == 1000 * 10**9
    assert (stamps[1:] >= stamps[:-1]).all()
    with pytest.raises(ValueError):
        stamps[0] = 0


def test_the_index_of_an_event_log_is_read_once_for_all_recordings(make_bag, tmp_path: Path
                                                                   ) -> None:
    bag, path = make_bag('robot.bag', robot(1000.0, 100.0)), str(tmp_path / 'many.events.bag')
    log = EventLogWriter(path)
    for _ in range(40):
        log.add_bag(bag, EncodingRules.defaults())
    log.close()
    before = _bytes_read()
    for recording in range(40):
        assert len(read_events(path, EncodingRules.defaults(), recording=recording).stamps) > 4000
    assert _bytes_read() - before < 8 * Path(path).stat().st_size  # not 40 times and more


def test_an_event_log_that_was_replaced_is_read_again(make_bag, tmp_path: Path) -> None:
    path = str(tmp_path / 'robot.events.bag')
    for length in (10.0, 20.0):
        log = EventLogWriter(path)
        log.add_bag(make_bag('robot.bag', robot(1000.0, length)), EncodingRules.defaults())
        log.close()
        events = read_events(path, EncodingRules.defaults(), recording=0)
        assert events.stamps[-1] - events.stamps[0] > (length - 1.0) * 1e9


def test_nodes_of_this_package_are_left_out_whatever_their_names(tmp_path: Path) -> None:
    """What they say in a recording is no communication of the robot."""
    path, encoding = str(tmp_path / 'a.bag'), EncodingRules.defaults()
    with rosbag.Bag(path, 'w') as bag:
        for tick in range(600):
            for source, topic, message in (
                    ('/watch', '/watch/status', SelfAwareness()), ('/watch', '/rosout', Log()),
                    ('/base', '/diagnostics', DiagnosticArray()), ('/watch', '/scan', String())):
                put(bag, source, topic, message, 1000.0 + 0.1 * tick)

    def heard() -> Set[Tuple[str, str]]:
        return {(kind.source, kind.scope) for kind in read_events(path, encoding).event_types}

    assert heard() == {('/base', '/diagnostics'), ('/watch', '/scan')}
    # Where all is under the name of a player, nobody can be told from the robot's nodes.
    encoding.source = 'none'
    assert heard() == {('', '/diagnostics'), ('', '/rosout'), ('', '/scan')}
