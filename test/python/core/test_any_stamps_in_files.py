"""Whatever stamps a bag has, an event log of it has the same, to the nanosecond."""
from __future__ import annotations

from pathlib import Path
from typing import List

import rosbag
import rospy
from any_stamps import LEFT_OUT, SECOND, Event, recordings
from hypothesis import assume, given, settings
from std_msgs.msg import String

from self_awareness import EncodingRules, EventLogWriter, read_events


def write_bag(path: Path, events: List[Event]) -> None:
    """Write a bag with an event of each topic."""
    with rosbag.Bag(str(path), 'w') as bag:
        for stamp, letter in events:
            header = {'topic': f'/{letter}', 'type': String._type, 'md5sum': String._md5sum,
                      'message_definition': String._full_text, 'callerid': '/node'}
            bag.write(f'/{letter}', String(), rospy.Time(*divmod(stamp, SECOND)),
                      connection_header=header)


@settings(max_examples=40, deadline=None, derandomize=True, database=None,
          suppress_health_check=LEFT_OUT)
@given(recordings())
def test_a_log_has_the_stamps_of_the_bag(tmp_path: Path, events: List[Event]) -> None:
    # As for rosbag, a stamp of 0 is none.
    stamped = [(stamp, f'/{letter}') for stamp, letter in events if stamp > 0]
    assume(stamped)
    write_bag(tmp_path / 'bag.bag', events)
    log = EventLogWriter(str(tmp_path / 'log.bag'))
    log.add_bag(str(tmp_path / 'bag.bag'), EncodingRules())
    log.close()
    read = [read_events(str(tmp_path / 'bag.bag'), EncodingRules()),
            read_events(str(tmp_path / 'log.bag'), EncodingRules(), recording=0)]
    for found in read:
        scopes = [found.event_types[index].scope for index in found.ids]
        # A bag is sorted by stamps; equal ones of several topics have no order in it.
        assert sorted(zip(found.stamps.tolist(), scopes)) == sorted(stamped)
        assert (found.stamps[:-1] <= found.stamps[1:]).all()
    assert read[0].ids.tolist() == read[1].ids.tolist()
