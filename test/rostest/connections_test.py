#!/usr/bin/python3
"""A node does not subscribe as it did, or hangs, or logs its first error: the monitor says so."""

import signal
import sys

import rospy
import rostest
from std_msgs.msg import String

from live_system import (MonitorListener, Process, again_if_disturbed, await_condition,
                         operation, ours, talker, write_bag)
from monitor_case import Talker, TrainedCase, accept, base, learned
from self_awareness.msg import SelfAwareness, Suspect

NODE = '/connections'
NODES = (('/camera', '/image', 0.1), (NODE, '/people', 0.05))
START_TIME_S = 6.0
HOUR_S = 3600.0
LINE = 'the lens is gone'
SAID = 'does not subscribe to /image, as it did in all 2 starts'
HANGS = '; it answers, but its subscriber /viewer does not'
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


def ignore(_: String) -> None:
    pass


@again_if_disturbed
class ConnectionsTest(TrainedCase):
    components = [('/camera', '/image', 0.1), ('/base', '/odom', 0.1)]

    def test_who_waits_for_a_subscriber_that_hangs_is_told_with_it(self) -> None:
        with base(), Process(sys.executable, '-c', CAMERA), \
                ours('talker', '__name:=viewer', '_input:=/image', '_output:=/seen') as viewer, \
                self.trained_monitor(unknown='ignore'), MonitorListener() as listener:
            listener.await_heard('/camera', '/base')
            accept(component='/camera', topic='/image', kind='other size')  # the bags have none
            listener.await_settled()
            viewer.send(signal.SIGSTOP)
            said = await_condition('the subscriber is told', lambda: next((
                alarm for alarm in listener.alarms if HANGS in alarm.message), None), 40)
            self.assertEqual((said.level, said.component, said.kind),
                             (SelfAwareness.ERROR, '/camera', SelfAwareness.SILENT))
            self.assertIn('/camera (/image) stopped sending at ', said.message)
            listener.await_diagnostics('communication', HANGS)
            viewer.send(signal.SIGCONT)
            await_condition('it is over', lambda: (
                listener.statuses[-1].level == SelfAwareness.OK), 40)

    def subscribed_model(self) -> str:
        """A model that learned from two starts, in which this node subscribed to /image."""
        bags = [write_bag(self.path('{}.bag'.format(seed)), (
            (stamp + HOUR_S * seed, source, topic)
            for stamp, source, topic in operation(NODES, 120, seed))) for seed in (1, 2)]
        model = learned(bags, START_TIME_S)
        for _ in bags:
            model.add_subscriptions({(NODE, '/image')})
        self.assertEqual(model.subscriptions, {(NODE, '/image')})
        model.save(self.path('model'))
        return self.path('model')

    def test_who_does_not_subscribe_or_logs_an_error_is_named(self) -> None:
        model = self.subscribed_model()
        camera = talker('camera', '/image', 10)
        self.addCleanup(camera.stop)
        subscriber = rospy.Subscriber('/image', String, ignore)
        with Talker('/people'), \
                self.monitor(model, detector='evidence', unknown='warn', settle_time=1.0,
                             subscribe='all'), MonitorListener() as listener:
            listener.await_settled()
            # Who is away for less than a start takes is only restarting.
            subscriber.unregister()
            rospy.sleep(1.0)
            subscriber = rospy.Subscriber('/image', String, ignore)
            rospy.sleep(1.5 * START_TIME_S)
            self.assertFalse(self.said_of(listener, SAID))
            subscriber.unregister()
            said = await_condition('who does not subscribe is named',
                                   lambda: self.said_of(listener, SAID), 30)
            self.assertEqual((said.kind, said.component), (SelfAwareness.NOT_SUBSCRIBED, NODE))
            subscriber = rospy.Subscriber('/image', String, ignore)
            await_condition('it is over', lambda: (
                'connections' not in listener.statuses[-1].evidence), 30)
            rospy.loginfo('all is well')  # rospy latches: the first line may be an old one
            rospy.sleep(1)
            rospy.logerr(LINE)
            said = await_condition('the line is quoted',
                                   lambda: self.said_of(listener, LINE), 15)
            self.assertEqual((said.kind, said.component), (SelfAwareness.STRANGER, NODE))
            self.assertIn('logged ERROR "{}"'.format(LINE), said.reason)
            # One that is dead keeps its subscriptions: it is one finding.
            camera.send(signal.SIGKILL)
            await_condition('the dead one is named', lambda: any(
                status.level == SelfAwareness.ERROR and status.suspects
                and status.suspects[0].component == '/camera'
                for status in listener.statuses[-50:]), 30)

    @staticmethod
    def said_of(listener: MonitorListener, words: str) -> Suspect:
        """A suspect with these words. Beside it, the machine may be busy with other work."""
        return next((suspect for status in listener.statuses for suspect in status.suspects
                     if words in suspect.reason), None)


if __name__ == '__main__':
    rospy.init_node(NODE[1:])  # as rostest calls it, too
    rostest.rosrun('self_awareness', NODE[1:], ConnectionsTest)
