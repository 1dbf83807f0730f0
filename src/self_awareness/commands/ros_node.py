"""Begins the ROS node of a program."""
from __future__ import annotations

import rospy


def begin(name: str) -> None:
    """Begin as rospy.init_node() does.

    Raises:
        KeyboardInterrupt: Ctrl-C came first, as while no master answers.
    """
    try:
        rospy.init_node(name)
    except rospy.exceptions.ROSInitException as error:
        raise KeyboardInterrupt from error
