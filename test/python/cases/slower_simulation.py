"""Writes bags of a simulated robot; in one, the simulation runs at 0.4 of its speed from 50 s on.

Environment: LIB, with the robot of ../shared/cases, and the folder OUT.
"""
import importlib
import os
import sys
from typing import Any

sys.path.insert(0, os.environ['LIB'])
cases: Any = importlib.import_module('robot')

SPEED = 0.4


def make(seed: int, seconds: float, speed: float = 1.0) -> Any:
    """Return a robot in simulated time; two of its nodes keep the time of the real world."""
    robot = cases.Robot(seed, seconds)
    robot.epoch = 0.0
    scan = robot.periodic('/gazebo', '/scan', 10, robot.scan, jitter=0.001)
    odom = robot.periodic('/gazebo', '/odom', 30, robot.odom, jitter=0.001)
    robot.follow(odom, '/robot_state_publisher', '/tf', robot.tf, 0.002, 0.001)
    robot.follow(scan, '/amcl', '/amcl_pose', robot.pose, 0.02, 0.004)
    for source, topic, hertz, message in (('/rosbridge', '/client/state', 10.0, robot.text),
                                          ('/camera', '/webcam/image', 15.0, robot.image)):
        time = 0.1
        while time < seconds:
            robot.add(time, source, topic, message)
            time += (speed if time >= 50.0 else 1.0) / hertz * (1.0 + robot.r.gauss(0.0, 0.02))
    return robot


cases.normal(lambda seed: make(seed, 120), 1)
make(19, 150, SPEED).write(cases.out('slower.bag'))
