"""Begins and ends the ROS node of a program."""
from __future__ import annotations

import os
import sys
import threading
import time

import rospy

if not hasattr(threading.Thread, 'isAlive'):
    # rospy of Debian 11 calls it when a node ends, though its Python has it no more.
    setattr(threading.Thread, 'isAlive', threading.Thread.is_alive)

START_AGAIN = 3
"""Exit code of what may go well the next time: neither an error nor wrong usage of cli.run."""

_POLL_S = 0.1
_GOODBYE_S = 2.0


def begin(name: str) -> None:
    """Begin as rospy.init_node() does.

    Raises:
        KeyboardInterrupt: Ctrl-C came first, as while no master answers.
    """
    try:
        rospy.init_node(name)
    except rospy.exceptions.ROSInitException as error:
        raise KeyboardInterrupt from error


def limit_goodbye() -> None:
    """Give rospy no more than 2 s to say goodbye to the master, which may hang.

    Call it before begin(). What this process has started was told to end before, and ends with it.
    """
    threading.Thread(target=_leave, daemon=True).start()


def _leave() -> None:
    while not rospy.core.is_shutdown_requested():
        time.sleep(_POLL_S)
    time.sleep(_GOODBYE_S)
    print('the master does not answer: this node ends without unregistering', file=sys.stderr,
          flush=True)
    os._exit(0)
