"""Ends this process soon after it was told to, whatever the master does."""
from __future__ import annotations

import os
import sys
import threading
import time

import rospy

_POLL_S = 0.1
_GOODBYE_S = 2.0


def limit_goodbye() -> None:
    """Give rospy no more than 2 s to say goodbye to the master, which may hang.

    Call it before rospy.init_node(). What this process has started was told to end before, and
    ends with it.
    """
    threading.Thread(target=_run, daemon=True).start()


def _run() -> None:
    while not rospy.core.is_shutdown_requested():
        time.sleep(_POLL_S)
    time.sleep(_GOODBYE_S)
    print('the master does not answer: this node ends without unregistering', file=sys.stderr,
          flush=True)
    os._exit(0)
