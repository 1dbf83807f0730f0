#!/usr/bin/python3
"""With ~learn_more, what was normal is kept beside the model, but for maintenance."""

import glob
import time
from typing import List

import rospy
import rostest

from live_system import MonitorListener, again_if_disturbed, await_condition, run_program
from monitor_case import MonitorCase, Talker
from self_awareness.srv import Maintenance

LONGER_S = 12.0  # than the shortest stretch that is kept


class KeptLogsTest(MonitorCase):

    def run_monitor(self, disturb=lambda talker: None) -> List[str]:
        """Lets a monitor listen for a while, and ends it; returns what it has kept."""
        model = self.model()
        with Talker('/a') as talker, MonitorListener() as listener:
            with self.monitor(model, learn_more='true'):
                listener.await_settled()
                begin = time.monotonic()
                self.listener = listener
                disturb(talker)
                await_condition('it has heard enough',
                                lambda: time.monotonic() > begin + LONGER_S, 40)
        return sorted(glob.glob(model + '.kept/*'))

    @again_if_disturbed
    def test_what_was_normal_is_kept_and_read_by_the_programs(self) -> None:
        kept = self.run_monitor()
        self.assertEqual(len(kept), 1, kept)
        self.assertRegex(kept[0], r'/model\.kept/normal_[-\d]+\.\d{3}\.bag$')
        said = run_program('info', kept[0], '--details')
        self.assertIn('/a std_msgs/String', said)
        self.assertIn('robot started', said)
        self.assertIsNotNone(self.listener.value('monitor', 'logs kept to learn from'))

    @again_if_disturbed
    def test_maintenance_is_not_kept(self) -> None:
        def maintain(_: Talker) -> None:
            rospy.wait_for_service('/self_awareness/maintenance', 20)
            rospy.ServiceProxy('/self_awareness/maintenance', Maintenance)(duration=60.0)

        self.assertEqual(self.run_monitor(maintain), [])


if __name__ == '__main__':
    rospy.init_node('kept_logs')  # as rostest calls it, too
    rostest.rosrun('self_awareness', 'kept_logs', KeptLogsTest)
