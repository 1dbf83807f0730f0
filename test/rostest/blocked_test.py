#!/usr/bin/python3
"""A node is silent since a subscriber of it hangs: the monitor asks both, and says so."""

import signal
import sys

import rospy
import rostest

from live_system import MonitorListener, Process, again_if_disturbed, await_condition
from monitor_case import TrainedCase, accept, base
from self_awareness.msg import SelfAwareness

# Without a queue_size, publish() waits until all have read.
CAMERA = """
import rospy
from std_msgs.msg import String
rospy.init_node('camera', disable_signals=True)
publisher = rospy.Publisher('/image', String)
rate = rospy.Rate(10)
while True:
    publisher.publish(200000 * 'x')
    rate.sleep()
"""
VIEWER = """
import rospy
from std_msgs.msg import String
rospy.init_node('viewer')
rospy.Subscriber('/image', String, lambda _: None)
rospy.spin()
"""
SAID = '; it answers, but its subscriber /viewer does not'


def node(code: str) -> Process:
    return Process(sys.executable, '-c', code)


@again_if_disturbed
class BlockedTest(TrainedCase):

    components = [('/camera', '/image', 0.1), ('/base', '/odom', 0.1)]

    def test_who_waits_for_a_subscriber_that_hangs_is_told_with_it(self) -> None:
        with base(), node(CAMERA), node(VIEWER) as viewer, \
                self.trained_monitor(unknown='ignore'), MonitorListener() as listener:
            listener.await_heard('/camera', '/base')
            accept(component='/camera', topic='/image', kind='other size')  # the bags have none
            listener.await_settled()
            viewer.send(signal.SIGSTOP)
            said = await_condition('the subscriber is told', lambda: next((
                alarm for alarm in listener.alarms if SAID in alarm.message), None), 40)
            self.assertEqual((said.level, said.component, said.kind),
                             (SelfAwareness.ERROR, '/camera', SelfAwareness.SILENT))
            self.assertIn('/camera (/image) stopped sending at ', said.message)
            listener.await_diagnostics('communication', SAID)
            viewer.send(signal.SIGCONT)
            await_condition('it is over', lambda: (
                listener.statuses[-1].level == SelfAwareness.OK), 40)


if __name__ == '__main__':
    rospy.init_node('blocked_test')
    rostest.rosrun('self_awareness', 'blocked', BlockedTest)
