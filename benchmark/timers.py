"""The system that most benchmarks measure: timers, each with a chain of two answers."""
from __future__ import annotations

import os
from typing import List, Tuple

import genpy
import numpy as np
import rosbag
from std_msgs.msg import Empty

SIZES = (15, 60, 150, 300, 1000)  # numbers of event types that are measured
_START_NS = 1_600_000_000_000_000_000


def events_of(types: int, duration: float) -> Tuple[np.ndarray, np.ndarray]:
    """Return stamps [ns] and ids of timers of 50 ms to 2 s with chains of two answers each."""
    random = np.random.default_rng(1)
    stamps, ids = [], []
    for timer in range(0, types, 3):
        period = 0.05 * 40.0 ** random.random()
        times = 2.0 * random.random() + np.cumsum(
            period * random.normal(1.0, 0.05, int(duration / period)))
        for kind in range(timer, min(timer + 3, types)):
            stamps.append(times)
            ids.append(np.full(len(times), kind))
            delay = 0.002 + 0.038 * random.random()
            times = times + delay * random.normal(1.0, 0.05, len(times))
    order = np.argsort(np.concatenate(stamps), kind='stable')
    return ((np.concatenate(stamps)[order] * 1e9).astype(np.int64),
            np.concatenate(ids)[order].astype(np.uint32))


def write(folder: str, number: int, types: int, seconds: float) -> Tuple[List[str], int]:
    """Write bags of so many seconds each; return their paths, and the number of all messages."""
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
