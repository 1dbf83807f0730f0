"""Event logs as the recorder leaves them."""
from __future__ import annotations

import shutil
from pathlib import Path
from typing import Iterable, Tuple

import rosbag
import rospy
from conftest import write_bag

from self_awareness import EncodingRules, EventLogWriter

Message = Tuple[float, str, str]


def write_log(path: Path, messages: Iterable[Message], robot_start: int = 0,
              crashed: bool = False, without: int = -1) -> str:
    """Write a log of one recording.

    Args:
        robot_start: [s].
        crashed: as a recorder leaves it that was killed: without an index.
        without: the number of a part that is missing.
    """
    bag, whole = path.with_suffix('.made_of'), path.with_suffix('.whole')
    write_bag(bag, messages)
    writer = EventLogWriter(str(whole))
    writer.add_bag(str(bag), EncodingRules.defaults())
    writer.close()
    target = path.with_suffix('.open') if crashed else path
    with rosbag.Bag(str(whole)) as source, open(target, 'wb+') as file, \
            rosbag.Bag(file, 'w') as log:
        for topic, message, stamp in source.read_messages():
            if topic == '/event_log/start':
                message.robot_start = rospy.Time(robot_start)
            if topic != '/event_log/events' or message.number != without:
                log.write(topic, message, stamp)
        if crashed:
            log.flush()
            file.flush()
            shutil.copy(str(target), str(path))
    return str(path)
