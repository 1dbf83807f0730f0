"""What the tests of a single monitor share: somebody who publishes, a model of it, the monitor."""

import os
import shutil
import tempfile
import threading
import unittest
from typing import Any, Dict, List, Optional, Sequence
from xmlrpc.client import ServerProxy

import rosgraph
import rospy
from std_msgs.msg import String
from std_srvs.srv import Trigger, TriggerResponse

import self_awareness
from live_system import (Process, operation, ours, run_program, save_paper_model, talker,
                         write_bag)
from self_awareness import TrainedModel
from self_awareness.parts import BagPart
from self_awareness.recordings import RecordingEvents
from self_awareness.srv import Accept, AcceptResponse
from self_awareness.training import many_bags
from self_awareness.workers import InProcess


class Talker:
    """Publishes on a topic from this process at about 20 Hz, until the `with` block ends."""

    def __init__(self, topic: str, message_class=String) -> None:
        self.publisher = rospy.Publisher(topic, message_class, queue_size=10)
        self.published = 0  # messages so far
        self._message = message_class()
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)

    def _run(self) -> None:
        while not self._stop.wait(0.05):
            self.publisher.publish(self._message)
            self.published += 1

    def __enter__(self) -> 'Talker':
        self._thread.start()
        return self

    def __exit__(self, *_) -> None:
        self.stop()
        self.publisher.unregister()

    def stop(self) -> None:
        """Nothing is published any more; the topic stays."""
        self._stop.set()
        self._thread.join()


class MadeUpPublishers:
    """Topics and nodes that only the master knows: it takes any name, and any address."""

    def __init__(self, names: List[str], uri: str = 'http://127.0.0.1:9') -> None:
        self._names = names
        self._uri = uri

    def __enter__(self) -> 'MadeUpPublishers':
        self._call('registerPublisher', 'std_msgs/String')
        return self

    def __exit__(self, *_) -> None:
        self._call('unregisterPublisher')

    def _call(self, method: str, *arguments: str) -> None:
        master = ServerProxy(rosgraph.get_master_uri())
        for number, name in enumerate(self._names):
            getattr(master, method)('/made_up_{}'.format(number), name, *arguments, self._uri)


def publishers(topic: str) -> List[str]:
    return dict(rosgraph.Master(rospy.get_name()).getSystemState()[0]).get(topic, [])


def subscribers(topic: str) -> List[str]:
    return dict(rosgraph.Master(rospy.get_name()).getSystemState()[1]).get(topic, [])


def accept(**what: Any) -> AcceptResponse:
    rospy.wait_for_service('/self_awareness/accept', 20)
    return rospy.ServiceProxy('/self_awareness/accept', Accept)(**what)


def forget_parameters() -> None:
    """Takes the monitor's parameters from the master: the next one must not find them."""
    if rospy.has_param('/self_awareness'):
        rospy.delete_param('/self_awareness')


def learned(bags: Sequence[str], start_time: float) -> TrainedModel:
    """A model with limits, of recordings of starts that take so long [s]."""
    tuning = self_awareness.Tuning()
    tuning.set('start_time', start_time)
    trained = many_bags.train([BagPart(bag) for bag in bags], many_bags.Counting(tuning=tuning))
    many_bags.preliminary_limits(trained, InProcess())
    return trained.model


class FolderCase(unittest.TestCase):
    """With a folder of its own."""

    def setUp(self) -> None:
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)

    def path(self, name: str) -> str:
        return os.path.join(self.folder, name)


class MonitorCase(FolderCase):
    """Needs rospy.init_node()."""

    def setUp(self) -> None:
        super().setUp()
        self.addCleanup(forget_parameters)

    def model(self, threshold: float = 0.01, topics: Sequence[str] = ('/a',),
              type_fields: Optional[Dict[str, str]] = None, name: str = 'model',
              window: int = 10**8, sources: Optional[Dict[str, str]] = None) -> str:
        """A model of this process as it publishes on topics, std_msgs/String at 20 Hz.

        The bins are wide: on a busy machine, delays up to half a second are normal, too.

        Args:
            sources: who publishes a topic, where it is not this process
        """
        encoding = self_awareness.EncodingRules.defaults()
        encoding.type_fields = type_fields or {}
        # What rospy has to say of nodes that come and go is not what is tested.
        encoding.exclude_topics += ['/rosout']
        types = [self_awareness.EventType((sources or {}).get(topic, rospy.get_name()), topic,
                                          'std_msgs/String') for topic in topics]
        stamps = [10**12 + tick * 50 * 10**6 + event * 10**6
                  for tick in range(1000) for event, _ in enumerate(types)]
        recording = RecordingEvents(types, stamps, 1000 * list(range(len(types))))
        save_paper_model(self.path(name), recording, encoding, threshold,
                         bin_size=500 * 10**6, window=window)
        return self.path(name)

    def monitor(self, model: str, name: str = 'self_awareness', **parameters) -> Process:
        """A monitor in a process of its own, by the paper's score; settles within half a second.
        """
        settings = dict({'detector': 'paper', 'unknown': 'ignore', 'settle_time': 0.5,
                         'poll_interval': 0.1, 'recorder/directory': self.path('recorder')},
                        **parameters)
        return ours('self_awareness_node', '__name:=' + name, '_model:=' + model,
                    *['_{}:={}'.format(key, value) for key, value in settings.items()])

    def call(self, service: str) -> TriggerResponse:
        rospy.wait_for_service(service, 20)
        return rospy.ServiceProxy(service, Trigger)()


def driver(rate: float = 12.5) -> Process:
    """The node of TrainedCase that dies."""
    return talker('driver', '/scan', rate)


def base() -> Process:
    """The node of TrainedCase that goes on."""
    return talker('base', '/odom', 10)


class TrainedCase(MonitorCase):
    """With a model that has limits, of nodes that a test starts by talker()."""

    components = [('/driver', '/scan', 0.08), ('/base', '/odom', 0.1)]
    """Source, topic and mean period [s] of each."""
    trained: str

    @classmethod
    def setUpClass(cls) -> None:
        folder = tempfile.mkdtemp()
        cls.addClassCleanup(shutil.rmtree, folder)
        cls.trained = os.path.join(folder, 'trained')
        run_program('train', '-o', cls.trained, *[
            write_bag(os.path.join(folder, '{}.bag'.format(seed)),
                      operation(cls.components, 120, seed)) for seed in (1, 2)])

    def setUp(self) -> None:
        super().setUp()
        shutil.copy(self.trained, self.path('model'))

    def trained_monitor(self, **options: Any) -> Process:
        """A monitor by the default detector, which says what it never saw in training."""
        return self.monitor(self.path('model'), **{'detector': 'evidence', 'unknown': 'warn',
                                                   'subscribe': 'all', **options})
