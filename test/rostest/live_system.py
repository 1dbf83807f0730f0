"""What the live tests share: processes, waiting for conditions, listening to the monitor."""

import functools
import os
import random
import signal
import subprocess
import tempfile
import threading
import time
import unittest
from typing import (Any, Callable, Dict, Iterable, Iterator, List, Optional, Set, Tuple, Type,
                    TypeVar)
from xmlrpc.client import ServerProxy

import rosbag
import rosgraph
import rospy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from std_msgs.msg import String

import self_awareness
from self_awareness.learning.programs import executable
from self_awareness.msg import SelfAwareness
from self_awareness.recordings import RecordingEvents
from self_awareness.status_names import task_of

T = TypeVar('T')
Case = TypeVar('Case', bound=unittest.TestCase)

START_S = 1600000000.0
"""Of the recordings that operation() makes up, since 1970."""

THRESHOLD = 0.02
"""A tenth of what normal operation scores; a window without messages scores 0."""

DISTURBED_S = 0.4
"""A machine that stands still, or whose clock is set, by less disturbs no test [s]: the monitor
calls 0.5 s a standstill."""


def await_condition(what: str, condition: Callable[[], Optional[T]], timeout: float) -> T:
    """The condition's value as soon as it is true; AssertionError after `timeout` [s]."""
    deadline = time.monotonic() + timeout
    while True:
        value = condition()
        if value:
            return value
        if time.monotonic() > deadline:
            raise AssertionError('not within {:g} s: {}'.format(timeout, what))
        if rospy.is_shutdown():
            raise AssertionError('interrupted while waiting: {}'.format(what))
        time.sleep(0.02)


def pid_of(node: str) -> int:
    """Asks a node for its process id, as `induce` does; needs rospy.init_node()."""
    uri = rosgraph.Master(rospy.get_name()).lookupNode(node)
    answer: Any = ServerProxy(uri).getPid(rospy.get_name())
    return int(answer[2])


class Ticks:
    """Looks at the clock all the time, to see whether this machine stood still meanwhile."""

    _EVERY_S = 0.02

    def __init__(self) -> None:
        self.longest = 0.0  # time from one look to the next [s]
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)

    def __enter__(self) -> 'Ticks':
        self._thread.start()
        return self

    def __exit__(self, *_) -> None:
        self._ended.set()
        self._thread.join()

    def _run(self) -> None:
        last = time.monotonic()
        while not self._ended.wait(self._EVERY_S):
            now = time.monotonic()
            self.longest = max(self.longest, now - last)
            last = now


def again_if_disturbed(case: Type[Case]) -> Type[Case]:
    """Decorates a case: a test that fails while the machine disturbs it has a second try.

    A machine may stand still (a virtual one, while its host is busy), or its clock is set (by NTP,
    by the host). The monitor says so, and settles once more or starts from the beginning.
    """
    for name in [name for name in vars(case) if name.startswith('test_')]:
        setattr(case, name, _again(getattr(case, name)))
    return case


def _again(test: Callable) -> Callable:
    @functools.wraps(test)
    def run(self: unittest.TestCase) -> None:
        ahead = time.time() - time.monotonic()
        with Ticks() as ticks:
            try:
                return test(self)
            except AssertionError:
                set_by = time.time() - time.monotonic() - ahead
                if abs(set_by) < DISTURBED_S and ticks.longest < DISTURBED_S:
                    raise
        print('once more: the machine stood still for {:.1f} s, its clock was set by {:.1f} s'
              .format(ticks.longest, set_by))
        self.doCleanups()
        self.setUp()
        test(self)
    return run


class Process:
    """A process with its output in a file, ended with the `with` block, or if the test dies."""

    def __init__(self, *command: str, env: Optional[Dict[str, str]] = None) -> None:
        self._output = tempfile.NamedTemporaryFile(mode='r', suffix='.log')
        self._process = subprocess.Popen(
            ('setpriv', '--pdeathsig', 'TERM') + command,
            env=dict(os.environ, **(env or {})), stdin=subprocess.DEVNULL,
            stdout=open(self._output.name, 'w'), stderr=subprocess.STDOUT,
            start_new_session=True)

    def __enter__(self) -> 'Process':
        return self

    def __exit__(self, *_) -> None:
        self.stop()

    @property
    def pid(self) -> int:
        return self._process.pid

    @property
    def output(self) -> str:
        """All that the process has printed so far."""
        with open(self._output.name, errors='replace') as output:
            return output.read()

    def running(self) -> bool:
        return self._process.poll() is None

    def wait(self, timeout: float) -> int:
        """The exit code; AssertionError after `timeout` [s]."""
        try:
            return self._process.wait(timeout)
        except subprocess.TimeoutExpired:
            raise AssertionError('does not end:\n' + self.output)

    def send(self, number: int) -> None:
        """Sends a signal to the process and all that it started."""
        try:
            os.killpg(self._process.pid, number)
        except ProcessLookupError:
            pass

    def stop(self) -> None:
        """Interrupts the process and all that it started, and kills what is left after 15 s.

        What it started may end after it: `rosbag record` leaves the bag to a child.
        """
        self.send(signal.SIGCONT)
        self.send(signal.SIGINT)
        deadline = time.monotonic() + 15
        while self._group_runs() and time.monotonic() < deadline:
            time.sleep(0.02)
        self.send(signal.SIGKILL)
        self._process.wait()

    def _group_runs(self) -> bool:
        self._process.poll()  # reaps the leader, which would count otherwise
        try:
            os.killpg(self._process.pid, 0)
        except ProcessLookupError:
            return False
        return True


