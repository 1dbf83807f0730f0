#!/usr/bin/python3
"""A mode that training never saw is a suspicion, and normal once it is accepted."""

import signal
from contextlib import ExitStack
from typing import List

import rospy
import rostest

from accept_test import accept
from live_system import MonitorListener, again_if_disturbed, await_condition, ours, talker
from monitor_case import TrainedCase
from self_awareness.msg import SelfAwareness


class NewModeTest(TrainedCase):
    """Of four that do not hear each other, and three others, one of which hears another one."""

    off = ['/arm', '/base', '/camera', '/lidar']
    components = [*((name, name + '_out', 0.1) for name in off), ('/driver', '/scan', 0.1),
                  ('/imu', '/imu_out', 0.1), ('/slam', '/pose', 0.1)]

    def await_off(self, listener: MonitorListener, *names: str) -> None:
        await_condition('off: {}'.format(names), lambda: (
            listener.value('communication', 'off together, as is accepted') or ''
            ) == ', '.join(names), 30)

    def await_all_heard(self, listener: MonitorListener) -> None:
        def are_heard() -> bool:
            return all(float(listener.value(name, 'last heard [s ago]') or 9) < 1
                       for name, _, _ in self.components)
        await_condition('all are heard', are_heard, 30)
        seen = len(listener.statuses)
        # Who came back is excused for as long as rates are counted.

        def are_normal() -> bool:
            last = listener.statuses[-20:]
            return (len(listener.statuses) > seen + 40
                    and not any(status.level or status.settling for status in last))
        await_condition('normal windows', are_normal, 40)

    @staticmethod
    def of_those_off(listener: MonitorListener, after: int) -> List[str]:
        """What was told since so many windows of those who are off together.

        Without suspicions of one of them: while the machine is busy with other tests, one of them
        may have been late already when they stop.
        """
        return [status.message for status in listener.statuses[after:] if status.level and (
            status.kind == SelfAwareness.NEW_MODE
            or status.level == SelfAwareness.ERROR and status.component in NewModeTest.off)]

    @again_if_disturbed
    def test_a_mode_is_accepted_and_deaths_are_found_in_it(self) -> None:
        with ExitStack() as robot:
            nodes = {name: robot.enter_context(talker(name[1:], topic, 1 / period))
                     for name, topic, period in self.components if name != '/slam'}
            # Without a subscription, nobody would know who hears whom.
            robot.enter_context(ours('talker', '__name:=slam', '_output:=/pose', '_input:=/scan'))

            def send(number: int) -> None:
                for name in self.off:
                    nodes[name].send(number)

            with self.trained_monitor(diagnostic_bytes=100000), MonitorListener() as listener:
                self.await_all_heard(listener)
                stopped_at = len(listener.statuses)
                send(signal.SIGSTOP)
                told = await_condition('a new mode', lambda: next((
                    status for status in listener.statuses[stopped_at:]
                    if status.level == SelfAwareness.WARN
                    and status.kind == SelfAwareness.NEW_MODE), None), 60)
                self.assertEqual(told.component, '')
                asked = accept()
                self.assertFalse(asked.success, 'it only asks')
                self.assertIn('{{alarm: {}}}'.format(told.alarm), asked.message)
                said = accept(alarm=told.alarm)
                self.assertTrue(said.success, said.message)
                self.assertIn('/arm /base /camera /lidar (new mode)', said.message)
                await_condition('the suspicion is over', lambda: (
                    listener.alarms[-1].level == SelfAwareness.OK), 20)
                self.await_off(listener, *self.off)
                send(signal.SIGCONT)
                self.await_off(listener)
                self.await_all_heard(listener)
                off_again_at = len(listener.statuses)
                send(signal.SIGSTOP)
                self.await_off(listener, *self.off)
                listener.next_statuses(50)
                self.assertEqual(self.of_those_off(listener, off_again_at), [])
                nodes['/imu'].send(signal.SIGKILL)
                await_condition('a death that is found', lambda: any(
                    status.level == SelfAwareness.ERROR and suspect.component == '/imu'
                    and suspect.kind == SelfAwareness.SILENT
                    for status in listener.statuses[off_again_at:]
                    for suspect in status.suspects), 30)
                self.assertEqual(self.of_those_off(listener, off_again_at), [])


if __name__ == '__main__':
    rospy.init_node('new_mode_test')
    rostest.rosrun('self_awareness', 'new_mode', NewModeTest)
