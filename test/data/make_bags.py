"""Writes the recordings that the files of a release are made of: make_bags.py FOLDER.

A robot of six nodes: a laser at 10 Hz; slam, which answers it within 25 to 40 ms; navigation,
which answers each second pose; a battery at 2 Hz; a microphone that hears a word now and again;
and a voice that answers it within 60 to 80 ms. The same numbers every time.
"""
from __future__ import annotations

import random
import sys
from pathlib import Path
from typing import Dict, List, Tuple

import rosbag
import rospy
from std_msgs.msg import String

from self_awareness.training.robot_graph import RobotGraph

LASER, SLAM, NAVIGATION, BATTERY = '/laser', '/slam', '/navigation', '/battery'
MICROPHONE, VOICE = '/microphone', '/voice'
TOPICS = {LASER: '/scan', SLAM: '/pose', NAVIGATION: '/cmd_vel', BATTERY: '/charge',
          MICROPHONE: '/word', VOICE: '/reply'}
HEARD_BY: Dict[str, List[str]] = {
    LASER: [SLAM], SLAM: [NAVIGATION], NAVIGATION: [LASER], BATTERY: [NAVIGATION],
    MICROPHONE: [VOICE], VOICE: []}
BEGIN_S = 1700000000.0
FAULT_S = 20.0

Message = Tuple[float, str]


def robot(begin: float, length: float, seed: int, slam_s: float = 0.025,
          late_from: float = float('inf')) -> List[Message]:
    """Return stamp [s] and node of each message.

    Args:
        begin: of the recording [s since 1970].
        length: of the recording [s].
        seed: of all that varies.
        slam_s: how long slam needs at least once it is late [s].
        late_from: when that begins [s from the recording's begin].
    """
    rng = random.Random(seed)
    messages = []
    for i in range(int(length / 0.1)):
        scan = 0.1 * i + rng.uniform(0.0, 0.002)
        pose = scan + (slam_s if scan > late_from else 0.025) + rng.uniform(0.0, 0.015)
        messages += [(begin + scan, LASER), (begin + pose, SLAM)]
        if i % 2 == 0:
            messages.append((begin + pose + rng.uniform(0.010, 0.016), NAVIGATION))
    for i in range(int(length / 0.5)):
        messages.append((begin + 0.031 + 0.5 * i + rng.uniform(0.0, 0.01), BATTERY))
    word = rng.uniform(0.2, 2.0)
    while word < length - 0.1:
        messages += [(begin + word, MICROPHONE),
                     (begin + word + rng.uniform(0.06, 0.08), VOICE)]
        word += rng.uniform(0.2, 2.0)
    return sorted(messages)


def write(path: Path, messages: List[Message]) -> None:
    """Write a recording, and beside it who listens to whom."""
    with rosbag.Bag(str(path), 'w') as bag:
        for stamp, node in messages:
            header = {'topic': TOPICS[node], 'callerid': node, 'type': String._type,
                      'md5sum': String._md5sum, 'message_definition': String._full_text}
            bag.write(TOPICS[node], String('x'), rospy.Time.from_sec(stamp),
                      connection_header=header)
    RobotGraph({TOPICS[node]: {node} for node in TOPICS},
               {TOPICS[node]: set(HEARD_BY[node]) for node in TOPICS}).save(
                   str(path.with_suffix('.graph.yaml')))


def main(folder: Path) -> None:
    """Write all recordings."""
    for day in range(6):
        write(folder / f'normal_{day + 1}.bag', robot(BEGIN_S + 1000.0 * day, 120.0, day))
    dead = robot(BEGIN_S + 10000.0, 40.0, 10)
    write(folder / 'dead.bag', [message for message in dead
                                if message[1] != LASER
                                or message[0] < BEGIN_S + 10000.0 + FAULT_S])
    write(folder / 'late.bag', robot(BEGIN_S + 20000.0, 40.0, 11, 0.06, FAULT_S))


if __name__ == '__main__':
    main(Path(sys.argv[1]))
