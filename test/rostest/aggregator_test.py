#!/usr/bin/python3
"""Two monitors of 60 healthy nodes on /diagnostics_agg: nothing is stale, each has one place."""

import contextlib
import threading
import time
from typing import Dict, Iterator, List, Set

import rospkg
import rospy
import rostest
import yaml
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus

from fake_publisher import FakeTalker
from live_system import again_if_disturbed, await_condition
from monitor_case import MonitorCase

WHOLE = '/Self-awareness'
SOURCES = '/Self-awareness sources'
TOPICS = {'/arm/joint_{}'.format(i): '/arm/driver_{}'.format(i) for i in range(60)}
# Of the robot's monitor, and of the one in the namespace /steps.
SUFFIXES = ('', ' (steps)')
STALE = 3
ROUND_S = 50
"""All sources have had their turn."""


class Aggregated:
    """What is said on /diagnostics and what the aggregator makes of it, while its block lasts."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._said: Dict[str, List[float]] = {}  # when, by the name of the status
        self._levels: Dict[str, int] = {}  # by name on /diagnostics_agg, as they are now
        self._groups: Dict[str, Set[str]] = {}  # names of the statuses in each, as they are now
        self._not_ok: Set[str] = set()  # what was not OK since forget()
        self._root = STALE
        self._subscribers = [
            rospy.Subscriber('/diagnostics', DiagnosticArray, self._on_said),
            rospy.Subscriber('/diagnostics_agg', DiagnosticArray, self._on_aggregated),
            rospy.Subscriber('/diagnostics_toplevel_state', DiagnosticStatus, self._on_root)]

    def __enter__(self) -> 'Aggregated':
        return self

    def __exit__(self, *_) -> None:
        for subscriber in self._subscribers:
            subscriber.unregister()

    def _on_said(self, array: DiagnosticArray) -> None:
        with self._lock:
            for status in array.status:
                self._said.setdefault(status.name, []).append(time.monotonic())

    def _on_aggregated(self, array: DiagnosticArray) -> None:
        with self._lock:
            self._levels = {status.name: status.level for status in array.status}
            self._groups = {status.name: {pair.key for pair in status.values}
                            for status in array.status if status.name.count('/') == 1}
            self._not_ok.update('{} {}: {}'.format(status.level, status.name, status.message)
                                for status in array.status
                                if status.level != DiagnosticStatus.OK)

    def _on_root(self, status: DiagnosticStatus) -> None:
        with self._lock:
            self._root = status.level
            if status.level != DiagnosticStatus.OK:
                self._not_ok.add('{}: the root'.format(status.level))

    def forget(self) -> None:
        with self._lock:
            self._not_ok.clear()
            self._said.clear()

    @property
    def said(self) -> Dict[str, List[float]]:
        with self._lock:
            return {name: list(times) for name, times in self._said.items()}

    @property
    def levels(self) -> Dict[str, int]:
        with self._lock:
            return dict(self._levels)

    @property
    def not_ok(self) -> List[str]:
        with self._lock:
            return sorted(self._not_ok)

    def groups_of(self, name: str) -> List[str]:
        with self._lock:
            return [group for group, names in self._groups.items() if name in names]

    def all_ok(self, *names: str) -> bool:
        with self._lock:
            return self._root == DiagnosticStatus.OK and all(
                self._levels.get(name) == DiagnosticStatus.OK for name in names)


class AggregatorTest(MonitorCase):

    @classmethod
    def setUpClass(cls) -> None:
        for topic, node in TOPICS.items():
            talker = FakeTalker(topic, node)
            talker.__enter__()
            cls.addClassCleanup(talker.__exit__)

    def setUp(self) -> None:
        super().setUp()
        self.addCleanup(rospy.delete_param, '/steps')

    @contextlib.contextmanager
    def monitors(self, **parameters) -> Iterator[None]:
        """Two monitors, whose model takes all that the nodes do for normal."""
        model = self.model(-1e9, sorted(TOPICS), sources=TOPICS)
        parameters['recorder/duration'] = 0
        with contextlib.ExitStack() as stack:
            for namespace in ('/', '/steps'):
                stack.enter_context(self.monitor(model, _ns=namespace, **parameters))
            yield

    def test_1_no_sources_are_all_right(self) -> None:
        """Nor is who waits for its turn."""
        with open(rospkg.RosPack().get_path('self_awareness')
                  + '/config/diagnostic_analyzers.yaml') as file:
            analyzers = yaml.safe_load(file)['analyzers']
        self.assertGreater(analyzers['self_awareness_sources']['timeout'], ROUND_S)
        with self.monitors(source_diagnostics='false'), Aggregated() as aggregated:
            await_condition('OK', lambda: aggregated.all_ok(WHOLE, SOURCES), 60)
            self.assertEqual([x for x in aggregated.levels if x.startswith(SOURCES + '/')], [])

    @again_if_disturbed
    def test_2_all_healthy_and_each_in_one_group(self) -> None:
        whole = {'{}/{}{}'.format(WHOLE, task, suffix)
                 for task in ('communication', 'monitor') for suffix in SUFFIXES}
        sources = {'{}/arm {}{}'.format(SOURCES, node.split('/')[2], suffix)
                   for node in TOPICS.values() for suffix in SUFFIXES}
        seconds = rospy.get_param('~seconds')
        with Aggregated() as aggregated:
            with self.monitors():
                await_condition('all are OK', lambda: aggregated.all_ok(*whole, *sources), 90)
                aggregated.forget()
                began = time.monotonic()
                time.sleep(seconds)  # nothing is to happen
                self.assertEqual(aggregated.not_ok, [])
                self.assertEqual({name for name in aggregated.levels if name.count('/') > 1},
                                 whole | sources)
                said = aggregated.said
                if seconds > ROUND_S:
                    self.assertEqual(len(said), len(whole | sources))
                for name in said:
                    group = SOURCES if ': /' in name else WHOLE
                    self.assertEqual(aggregated.groups_of(name), [group], name)
            # They do take turns: not all are said within 5 s, which the whole has.
            waits = [times[0] - began for name, times in said.items() if ': /' in name]
            self.assertGreater(max(waits), 5)
            await_condition('dead monitors are stale',
                            lambda: aggregated.levels.get(WHOLE) == STALE, 20)


if __name__ == '__main__':
    rospy.init_node('aggregator_test')
    rostest.rosrun('self_awareness', 'aggregator', AggregatorTest)
