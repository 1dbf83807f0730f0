#!/usr/bin/python3
"""Prints what a monitor says, a line of JSON a message: for tests that outlive their master.

Every line has "at" [s of time.monotonic()] and "topic": "status" or "alarm" with level, settling,
abnormal and suspects (sources), or "diagnostics" with task, level and message.
"""

import json
import threading
import time

import rospy
from diagnostic_msgs.msg import DiagnosticArray

from self_awareness.msg import SelfAwareness

NAME = 'self_awareness'

lock = threading.Lock()


def tell(topic: str, **fields) -> None:
    with lock:
        print(json.dumps(dict(fields, at=time.monotonic(), topic=topic)), flush=True)


def tell_verdict(verdict: SelfAwareness, topic: str) -> None:
    tell(topic, level=verdict.level, settling=verdict.settling, abnormal=verdict.abnormal,
         suspects=[suspect.source for suspect in verdict.suspects])


def tell_diagnostics(array: DiagnosticArray) -> None:
    for status in array.status:
        name, _, task = status.name.partition(': ')
        if name == NAME:
            tell('diagnostics', task=task, level=status.level, message=status.message)


def main() -> None:
    rospy.init_node('listener', anonymous=True, disable_rosout=True)
    for topic in ('status', 'alarm'):
        rospy.Subscriber('/{}/{}'.format(NAME, topic), SelfAwareness, tell_verdict, topic)
    rospy.Subscriber('/diagnostics', DiagnosticArray, tell_diagnostics)
    rospy.spin()


if __name__ == '__main__':
    main()
