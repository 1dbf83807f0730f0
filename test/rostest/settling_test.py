#!/usr/bin/python3
"""When the monitor settles."""

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
            seen = len(listener.statuses)
            rare.publish()
            await_condition('it is heard', lambda: (
                listener.value('monitor', 'publishers heard') == '2'), 20)
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


if __name__ == '__main__':
    rospy.init_node('settling')  # as rostest calls it, too
    rostest.rosrun('self_awareness', 'settling', SettlingTest)
