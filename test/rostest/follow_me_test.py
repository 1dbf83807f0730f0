#!/usr/bin/python3
"""The simulated robot as real nodes: processes, rates, and errors induced while it runs."""
from __future__ import annotations

import argparse
import os
import signal
import sys
import time
import traceback
import unittest
from functools import partial
from itertools import chain
from statistics import median
from types import FrameType
from typing import Callable, Dict, List, Optional, Set

import rosgraph
import rospy
import rostest
from std_msgs.msg import Header

from live_system import await_condition, pid_of
from self_awareness.commands import induce
from self_awareness_follow_me import induction
from self_awareness_follow_me.scenario import Scenario, load_scenario

_RATE_HZ = 163.0
_WINDOW_S = 5.0
# Passes the stamp of its input on, which tells how long it took.
_STAMPED = 'legs'
# Generous: 15 processes start on a machine that may be busy with other things.
_DEADLINE_S = 45.0
# Of one test. All of them together take less than what the .test file allows: so a test that waits
# for what never comes, or hangs, says so itself.
_TEST_S = 60


def wait_for(condition: Callable[[], bool], what: str) -> None:
    """Wait until the condition holds; fail with `what` if that takes too long."""
    await_condition(what, condition, _DEADLINE_S)


def _hangs(_: int, frame: Optional[FrameType]) -> None:
    calls = traceback.extract_stack(frame)[-8:]
    raise AssertionError(f'not within {_TEST_S} s; it is in ' + ', '.join(
        f'{call.name} ({os.path.basename(call.filename)}:{call.lineno})' for call in calls))


class Listener:
    """Remembers when messages came."""

    def __init__(self, prefix: str, scenario: Scenario) -> None:
        self._begin = time.monotonic()
        self._came: Dict[str, List[float]] = {topic: [] for topic in scenario.datatypes}
        self._ages = [0.0]  # of _STAMPED
        self._subscribers = [rospy.Subscriber(prefix + topic, rospy.AnyMsg, self._heard, topic)
                             for topic in scenario.datatypes]

    def rate(self, topic: Optional[str] = None) -> float:
        """Return the rate of all messages, or of a topic, lately (Hz); 0 in the first seconds."""
        since = time.monotonic() - _WINDOW_S
        came = chain.from_iterable(self._came.values()) if topic is None else self._came[topic]
        return sum(stamp > since for stamp in came) / _WINDOW_S if since > self._begin else 0.0

    def silent_for(self, topic: str, seconds: float) -> bool:
        """Return whether nothing came on a topic for so long."""
        return time.monotonic() - (self._came[topic] or [self._begin])[-1] > seconds

    def heard(self, topic: str) -> bool:
        """Return whether anything ever came on a topic."""
        return bool(self._came[topic])

    def age(self) -> float:
        """Return what stamps on _STAMPED are behind their arrival (s): the median, lately."""
        return median(self._ages[-11:])

    def _heard(self, message: rospy.AnyMsg, topic: str) -> None:
        if topic == _STAMPED:
            # Every message with a header begins with it.
            stamp = Header().deserialize(message._buff).stamp
            self._ages.append((rospy.Time.now() - stamp).to_sec())
        self._came[topic].append(time.monotonic())


