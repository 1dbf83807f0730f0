"""A relay of odometry that comes late as long as it is told to: `~late` (std_srvs/SetBool).

Run as `python3 -m self_awareness_evaluation.live.late_relay INPUT OUTPUT`.
"""
from __future__ import annotations

import queue
import sys
import time
from typing import List, Tuple

import rospy
from nav_msgs.msg import Odometry
from std_srvs.srv import SetBool, SetBoolRequest, SetBoolResponse

from self_awareness_evaluation.live.packaged_nodes import LATE_S

_QUEUE = 100  # messages
_LOOK_S = 0.5  # how often it looks whether it is shut down


class LateRelay:
    """Publishes what it hears, LATE_S later while it is told to be late; keeps the order."""

    def __init__(self, heard: str, said: str) -> None:
        self._waiting: queue.Queue[Tuple[float, Odometry]] = queue.Queue()
        self._late_s = 0.0
        self._publisher = rospy.Publisher(said, Odometry, queue_size=_QUEUE)
        rospy.Subscriber(heard, Odometry, self._on_message, queue_size=_QUEUE)
        rospy.Service('~late', SetBool, self._on_late)

    def run(self) -> None:
        """Relay until the node is shut down."""
        while not rospy.is_shutdown():
            try:
                due, message = self._waiting.get(timeout=_LOOK_S)
            except queue.Empty:
                continue
            time.sleep(max(0.0, due - time.monotonic()))
            self._publisher.publish(message)

    def _on_message(self, message: Odometry) -> None:
        self._waiting.put((time.monotonic() + self._late_s, message))

    def _on_late(self, request: SetBoolRequest) -> SetBoolResponse:
        self._late_s = LATE_S if request.data else 0.0
        return SetBoolResponse(True, '')


def main(arguments: List[str]) -> None:
    """Run the node; the arguments are the topics that it hears and publishes."""
    rospy.init_node('late_relay')
    LateRelay(*arguments).run()


if __name__ == '__main__':
    main(rospy.myargv(sys.argv)[1:])
