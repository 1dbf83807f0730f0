#!/usr/bin/python3
"""When the monitor settles, and what ~reload changes and leaves."""

import statistics
import time
from typing import List

import rospy
import rostest
from std_msgs.msg import String

from live_system import MonitorListener, again_if_clock_was_set, await_condition
from monitor_case import MonitorCase, Talker
from self_awareness.msg import SelfAwareness


class SettlingTest(MonitorCase):

    def await_statuses(self, listener: MonitorListener, number: int) -> List[SelfAwareness]:
        """The next statuses."""
        seen = len(listener.statuses)
        await_condition('{} statuses'.format(number),
                        lambda: len(listener.statuses) >= seen + number, 20)
        return listener.statuses[seen:]

    # New publishers

    @again_if_clock_was_set
    def test_the_first_message_of_a_publisher_that_was_there_lets_nothing_settle(self) -> None:
        rare = rospy.Publisher('/rare', String, queue_size=1)
        self.addCleanup(rare.unregister)
        with Talker('/a'), self.monitor(self.model(topics=('/a', '/rare'))), \
                MonitorListener() as listener:
            listener.await_settled()
            await_condition('the monitor listens', rare.get_num_connections, 20)
            reports = len(listener.heartbeats)
            await_condition('two reports', lambda: len(listener.heartbeats) > reports + 1, 20)
            self.assertEqual(listener.value('monitor', 'publishers heard'), '1',
                             'its own reports, which it hears, do not count')
            seen = len(listener.statuses)
            rare.publish()
            await_condition('it is heard', lambda: (
                listener.value('monitor', 'publishers heard') == '2'), 20)
            self.await_statuses(listener, 5)
            self.assertEqual({s.settling for s in listener.statuses[seen:]}, {False})

    @again_if_clock_was_set
    def test_a_publisher_that_registers_later_is_new_once(self) -> None:
        with Talker('/a'), self.monitor(self.model(topics=('/a', '/late'))), \
                MonitorListener() as listener:
            listener.await_settled()
            with Talker('/late'):
                await_condition('settling', lambda: listener.statuses[-1].settling, 20)
                listener.await_settled()
            with Talker('/late') as again:
                await_condition('the monitor listens', again.publisher.get_num_connections, 20)
                statuses = self.await_statuses(listener, 10)
            self.assertEqual({s.settling for s in statuses}, {False})

    @again_if_clock_was_set
    def test_settling_does_not_wait_for_the_next_poll_of_the_master(self) -> None:
        model = self.model(topics=('/a', '/late'))
        with Talker('/a'), self.monitor(model, poll_interval=3600), \
                MonitorListener() as listener:
            listener.await_settled()
            with Talker('/late'):
                await_condition('settling', lambda: listener.statuses[-1].settling, 20)

    # ~reload

    @again_if_clock_was_set
    def test_reload_takes_a_standing_alarm_back(self) -> None:
        with self.monitor(self.model(), hold_time=600):
            with MonitorListener() as listener:
                with Talker('/a'):
                    listener.await_settled()
                listener.await_alarm()
                self.assertTrue(self.call('/self_awareness/reload').success)
            with MonitorListener() as late:
                alarm = await_condition('the latched message', lambda: late.alarms, 20)[0]
            self.assertEqual(alarm.level, SelfAwareness.OK)
            self.assertEqual(alarm.message, 'settling: model loaded')

    @again_if_clock_was_set
    def test_after_reload_the_next_message_of_a_latching_connection_is_an_event(self) -> None:
        latching = rospy.Publisher('/latched', String, latch=True, queue_size=1)
        self.addCleanup(latching.unregister)
        latching.publish('published long ago')
        with Talker('/a'), self.monitor(self.model(), subscribe='all'), \
                MonitorListener() as listener:
            listener.await_settled()
            await_condition('both are heard', lambda: (
                listener.value('monitor', 'publishers heard') == '2'), 20)
            self.assertTrue(self.call('/self_awareness/reload').success)
            listener.await_settled()
            latching.publish('published now')
            await_condition('it is an event', lambda: any(
                s.unknown_events for s in listener.statuses), 20)

    @again_if_clock_was_set
    def test_after_reload_windows_are_judged_in_the_pace_of_the_new_model(self) -> None:
        arrivals = []  # type: List[float]
        with self.monitor(self.model(window=4 * 10**9)), MonitorListener() as listener:
            with Talker('/a'):
                self.await_statuses(listener, 1)
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
