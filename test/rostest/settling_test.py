#!/usr/bin/python3
"""When the monitor settles, and what ~reload changes and leaves."""

import statistics
import time
from typing import List

import rospy
import rostest
from std_msgs.msg import String

from live_system import (MonitorListener, Process, again_if_disturbed, await_condition,
                         talker)
from monitor_case import MonitorCase, Talker
from self_awareness.msg import SelfAwareness


def late() -> Process:
    return talker('late', '/late', 10)


@again_if_disturbed
class SettlingTest(MonitorCase):
    # New publishers

    def test_the_first_message_of_a_publisher_that_was_there_lets_nothing_settle(self) -> None:
        rare = rospy.Publisher('/rare', String, queue_size=1)
        self.addCleanup(rare.unregister)
        with Talker('/a'), self.monitor(self.model(topics=('/a', '/rare'))), \
                MonitorListener() as listener:
            listener.await_settled()
            await_condition('the monitor listens', rare.get_num_connections, 20)
            listener.await_heartbeats(2)
            self.assertEqual(listener.value('monitor', 'publishers heard'), '1',
                             'its own reports, which it hears, do not count')
            seen = len(listener.statuses)
            rare.publish()
            await_condition('it is heard', lambda: (
                listener.value('monitor', 'publishers heard') == '2'), 20)
            listener.next_statuses(5)
            self.assertEqual({s.settling for s in listener.statuses[seen:]}, {False})

    # By the paper's detector: the whole robot settles.

    def test_settling_does_not_wait_for_the_next_poll_of_the_master(self) -> None:
        with Talker('/a'), self.monitor(self.late_model(), poll_interval=3600), \
                MonitorListener() as listener:
            listener.await_settled()
            with late():
                await_condition('settling', lambda: listener.statuses[-1].settling, 20)

    def late_model(self) -> str:
        return self.model(topics=('/a', '/late'), sources={'/late': '/late'})

    # ~reload

    def test_reload_takes_the_model_that_is_set_now(self) -> None:
        first, second = self.model(name='first'), self.model(name='second', topics=('/a', '/b'))
        with Talker('/a'), Talker('/b'), self.monitor(first), MonitorListener() as listener:
            listener.await_settled()
            rospy.set_param('/self_awareness/model', second)
            response = self.call('/self_awareness/reload')
            self.assertTrue(response.success, response.message)
            self.assertIn(second, response.message)
            await_condition('the other model is said', lambda: (
                listener.value('communication', 'model') == second), 20)
            listener.await_settled()
            await_condition('events of both', lambda: listener.statuses[-1].events > 2, 20)
            for bad in (self.path('missing'), 42):
                rospy.set_param('/self_awareness/model', bad)
                response = self.call('/self_awareness/reload')
                self.assertFalse(response.success)
                self.assertIn('the old model stays', response.message)
            self.assertEqual(listener.value('communication', 'model'), second)
            # As after a restart of the master, which forgets its parameters.
            rospy.delete_param('/self_awareness/model')
            self.assertIn(second, self.call('/self_awareness/reload').message)

    def test_after_reload_windows_are_judged_in_the_pace_of_the_new_model(self) -> None:
        arrivals: List[float] = []
        with self.monitor(self.model(window=4 * 10**9)), MonitorListener() as listener:
            with Talker('/a'):
                listener.next_statuses(1)
                self.model(window=10**8)
                self.assertTrue(self.call('/self_awareness/reload').success)
                listener.await_settled()
            # In silence, no event tells the monitor that a window is over.
            await_condition('silence', lambda: listener.statuses[-1].events == 0, 20)
            subscriber = rospy.Subscriber('/self_awareness/status', SelfAwareness,
                                          lambda _: arrivals.append(time.monotonic()))
            self.addCleanup(subscriber.unregister)
            await_condition('20 statuses', lambda: len(arrivals) > 20, 20)
        gaps = [later - earlier for earlier, later in zip(arrivals, arrivals[1:])]
        self.assertGreater(statistics.median(gaps), 0.05, gaps)


if __name__ == '__main__':
    rospy.init_node('settling')  # as rostest calls it, too
    rostest.rosrun('self_awareness', 'settling', SettlingTest)
