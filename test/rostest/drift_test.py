#!/usr/bin/python3
"""Over starts of the robot, the monitor says whose evidence comes nearer to its limits."""

import os
import subprocess
import time
from typing import Any, List, Optional

import rosbag
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticStatus

from accept_test import TrainedCase, talker
from live_system import MonitorListener, again_if_disturbed, await_condition
from self_awareness import Tuning
from self_awareness.parts import BagPart
from self_awareness.training import many_bags

LONGER_S = 12.0  # than the shortest time that counts
BEFORE = 9


class DriftTest(TrainedCase):

    def setUp(self) -> None:
        super().setUp()
        run_id = rospy.get_param('/run_id')
        self.addCleanup(rospy.set_param, '/run_id', run_id)
        self.file = self.path('model.drift')

    def train(self) -> str:
        """Without the rule that a starved machine is not normal: that of the test may be one."""
        tuning = Tuning()
        tuning.set('starved', 2.0)
        trained = many_bags.train([BagPart(self.bags[0])],
                                  many_bags.Counting(detector='evidence', tuning=tuning))
        trained.model.save(self.path('model'))
        return subprocess.run(['rosrun', 'self_awareness', 'calibrate', '--model',
                               self.path('model'), '--normal', self.bags[1], '-o',
                               self.path('model')], check=True, stdout=subprocess.PIPE,
                              text=True).stdout

    def listen(self, run_id: str) -> str:
        """Starts the robot, lets the monitor listen for a while, and ends it; what it has logged.

        On a busy machine, that may not be normal: then it is done again.
        """
        rospy.set_param('/run_id', run_id)
        said = ''
        for _ in range(3):
            with talker('base', '/odom', 10), talker('driver', '/scan', 12.5):
                with MonitorListener() as self.listener, self.trained_monitor(
                        unknown='ignore', settle_time=3.0) as monitor:
                    self.await_heard(self.listener, '/driver', '/base')
                    begin = time.monotonic()
                    await_condition('it has heard enough',
                                    lambda: time.monotonic() > begin + LONGER_S, 40)
                    monitor.stop()
                    said += monitor.output
            if self.has_sample_of(run_id):
                break
        return said

    def has_sample_of(self, run_id: str) -> bool:
        try:
            return bool(self.kept().run_id == run_id)
        except (OSError, rosbag.ROSBagException):
            return False

    def kept(self) -> Any:
        with rosbag.Bag(self.file) as bag:
            return next(message for topic, message, _ in bag if topic == '/drift')

    def keep(self, kept: Any) -> None:
        """Writes the file as the monitor would."""
        with rosbag.Bag(self.file) as bag:
            version, at = next((message, stamp) for topic, message, stamp in bag
                               if topic == '/version')
        with rosbag.Bag(self.file, 'w') as bag:
            bag.write('/version', version, at)
            bag.write('/drift', kept, at)

    def told(self) -> Optional[DiagnosticStatus]:
        found: List[DiagnosticStatus] = [
            status for status in self.listener.diagnostics('monitor')
            if 'drift: ' in status.message]
        return found[-1] if found else None

    @again_if_disturbed
    def test_a_share_that_grows_from_start_to_start_is_told(self) -> None:
        self.listen('first')
        first = self.kept()
        self.assertEqual(sorted(first.components), ['/base', '/driver'])
        self.assertEqual(len(first.shares), 2)
        self.assertTrue(all(0 < share < 1 for share in first.shares), first.shares)
        self.listen('first')
        self.assertEqual(len(self.kept().shares), 2, 'the robot was not started again')
        self.assertIsNone(self.told())

        drifts = first.components.index('/driver')
        history = []
        for start in range(BEFORE):
            history += [1e-6 * start if which == drifts else 0.99 for which in range(2)]
        first.shares = history
        first.run_id = 'before'
        self.keep(first)
        self.listen('second')
        self.assertEqual(len(self.kept().shares), 2 * (BEFORE + 1))
        status = self.told()
        assert status is not None
        self.assertEqual(status.level, DiagnosticStatus.WARN)
        self.assertIn('drift: /driver 0 % -> 0 % of its limit, evidence 5e+03', status.message)
        self.assertNotIn('/base', status.message)
        self.listen('third')
        status = self.told()
        assert status is not None
        self.assertRegex(status.message, r'drift: /driver 0 % -> [1-9][0-9]* % of its limit')
        self.assertFalse([each for each in self.listener.diagnostics('communication')
                          if 'drift' in each.message])

    @again_if_disturbed
    def test_a_damaged_file_is_named_and_written_anew(self) -> None:
        with open(self.file, 'w') as file:
            file.write('no bag')
        said = self.listen('first')
        self.assertIn('model.drift: the drift in it is damaged', said)
        self.assertEqual(len(self.kept().shares), 2)
        self.assertGreater(os.path.getsize(self.file), 100)


if __name__ == '__main__':
    rospy.init_node('drift_test')
    rostest.rosrun('self_awareness', 'drift', DriftTest)
