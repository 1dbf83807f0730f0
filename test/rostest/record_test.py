#!/usr/bin/python3
"""launch/record.launch: what lies in event logs and in bags, and who listens to whom."""

import glob
import os
from typing import Callable, List, Set

import rosbag
import rosgraph
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from rosgraph_msgs.msg import Log
from std_msgs.msg import String

from live_system import Process, await_condition, ours
from monitor_case import FolderCase, Talker, subscribers
from self_awareness import (EncodingRules, read_events, recordings_in_event_log,
                            summarise_bag)
from self_awareness.training.robot_graph import RobotGraph, graph_file


def own_host() -> str:
    """The computer of this node, as its address says."""
    uri = rosgraph.Master(rospy.get_name()).lookupNode(rospy.get_name())
    return uri.split('//')[1].split(':')[0]


class RecordTest(FolderCase):

    def launch(self, *arguments: str) -> Process:
        return Process('roslaunch', 'self_awareness', 'record.launch',
                       'output:={}/run'.format(self.folder), *arguments)

    def record_bags(self, *arguments: str) -> str:
        """Records for a moment; returns the path of the bag."""
        name = rospy.get_name()
        with Talker('/a') as heard, Talker('/b'), self.launch('what:=bags', *arguments):
            await_condition('a bag', self.active, 30)
            await_condition('the recorder listens', lambda: set(subscribers('/a')) - {name}
                            and heard.publisher.get_num_connections(), 30)
            # A connection is there before its first message has arrived.
            before = heard.published
            await_condition('a graph', self.edges, 30)
            # Somebody who comes during the recording belongs to it, too.
            late = rospy.Subscriber('/a', String, lambda _: None)
            await_condition('it grows', lambda: (name, '/a', name) in self.edges(), 30)
            late.unregister()
            await_condition('messages', lambda: heard.published >= before + 20, 30)
        bag, = glob.glob(self.folder + '/run*.bag')
        return bag

    def active(self) -> Set[str]:
        return set(glob.glob(self.folder + '/run*.bag.active'))

    def edges(self) -> Set[object]:
        files = [graph_file(bag) for bag in self.active()]
        return set().union(*(RobotGraph.load(path).edges(EncodingRules()) for path in files
                             if os.path.exists(path)))

    def topics(self, bag: str) -> Set[str]:
        with rosbag.Bag(bag) as opened:
            return set(opened.get_type_and_topic_info().topics)

    def test_all_but_what_is_excluded_is_recorded_and_the_graph_lies_beside(self) -> None:
        bag = self.record_bags('exclude:=/b')
        self.assertIn('/a', self.topics(bag))
        self.assertNotIn('/b', self.topics(bag))
        name = rospy.get_name()
        graph = RobotGraph.load(graph_file(bag))
        self.assertIn((name, '/a', name), graph.edges(EncodingRules()))
        self.assertEqual(graph.hosts[name], own_host())
        self.assertEqual(subscribers('/a'), [])

    def test_only_the_topics_that_are_named_are_recorded(self) -> None:
        self.assertEqual(self.topics(self.record_bags('topics:=/a /c')), {'/a'})

    def record_events(self, until: Callable[[], object], *arguments: str) -> List[str]:
        """Records event logs until something holds; returns their paths, in order."""
        with self.launch(*arguments):
            await_condition('a log', self.active, 30)
            await_condition('something', until, 60)
        self.assertEqual(self.active(), set())
        return sorted(glob.glob(self.folder + '/run*.bag'))

    def test_event_logs_hold_what_somebody_listens_to(self) -> None:
        name = rospy.get_name()
        with Talker('/a') as heard, Talker('/lonely') as lonely:
            listener = rospy.Subscriber('/a', String, lambda _: None)
            log, = self.record_events(
                lambda: heard.publisher.get_num_connections() > 1 and self.holds(20)
                and not lonely.publisher.get_num_connections())  # nobody is woken
            listener.unregister()
        self.assertEqual(recordings_in_event_log(log), 1)
        events = read_events(log, EncodingRules.defaults(), recording=0)
        heard_of = {(kind.source, kind.scope, kind.type) for kind in events.event_types}
        self.assertIn((name, '/a', 'std_msgs/String'), heard_of)
        self.assertNotIn('/recorder', {source for source, _, _ in heard_of})
        summary = summarise_bag(log, 0)
        self.assertTrue(0 < summary.robot_start <= summary.start <= events.stamps[0])
        self.assertIn((name, '/a', name), RobotGraph(*summary.graph).edges(EncodingRules()))
        self.assertEqual(RobotGraph(*summary.graph).hosts[name], own_host())
        unheard = RobotGraph(*summary.graph).unheard(EncodingRules.defaults())
        self.assertIn((name, '/lonely'), unheard, 'it is known by name')
        self.assertNotIn('/recorder', {source for source, _ in unheard})

    def test_files_of_one_start_say_so(self) -> None:
        with Talker('/a'), Talker('/b'):
            rospy.Subscriber('/a', String, lambda _: None)
            files = self.record_events(lambda: glob.glob(self.folder + '/run*.bag'),
                                       'split:=0.1', 'robot:=r7')
            again = self.record_events(lambda: True, 'split:=1')
        self.assertEqual({summarise_bag(path, 0).robot for path in files}, {'r7'})
        self.assertEqual({summarise_bag(path, 0).robot for path in set(again) - set(files)}, {''})
        starts = [summarise_bag(path, 0).robot_start for path in files]
        self.assertGreaterEqual(len(files), 2)
        self.assertEqual(len(set(starts)), 1)
        later, = set(again) - set(files)
        self.assertNotEqual(summarise_bag(later, 0).robot_start, starts[0])

    def test_a_missing_folder_is_told_once_and_recording_begins_when_it_is_there(self) -> None:
        said, folder = [], self.folder + '/new'
        listener = rospy.Subscriber('/rosout', Log, said.append)
        with ours('record_events', '__name:=early',
                  '_output:={}/run'.format(folder)), Talker('/a'):
            looks: List[object] = []
            looking = rospy.Subscriber('/diagnostics', DiagnosticArray, lambda array: looks.extend(
                status for status in array.status if status.name == 'early: recording'
                and "mkdir -p '{}'".format(folder) in status.message))
            await_condition('it has looked again and again', lambda: len(looks) >= 4, 60)
            told = [log.msg for log in said if log.name == '/early' and log.level >= Log.ERROR]
            os.mkdir(folder)
            await_condition('a log', lambda: glob.glob(folder + '/run*.bag.active'), 30)
            looking.unregister()
        listener.unregister()
        self.assertEqual(len(told), 1, told)

    def test_a_disk_without_space_is_an_error_on_diagnostics(self) -> None:
        said = []
        listener = rospy.Subscriber('/diagnostics', DiagnosticArray, said.append)
        # Under a name of its own: the parameters stay on the master.
        with ours('record_events', '__name:=full',
                  '_output:={}/run'.format(self.folder), '_min_space:=1e12'):
            await_condition('an error', lambda: [
                status for array in said for status in array.status
                if status.name == 'full: recording' and status.level == 2
                and 'min_space' in status.message], 30)
        listener.unregister()
        self.assertEqual(os.listdir(self.folder), [])

    def test_an_encoding_that_is_wrong_ends_the_node_and_is_named(self) -> None:
        for number, (parameter, value) in enumerate((
                ('encoding/exclude', '[/a]'), ('encoding/exclude_topics', '/a'),
                ('encoding/include_topics', '["("]'), ('encoding/source', 'nobody'),
                ('encoding/type_fields', '{std_msgs/String: 1}'),
                ('encoding/type_fields', '{std_msgs/Float32: {field: data, classes: 4}}'),
                ('encoding/mode', '{topic: /a}'), ('split', '0'))):
            name = 'wrong{}'.format(number)
            recorder = ours('record_events', '__name:=' + name,
                            '_output:={}/run'.format(self.folder),
                            '_{}:={}'.format(parameter, value))
            with recorder:
                self.assertEqual(recorder.wait(30), 1)
                self.assertIn('/{}/{}'.format(name, parameter.split('/')[0]), recorder.output)
        self.assertEqual(os.listdir(self.folder), [])

    def holds(self, events: int) -> bool:
        """Whether a diagnostic says that at least so many events were recorded."""
        said = rospy.wait_for_message('/diagnostics', DiagnosticArray, 10)
        return any(int(value.value) >= events for status in said.status
                   if status.name == 'recorder: recording'
                   for value in status.values if value.key == 'events')


if __name__ == '__main__':
    rospy.init_node('recording')  # as rostest calls it, too
    rostest.rosrun('self_awareness', 'recording', RecordTest)
