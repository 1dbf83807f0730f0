#!/usr/bin/python3
"""launch/record.launch: what lies in the bags, and who listens to whom beside them."""

import glob
import os
import shutil
import tempfile
import unittest
from typing import Set

import rosbag
import rospy
import rostest
from std_msgs.msg import String

from live_system import Process, await_condition
from monitor_case import Talker, subscribers
from self_awareness.training.robot_graph import RobotGraph, graph_file


class RecordTest(unittest.TestCase):

    def setUp(self) -> None:
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)

    def record(self, *arguments: str) -> str:
        """Records for a moment; returns the path of the bag."""
        name = rospy.get_name()
        with Talker('/a') as heard, Talker('/b'), \
                Process('roslaunch', 'self_awareness', 'record.launch',
                        'output:={}/run'.format(self.folder), *arguments):
            await_condition('a bag', self.active, 30)
            await_condition('the recorder listens', heard.publisher.get_num_connections, 30)
            await_condition('a graph', self.edges, 30)
            # Somebody who comes during the recording belongs to it, too.
            late = rospy.Subscriber('/a', String, lambda _: None)
            await_condition('it grows', lambda: (name, '/a', name) in self.edges(), 30)
            late.unregister()
        bag, = glob.glob(self.folder + '/run*.bag')
        return bag

    def active(self) -> Set[str]:
        return set(glob.glob(self.folder + '/run*.bag.active'))

    def edges(self) -> Set[object]:
        files = [graph_file(bag) for bag in self.active()]
        return set().union(*(RobotGraph.load(path).edges() for path in files
                             if os.path.exists(path)))

    def topics(self, bag: str) -> Set[str]:
        with rosbag.Bag(bag) as opened:
            return set(opened.get_type_and_topic_info().topics)

    def test_all_but_what_is_excluded_is_recorded_and_the_graph_lies_beside(self) -> None:
        bag = self.record('exclude:=/b')
        self.assertIn('/a', self.topics(bag))
        self.assertNotIn('/b', self.topics(bag))
        name = rospy.get_name()
        self.assertIn((name, '/a', name), RobotGraph.load(graph_file(bag)).edges())
        self.assertEqual(subscribers('/a'), [])

    def test_only_the_topics_that_are_named_are_recorded(self) -> None:
        self.assertEqual(self.topics(self.record('topics:=/a /c')), {'/a'})


if __name__ == '__main__':
    rospy.init_node('recording')  # as rostest calls it, too
    rostest.rosrun('self_awareness', 'recording', RecordTest)
