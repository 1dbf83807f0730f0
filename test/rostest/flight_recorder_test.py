#!/usr/bin/python3
"""What the monitor writes of what it heard: before an alarm, and, to learn more, what was normal.
"""

import copy
import glob
import os
import re
import signal
import time
from typing import List

import rosbag
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticStatus

from live_system import MonitorListener, again_if_disturbed, await_condition, run_program
from monitor_case import Talker, TrainedCase, base, driver
from self_awareness.msg import SelfAwareness
from self_awareness.srv import Maintenance

FILE = re.compile(r'; events in (/\S+/alarm_[-\d.]+\.bag)')
LONGER_S = 12.0  # than the shortest stretch of normal operation that is kept
LOAD = re.compile(r' \(load [\d.]+ on \d+ cores?\)')


@again_if_disturbed
class FlightRecorderTest(TrainedCase):

    def folder_of_files(self) -> str:
        return self.path('recorder')

    def files(self, pattern: str) -> List[str]:
        return sorted(glob.glob(os.path.join(self.folder_of_files(), pattern)))

    def test_a_killed_node_is_in_a_file_that_score_reads(self) -> None:
        after = 3
        with driver() as victim, base(), \
                self.trained_monitor(unknown='ignore', subscribe='used', **{
                    'recorder/after': after}), MonitorListener() as listener:
            listener.await_heard('/driver')
            victim.send(signal.SIGKILL)
            alarm = listener.await_alarm()
            found = FILE.search(alarm.message)
            self.assertIsNotNone(found, alarm.message)
            path = found.group(1)
            self.assertEqual(os.path.dirname(path), self.folder_of_files())
            self.assertFalse(os.path.exists(path), 'what follows is missing')
            listener.await_diagnostics('communication', path, DiagnosticStatus.ERROR)
            await_condition('the file', lambda: os.path.exists(path), 20)
            await_condition('the file is reported', lambda: (
                listener.value('monitor', 'last file') == path), 20)
            self.assertGreater(float(listener.value('monitor', 'recorded [s]')), after)
            self.assertGreater(float(listener.value('monitor', 'memory of the recorder [MB]')), 0)
            statuses = listener.statuses
        self.check_same_verdicts(path, alarm, statuses)
        self.assertEqual([os.path.basename(name).split('_')[0] for name in self.files('*.bag')],
                         ['alarm', 'shutdown'], 'the alarm stood when the monitor ended')

    def check_same_verdicts(self, path: str, alarm: SelfAwareness,
                            statuses: List[SelfAwareness]) -> None:
        """Of the file, `score` says in each window what the monitor said."""
        printed = run_program('score', path, '--model', self.path('model'), '--unknown', 'ignore',
                              '--settle-time', '0.5', '--result-bag', self.path('results.bag'))
        self.assertRegex(printed, r'\n    1\. /driver /scan std_msgs/String: silent for ')
        with rosbag.Bag(self.path('results.bag')) as bag:
            replayed = {message.window_start.to_nsec(): message for _, message, _
                        in bag.read_messages('/self_awareness/status')}
            raised = [message for _, message, _ in bag.read_messages('/self_awareness/alarm')
                      if message.level == SelfAwareness.ERROR]
        self.assertEqual(raised[0].header.stamp, alarm.header.stamp)
        compared = 0
        for status in statuses:
            start = status.window_start.to_nsec()
            # The first window of a model that was loaded late, and the last one, are cut.
            if start in list(replayed)[1:-1]:
                live, later = copy.deepcopy(status), copy.deepcopy(replayed[start])
                live.message = LOAD.sub('', FILE.sub('', live.message))  # no file knows these
                live.header.seq = later.header.seq
                self.assertEqual(str(live), str(later))
                compared += 1
        self.assertGreater(compared, 30)
        last = max(replayed) / 1e9
        self.assertGreater(last, alarm.header.stamp.to_sec() + 2, 'what follows is in it')

    def test_a_disk_that_takes_nothing_is_a_warning_and_it_is_tried_again(self) -> None:
        with open(self.folder_of_files(), 'w') as file:
            file.write('in the way')
        with Talker('/a'), self.monitor(self.model()), MonitorListener() as listener:
            listener.await_settled()
            self.call('/self_awareness/dump')
            warning = listener.await_diagnostics(
                'monitor', 'the flight recorder cannot write', DiagnosticStatus.WARN)
            self.assertIn('but a file', warning.message)
            response = self.call('/self_awareness/dump')
            self.assertFalse(response.success)
            self.assertIn('but a file', response.message)
            os.remove(self.folder_of_files())
            await_condition('both files', lambda: len(self.files('dump_*.bag')) == 2, 30)
            await_condition('all is well', lambda: (
                listener.diagnostics('monitor')[-1].level == DiagnosticStatus.OK), 20)
            self.assertEqual(self.files('*.part'), [])

    def test_what_was_normal_is_kept_but_for_maintenance(self) -> None:
        model = self.model()
        for is_maintained in (True, False):
            with Talker('/a'), MonitorListener() as listener, \
                    self.monitor(model, learn_more='true'):
                listener.await_settled()
                if is_maintained:
                    rospy.wait_for_service('/self_awareness/maintenance', 20)
                    rospy.ServiceProxy('/self_awareness/maintenance', Maintenance)(duration=60.0)
                begin = time.monotonic()
                await_condition('it has heard enough',
                                lambda: time.monotonic() > begin + LONGER_S, 40)
                self.assertIsNotNone(listener.value('monitor', 'logs kept to learn from'))
            kept = glob.glob(model + '.kept/*')
            self.assertEqual(len(kept), 0 if is_maintained else 1, kept)
        self.assertRegex(kept[0], r'/model\.kept/normal_[-\d]+\.\d{3}\.bag$')
        said = run_program('info', kept[0], '--details')
        self.assertIn('/a std_msgs/String', said)
        self.assertIn('robot started', said)


if __name__ == '__main__':
    rospy.init_node('flight_recorder')  # as rostest calls it, too
    rostest.rosrun('self_awareness', 'flight_recorder', FlightRecorderTest)
