"""Begins the ROS node of a program."""
from __future__ import annotations

import threading

import rospy

if not hasattr(threading.Thread, 'isAlive'):
    # rospy of Debian 11 calls it when a node ends, though its Python has it no more.
    setattr(threading.Thread, 'isAlive', threading.Thread.is_alive)


def begin(name: str) -> None:
    """Begin as rospy.init_node() does.

    Raises:
        KeyboardInterrupt: Ctrl-C came first, as while no master answers.
    """
    try:
        rospy.init_node(name)
    except rospy.exceptions.ROSInitException as error:
        raise KeyboardInterrupt from error
