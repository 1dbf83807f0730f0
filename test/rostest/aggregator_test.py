#!/usr/bin/python3
"""Two monitors on /diagnostics_agg: each source has one place, only dead monitors are stale."""

from contextlib import ExitStack
from typing import Dict

import rospkg
import rospy
import rostest
import yaml
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus

from live_system import await_condition, talker
from monitor_case import MonitorCase

WHOLE = '/Self-awareness'
SOURCES = '/Self-awareness sources'
TOPICS = {'/arm/joint_{}'.format(i): '/arm/driver_{}'.format(i) for i in range(3)}
SUFFIXES = ('', ' (steps)')
"""Of the robot's monitor, and of the one in the namespace /steps."""
STALE = 3
ROUND_S = 50
"""In which each source has its turn, however many there are: test/monitor."""


class AggregatorTest(MonitorCase):

    def setUp(self) -> None:
        super().setUp()
        self.addCleanup(rospy.delete_param, '/steps')
        self.levels: Dict[str, int] = {}  # by name on /diagnostics_agg, as they are now
        self.root = STALE
        for subscriber in (
                rospy.Subscriber('/diagnostics_agg', DiagnosticArray, lambda array: setattr(
                    self, 'levels', {each.name: each.level for each in array.status})),
                rospy.Subscriber('/diagnostics_toplevel_state', DiagnosticStatus,
                                 lambda status: setattr(self, 'root', status.level))):
            self.addCleanup(subscriber.unregister)

    def await_ok(self, *names: str) -> None:
        """Waits until these, their groups and the root are OK, and nothing else is there."""
        expected = dict.fromkeys((WHOLE, SOURCES, *names), DiagnosticStatus.OK)
        await_condition('{} are OK'.format(sorted(expected)), lambda: (
            self.root == DiagnosticStatus.OK and self.levels == expected), 60)

    def test_each_source_of_each_monitor_has_one_place_and_dead_monitors_are_stale(self) -> None:
        with open(rospkg.RosPack().get_path('self_awareness')
                  + '/config/diagnostic_analyzers.yaml') as file:
            analyzers = yaml.safe_load(file)['analyzers']
        self.assertGreater(analyzers['self_awareness_sources']['timeout'], ROUND_S)
        whole = ['{}/{}{}'.format(WHOLE, task, suffix)
                 for task in ('communication', 'monitor') for suffix in SUFFIXES]
        sources = ['{}/arm {}{}'.format(SOURCES, node.split('/')[2], suffix)
                   for node in TOPICS.values() for suffix in SUFFIXES]
        # All that the nodes do is normal.
        model = self.model(-1e9, sorted(TOPICS), sources=TOPICS)
        with ExitStack() as robot:
            for topic, node in TOPICS.items():
                robot.enter_context(talker(node.split('/')[2], topic, 10, '__ns:=/arm'))
            for told, names in (('false', whole), ('true', whole + sources)):
                with ExitStack() as monitors:
                    for namespace in ('/', '/steps'):
                        monitors.enter_context(self.monitor(
                            model, _ns=namespace, source_diagnostics=told, subscribe='all'))
                    self.await_ok(*names)
                await_condition('dead monitors are stale',
                                lambda: self.levels.get(WHOLE) == STALE, 20)


if __name__ == '__main__':
    rospy.init_node('aggregator_test')
    rostest.rosrun('self_awareness', 'aggregator', AggregatorTest)
