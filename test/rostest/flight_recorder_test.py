#!/usr/bin/python3
"""The flight recorder: what the monitor heard before an alarm is in a file that `score` reads."""

import copy
import glob
import os
import re
import signal
import subprocess
import unittest
from typing import Any, Callable, Dict, List

import rosbag
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticStatus

from live_system import (MonitorListener, Process, again_if_disturbed, await_condition,
                         run_program, talker)
from monitor_case import Talker, TrainedCase
from self_awareness.msg import SelfAwareness

FILE = re.compile(r'; events in (/\S+/alarm_[-\d.]+\.bag)')
LOAD = re.compile(r' \(load [\d.]+ on \d+ cores?\)')


class FlightRecorderTest(TrainedCase):

    def folder_of_files(self) -> str:
        return self.path('recorder')

    def files(self, pattern: str = '*') -> List[str]:
        return sorted(glob.glob(os.path.join(self.folder_of_files(), pattern)))

    def score(self, path: str, *options: str) -> str:
        return run_program('score', path, '--model', self.path('model'), '--unknown', 'ignore',
                           '--settle-time', '0.5', *options)

    def recording_monitor(self, model: str, detector: str = 'paper', **options: Any) -> Process:
        """A monitor with parameters of the recorder."""
        parameters: Dict[str, Any] = {'recorder/' + name: value
                                      for name, value in options.items()}
        return self.monitor(model, detector=detector, **parameters)

    @again_if_disturbed
    def test_a_killed_node_is_in_a_file_that_score_reads(self) -> None:
        after = 3
        with talker('driver', '/scan', 12.5) as victim, talker('base', '/odom', 10), \
                self.recording_monitor(self.path('model'), 'evidence', after=after), \
                MonitorListener() as listener:
            listener.await_heard('/driver')
            victim.send(signal.SIGKILL)
            alarm = listener.await_alarm()
            found = FILE.search(alarm.message)
            self.assertIsNotNone(found, alarm.message)
            path = found.group(1)
            self.assertEqual(os.path.dirname(path), self.folder_of_files())
            self.assertFalse(os.path.exists(path), 'what follows is missing')
            status = await_condition('ERROR of the whole', lambda: next(
                (s for s in listener.diagnostics('communication')
                 if s.level == DiagnosticStatus.ERROR), None), 20)
            self.assertIn(path, status.message)
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
        printed = self.score(path, '--result-bag', self.path('results.bag'))
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

    @again_if_disturbed
    def test_dump_writes_what_was_heard(self) -> None:
        with Talker('/a'), self.recording_monitor(self.model(), files=2), \
                MonitorListener() as listener:
            listener.await_settled()
            paths = []
            for _ in range(3):
                response = self.call('/self_awareness/dump')
                self.assertTrue(response.success, response.message)
                paths.append(re.search(r' go to (\S+/dump_\S+\.bag)$', response.message).group(1))
                await_condition('it is written', lambda: (
                    listener.value('monitor', 'last file') == paths[-1]), 20)
            self.assertEqual(self.files(), paths[1:], 'the oldest is removed')
            self.assertIn('alarms: 0', self.score(paths[2], '--detector', 'paper'))

    @again_if_disturbed
    def test_without_a_duration_there_is_none(self) -> None:
        with Talker('/a'), self.recording_monitor(self.model(), duration=0.0), \
                MonitorListener() as listener:
            listener.await_settled()
            response = self.call('/self_awareness/dump')
            self.assertFalse(response.success)
            self.assertIn('~recorder/duration', response.message)
            await_condition('a report', lambda: listener.diagnostics('monitor'), 20)
            self.assertIsNone(listener.value('monitor', 'recorded [s]'))
            self.assertFalse(os.path.exists(self.folder_of_files()))

    # A disk that takes nothing: a warning, and it is tried again.

    @again_if_disturbed
    def test_a_file_in_place_of_the_folder(self) -> None:
        def blocked() -> None:
            with open(self.folder_of_files(), 'w') as file:
                file.write('in the way')

        self.check_disk(blocked, lambda: os.remove(self.folder_of_files()), 'but a file')

    @unittest.skipUnless(os.geteuid() == 0, 'only root may mount')
    @again_if_disturbed
    def test_a_full_disk(self) -> None:
        folder = self.folder_of_files()

        def full() -> None:
            os.mkdir(folder)
            subprocess.run(['mount', '-t', 'tmpfs', '-o', 'size=16k', 'tmpfs', folder], check=True)
            self.addCleanup(lambda: subprocess.run(['umount', folder], check=True))
            with open(os.path.join(folder, 'filled'), 'wb') as file:
                file.write(bytes(12 * 1024))

        self.check_disk(full, lambda: subprocess.run(
            ['mount', '-o', 'remount,size=1m', folder], check=True), 'space')

    def check_disk(self, spoil: Callable, mend: Callable, reason: str) -> None:
        spoil()
        with Talker('/a'), self.monitor(self.model()), MonitorListener() as listener:
            listener.await_settled()
            self.call('/self_awareness/dump')
            warning = await_condition('the warning', lambda: next(
                (s for s in listener.diagnostics('monitor')
                 if 'the flight recorder cannot write' in s.message), None), 20)
            self.assertEqual(warning.level, DiagnosticStatus.WARN)
            self.assertIn(reason, warning.message)
            response = self.call('/self_awareness/dump')
            self.assertFalse(response.success)
            self.assertIn(reason, response.message)
            listener.next_statuses(10)
            mend()
            await_condition('both files', lambda: len(self.files('dump_*.bag')) == 2, 30)
            await_condition('all is well', lambda: (
                listener.diagnostics('monitor')[-1].level == DiagnosticStatus.OK), 20)
            self.assertEqual(self.files('*.part'), [])


if __name__ == '__main__':
    rospy.init_node('flight_recorder')  # as rostest calls it, too
    rostest.rosrun('self_awareness', 'flight_recorder', FlightRecorderTest)