@functools.lru_cache(maxsize=None)
def path_of(program: str) -> str:
    """Where a program or node of this package is; `rosrun` looks for it each time."""
    return executable(program)


def ours(program: str, *arguments: str) -> Process:
    """A program or node of this package."""
    return Process(path_of(program), *arguments)


def talker(name: str, topic: str, rate: float, *arguments: str) -> Process:
    """talker.cpp: a node whose periods vary as those of operation()."""
    return ours('talker', '__name:=' + name, '_output:=' + topic, '_rate:={}'.format(rate),
                '_variation:=0.3', *arguments)


def run_program(program: str, *arguments: str) -> str:
    """What a program of this package prints; AssertionError if it fails."""
    done = subprocess.run((path_of(program), *arguments), stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        raise AssertionError('{}: {}'.format(program, done.stderr))
    return done.stdout


class MonitorListener:
    """Keeps all that a monitor says, which only grows; needs rospy.init_node()."""

    def __init__(self, name: str = '/self_awareness') -> None:
        self._name = name
        self.statuses: List[SelfAwareness] = []
        self.alarms: List[SelfAwareness] = []
        self.heartbeats: List[float] = []
        """When the monitor's diagnostics came [s of time.monotonic()]."""
        self._awaited: Set[int] = set()  # alarms that await_alarm() returned
        self._diagnostics: List[DiagnosticStatus] = []
        self._subscribers = [
            rospy.Subscriber(name + '/status', SelfAwareness, self.statuses.append),
            rospy.Subscriber(name + '/alarm', SelfAwareness, self.alarms.append),
            rospy.Subscriber('/diagnostics', DiagnosticArray, self._on_diagnostics),
        ]

    def _on_diagnostics(self, array: DiagnosticArray) -> None:
        self._diagnostics += [status for status in array.status
                              if task_of(self._name, status.name) is not None]
        if any(task_of(self._name, status.name) == 'monitor' for status in array.status):
            self.heartbeats.append(time.monotonic())

    def __enter__(self) -> 'MonitorListener':
        return self

    def __exit__(self, *_) -> None:
        for subscriber in self._subscribers:
            subscriber.unregister()

    @property
    def errors(self) -> List[str]:
        """What alarms said that are of somebody."""
        return [alarm.message for alarm in self.alarms if self._is_of_somebody(alarm)]

    def diagnostics(self, task: str) -> List[DiagnosticStatus]:
        """All statuses so far of one task: 'communication', 'monitor' or a component."""
        return [status for status in self._diagnostics
                if task_of(self._name, status.name) == task]

    def await_diagnostics(self, task: str, words: str, level: Optional[int] = None,
                          timeout: float = 40, since: int = 0) -> DiagnosticStatus:
        """Waits for a status of a task with these words, after so many of them."""
        return await_condition('{} at level {}'.format(words, level), lambda: next(
            (status for status in self.diagnostics(task)[since:]
             if words in status.message and level in (None, status.level)), None), timeout)

    def await_next(self, task: str, words: str, level: int,
                   timeout: float = 40) -> DiagnosticStatus:
        """Waits for a status of a task with these words, from now on."""
        return self.await_diagnostics(task, words, level, timeout, len(self.diagnostics(task)))

    def value(self, task: str, key: str) -> Optional[str]:
        """A value of the task's last status; None if there is none yet."""
        for status in reversed(self.diagnostics(task)):
            return next((pair.value for pair in status.values if pair.key == key), None)
        return None

    def next_statuses(self, number: int) -> List[SelfAwareness]:
        """Waits for so many more; returns them."""
        seen = len(self.statuses)
        await_condition('{} statuses'.format(number),
                        lambda: len(self.statuses) >= seen + number, 40)
        return self.statuses[seen:]

    def await_heartbeats(self, number: int) -> None:
        """Waits until the monitor's diagnostics have come so many times more."""
        seen = len(self.heartbeats)
        await_condition('{} heartbeats'.format(number),
                        lambda: len(self.heartbeats) >= seen + number, 40)

    def await_heard(self, *nodes: str) -> None:
        """Waits until nodes are heard, and judged."""
        for node in nodes:
            await_condition(node + ' is heard', lambda: (
                float(self.value(node, 'events a second') or 0) > 5), 30)
        self.await_settled()

    def await_settled(self, timeout: float = 40) -> SelfAwareness:
        """Waits until the monitor has settled after what has happened so far."""
        seen = len(self.statuses)
        return await_condition(
            'the monitor settles',
            lambda: next((s for s in self.statuses[seen:] if not s.settling), None), timeout)

    def await_alarm(self, timeout: float = 20) -> SelfAwareness:
        """Waits for an alarm that it has not returned before; it may have been raised already.

        On a busy machine, an alarm may say so first, and later who died.
        """
        alarm = await_condition(
            'an alarm', lambda: next((a for a in self.alarms if self._is_of_somebody(a)
                                      and a.alarm not in self._awaited), None), timeout)
        self._awaited.add(alarm.alarm)
        return alarm

    @staticmethod
    def _is_of_somebody(alarm: SelfAwareness) -> bool:
        """Whether it is an alarm that says more than that the machine is busy: beside other tests,
        it is."""
        return alarm.level == SelfAwareness.ERROR and bool(
            alarm.kind != SelfAwareness.BUSY_MACHINE or alarm.suspects)

    def await_culprit(self, source: str, topic: str, timeout: float = 20) -> None:
        """Waits until an alarm names a node first; no alarm may have named another one before,
        but one that says that the machine is busy."""
        def named() -> Optional[SelfAwareness]:
            return next((a for a in self.alarms if a.level == SelfAwareness.ERROR and a.suspects
                         and (a.suspects[0].source, a.suspects[0].scope) == (source, topic)), None)
        culprit = await_condition('an alarm that names {}'.format(source), named, timeout)
        before = self.alarms[:self.alarms.index(culprit)]
        others = [a for a in before if a.level == SelfAwareness.ERROR
                  and a.kind != SelfAwareness.BUSY_MACHINE]
        if others:
            raise AssertionError('an alarm named another one first: {}'.format(others))


def operation(components: Iterable[Tuple[str, str, float]], length: float,
              seed: int) -> Iterator[Tuple[float, str, str]]:
    """A recording of normal operation, from START_S on, as write_bag() takes it.

    Periods vary by 30 %: by more than those of a live system, or of a replay under sim time.

    Args:
        components: source, topic and mean period [s] of each
        length: [s]
    """
    rng = random.Random(seed)
    for source, topic, period in components:
        time_s = rng.uniform(0, period)
        while time_s < length:
            yield START_S + time_s, source, topic
            time_s += period * rng.uniform(0.7, 1.3)


def write_bag(path: str, messages: Iterable[Tuple[float, str, str]]) -> str:
    """Writes std_msgs/String messages, given as (stamp [s], source, topic); returns the path."""
    connections: Dict[Tuple[str, str], Any] = {}
    with rosbag.Bag(path, 'w') as bag:
        for stamp, source, topic in sorted(messages):
            # rosbag itself has one connection for each topic, however many nodes publish there.
            bag._topic_connections.pop(topic, None)
            if (source, topic) in connections:
                bag._topic_connections[topic] = connections[source, topic]
            header = {'topic': topic, 'type': String._type, 'md5sum': String._md5sum,
                      'message_definition': String._full_text, 'callerid': source}
            bag.write(topic, String(), rospy.Time.from_sec(stamp), connection_header=header)
            connections[source, topic] = bag._topic_connections[topic]
    return path


def make_model(path: str, components: Iterable[Tuple[str, str, float]],
               source: str = 'callerid') -> None:
    """Writes a model for the paper's detector of operation()."""
    encoding = self_awareness.EncodingRules.defaults()
    encoding.source = source
    read = self_awareness.read_events(
        write_bag(path + '.bag', operation(components, 120, seed=1)), encoding)
    save_paper_model(path, RecordingEvents(read.event_types, read.stamps, read.ids), encoding,
                     THRESHOLD)


def save_paper_model(path: str, recording: RecordingEvents, encoding: self_awareness.EncodingRules,
                     threshold: float, **of_learner: Any) -> None:
    """Trains a model for the paper's detector on a recording."""
    learner = self_awareness.Learner(encoding=encoding, paper=True, **of_learner)
    learner.count(recording)
    model = learner.model()
    calibration = self_awareness.PaperCalibration()
    calibration.threshold = threshold
    model.paper_calibration = calibration
    model.save(path)