class FollowMeTest(unittest.TestCase):
    """The tests run in the order of their names: the last ones break the robot."""

    namespace = ''
    scenario: Scenario
    listener: Listener

    @classmethod
    def setUpClass(cls) -> None:
        cls.scenario = load_scenario()
        cls.listener = Listener(f'/{cls.namespace}/', cls.scenario)

    def setUp(self) -> None:
        signal.signal(signal.SIGALRM, _hangs)
        signal.alarm(_TEST_S)
        self.addCleanup(signal.alarm, 0)

    def _node(self, name: str) -> str:
        return f'/{self.namespace}/{name}'

    def _registered(self) -> Set[str]:
        publishers = rosgraph.Master(rospy.get_name()).getSystemState()[0]
        return {node for _, nodes in publishers for node in nodes
                if node.startswith(f'/{self.namespace}/')}

    def test_1_every_component_is_a_process_of_its_own_and_sends_as_in_the_paper(self) -> None:
        nodes = {self._node(spec.name) for spec in self.scenario.components}
        wait_for(lambda: self._registered() == nodes, 'all 15 components publish')
        self.assertEqual(len({pid_of(node) for node in nodes}), 15)
        wait_for(lambda: abs(self.listener.rate() - _RATE_HZ) < 0.1 * _RATE_HZ,
                 f'about {_RATE_HZ:g} messages a second')
        for topic in ('odom', 'scan', 'pose', 'cmd_vel', 'tracks', 'person_hypotheses', 'battery',
                      'speech/command', 'map_metadata'):
            wait_for(partial(self.listener.heard, topic), f'a message on {topic}')

    def test_2_latency_grows_at_an_unchanged_rate(self) -> None:
        wait_for(lambda: 0.0 < self.listener.age() < 0.04, 'legs soon after the scan')
        with induction.disturbed('lat', self.namespace):
            wait_for(lambda: 0.06 < self.listener.age() < 0.1, 'legs 60 ms later')
            since = time.monotonic()
            wait_for(lambda: time.monotonic() - since > _WINDOW_S
                     and abs(self.listener.rate('legs') - 10.0) < 0.5, '10 Hz nevertheless')
            self.assertGreater(self.listener.age(), 0.06)
        wait_for(lambda: self.listener.age() < 0.04, 'legs soon after the scan again')

    def test_2_subscriber_leaves_and_comes_back(self) -> None:
        def listens() -> bool:
            subscribers = dict(rosgraph.Master(rospy.get_name()).getSystemState()[1])
            return self._node('navigation') in subscribers[self._node('pose_hypotheses')]
        wait_for(listens, 'navigation subscribes to pose_hypotheses')
        with induction.disturbed('unsubscribed:navigation', self.namespace):
            wait_for(lambda: not listens(), 'navigation does not subscribe to pose_hypotheses')
        wait_for(listens, 'navigation subscribes to pose_hypotheses again')

    def test_2_intruder_comes_and_goes(self) -> None:
        intruder = self.scenario.faults.extra
        with induction.intruding(intruder, self.namespace):
            wait_for(lambda: abs(self.listener.rate('cmd_vel') - 15.0) < 1.0, 'two who publish')
        wait_for(lambda: self._node(intruder.spec.name) not in self._registered(), 'one leaves')
        wait_for(lambda: abs(self.listener.rate('cmd_vel') - 5.0) < 0.5, 'one who publishes')

    def test_3_unknown_robot_is_an_error(self) -> None:
        self.assertEqual(induce.main(['cc1', '--namespace', 'nobody']), 1)
        for kind in ('ac', 'extra', 'silence'):
            self.assertEqual(induce.main([kind, '--namespace', 'nobody']), 1)

    def test_4_killed_player_silences_slam(self) -> None:
        player, slam = (pid_of(self._node(name)) for name in ('player', 'slam'))
        self.assertEqual(induce.main(['cc1', '--namespace', self.namespace]), 0)
        for topic in ('scan', 'pose', 'cmd_vel'):
            wait_for(partial(self.listener.silent_for, topic, 2.0), f'{topic} silent')
        wait_for(lambda: not os.path.exists(f'/proc/{player}'), 'player dead')
        # The others live on.
        self.assertEqual(pid_of(self._node('slam')), slam)
        wait_for(lambda: not self.listener.silent_for('odom', 1.0), 'a message on odom')
        self.assertEqual(induce.main(['cc1', '--namespace', self.namespace]), 1)

    def test_5_silence_kills_who_is_left(self) -> None:
        pids = [pid_of(self._node(spec.name)) for spec in self.scenario.components
                if spec.name != 'player']
        self.assertEqual(induce.main(['silence', '--namespace', self.namespace]), 0)
        wait_for(lambda: not any(os.path.exists(f'/proc/{pid}') for pid in pids), 'all dead')
        self.assertEqual(induce.main(['silence', '--namespace', self.namespace]), 1)


if __name__ == '__main__':
    rospy.init_node('follow_me_test')
    parser = argparse.ArgumentParser()
    parser.add_argument('--namespace', required=True)
    FollowMeTest.namespace = parser.parse_known_args(rospy.myargv()[1:])[0].namespace
    rostest.rosrun('self_awareness', 'follow_me', FollowMeTest, sys.argv)
