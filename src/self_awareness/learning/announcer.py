"""Says on /diagnostics how far a learning is."""
from __future__ import annotations

import threading
from typing import Dict

import rospy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

from self_awareness.msg import SelfAwareness
from self_awareness.status_names import status_name

_PERIOD_S = 1.0


class Announcer:
    """Publishes one status, every second and at once when it changes; needs rospy.init_node().

    The status has the name under which the monitor will say how the robot communicates: so it
    never becomes STALE when the monitor takes over.
    """

    def __init__(self) -> None:
        self._publisher = rospy.Publisher('/diagnostics', DiagnosticArray, queue_size=10)
        # The monitor's, which will come. By its type, other monitors know this node for one of
        # this package, whatever its name is.
        self._status_topic = rospy.Publisher('~status', SelfAwareness, queue_size=1)
        self._name = status_name(rospy.get_name(), 'communication')
        self._hardware_id = str(rospy.get_param('~hardware_id', 'none'))
        self._status = DiagnosticStatus()  # replaced as a whole: it needs no lock
        self._change = threading.Event()
        self.say(DiagnosticStatus.OK, 'learning', {})
        threading.Thread(target=self._run, daemon=True).start()

    def say(self, level: int, message: str, values: Dict[str, str]) -> None:
        """Set what is published from now on; level: of DiagnosticStatus."""
        status = DiagnosticStatus(level, self._name, message, self._hardware_id,
                                  [KeyValue(key, value) for key, value in values.items()])
        if status != self._status:
            self._status = status
            self._change.set()

    def _run(self) -> None:
        while not rospy.is_shutdown():
            self._change.wait(_PERIOD_S)
            self._change.clear()
            array = DiagnosticArray()
            array.header.stamp = rospy.Time.now()
            array.status = [self._status]
            try:
                self._publisher.publish(array)
            except rospy.ROSException:  # the node was shut down meanwhile
                return
