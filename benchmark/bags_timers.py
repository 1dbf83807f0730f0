"""Writes bags of a robot with many event types, parts of one recording: much to count."""
from __future__ import annotations

import os
from typing import List, Tuple

import genpy
import numpy as np
import rosbag
from std_msgs.msg import Empty

from numpy_scoring import events_of

_START_NS = 1_600_000_000_000_000_000


def write(folder: str, number: int, types: int, seconds: float) -> Tuple[List[str], int]:
    """Write the bags, of so many seconds each.

    Returns:
        their paths, and the number of messages in all of them.
    """
    stamps, ids = events_of(types, number * seconds)
    cuts = np.searchsorted(stamps, [int(1e9 * seconds * part) for part in range(1, number)])
    paths = []
    for part, events in enumerate(zip(np.split(stamps, cuts), np.split(ids, cuts))):
        paths.append(os.path.join(folder, f'part{part}.bag'))
        write_bag(paths[-1], *events)
    return paths, len(stamps)


def write_bag(path: str, stamps: np.ndarray, ids: np.ndarray) -> None:
    """Write events as a bag: stamps [ns] from its start, and the number of each one's topic."""
    message = (Empty._type, b'', Empty._md5sum, 0, Empty)
    with rosbag.Bag(path, 'w') as bag:
        for stamp, kind in zip((stamps + _START_NS).tolist(), ids.tolist()):
            topic = f'/topic_{kind}'
            bag.write(topic, message, genpy.Time(*divmod(stamp, 1_000_000_000)), raw=True,
                      connection_header={
                          'topic': topic, 'callerid': f'/node_{kind // 3}', 'type': Empty._type,
                          'md5sum': Empty._md5sum, 'message_definition': Empty._full_text,
                          'latching': '0'})
