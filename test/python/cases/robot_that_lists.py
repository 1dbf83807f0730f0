"""Writes bags of a robot of which one lacks a transform from 50 s on, one a joint, one fails.

Environment: LIB, with the robot of ../shared/cases, and the folder OUT.
"""
import importlib
import os
import sys
from typing import Any

sys.path.insert(0, os.environ['LIB'])
cases: Any = importlib.import_module('robot')

FRAMES = ['arm', 'camera', 'gps', 'gripper', 'imu', 'laser', 'wheel_left', 'wheel_right']


def make(seed: int, seconds: float, lacking: str = '', joint: bool = True,
         failing: bool = False) -> Any:
    """Return a robot whose state publisher sends eight transforms in each message."""
    robot = cases.standard(seed, seconds)

    def transforms(event: Any) -> Any:
        frames = [name for name in FRAMES if name != lacking or event.t < 50]
        message = cases.TFMessage([cases.TransformStamped(
            header=robot.header((event.caller, event.topic), event.stamp, 'base_link'),
            child_frame_id=name) for name in frames])
        return message

    def diagnostics(event: Any) -> Any:
        message = robot.diag(event)
        if failing and event.t >= 50:
            message.status[0].level, message.status[0].message = 2, 'no fix'
        return message

    def joints(event: Any) -> Any:
        message = robot.joints(event)
        if not joint and event.t >= 50:
            message.name, message.position = message.name[:1], message.position[:1]
        return message

    for event in robot.ev:
        if (event.caller, event.topic) == ('/robot_state_publisher', '/tf'):
            event.make = transforms
        elif (event.caller, event.topic) == ('/gps', '/diagnostics'):
            event.make = diagnostics
        elif event.topic == '/joint_states':
            event.make = joints
    return robot


cases.normal(lambda seed: make(seed, 120), 1)
make(18, 110, lacking='laser').write(cases.out('lacking.bag'))
make(20, 110, joint=False).write(cases.out('jointless.bag'))
make(19, 110, failing=True).write(cases.out('failing.bag'))
