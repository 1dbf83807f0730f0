"""The learning as a node: records until there is enough, then trains, or records more."""
from __future__ import annotations

import os
import threading
import time
from dataclasses import dataclass
from typing import Dict, Optional

import rosgraph
import rospy
from diagnostic_msgs.msg import DiagnosticStatus
from std_srvs.srv import Trigger, TriggerRequest, TriggerResponse

from self_awareness import EncodingRules, why_nothing_is_heard
from self_awareness.learning import programs
from self_awareness.learning.announcer import Announcer
from self_awareness.learning.logs import HEARD_S, LogFolder, divide
from self_awareness.learning.recorder import Recorder
from self_awareness.reporting.text import number_of

_PERIOD_S = 1.0
_NOBODY_S = 3.0  # nothing was heard at all: who starts has been seen by then
_MORE = 1.5
_LEAST_MORE_H = 1.0 / 60.0


@dataclass(frozen=True)
class Plan:
    """What is to be learned.

    Recordings that are there count among the hours; time in which nobody is heard does not.
    """

    model: str  # file to write
    logs: str  # folder of the event logs
    hours: float  # of recordings to learn from
    start_up: float  # left out after each start of the robot [s]
    budget: float  # false alarms an hour that the limits allow
    encoding: EncodingRules
    subscribe: str  # used or all, see launch/record.launch


class LearningNode:
    """Learns by a plan, and serves `~finish` (std_srvs/Trigger); needs rospy.init_node()."""

    def __init__(self, plan: Plan) -> None:
        self._plan = plan
        self._wanted = plan.hours
        self._folder = LogFolder(plan.logs, plan.encoding)
        self._announcer = Announcer()
        self._problem = ''  # why the last attempt failed
        self._silence = ''  # why nothing is heard
        self._recorder: Optional[Recorder] = None
        self._robot_start = time.time()
        self._starts_before = 0
        self._finish = threading.Event()
        self._service = rospy.Service('~finish', Trigger, self._on_finish)

    def run(self) -> bool:
        """Learn the model; return False if the node was told to end before.

        Raises:
            ValueError: another one records in the folder, or the recorder refused to.
            RecorderCrash: the recorder has ended by itself.
        """
        with self._folder.locked() as lock:
            for line in self._folder.mend():
                rospy.logwarn(line)
            self._look()
            self._starts_before = self._folder.starts
            while self._listen(lock) and not rospy.is_shutdown():
                if self._train():
                    return True
        return False

    def _listen(self, lock: int) -> bool:
        """Record until there is enough; return False if the node was told to end before."""
        self._finish.clear()
        while self._folder.hours < self._wanted and not self._finish.is_set():
            rospy.loginfo('recording to %s; %s', self._plan.logs,
                          self._progress(self._folder.hours, self._folder.starts))
            with Recorder(os.path.join(self._plan.logs, 'normal'), self._plan.encoding,
                          self._plan.subscribe, self._robot_start, lock) as self._recorder:
                self._await(self._recorder)
            self._recorder = None
            self._look()
            if rospy.is_shutdown():
                return False
        return True

    def _await(self, recorder: Recorder) -> None:
        """Wait until there is enough, or nothing more is to be recorded; say how far it is."""
        starts = self._starts_before + 1
        told = 0
        while not rospy.is_shutdown() and not self._finish.is_set():
            if recorder.ended():
                self._finish.set()
            self._look()
            hours = self._folder.hours + recorder.seconds() / 3600.0
            if hours >= self._wanted:
                return
            progress = self._progress(hours, max(starts, self._folder.starts))
            self._hear(recorder)
            self._say_progress(progress, recorder.problem)
            tenths = int(10.0 * hours / self._wanted)
            if tenths > told:
                told = tenths
                rospy.loginfo(progress)
            self._finish.wait(_PERIOD_S)

    def _hear(self, recorder: Recorder) -> None:
        """Say it when nothing is heard, and why, once for each reason; and when it is over."""
        before, self._silence = self._silence, ''
        longest = HEARD_S if recorder.events else _NOBODY_S
        if not recorder.problem and recorder.silent_for() > longest:
            self._silence = self._ask_why()
            if self._silence != before:
                rospy.logwarn('nothing is heard, so this time does not count: %s', self._silence)
        elif before and not recorder.problem:
            rospy.loginfo('the robot is heard')

    def _ask_why(self) -> str:
        """Return why nothing is heard, by what the master says, in words."""
        try:
            master = rosgraph.Master(rospy.get_name())
            publishers, subscribers, _ = master.getSystemState()
            types = dict(master.getTopicTypes())
        except (OSError, rosgraph.MasterException):
            return f'no master at {rosgraph.get_master_uri()}'
        return why_nothing_is_heard(
            self._plan.encoding, {topic: set(nodes) for topic, nodes in publishers},
            {topic: set(nodes) for topic, nodes in subscribers}, types,
            self._plan.subscribe == 'used')

    def _train(self) -> bool:
        """Learn from what there is; return False, and want more, if that is not enough."""
        held = self._folder.hours
        progress = f'{_length(held)} of {number_of(self._folder.starts, "start")} of the robot'
        rospy.loginfo('learning from %s', progress)
        self._announcer.say(DiagnosticStatus.OK, f'learning from {progress}', self._values())
        division = divide(self._folder.logs, self._plan.start_up)
        try:
            programs.train_and_calibrate(division, self._plan.model, self._plan.logs,
                                         self._plan.budget, rospy.is_shutdown)
        except programs.ProgramError as error:
            if not rospy.is_shutdown():
                self._wanted = max(_MORE * held, held + _LEAST_MORE_H)
                self._problem = str(error)
                rospy.logwarn('nothing was learned (%s): recording goes on until there are %s',
                              error, _length(self._wanted))
            return False
        return True

    def _look(self) -> None:
        for problem in self._folder.look():
            rospy.logwarn(problem)

    def _progress(self, hours: float, starts: int) -> str:
        return (f'learning: {_length(hours)} of {_length(self._wanted)}, '
                f'{number_of(starts, "start")} of the robot')

    def _say_progress(self, progress: str, problem: str) -> None:
        level = DiagnosticStatus.OK
        if self._problem:
            level = DiagnosticStatus.WARN
            progress += f'; the last attempt failed: {self._problem}'
        if self._silence:
            level = DiagnosticStatus.WARN
            progress = f'nothing is heard: {self._silence}; {progress}'
        if problem:
            level = DiagnosticStatus.ERROR
            progress = f'{problem}; {progress}'
        self._announcer.say(level, progress, self._values())

    def _values(self) -> Dict[str, str]:
        return {'model': self._plan.model, 'logs': self._plan.logs,
                'complete logs': str(len(self._folder.logs))}

    def _on_finish(self, _: TriggerRequest) -> TriggerResponse:
        if self._recorder is None:
            return TriggerResponse(False, 'nothing is recorded at the moment')
        self._finish.set()
        return TriggerResponse(True, 'learns from what was recorded; see /diagnostics')


def _length(hours: float) -> str:
    return f'{hours:.1f} h' if hours >= 1.0 else f'{60.0 * hours:.1f} min'
