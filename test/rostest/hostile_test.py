#!/usr/bin/python3
"""The monitor in a system of ROS 1 that is broken, or means ill."""

import socket
import subprocess

import rosgraph
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticStatus
from roscpp.srv import GetLoggers, SetLoggerLevel

from live_system import MonitorListener, again_if_disturbed, await_condition
from monitor_case import MadeUpPublishers, MonitorCase, Talker
from self_awareness.msg import SelfAwareness


class HostileTest(MonitorCase):

    @again_if_disturbed
    def test_rosnode_kill_ends_it_in_order(self) -> None:
        """roscpp takes its ports away before it says that it ends."""
        for attempt in range(4):
            with Talker('/a'), self.monitor(self.model()) as monitor, \
                    MonitorListener() as listener:
                listener.await_settled()
                subprocess.run(['rosnode', 'kill', '/self_awareness'], check=True,
                               stdout=subprocess.DEVNULL)
                self.assertEqual(monitor.wait(20), 0, monitor.output)
                self.assertNotIn('Assertion', monitor.output, attempt)

    # Who is heard

    @again_if_disturbed
    def test_who_does_not_answer_is_not_heard_and_not_silent(self) -> None:
        model = self.model(topics=('/a', '/b'), sources={'/b': '/made_up_0'})
        with Talker('/a'), socket.create_server(('127.0.0.1', 0)) as silent, \
                MadeUpPublishers(['/b'], 'http://127.0.0.1:{}/'.format(silent.getsockname()[1])), \
                self.monitor(model, alarm_windows=1), MonitorListener() as listener:
            warning = await_condition('a warning', lambda: next(
                (s for s in listener.diagnostics('monitor')
                 if '/made_up_0 on /b (does not answer)' in s.message
                 and s.level == DiagnosticStatus.WARN), None), 20)
            self.assertTrue(warning.message.startswith('not heard: '), warning.message)
            listener.await_settled()
            await_condition('the component is told', lambda: any(
                'not heard by the monitor: does not answer' in s.message
                for s in listener.diagnostics('/made_up_0')), 20)
            self.assertEqual([s.message for s in listener.statuses
                              if '/made_up' in s.message and 'silent' in s.message], [])

    # Operators

    @again_if_disturbed
    def test_services_that_are_called_in_a_loop(self) -> None:
        with Talker('/a') as talker, self.monitor(self.model(), alarm_windows=1) as monitor, \
                MonitorListener() as listener:
            listener.await_settled()
            self.assertTrue(self.call('/self_awareness/dump').success)
            talker.stop()
            alarm = listener.await_alarm()
            self.check_answered_sometimes('clear')
            again = listener.alarms[-1]  # it is back
            self.assertEqual(again.level, SelfAwareness.ERROR)
            self.assertNotEqual(again.header.stamp, alarm.header.stamp)
            answer = self.call('/self_awareness/clear')
            self.assertFalse(answer.success)
            self.assertIn('too many calls', answer.message)
            self.assertIn('cleared by hand, by ' + rospy.get_name(),
                          [each.message for each in listener.alarms])
            taken_back = await_condition('it is on record', lambda: (
                listener.value('monitor', 'alarm taken back')), 20)
            self.assertIn(' by {} at 20'.format(rospy.get_name()), taken_back)
            self.check_answered_sometimes('reload')
            monitor.stop()  # what it logs comes when the buffer is emptied
            self.assertLess(len(monitor.output), 20000)

    @again_if_disturbed
    def test_a_logger_that_is_set_to_debug(self) -> None:
        with Talker('/a'), self.monitor(self.model()), MonitorListener() as listener:
            listener.await_settled()
            # As rqt does: it lists the loggers at first, where that is offered.
            services = dict(rosgraph.Master(rospy.get_name()).getSystemState()[2])
            if '/self_awareness/get_loggers' in services:
                rospy.ServiceProxy('/self_awareness/get_loggers', GetLoggers)()
            for logger in ('ros.self_awareness', 'ros.roscpp', 'ros'):
                rospy.ServiceProxy('/self_awareness/set_logger_level', SetLoggerLevel)(
                    logger, 'debug')
            self.assertTrue(any(s.events for s in listener.next_statuses(10)))

    def check_answered_sometimes(self, service: str) -> None:
        answers = [self.call('/self_awareness/' + service).success for _ in range(200)]
        self.assertLess(sum(answers), 10, service)
        self.assertGreater(sum(answers), 0, service)


if __name__ == '__main__':
    rospy.init_node('hostile_test')
    rostest.rosrun('self_awareness', 'hostile', HostileTest)
